#pragma once

#include "lang/lsp/document.h"

namespace scc::lang::lsp {

/// DocumentSymbols: definitions by name, things by their path in the scene where it is known.
Json outline(Document& document, const Schema& schema);

} // namespace scc::lang::lsp
