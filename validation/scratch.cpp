#include "validation/scratch.h"

#include "runtime/host/file.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace scc::validation {

ScratchFolder::ScratchFolder() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    if (error)
        throw host::FileError(fmt::format("there is no folder for temporary files: {}", error.message()));
    std::string name = (parent / "scc-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw host::FileError(
            fmt::format("cannot make a folder in `{}`: {}", parent.string(), std::strerror(errno)));
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

} // namespace scc::validation
