#pragma once

#include "lang/diagnostic.h"
#include "lang/lexer.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace scc::lang {

inline constexpr std::uint32_t no_partner = std::numeric_limits<std::uint32_t>::max();

/// For every token that is a bracket the index of the one it pairs with, or no_partner. Reports what does not
/// pair, each mistake once: the parser can take the pairs for granted, and a mistake inside one never spills
/// over its end.
std::vector<std::uint32_t> pair_brackets(const std::vector<Token>& tokens, Diagnostics& diagnostics);

} // namespace scc::lang
