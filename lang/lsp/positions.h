#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace scc::lang::lsp {

/// What a client counts columns in.
enum class Encoding { utf8, utf16 };

/// A place as a client names it: 0-based line, and code units before it on the line.
struct Place {
    std::uint32_t line = 0;
    std::uint32_t character = 0;
};

/// Translates between byte offsets and a client's places. Lines end at `\n`, `\r\n` and `\r`, as the protocol
/// has it. The text, UTF-8, is to outlive this.
class Positions {
public:
    Positions(std::string_view text, Encoding encoding);

    /// An offset past the end counts as the end.
    Place place(std::uint32_t offset) const;
    /// A place past the end of its line counts as that end, one past the last line as the end of the text.
    std::uint32_t offset(Place place) const;

private:
    std::string_view text_;
    Encoding encoding_;
    std::vector<std::uint32_t> line_starts_;
};

} // namespace scc::lang::lsp
