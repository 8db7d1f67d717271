#include "lang/symbols.h"

#include "lang/scope.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace scc::lang {
namespace {

bool touches(Span span, std::uint32_t offset) {
    return span.begin <= offset && offset <= span.end;
}

bool before(const Mention& a, const Mention& b) {
    return a.span.begin < b.span.begin;
}

} // namespace

const Symbol* SymbolIndex::at(std::uint32_t offset) const {
    for (const Symbol& symbol : symbols) {
        const bool is_here = touches(symbol.span, offset) ||
                             std::any_of(symbol.mentions.begin(), symbol.mentions.end(),
                                         [&](const Mention& m) { return touches(m.span, offset); });
        if (is_here) {
            return &symbol;
        }
    }
    return nullptr;
}

std::uint32_t SymbolIndex::scope_at(std::uint32_t offset) const {
    std::uint32_t best = 0;
    for (std::uint32_t i = 0; i < scopes.size(); ++i) {
        const Span& extent = scopes[i].extent;
        const Span& smallest = scopes[best].extent;
        if (touches(extent, offset) && extent.end - extent.begin <= smallest.end - smallest.begin) {
            best = i;
        }
    }
    return best;
}

const Symbol* SymbolIndex::find(std::uint32_t scope, std::string_view name) const {
    for (; scope != SymbolScope::none; scope = scopes[scope].parent) {
        for (const std::uint32_t symbol : scopes[scope].symbols) {
            if (symbols[symbol].name == name) {
                return &symbols[symbol];
            }
        }
    }
    return nullptr;
}

bool SymbolIndex::is_within(std::uint32_t inner, std::uint32_t outer) const {
    while (inner != outer && inner != SymbolScope::none) {
        inner = scopes[inner].parent;
    }
    return inner == outer;
}

SymbolIndex Names::index(std::vector<Found> mentions) const {
    SymbolIndex index;
    std::unordered_map<const Scope*, std::uint32_t> scopes;
    for (const Scope& scope : scopes_) { // parents come before what stands in them
        scopes.emplace(&scope, static_cast<std::uint32_t>(index.scopes.size()));
        index.scopes.push_back(
            {scope.parent ? scopes.at(scope.parent) : SymbolScope::none, scope.extent, {}});
    }
    std::unordered_map<std::uint32_t, std::size_t> defined_at;
    for (const Binding& binding : bindings_) {
        if (binding.name.empty()) {
            continue;
        }
        const std::uint32_t scope = scopes.at(binding.scope);
        if (find(binding.scope, binding.name) == &binding) { // else a second one of this name
            index.scopes[scope].symbols.push_back(static_cast<std::uint32_t>(index.symbols.size()));
        }
        defined_at.emplace(binding.span.begin, index.symbols.size());
        index.symbols.push_back(
            {binding.kind, std::string(binding.name), binding.span, binding.extent, binding.type, scope, {}});
    }
    for (const Found& found : mentions) {
        if (const auto symbol = defined_at.find(found.definition.begin); symbol != defined_at.end()) {
            index.symbols[symbol->second].mentions.push_back({found.span, scopes.at(found.scope)});
        }
    }
    for (Symbol& symbol : index.symbols) {
        std::sort(symbol.mentions.begin(), symbol.mentions.end(), before);
    }
    return index;
}

} // namespace scc::lang
