#pragma once

#include "lang/lsp/document.h"
#include "lang/lsp/imports.h"

#include <string>

/// What a client asks about the name at a place.
namespace scc::lang::lsp {

/// Each gives null where there is nothing to say.
Json hover(Document& document, const Schema& schema, const OpenImport& open, std::uint32_t offset);
/// In another file, if an import has the name from there.
Json definition(Document& document, const Schema& schema, const OpenImport& open, std::uint32_t offset);
Json references(Document& document, const Schema& schema, std::uint32_t offset, bool with_definition);
Json highlights(Document& document, const Schema& schema, std::uint32_t offset);
Json prepare_rename(Document& document, const Schema& schema, std::uint32_t offset);

/// A WorkspaceEdit that gives the name at the offset another spelling wherever it is mentioned. Throws
/// RequestError if the new name could not be read, or would stand for something else somewhere.
Json rename(Document& document, const Schema& schema, std::uint32_t offset, const std::string& new_name);

} // namespace scc::lang::lsp
