#pragma once

#include "runtime/host/file.h"
#include "runtime/image.h"

#include <string>

/// Writing image files. Linear light in memory; the file's encoding follows from its type.
namespace scc::host {

struct ImageFileOptions {
    int bits = 8;         ///< of a PNG: 8 or 16
    bool compact = false; ///< an EXR is compressed: less than half the size, several times the time
    int threads = 1;      ///< that encode
};

/// True for `.exr` (32-bit float linear), `.png` (sRGB-encoded), `.pfm` (float linear); case does not matter.
bool is_image_type_known(const std::string& path);

/// Whether the file holds but 8 bits of each value, with `bits` for a PNG.
bool keeps_8_bits(const std::string& path, int bits);

/// True for `.exr`.
bool has_layers(const std::string& path);

/// Writes one or three channels through `replace_file`: the final name never holds half a picture. A PNG
/// holds values clamped to 0..1 (NaN: 0); float files keep every value. The bytes depend on the picture
/// alone. Throws FileError; for an unknown type, another number of channels or of bits,
/// std::invalid_argument.
void write_image(const std::string& path, const runtime::Image& image, const ImageFileOptions& options = {});

} // namespace scc::host
