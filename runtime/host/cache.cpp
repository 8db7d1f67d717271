#include "runtime/host/cache.h"

#include "runtime/host/checksum.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace scc::host {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t default_limit = std::uint64_t{1} << 30;

struct Seal {
    char magic[8] = {'s', 'c', 'c', ' ', 'c', 'a', 'c', '1'};
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;
};
static_assert(sizeof(Seal) == 24);

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

/// 0 if it is no size.
std::uint64_t parse_size(const std::string& text) {
    std::uint64_t size = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, size);
    const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
    const int shift = unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : 0;
    const bool fits = size <= ~std::uint64_t{0} >> shift;
    return error == std::errc{} && (unit.empty() || shift != 0) && fits ? size << shift : 0;
}

/// Its folder, made if need be; ours alone to write.
bool is_private_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder.parent_path(), error);
    ::mkdir(folder.c_str(), 0700);
    struct stat status {};
    return ::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid() &&
           (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// The content's size, or nothing if the file is not whole.
std::optional<std::size_t> sealed_size(std::string_view file) {
    Seal seal;
    const Seal expected;
    if (file.size() < sizeof seal) {
        return std::nullopt;
    }
    const std::string_view content = file.substr(0, file.size() - sizeof seal);
    std::memcpy(&seal, content.data() + content.size(), sizeof seal);
    const bool whole = std::memcmp(seal.magic, expected.magic, sizeof seal.magic) == 0 &&
                       seal.size == content.size() && seal.checksum == checksum(content);
    return whole ? std::optional(content.size()) : std::nullopt;
}

} // namespace

std::string cache_key(std::initializer_list<std::string_view> parts) {
    // Two 64-bit sums with seeds of their own; each part's length is in its sum.
    std::array<std::uint64_t, 2> sums{1, 2};
    for (const std::string_view part : parts) {
        for (std::uint64_t& sum : sums) {
            sum = checksum(part, sum);
        }
    }
    std::string key;
    for (const std::uint64_t sum : sums) {
        for (int shift = 60; shift >= 0; shift -= 4) {
            key += "0123456789abcdef"[sum >> shift & 15];
        }
    }
    return key;
}

Cache Cache::of_user() {
    if (environment("SCC_CACHE") == "off") {
        return {};
    }
    fs::path base = environment("XDG_CACHE_HOME");
    if (!base.is_absolute()) {
        const fs::path home = environment("HOME");
        if (!home.is_absolute()) {
            return {};
        }
        base = home / ".cache";
    }
    const fs::path folder = base / "scc";
    return is_private_folder(folder) ? in_folder(folder) : Cache();
}

Cache Cache::in_folder(fs::path folder) {
    const std::string size = environment("SCC_CACHE_SIZE");
    return {std::move(folder), size.empty() ? default_limit : parse_size(size)};
}

std::optional<Cache::Entry> Cache::find(std::string_view kind, const std::string& key) const {
    if (folder_.empty()) {
        return std::nullopt;
    }
    const fs::path path = folder_ / kind / key;
    try {
        MappedFile file(path.string());
        if (const std::optional<std::size_t> size = sealed_size(file.text())) {
            ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0); // used now
            return Entry(path, std::move(file), *size);
        }
        ::unlink(path.c_str());
    } catch (const FileError&) {
        // not there, or not ours to read
    }
    return std::nullopt;
}

void Cache::store(std::string_view kind, const std::string& key, std::string_view content) const {
    if (folder_.empty() || content.size() >= limit_bytes_) {
        return;
    }
    try {
        Seal seal;
        seal.size = content.size();
        seal.checksum = checksum(content);
        const std::array<std::string_view, 2> parts{content,
                                                    {reinterpret_cast<const char*>(&seal), sizeof seal}};
        fs::create_directories(folder_ / kind);
        replace_file((folder_ / kind / key).string(), parts);
        make_room();
    } catch (const FileError&) {
    } catch (const fs::filesystem_error&) {
    } catch (const std::bad_alloc&) {
    }
}

void Cache::make_room() const {
    struct File {
        fs::path path;
        fs::file_time_type used;
        std::uint64_t size;
    };
    constexpr std::chrono::hours abandoned(1); // a temporary file of a process that was ended
    const auto now = fs::file_time_type::clock::now();
    std::vector<File> files;
    std::uint64_t total = 0;
    // Others may remove files meanwhile: what has gone is passed over.
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder_, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code gone;
        if (!entry->is_regular_file(gone)) {
            continue;
        }
        const File file{entry->path(), entry->last_write_time(gone), entry->file_size(gone)};
        if (gone) {
            continue;
        }
        if (file.path.filename().native().starts_with(".")) {
            if (now - file.used > abandoned) {
                fs::remove(file.path, gone);
            }
            continue;
        }
        total += file.size;
        files.push_back(file);
    }
    std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
    for (const File& file : files) {
        if (total <= limit_bytes_) {
            return;
        }
        fs::remove(file.path, error);
        total -= file.size;
    }
}

} // namespace scc::host
