#pragma once

#include "runtime/host/file.h"
#include "runtime/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace scc::host {

/// Reads any type that OpenImageIO knows. Integer files are decoded from sRGB unless `linear_integers`
/// (a 16-bit PNG that POV-Ray wrote with File_Gamma=1.0). At most the first three channels are
/// kept, and no alpha; of a multi-part file the first part. Throws FileError.
runtime::Image read_image(const std::string& path, bool linear_integers = false);

/// An image file as a texture: rows from the bottom, 1 channel (grey) or 3, no alpha (colours as stored). The
/// codes of an 8-bit file, or the linear light of any other.
struct Texels {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<std::uint8_t> codes;
    std::vector<float> values;
    bool holds_floats = false; ///< which are linear light
};

/// Reads any type that OpenImageIO knows, of at most `largest` texels a side. Files of 16 bits are decoded
/// from sRGB unless `linear_integers`. Returns what is wrong with the file, or "". Throws FileError where no
/// image can be read.
std::string read_texels(const std::string& path, bool linear_integers, int largest, Texels& texels);

} // namespace scc::host
