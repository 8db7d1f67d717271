#pragma once

#include "runtime/host/file.h"
#include "runtime/image.h"

#include <string>

namespace scc::host {

/// Reads any type that OpenImageIO knows. Integer files are decoded from sRGB unless `linear_integers`
/// (a 16-bit PNG that POV-Ray wrote with File_Gamma=1.0). At most the first three channels are
/// kept, and no alpha; of a multi-part file the first part. Throws FileError.
runtime::Image read_image(const std::string& path, bool linear_integers = false);

} // namespace scc::host
