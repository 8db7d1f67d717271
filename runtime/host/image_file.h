#pragma once

#include "runtime/image.h"

#include <stdexcept>
#include <string>

/// Image files through OpenImageIO. Linear light in memory; the file's encoding follows from its type.
namespace scc::host {

/// The environment's fault (a file that cannot be read or written); the text names the file and the reason.
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct ImageFileOptions {
    int bits = 8; ///< of a PNG: 8 or 16
};

/// True for `.exr` (32-bit float linear), `.png` (sRGB-encoded), `.pfm` (float linear); case does not matter.
bool is_image_type_known(const std::string& path);

/// Writes under a temporary name in the same folder, then renames: the final name never holds half a picture.
void write_image(const std::string& path, const runtime::Image& image, const ImageFileOptions& options = {});

/// Reads any type that OpenImageIO knows. Integer files are decoded from sRGB unless `linear_integers`
/// (a 16-bit PNG that POV-Ray wrote with File_Gamma=1.0). At most the first three channels are kept.
runtime::Image read_image(const std::string& path, bool linear_integers = false);

} // namespace scc::host
