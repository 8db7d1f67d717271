#pragma once

#include "lang/schema.h"

#include <string>

namespace scc::lang::lsp {

/// A TextMate grammar (JSON) of the language: its words and signs from the token table, units, types and
/// functions from theirs, constructors and fields from the schema.
std::string textmate_grammar(const Schema& schema);

} // namespace scc::lang::lsp
