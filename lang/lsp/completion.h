#pragma once

#include "lang/lsp/document.h"
#include "lang/lsp/imports.h"

namespace scc::lang::lsp {

struct CompletionStyle {
    bool snippets = false; ///< the client knows `$0`
};

/// A CompletionList for the cursor at the offset.
Json completion(Document& document, const Schema& schema, const OpenImport& open, std::uint32_t offset,
                CompletionStyle style);

} // namespace scc::lang::lsp
