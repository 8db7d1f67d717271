#pragma once

#include "lang/ast.h"
#include "lang/diagnostic.h"
#include "lang/source.h"

#include <string>
#include <string_view>
#include <vector>

namespace scc::lang {

/// The kinds of token; rows in tokens.def.
enum class TokenKind {
#define SCC_TOKEN(kind, spelling) kind,
#include "lang/tokens.def"
#undef SCC_TOKEN
};

std::string_view spelling(TokenKind kind);

struct Token {
    TokenKind kind;
    Span span;
    bool starts_line = false; ///< the first token on its line
    double number = 0;        ///< of a number
    ast::Unit unit = ast::Unit::none;
    std::string text; ///< of a string: its value with escapes resolved
};

/// Splits a file into tokens, the last of which is end_of_file. Never stops at a mistake: what cannot be read is
/// reported and becomes a token of kind `error`. Line ends are not tokens; the parser asks `starts_line`.
std::vector<Token> lex(const SourceSet& sources, FileId file, Diagnostics& diagnostics);

} // namespace scc::lang
