#pragma once

#include "lang/ast.h"
#include "lang/diagnostic.h"
#include "lang/lexer.h"
#include "lang/source.h"

#include <memory>
#include <vector>

namespace scc::lang {

/// Brackets, operators and blocks may nest this deep; deeper is reported and skipped.
inline constexpr int max_nesting = 128;
/// A chain of operators makes a tree as high as it is long, so trees are at most this high; brackets around a
/// chain add to it at most max_nesting.
inline constexpr int max_chain = 512;

/// Recursive descent over the grammar in grammar.md. After a mistake it goes on at the next item, so one run
/// reports all of them. What could not be read is an ErrorExpr, an empty name, or missing from the tree.
ast::File parse(const SourceSet& sources, FileId file, const std::vector<Token>& tokens,
                Diagnostics& diagnostics);

/// lex and parse in one go.
std::shared_ptr<const ast::File> parse_file(const SourceSet& sources, FileId file, Diagnostics& diagnostics);

/// parse_file for what is to be evaluated: long runs of lines that differ in numbers only are read as tables,
/// which gives the same in much less time. The tree is to outlive what is made of it.
std::shared_ptr<const ast::File> read_file(const SourceSet& sources, FileId file, Diagnostics& diagnostics);

/// A single expression from its own file (the value of a `-D`).
ast::ExprPtr parse_expression(const SourceSet& sources, FileId file, Diagnostics& diagnostics);

} // namespace scc::lang
