#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scc::cli {

/// What an ELF file of this machine's kind says of itself.
struct Executable {
    std::uint64_t code_bytes = 0; ///< of the sections with instructions
    std::vector<std::string> libraries;
};

/// Throws host::FileError if the file cannot be read or is no such file.
Executable inspect_executable(const std::string& path);

} // namespace scc::cli
