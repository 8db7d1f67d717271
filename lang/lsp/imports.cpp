#include "lang/lsp/imports.h"

#include <utility>
#include <variant>

namespace scc::lang::lsp {
namespace {

template <class Predicate>
const ast::Import* find_import(const Analysis& analysis, Predicate&& is_meant) {
    for (const ast::Item& item : analysis.tree->items) {
        const auto* import = std::get_if<ast::Import>(&item.node);
        if (import && is_meant(*import)) {
            return import;
        }
    }
    return nullptr;
}

const std::string* name_of_file(const ast::Import& import) {
    const auto* string = import.path ? std::get_if<ast::String>(&import.path->node) : nullptr;
    return string ? &string->value : nullptr;
}

} // namespace

const ast::Import* import_of_path(const Analysis& analysis, std::size_t token) {
    return find_import(analysis, [&](const ast::Import& import) {
        return import.path && import.path->span == analysis.tokens[token].span;
    });
}

const ast::Import* import_before_dot(const Analysis& analysis, std::size_t token) {
    if (token < 2 || analysis.tokens[token - 1].kind != TokenKind::dot) {
        return nullptr;
    }
    const Symbol* before = analysis.symbols.at(analysis.tokens[token - 2].span.begin);
    if (!before || before->kind != SymbolKind::import) {
        return nullptr;
    }
    return find_import(analysis,
                       [&](const ast::Import& import) { return import.alias.span == before->span; });
}

std::unique_ptr<Analysis> analyse_import(const ast::Import& import, const std::string& from,
                                         const Schema& schema, const OpenImport& open) {
    const std::string* name = name_of_file(import);
    std::optional<SceneText> found = name ? open(from, *name) : std::nullopt;
    return found ? std::make_unique<Analysis>(found->path, std::move(found->text), schema) : nullptr;
}

std::vector<const Symbol*> exported_symbols(const Analysis& imported) {
    std::vector<const Symbol*> symbols;
    for (const std::uint32_t index : imported.symbols.scopes.front().symbols) {
        const Symbol& symbol = imported.symbols.symbols[index];
        if (symbol.kind == SymbolKind::let || symbol.kind == SymbolKind::param ||
            symbol.kind == SymbolKind::function) {
            symbols.push_back(&symbol);
        }
    }
    return symbols;
}

const Symbol* exported_symbol(const Analysis& imported, std::string_view name) {
    for (const Symbol* symbol : exported_symbols(imported)) {
        if (symbol->name == name) {
            return symbol;
        }
    }
    return nullptr;
}

} // namespace scc::lang::lsp
