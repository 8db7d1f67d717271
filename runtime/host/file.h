#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace scc::host {

/// The environment's fault (a file that cannot be read or written); the text names the file and the reason.
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Makes `bytes` the content of the file: written under a temporary name in the same folder, then renamed, so
/// that the final name never holds half of it; the temporary file is removed on failure. A symbolic link
/// stays one and its target is replaced. What is not a regular file (a device, a pipe) is written in place.
/// Throws FileError.
void replace_file(const std::string& path, std::string_view bytes);

} // namespace scc::host
