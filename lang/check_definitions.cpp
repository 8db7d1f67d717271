#include "lang/checker.h"
#include "lang/wording.h"

namespace scc::lang {

Typed Checker::reference(Binding& binding, Span span, const Place& place) {
    Names::note_use(binding, span, place.owner);
    ensure(binding);
    if (binding.kind == Binding::Kind::import) {
        if (binding.imported) {
            diagnostics_.report(Diag::bare_import, span, binding.name)
                .suggest(span, std::string(binding.name) + ".scene");
        }
        return {};
    }
    return value_of(binding, Names::depth(place.scope, binding.scope), span);
}

/// The code stands `depth` frames within that of the binding.
Typed Checker::value_of(const Binding& binding, std::uint32_t depth, Span span) {
    const bool has_gaps = binding.function && binding.function->has_gaps;
    if (binding.kind == Binding::Kind::misplaced || !binding.type_known || binding.is_spoilt || has_gaps) {
        return {};
    }
    if (binding.kind == Binding::Kind::function) {
        return {binding.type, make_code(code::FunctionValue{depth, binding.function_code}, span)};
    }
    return {binding.type, make_code(code::Variable{depth, binding.cell}, span)};
}

/// Finds the binding's type. One that is being checked already keeps an unknown type: report_cycles tells
/// why.
void Checker::ensure(Binding& binding) {
    switch (binding.kind) {
    case Binding::Kind::let:
        if (binding.state == Binding::State::unchecked) {
            ensure_let(binding);
        }
        break;
    case Binding::Kind::function:
        ensure_signature(binding);
        if (!binding.type_known) {
            ensure_function(binding);
        }
        break;
    case Binding::Kind::param:
        if (binding.state == Binding::State::unchecked) {
            param(binding);
        }
        break;
    case Binding::Kind::variable:
    case Binding::Kind::import:
    case Binding::Kind::misplaced:
        binding.type_known = true;
        break;
    }
}

void Checker::ensure_let(Binding& binding) {
    binding.state = Binding::State::checking;
    const Place place{binding.scope, &binding, binding.name};
    const ast::Let& let = *binding.let;
    if (let.type) { // known from the start, so that functions may refer to it
        binding.type = type(let.type.get());
        binding.type_known = true;
    }
    Typed value = expression(let.value, place);
    if (let.type && let.value) {
        expect(in_code(binding.name), binding.type, value, *let.value);
    } else {
        binding.type = std::move(value.type);
    }
    binding.type_known = true;
    binding.code = std::move(value.code);
    binding.state = Binding::State::checked;
}

std::vector<Type> Checker::formal_types(const std::vector<ast::Formal>& formals) {
    std::vector<Type> types;
    for (const ast::Formal& formal : formals) {
        types.push_back(type(formal.type.get()));
    }
    return types;
}

void Checker::defaults(const std::vector<ast::Formal>& formals, const std::vector<Type>& types,
                       const Place& place, FunctionCode& function) {
    function.parameters = formals.size();
    for (std::size_t i = 0; i < formals.size(); ++i) {
        Typed value = expression(formals[i].default_value, place.unnamed());
        if (formals[i].default_value) {
            expect(in_code(formals[i].name.text), types[i], value, *formals[i].default_value);
        }
        function.defaults.push_back(std::move(value.code));
    }
}

Scope& Checker::bind_formals(const std::vector<ast::Formal>& formals, const std::vector<Type>& types,
                             Scope* outer, Binding* owner) {
    Scope& scope = names_.add_scope(outer);
    for (std::size_t i = 0; i < formals.size(); ++i) {
        Binding& formal = bind(scope, Binding::Kind::variable, formals[i].name, owner);
        formal.type = types[i];
    }
    return scope;
}

/// The type as far as the function's head tells it.
void Checker::ensure_signature(Binding& binding) {
    if (binding.type.kind == TypeKind::function) {
        return;
    }
    const ast::Function& function = *binding.function;
    binding.type = Type::function(formal_types(function.formals), type(function.result.get()));
    binding.type_known = function.result != nullptr;
}

void Checker::ensure_function(Binding& binding) {
    ensure_signature(binding);
    const ast::Function& function = *binding.function;
    if (binding.state != Binding::State::unchecked) {
        if (binding.state == Binding::State::checking && !binding.type_known) {
            binding.needs_result_type = true;
            binding.type_known = true;
        }
        return;
    }
    binding.state = Binding::State::checking;
    const std::vector<Type> parameters(binding.type.args.begin(), binding.type.args.end() - 1);
    FunctionCode& code = *binding.function_code;
    defaults(function.formals, parameters, {binding.scope, &binding, {}}, code);
    Scope& scope = bind_formals(function.formals, parameters, binding.scope, &binding);
    for (const ast::Let& let : function.body.lets) {
        Binding& local = bind(scope, Binding::Kind::let, let.name, &binding);
        local.let = &let;
    }
    for (Binding* local : scope.cells) {
        ensure(*local);
    }
    Typed result = expression(function.body.result, {&scope, &binding, binding.name});
    if (function.result && function.body.result) {
        expect(fmt::format("the result of `{}`", binding.name), binding.type.args.back(), result,
               *function.body.result);
    } else {
        binding.type.args.back() = std::move(result.type);
        binding.type = bounded(std::move(binding.type), function.name.span);
    }
    binding.type_known = true;
    binding.state = Binding::State::checked;
    if (std::holds_alternative<ast::ErrorExpr>(function.body.result->node)) { // what would have used them
        for (Binding* local : scope.cells) {
            local->used = true;
        }
    }
    code.result =
        binding.needs_result_type ? make_code(code::Failed{}, function.name.span) : std::move(result.code);
    close(scope, code.cells);
}

Typed Checker::check(const ast::Lambda& node, const ast::Expr& expr, const Place& place) {
    FunctionCode& code = functions_.emplace_back();
    code.name = place.thing_name;
    code.span = expr.span;
    const std::vector<Type> parameters = formal_types(node.formals);
    defaults(node.formals, parameters, place, code);
    Scope& scope = bind_formals(node.formals, parameters, place.scope, place.owner);
    Typed result = expression(node.body, {&scope, place.owner, {}});
    code.result = std::move(result.code);
    close(scope, code.cells);
    return {bounded(Type::function(parameters, std::move(result.type)), expr.span),
            make_code(code::FunctionValue{0, &code}, expr.span)};
}

} // namespace scc::lang
