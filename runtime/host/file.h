#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace scc::host {

/// The environment's fault (a file that cannot be read or written); the text names the file and the reason.
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class FileKind { data, program };

/// Makes `bytes` the content of the file: written under a temporary name in the same folder, then renamed, so
/// that the final name never holds half of it; the temporary file is removed on failure. A symbolic link
/// stays one and its target is replaced. What is not a regular file (a device, a pipe) is written in place.
/// Throws FileError.
void replace_file(const std::string& path, std::string_view bytes, FileKind kind = FileKind::data);
/// The same for content in parts.
void replace_file(const std::string& path, std::span<const std::string_view> parts,
                  FileKind kind = FileKind::data);

/// A file's content in memory, read as it is looked at. Throws FileError if it cannot be read.
class MappedFile {
public:
    explicit MappedFile(const std::string& path);
    ~MappedFile();
    MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }

    std::span<const std::byte> bytes() const { return bytes_; }
    std::string_view text() const { return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}; }

private:
    std::span<const std::byte> bytes_;
};

} // namespace scc::host
