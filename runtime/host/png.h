#pragma once

#include "runtime/image.h"

#include <string>

namespace scc::host {

/// A PNG file's bytes (ISO 15948), sRGB-encoded, 8 or 16 bits; 1 or 3 channels. They depend on the picture
/// alone.
std::string encode_png(const runtime::Image& image, int bits = 8, int threads = 1);

} // namespace scc::host
