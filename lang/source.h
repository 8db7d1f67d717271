#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang {

using FileId = std::uint32_t;
inline constexpr FileId no_file = std::numeric_limits<FileId>::max();

/// A half-open range of bytes in one source file; by default at no place.
struct Span {
    FileId file = no_file;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    friend bool operator==(const Span&, const Span&) = default;
};

/// From the first byte of `a` to the last byte of `b`; both lie in the same file.
constexpr Span join(Span a, Span b) {
    return {a.file, a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end};
}

/// 1-based line and column; the column counts bytes, as Clang's does.
struct Position {
    std::uint32_t line = 1;
    std::uint32_t column = 1;
};

/// One text with its name and the offsets at which its lines start.
class SourceFile {
public:
    /// Throws std::length_error if the text is too long for 32-bit offsets.
    SourceFile(std::string path, std::string text);

    const std::string& path() const { return path_; }
    std::string_view text() const { return text_; }
    /// Offsets past the end count as the end.
    Position position(std::uint32_t offset) const;
    /// Text of a 1-based line, without its line end (`\n` or `\r\n`).
    std::string_view line(std::uint32_t number) const;

private:
    std::string path_;
    std::string text_;
    std::vector<std::uint32_t> line_starts_;
};

/// All files of one compilation. References stay valid while files are added.
class SourceSet {
public:
    FileId add(std::string path, std::string text);
    const SourceFile& file(FileId id) const { return files_[id]; }
    bool contains(FileId id) const { return id < files_.size(); }
    /// Empty for a span at no place; a span that reaches past the end is cut there.
    std::string_view text(Span span) const;

private:
    std::deque<SourceFile> files_;
};

} // namespace scc::lang
