#include "lang/scope.h"

#include <utility>

namespace scc::lang {

Scope& Names::add_scope(Scope* parent) {
    scopes_.push_back({parent, {}, {}});
    return scopes_.back();
}

Binding& Names::bind(Scope& scope, Binding::Kind kind, std::string_view name, Span span, Binding* owner) {
    Binding& binding = bindings_.emplace_back();
    binding.kind = kind;
    binding.name = name;
    binding.span = span;
    binding.scope = &scope;
    binding.owner = owner;
    const bool has_cell =
        kind == Binding::Kind::let || kind == Binding::Kind::param || kind == Binding::Kind::variable;
    if (has_cell) {
        binding.cell = static_cast<std::uint32_t>(scope.cells.size());
        scope.cells.push_back(&binding);
    }
    if (name.empty()) { // could not be read
        binding.used = true;
        return binding;
    }
    const auto [first, inserted] = scope.names.try_emplace(name, &binding);
    if (!inserted) {
        diagnostics_.report(Diag::duplicate_name, span, name)
            .note(first->second->span, "the first one is here");
        binding.used = true;
        first->second->used = true;
        first->second->is_spoilt = true;
    }
    return binding;
}

Binding* Names::find(Scope* scope, std::string_view name) {
    for (; scope; scope = scope->parent) {
        if (const auto found = scope->names.find(name); found != scope->names.end()) {
            return found->second;
        }
    }
    return nullptr;
}

std::vector<std::string_view> Names::visible(const Scope* scope) {
    std::vector<std::string_view> names;
    for (; scope; scope = scope->parent) {
        for (const auto& [name, binding] : scope->names) {
            names.push_back(name);
        }
    }
    return names;
}

std::uint32_t Names::depth(const Scope* from, const Scope* to) {
    std::uint32_t frames = 0;
    for (; from != to; from = from->parent) {
        ++frames;
    }
    return frames;
}

static bool stands_within(const Binding& inner, const Binding* outer) {
    const Binding* b = inner.owner;
    while (b && b != outer) {
        b = b->owner;
    }
    return b == outer;
}

void Names::note_use(Binding& target, Span span, Binding* user) {
    target.used = true;
    if (target.kind == Binding::Kind::variable || target.kind == Binding::Kind::misplaced) {
        return;
    }
    for (Binding* b = user; b && !stands_within(target, b); b = b->owner) {
        b->uses.push_back({&target, span});
    }
}

void Names::export_all(const Scope& scope) {
    for (const auto& [name, binding] : scope.names) {
        binding->used = binding->used || binding->kind != Binding::Kind::import;
    }
}

Span Names::definition_span(const Binding& binding) {
    if (binding.let) {
        return binding.let->span;
    }
    Span span = binding.span;
    if (binding.param) {
        for (const ast::Expr* part : {binding.param->default_value.get(), binding.param->range.get()}) {
            span = part ? join(span, part->span) : span;
        }
    }
    return span;
}

} // namespace scc::lang
