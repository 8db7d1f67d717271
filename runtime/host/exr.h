#pragma once

#include "runtime/image.h"

#include <string>

namespace scc::host {

/// An OpenEXR file's bytes (one part, rows of 32-bit floats), uncompressed or, `compact`, by its ZIP method.
std::string encode_exr(const runtime::Image& image, bool compact, int threads = 1);

} // namespace scc::host
