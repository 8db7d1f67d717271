#pragma once

#include "lang/ast.h"
#include "lang/lexer.h"
#include "lang/source.h"

#include <string>
#include <vector>

namespace scc::lang {

/// The text of a file that was parsed without errors, in the one layout of the language: the same tokens and
/// comments in the same order, with other blanks, line ends and separators. It parses to the same tree, and
/// its own layout is itself.
///
/// A body or a bracket that the author wrote on one line stays there if it fits; other bodies have one item a
/// line. Lines that the author began within an item begin there still.
std::string format(const SourceSet& sources, const std::vector<Token>& tokens, const ast::File& file);

/// The same, after reading the result once more. Throws std::logic_error if the layout would change what the
/// text means, which is a mistake of ours.
std::string checked_format(const SourceSet& sources, const std::vector<Token>& tokens, const ast::File& file);

} // namespace scc::lang
