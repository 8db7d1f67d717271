#pragma once

#include "runtime/host/file.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

/// What can be made again but takes time to: compiled code, hierarchies over meshes.
namespace scc::host {

/// The name of an entry that depends on nothing but these texts.
std::string cache_key(std::initializer_list<std::string_view> parts);

/// Files in a folder, each under its key. Several processes may use it at once; an entry appears as a whole
/// or not at all. It never fails: what cannot be stored is not there the next time, and a damaged entry is
/// removed and counts as missing. Beyond its limit the entries that were not used for longest are removed.
class Cache {
public:
    /// An entry's content, in memory as long as this lives.
    class Entry {
    public:
        Entry(std::filesystem::path path, MappedFile file, std::size_t size)
            : path_(std::move(path)), file_(std::move(file)), size_(size) {}
        std::string_view content() const { return file_.text().substr(0, size_); }
        /// The file that begins with the content; a seal of 24 bytes follows.
        const std::filesystem::path& path() const { return path_; }

    private:
        std::filesystem::path path_;
        MappedFile file_;
        std::size_t size_;
    };

    /// No folder: nothing is ever found or kept.
    Cache() = default;
    Cache(std::filesystem::path folder, std::uint64_t limit_bytes)
        : folder_(std::move(folder)), limit_bytes_(limit_bytes) {}

    /// The user's: $XDG_CACHE_HOME/scc, else ~/.cache/scc. The environment's SCC_CACHE_SIZE is its limit
    /// (bytes, or with K, M or G; 1G if it is not set), and SCC_CACHE=off means none. A folder that others
    /// may write to is not used, since programs are run from it.
    static Cache of_user();
    /// An existing folder, with the same limit; whoever may write to it can change what is found there.
    static Cache in_folder(std::filesystem::path folder);

    bool keeps() const { return !folder_.empty(); }
    /// `kind`: a folder within, for a person to see what is there.
    std::optional<Entry> find(std::string_view kind, const std::string& key) const;
    void store(std::string_view kind, const std::string& key, std::string_view content) const;

private:
    void make_room() const;

    std::filesystem::path folder_;
    std::uint64_t limit_bytes_ = 0;
};

} // namespace scc::host
