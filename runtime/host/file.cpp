#include "runtime/host/file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/mman.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace scc::host {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
    throw FileError("cannot write `" + path + "`: " + std::strerror(error));
}

class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0)
            ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int get() const { return fd_; }
    /// Closing may be where a network or quota error shows.
    bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

private:
    int fd_;
};

class TemporaryName {
public:
    explicit TemporaryName(fs::path path) : path_(std::move(path)) {}
    ~TemporaryName() {
        if (!path_.empty())
            ::unlink(path_.c_str());
    }
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;

    void release() { path_.clear(); }

private:
    fs::path path_;
};

void write_all(Descriptor& file, std::span<const std::string_view> parts, const std::string& path) {
    for (std::string_view bytes : parts) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
            if (written < 0 && errno != EINTR)
                fail(path, errno);
            if (written > 0)
                bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }
    if (!file.close())
        fail(path, errno);
}

void write_in_place(const std::string& path, std::span<const std::string_view> parts) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.get() < 0)
        fail(path, errno);
    write_all(file, parts, path);
}

/// Where the bytes have to go: the end of a chain of symbolic links.
fs::path target_of(const std::string& path) {
    std::error_code none;
    if (!fs::is_symlink(path, none))
        return path;
    const fs::path target = fs::weakly_canonical(path, none);
    return none ? fs::path(path) : target;
}

} // namespace

void replace_file(const std::string& path, std::string_view bytes, FileKind kind) {
    replace_file(path, std::span(&bytes, 1), kind);
}

void replace_file(const std::string& path, std::span<const std::string_view> parts, FileKind kind) {
    const fs::path target = target_of(path);
    std::error_code none;
    const fs::file_status status = fs::status(target, none);
    if (fs::is_directory(status))
        fail(path, EISDIR);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return write_in_place(path, parts);

    static std::atomic<unsigned> counter{0};
    // Not derived from the file's own name, which may already be as long as the file system allows.
    const fs::path name = target.parent_path() /
                          (".scc-" + std::to_string(::getpid()) + "-" + std::to_string(++counter) + ".tmp");
    Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                           kind == FileKind::program ? 0777 : 0666));
    if (file.get() < 0)
        fail(path, errno);
    TemporaryName temporary(name);
    write_all(file, parts, path);
    if (::rename(name.c_str(), target.c_str()) != 0)
        fail(path, errno);
    temporary.release();
}

MappedFile::MappedFile(const std::string& path) {
    const auto fail_reading = [&](int error) {
        throw FileError("cannot read `" + path + "`: " + std::strerror(error));
    };
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status {};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0)
        fail_reading(errno);
    if (!S_ISREG(status.st_mode))
        fail_reading(S_ISDIR(status.st_mode) ? EISDIR : EINVAL);
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size == 0)
        return;
    void* memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.get(), 0);
    if (memory == MAP_FAILED)
        fail_reading(errno);
    bytes_ = {static_cast<const std::byte*>(memory), size};
}

MappedFile::~MappedFile() {
    if (!bytes_.empty())
        ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

} // namespace scc::host
