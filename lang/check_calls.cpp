#include "lang/checker.h"
#include "lang/components.h"
#include "lang/wording.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scc::lang {
namespace {

std::string type_list(const std::vector<Type>& types) {
    std::string text = "(";
    for (const Type& type : types) {
        text += (text.size() > 1 ? ", " : "") + to_string(type);
    }
    return text + ")";
}

std::vector<Type> types_of(const std::vector<Typed>& values) {
    std::vector<Type> types;
    for (const Typed& value : values) {
        types.push_back(value.type);
    }
    return types;
}

bool all_fit(const std::vector<Type>& wanted, const std::vector<Typed>& values) {
    return wanted.size() == values.size() &&
           std::equal(wanted.begin(), wanted.end(), values.begin(),
                      [](const Type& type, const Typed& value) { return fits(type, value.type); });
}

std::vector<CodePtr> codes(std::vector<Typed>& values) {
    std::vector<CodePtr> result;
    for (Typed& value : values) {
        result.push_back(std::move(value.code));
    }
    return result;
}

bool is_sum_type(TypeKind kind) {
    return kind == TypeKind::error || arithmetic_result(ast::BinaryOp::add, kind, kind) != TypeKind::error;
}

} // namespace

Typed Checker::check(const ast::Call& node, const ast::Expr& expr, const Place& place) {
    const auto* name = node.callee ? std::get_if<ast::NameRef>(&node.callee->node) : nullptr;
    const auto* member = node.callee ? std::get_if<ast::Member>(&node.callee->node) : nullptr;
    Binding* import = member ? import_named(*member->object, place) : nullptr;
    if (import) {
        const Binding* function = imported_binding(*import, member->member, place);
        if (function && function->kind == Binding::Kind::function) {
            return function_call(node, *function, imported_value(*import, *function, node.callee->span),
                                 expr.span, place);
        }
    }
    if (!name) {
        return value_call(node, expr.span, place);
    }
    Binding* binding = Names::find(place.scope, name->name);
    if (binding && binding->kind == Binding::Kind::function) {
        return function_call(node, *binding, reference(*binding, node.callee->span, place), expr.span, place);
    }
    return binding ? value_call(node, expr.span, place) : named_call(node, name->name, expr.span, place);
}

/// A call of a name that the scene does not bind.
Typed Checker::named_call(const ast::Call& node, std::string_view name, Span span, const Place& place) {
    if (const Builtin* builtin = find_builtin(name)) {
        return builtin_call(node, *builtin, span, place);
    }
    if (is_list_function(name)) {
        return list_call(node, name, span, place);
    }
    std::vector<Typed> values = arguments(node, in_code(name), place);
    const Span name_span = node.callee->span;
    if (is_statement(name)) {
        diagnostics_.report(Diag::misplaced_statement, name_span, name);
    } else if (schema_.find(name)) {
        return constructor_call(name, name_span, span);
    } else {
        return unknown(name, name_span, place, function_names());
    }
    return {};
}

Typed Checker::constructor_call(std::string_view name, Span name_span, Span span) {
    std::string text(sources_.text({span.file, name_span.end, span.end}));
    Diagnostic& diagnostic = diagnostics_.report(Diag::called_constructor, name_span, name);
    const std::size_t open = text.find('(');
    if (open != std::string::npos && text.ends_with(')')) {
        text = " { " + text.substr(open + 1, text.size() - open - 2) + " }";
        diagnostic.suggest(span, std::string(name) + text);
    }
    return {schema_.find(name)->type, nullptr};
}

/// The values of arguments that are given by position.
std::vector<Typed> Checker::arguments(const ast::Call& node, std::string_view subject, const Place& place) {
    std::vector<Typed> values;
    bool reported = false;
    for (const ast::Argument& argument : node.arguments) {
        if (argument.name && !reported && !schema_.find(sources_.text(node.callee->span))) {
            diagnostics_.report(Diag::named_argument, argument.name->span, subject);
            reported = true;
        }
        values.push_back(expression(argument.value, place.unnamed()));
    }
    return values;
}

bool Checker::argument_count(std::size_t wanted, std::string_view subject, const ast::Call& node, Span span) {
    if (node.arguments.size() == wanted) {
        return true;
    }
    diagnostics_.report(Diag::argument_count, span, subject, counted(wanted, "argument"),
                        std::to_string(node.arguments.size()));
    return false;
}

/// A function known by name: arguments may be named, and those with defaults left out.
Typed Checker::function_call(const ast::Call& node, const Binding& binding, Typed callee, Span span,
                             const Place& place) {
    if (!callee.code) {
        for (const ast::Argument& argument : node.arguments) {
            expression(argument.value, place.unnamed());
        }
        return {};
    }
    const std::vector<ast::Formal>& formals = binding.function->formals;
    std::vector<std::string_view> names;
    for (const ast::Formal& formal : formals) {
        names.push_back(formal.name.text);
    }
    std::vector<Typed> values(formals.size());
    std::vector<const ast::Expr*> given(formals.size(), nullptr);
    bool understood = true;
    for (std::size_t i = 0; i < node.arguments.size(); ++i) {
        const ast::Argument& argument = node.arguments[i];
        Typed value = expression(argument.value, place.unnamed());
        const std::size_t at = parameter_of(node, i, names, binding.name);
        understood = understood && at != no_parameter;
        if (at >= formals.size()) {
            continue;
        }
        if (argument.name) {
            mention(formals[at].name.span, argument.name->span, place);
        }
        if (given[at]) {
            diagnostics_.report(Diag::duplicate_argument, argument.value->span, formals[at].name.text)
                .note(given[at]->span, "the first value is here");
            understood = false;
            continue;
        }
        given[at] = argument.value.get();
        expect(in_code(formals[at].name.text), binding.type.args[at], value, *argument.value);
        values[at] = std::move(value);
    }
    if (understood && node.arguments.size() > formals.size()) {
        argument_count(formals.size(), in_code(binding.name), node, span);
        understood = false;
    }
    bool is_complete = understood;
    for (std::size_t i = 0; i < formals.size() && understood; ++i) {
        if (!given[i] && !formals[i].default_value) {
            diagnostics_.report(Diag::missing_argument, span, binding.name, formals[i].name.text);
            is_complete = false;
        }
    }
    const Type& result = binding.type.args.back();
    if (!is_complete) {
        return {result, nullptr};
    }
    return {result, make_code(code::Call{std::move(callee.code), codes(values)}, span)};
}

/// The index of the parameter that an argument is for; past the last one if there are too many.
std::size_t Checker::parameter_of(const ast::Call& node, std::size_t argument,
                                  const std::vector<std::string_view>& names, std::string_view function) {
    if (const auto& name = node.arguments[argument].name) {
        return parameter_index(*name, names, function);
    }
    const auto named = [](const ast::Argument& earlier) { return earlier.name.has_value(); };
    const auto begin = node.arguments.begin();
    if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(argument), named)) {
        diagnostics_.report(Diag::unnamed_argument, node.arguments[argument].value->span);
        return no_parameter;
    }
    return argument;
}

std::size_t Checker::parameter_index(const ast::Name& name, const std::vector<std::string_view>& names,
                                     std::string_view function) {
    const auto found = std::find(names.begin(), names.end(), name.text);
    if (found != names.end()) {
        return static_cast<std::size_t>(found - names.begin());
    }
    const auto best = nearest(name.text, names);
    Diagnostic& diagnostic =
        diagnostics_.report(Diag::unknown_argument, name.span, function, name.text, did_you_mean(best));
    if (best) {
        diagnostic.suggest(name.span, std::string(*best));
    }
    return no_parameter;
}

/// A function that is a value: all its arguments, by position.
Typed Checker::value_call(const ast::Call& node, Span span, const Place& place) {
    Typed callee = expression(node.callee, place.unnamed());
    std::vector<Typed> values = arguments(node, "a function value", place);
    if (callee.type.kind == TypeKind::error) {
        return {};
    }
    if (callee.type.kind == TypeKind::image) {
        if (!argument_count(1, "an image", node, span)) {
            return {TypeKind::color, nullptr};
        }
        expect("an image", TypeKind::vec2, values[0], *node.arguments[0].value);
        return {TypeKind::color,
                make_code(code::ImageCall{std::move(callee.code), std::move(values[0].code)}, span)};
    }
    if (callee.type.kind != TypeKind::function) {
        diagnostics_.report(Diag::not_callable, node.callee->span, described(callee.type));
        return {};
    }
    const std::size_t count = callee.type.args.size() - 1;
    if (!argument_count(count, "this function", node, span)) {
        return {callee.type.args.back(), nullptr};
    }
    for (std::size_t i = 0; i < count; ++i) {
        expect("this parameter", callee.type.args[i], values[i], *node.arguments[i].value);
    }
    return {callee.type.args.back(), make_code(code::Call{std::move(callee.code), codes(values)}, span)};
}

/// Puts named arguments where the parameters are. False after a report.
bool Checker::put_in_order(const ast::Call& node, const Builtin& builtin,
                           std::vector<const ast::Argument*>& arguments) {
    const auto is_named = [](const ast::Argument* argument) { return argument->name.has_value(); };
    const auto overload = std::find_if(builtin.overloads.begin(), builtin.overloads.end(),
                                       [&](const Overload& o) { return o.names.size() == arguments.size(); });
    if (std::none_of(arguments.begin(), arguments.end(), is_named) || overload == builtin.overloads.end()) {
        return true;
    }
    std::vector<const ast::Argument*> ordered(arguments.size(), nullptr);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::size_t at = parameter_of(node, i, overload->names, builtin.name);
        if (at == no_parameter) {
            return false;
        }
        if (ordered[at]) {
            diagnostics_.report(Diag::duplicate_argument, arguments[i]->value->span, overload->names[at])
                .note(ordered[at]->value->span, "the first value is here");
            return false;
        }
        ordered[at] = arguments[i];
    }
    arguments = std::move(ordered);
    return true;
}

Typed Checker::builtin_call(const ast::Call& node, const Builtin& builtin, Span span, const Place& place) {
    std::vector<const ast::Argument*> given;
    for (const ast::Argument& argument : node.arguments) {
        given.push_back(&argument);
    }
    const bool understood = put_in_order(node, builtin, given);
    std::vector<Typed> values;
    for (const ast::Argument* argument : given) {
        values.push_back(expression(argument->value, place.unnamed()));
    }
    if (!understood) {
        return {builtin.overloads.size() == 1 ? builtin.overloads[0].result : Type{}, nullptr};
    }
    suspect_degrees(node, builtin.name);
    for (const Overload& overload : builtin.overloads) {
        if (all_fit(overload.parameters, values)) {
            const bool unsure = std::any_of(values.begin(), values.end(), [](const Typed& value) {
                return value.type.kind == TypeKind::error;
            });
            const Type result = unsure && builtin.overloads.size() > 1 ? Type{} : overload.result;
            return {result, make_code(code::BuiltinCall{&overload, codes(values)}, span)};
        }
    }
    no_overload(node, builtin, given, values, span);
    return {};
}

/// Explains a mismatch as narrowly as the overloads allow: one argument, the number of arguments, or all of
/// it.
void Checker::no_overload(const ast::Call& node, const Builtin& builtin,
                          const std::vector<const ast::Argument*>& given, std::vector<Typed>& values,
                          Span span) {
    std::vector<const Overload*> of_this_length;
    std::vector<std::string> spellings;
    std::vector<std::size_t> lengths;
    for (const Overload& overload : builtin.overloads) {
        spellings.push_back(in_code(type_list(overload.parameters)));
        lengths.push_back(overload.parameters.size());
        if (overload.parameters.size() == values.size()) {
            of_this_length.push_back(&overload);
        }
    }
    const bool one_length = std::all_of(lengths.begin(), lengths.end(),
                                        [&](std::size_t length) { return length == lengths.front(); });
    if (of_this_length.size() == 1) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            expect(in_code(builtin.name), of_this_length[0]->parameters[i], values[i], *given[i]->value);
        }
    } else if (of_this_length.empty() && one_length) {
        argument_count(lengths[0], in_code(builtin.name), node, span);
    } else {
        diagnostics_.report(Diag::no_overload, span, builtin.name, alternatives(spellings),
                            in_code(type_list(types_of(values))));
    }
}

void Checker::suspect_degrees(const ast::Call& node, std::string_view name) {
    if ((name != "sin" && name != "cos" && name != "tan") || node.arguments.size() != 1) {
        return;
    }
    const ast::ExprPtr& value = node.arguments[0].value;
    const auto* literal = value ? std::get_if<ast::Number>(&value->node) : nullptr;
    if (literal && literal->unit == ast::Unit::none && literal->value > 2 * std::numbers::pi) {
        const std::string text(sources_.text(value->span));
        diagnostics_.report(Diag::degrees_suspected, value->span, text, text)
            .suggest(value->span, text + "deg");
    }
}

/// `map(list, fn)`, `filter(list, fn)`, `sum(list)`, `len(list)`.
Typed Checker::list_call(const ast::Call& node, std::string_view name, Span span, const Place& place) {
    const bool takes_function = name == "map" || name == "filter";
    std::vector<Typed> values = arguments(node, in_code(name), place);
    if (!argument_count(takes_function ? 2 : 1, in_code(name), node, span)) {
        return {};
    }
    const Type list = values[0].type;
    if (!expect(in_code(name), Type::list_of({}), values[0], *node.arguments[0].value)) {
        return {};
    }
    const Type element = list.kind == TypeKind::list ? list.args[0] : Type{};
    if (name == "len") {
        return {TypeKind::number, make_code(code::ListCall{code::ListOp::len, codes(values), {}}, span)};
    }
    if (name == "sum") {
        if (!is_sum_type(element.kind)) {
            diagnostics_.report(Diag::type_mismatch, node.arguments[0].value->span, "`sum`",
                                "a list of numbers, angles, vectors or colors", described(list));
            return {};
        }
        const TypeKind kind = element.kind == TypeKind::error ? TypeKind::number : element.kind;
        return {kind, make_code(code::ListCall{code::ListOp::sum, codes(values), compose(kind, {})}, span)};
    }
    const Type function = values[1].type;
    const Type wanted = Type::function({element}, name == "filter" ? Type(TypeKind::boolean) : Type{});
    if (!fits(wanted, function)) {
        diagnostics_.report(Diag::type_mismatch, node.arguments[1].value->span, in_code(name),
                            "a function of " + described(element) +
                                (name == "filter" ? " that gives a bool" : ""),
                            described(function));
        return {};
    }
    if (function.kind != TypeKind::function) {
        return {};
    }
    const bool is_map = name == "map";
    const code::ListOp op = is_map ? code::ListOp::map : code::ListOp::filter;
    return {is_map ? bounded(Type::list_of(function.args.back()), span) : list,
            make_code(code::ListCall{op, codes(values), {}}, span)};
}

} // namespace scc::lang
