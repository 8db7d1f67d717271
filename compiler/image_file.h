#pragma once

#include "compiler/ir/image.h"

#include <filesystem>
#include <stdexcept>

namespace scc::compiler {

/// Neither side of an image has more texels.
inline constexpr int largest_image = 16384;

/// What is wrong with an image file, in words.
struct ImageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class ImageEncoding { srgb, linear };

struct LoadedImage {
    ir::Image image;
    bool holds_floats = false; ///< which are linear light, whatever the encoding
};

/// Reads a file of any type that OpenImageIO knows, as linear light: grey stays one channel, alpha is left
/// out (colours as stored). 8-bit files stay codes with a table, others become floats. Throws ImageError.
LoadedImage load_image(const std::filesystem::path& path, ImageEncoding encoding, runtime::Wrap wrap,
                       runtime::Filter filter);

} // namespace scc::compiler
