#pragma once

#include "runtime/texture.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace scc::compiler::ir {

/// An image that per-point functions look up.
struct Image {
    std::string name; ///< the file's, without folder and extension
    std::string key;  ///< of the content and of how it is looked up: two with the same key are one
    runtime::ImageData data;
    bool is_srgb = false; ///< its codes are those of IEC 61966-2-1; else a code is in proportion to the light
    std::shared_ptr<const void> owner; ///< of what `data` points to
};

} // namespace scc::compiler::ir
