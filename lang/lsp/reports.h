#pragma once

#include "lang/lsp/document.h"

/// Diagnostics and their fixes, as the protocol has them. Both are of a document that has been checked.
namespace scc::lang::lsp {

/// What the client understands.
struct DiagnosticStyle {
    bool related = false; ///< notes as related places; else they are added to the message
};

/// The parameters of `textDocument/publishDiagnostics`.
Json published(Document& document, DiagnosticStyle style);

/// Quick fixes for what was reported within the range, and one for all of the file's.
Json code_actions(Document& document, std::uint32_t begin, std::uint32_t end, DiagnosticStyle style);

} // namespace scc::lang::lsp
