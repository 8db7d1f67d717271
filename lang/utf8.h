#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace scc::lang {

/// One character of a UTF-8 text. Bytes that are not UTF-8 decode one at a time, with `valid` false.
struct Character {
    char32_t code = 0;
    std::size_t length = 1; ///< in bytes
    bool valid = false;
};

/// The character at `offset`, which lies inside the text.
Character decode(std::string_view text, std::size_t offset);
std::string encode(char32_t code);
/// Offset of the first byte that is not UTF-8, or npos.
std::size_t find_malformed(std::string_view text);
/// Columns a terminal uses for the character: 0, 1 or 2.
int display_width(char32_t code);
/// The text as it is safe to print: control characters and bytes that are not UTF-8 become U+FFFD.
std::string printable(std::string_view text);

/// The text as a message quotes it: of a long one only the beginning.
std::string shortened(std::string_view text);

} // namespace scc::lang
