#pragma once

#include "lang/ast.h"
#include "lang/lexer.h"

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace scc::lang {

/// Tokens from `first` to `last`.
struct TokenRange {
    std::uint32_t first, last;
};

/// What the layout of a text needs to know of its tree, by indices of tokens.
struct FormatStructure {
    std::vector<TokenRange> items;                                     ///< of the file
    std::unordered_map<std::uint32_t, std::vector<TokenRange>> bodies; ///< items by the opening brace
    std::unordered_set<std::uint32_t> postfix; ///< `(` and `[` that belong to the operand before them
    std::unordered_set<std::uint32_t> infix;   ///< `-` between two operands
    std::vector<std::uint32_t> partner;        ///< of a bracket
};

FormatStructure structure_of(const std::vector<Token>& tokens, const ast::File& file);

} // namespace scc::lang
