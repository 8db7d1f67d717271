#pragma once

#include "lang/ast.h"
#include "lang/lsp/document.h"
#include "lang/symbols.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Names that other files bind.
namespace scc::lang::lsp {

struct SceneText {
    std::string path;
    std::string text;
};
/// The file that `name` means in an import of the file at `from`; nothing if it cannot be had.
using OpenImport = std::function<std::optional<SceneText>(const std::string& from, const std::string& name)>;

/// The import whose path the token is, or whose name stands before the dot before it; null for other tokens.
const ast::Import* import_of_path(const Analysis& analysis, std::size_t token);
const ast::Import* import_before_dot(const Analysis& analysis, std::size_t token);

/// Null if it cannot be had.
std::unique_ptr<Analysis> analyse_import(const ast::Import& import, const std::string& from,
                                         const Schema& schema, const OpenImport& open);

/// What `name.member` can stand for: what the imported file binds on its top level, but its imports.
std::vector<const Symbol*> exported_symbols(const Analysis& imported);
const Symbol* exported_symbol(const Analysis& imported, std::string_view name);

} // namespace scc::lang::lsp
