#pragma once

#include <filesystem>
#include <string>

namespace scc::validation {

/// A new, private, empty folder in the temporary directory, removed with all it holds at the end.
class ScratchFolder {
public:
    /// Throws host::FileError if there is no place for it.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace scc::validation
