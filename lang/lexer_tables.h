#pragma once

#include "lang/ast.h"
#include "lang/lexer.h"
#include "lang/utf8.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What the lexer knows about characters and words.
namespace scc::lang {

constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
constexpr bool is_hex_digit(char c) {
    return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}
constexpr bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
constexpr bool is_ascii(char c) {
    return static_cast<unsigned char>(c) < 0x80;
}
constexpr bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

inline constexpr auto name_characters = [] {
    std::array<bool, 256> table{};
    for (int c = 0; c < 128; ++c) {
        table[static_cast<std::size_t>(c)] =
            is_letter(static_cast<char>(c)) || is_digit(static_cast<char>(c));
    }
    return table;
}();
constexpr bool continues_name(char c) {
    return name_characters[static_cast<unsigned char>(c)];
}

/// The reserved word, or `name`.
TokenKind kind_of_word(std::string_view word);

std::optional<ast::Unit> unit_named(std::string_view text);
std::vector<std::string_view> unit_names();
/// What the author of an unknown unit most likely meant.
std::optional<std::string_view> likely_unit(std::string_view text);

/// The ASCII for which word processors and web pages put this look-alike; else empty.
std::string_view ascii_look_alike(char32_t code);
/// Quotes of other languages and of typography.
bool is_wrong_quote(char32_t code);

/// A character as a message names it: itself in backticks, or its code point where it does not show.
std::string named(const Character& c);

} // namespace scc::lang
