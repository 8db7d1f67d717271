#pragma once

#include "lang/diagnostic.h"
#include "lang/value.h"

#include <array>
#include <optional>

namespace scc::lang {

/// Where the evaluator gets the content of images from: the front end itself opens no files.
class ImageSource {
public:
    virtual ~ImageSource() = default;
    /// The colour of an `image { }` at a point, v upwards; nothing if the image cannot be read, which is
    /// reported the first time.
    virtual std::optional<std::array<double, 3>> color(const ThingPtr& image, double u, double v) = 0;
};

} // namespace scc::lang
