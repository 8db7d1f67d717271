#pragma once

#include "lang/ast.h"
#include "lang/lexer.h"
#include "lang/source.h"

#include <string>
#include <string_view>
#include <vector>

namespace scc::lang {

/// One token per line: where it stands, its kind, its text; numbers with the value that was read.
std::string dump_tokens(const SourceSet& sources, const std::vector<Token>& tokens);
/// An indented tree, one node per line, without positions.
std::string dump_ast(const ast::File& file);
std::string dump_ast(const ast::Expr& expression);

/// As written in a scene: `deg`, `then`, `not`; empty for no unit.
std::string_view spelling(ast::Unit unit);
std::string_view spelling(ast::UnaryOp op);
std::string_view spelling(ast::BinaryOp op);

} // namespace scc::lang
