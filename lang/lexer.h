#pragma once

#include "lang/ast.h"
#include "lang/diagnostic.h"
#include "lang/source.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang {

/// The kinds of token; rows in tokens.def.
enum class TokenKind : std::uint8_t {
#define SCC_TOKEN(kind, spelling) kind,
#include "lang/tokens.def"
#undef SCC_TOKEN
};

std::string_view spelling(TokenKind kind);

struct Token {
    double number = 0; ///< of a number; of a colour 0xrrggbb
    Span span;         ///< a string's quotes and a number's unit belong to it
    TokenKind kind = TokenKind::error;
    ast::Unit unit = ast::Unit::none;
    bool starts_line = false; ///< the first token on its line
};

/// Splits a file into tokens, the last of which is end_of_file. Never stops at a mistake: what cannot be read
/// is reported and becomes a token of kind `error`. Line ends are not tokens; the parser asks `starts_line`.
std::vector<Token> lex(const SourceSet& sources, FileId file, Diagnostics& diagnostics);
/// Leaves out these lines, each of which lies whole in the text, in ascending order.
std::vector<Token> lex_around(const SourceSet& sources, FileId file, const std::vector<Span>& left_out,
                              Diagnostics& diagnostics);
/// Only what lies in the span.
std::vector<Token> lex_within(const SourceSet& sources, Span span, Diagnostics& diagnostics);

/// What a string literal stands for: without its quotes and with escapes resolved. The closing quote may
/// lack.
std::string string_value(std::string_view literal);

} // namespace scc::lang
