#include "lang/lexer_tables.h"

#include <utility>
#include <vector>

namespace scc::lang {
namespace {

constexpr std::string_view spellings[] = {
#define SCC_TOKEN(kind, spelling) spelling,
#include "lang/tokens.def"
#undef SCC_TOKEN
};

constexpr std::size_t words_per_letter = 3;
using Words = std::array<TokenKind, words_per_letter>;

// The reserved words by their first letter; unused places hold `name`.
constexpr auto reserved_words = [] {
    std::array<Words, 26> table{};
    for (Words& words : table) {
        for (TokenKind& kind : words) {
            kind = TokenKind::name;
        }
    }
    const auto first = static_cast<std::size_t>(TokenKind::kw_language);
    const auto last = static_cast<std::size_t>(TokenKind::kw_false);
    for (std::size_t kind = first; kind <= last; ++kind) {
        Words& words = table[static_cast<std::size_t>(spellings[kind][0] - 'a')];
        std::size_t place = 0;
        while (words[place] != TokenKind::name) { // no place left is an error of this constant expression
            ++place;
        }
        words[place] = static_cast<TokenKind>(kind);
    }
    return table;
}();

constexpr std::size_t longest_reserved_word = std::string_view("language").size();

constexpr std::pair<std::string_view, ast::Unit> units[] = {
    {"deg", ast::Unit::deg}, {"rad", ast::Unit::rad}, {"mm", ast::Unit::mm},    {"cm", ast::Unit::cm},
    {"m", ast::Unit::m},     {"km", ast::Unit::km},   {"inch", ast::Unit::inch}};

constexpr std::pair<std::string_view, std::string_view> unit_synonyms[] = {
    {"\xC2\xB0", "deg"}, {"d", "deg"},       {"degree", "deg"}, {"degrees", "deg"},
    {"radian", "rad"},   {"radians", "rad"}, {"in", "inch"},    {"inches", "inch"},
    {"meter", "m"},      {"metre", "m"},     {"meters", "m"},   {"metres", "m"}};

} // namespace

std::string_view spelling(TokenKind kind) {
    return spellings[static_cast<std::size_t>(kind)];
}

TokenKind kind_of_word(std::string_view word) {
    if (word[0] < 'a' || word[0] > 'z' || word.size() > longest_reserved_word) {
        return TokenKind::name;
    }
    for (const TokenKind kind : reserved_words[static_cast<std::size_t>(word[0] - 'a')]) {
        if (kind == TokenKind::name || spelling(kind) == word) {
            return kind;
        }
    }
    return TokenKind::name;
}

std::optional<ast::Unit> unit_named(std::string_view text) {
    for (const auto& [name, unit] : units) {
        if (name == text) {
            return unit;
        }
    }
    return {};
}

std::optional<std::string_view> likely_unit(std::string_view text) {
    for (const auto& [synonym, unit] : unit_synonyms) {
        if (text == synonym) {
            return unit;
        }
    }
    return nearest(text, unit_names());
}

std::vector<std::string_view> unit_names() {
    std::vector<std::string_view> names;
    for (const auto& [name, unit] : units) {
        names.push_back(name);
    }
    return names;
}

std::string_view ascii_look_alike(char32_t code) {
    switch (code) {
    case 0x00a0:
        return " ";
    case 0x00d7:
        return "*";
    case 0x2010:
    case 0x2013:
    case 0x2212:
        return "-";
    case 0x2260:
        return "!=";
    case 0x2264:
        return "<=";
    case 0x2265:
        return ">=";
    default:
        return {};
    }
}

bool is_wrong_quote(char32_t code) {
    return code == '\'' || (code >= 0x2018 && code <= 0x201f);
}

std::string named(const Character& c) {
    const std::string text = encode(c.code);
    const bool shows = c.code > ' ' && c.code != 0xa0 && display_width(c.code) > 0 && printable(text) == text;
    return shows ? fmt::format("`{}`", text) : fmt::format("U+{:04X}", static_cast<std::uint32_t>(c.code));
}

} // namespace scc::lang
