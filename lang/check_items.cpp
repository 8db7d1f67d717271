#include "lang/checker.h"
#include "lang/wording.h"

namespace scc::lang {
namespace {

bool defines_names(const std::vector<ast::Item>& items) {
    for (const ast::Item& item : items) {
        if (std::holds_alternative<ast::Let>(item.node) || std::holds_alternative<ast::Function>(item.node)) {
            return true;
        }
    }
    return false;
}

} // namespace

CheckedFile Checker::run(const ast::File& file, const std::vector<Definition>& given) {
    find_unit(file);
    CheckedFile checked;
    Scope& scope = names_.add_scope(nullptr);
    const Place place{&scope, nullptr, {}};
    check_definitions(declare(file.items, place, true));
    Fields fields;
    checked.body.has_frame = true;
    checked.body.items = items(file.items, {nullptr, true, true, false, &fields}, place);
    for (Binding* binding : scope.cells) {
        if (binding->kind == Binding::Kind::param) {
            checked.params.push_back(param_code(*binding));
        }
    }
    definitions(given, scope, checked.params);
    names_.report_cycles();
    if (!diagnostics_.has_errors()) { // a misspelt use would leave its name unused
        names_.warn_unused();
    }
    close(scope, checked.body.cells);
    checked.functions = std::move(functions_);
    checked.given = std::move(given_);
    return checked;
}

Binding& Checker::bind(Scope& scope, Binding::Kind kind, const ast::Name& name, Binding* owner) {
    if (schema_.find(name.text)) {
        diagnostics_.report(Diag::shadowed_name, name.span, name.text, "constructor");
    } else if (find_builtin(name.text) || is_list_function(name.text) || is_statement(name.text)) {
        diagnostics_.report(Diag::shadowed_name, name.span, name.text, "built-in function");
    } else if (name.text == "pi") {
        diagnostics_.report(Diag::shadowed_name, name.span, name.text, "constant");
    }
    return names_.bind(scope, kind, name.text, name.span, owner);
}

std::vector<Binding*> Checker::declare(const std::vector<ast::Item>& items, const Place& place, bool at_top) {
    std::vector<Binding*> bindings;
    const auto add = [&](Binding::Kind kind, const ast::Name& name) {
        bindings.push_back(&bind(*place.scope, kind, name, place.owner));
        return bindings.back();
    };
    for (const ast::Item& item : items) {
        if (const auto* let = std::get_if<ast::Let>(&item.node)) {
            add(Binding::Kind::let, let->name)->let = let;
        } else if (const auto* function = std::get_if<ast::Function>(&item.node)) {
            Binding& binding = *add(Binding::Kind::function, function->name);
            binding.function = function;
            binding.function_code = &functions_.emplace_back();
            binding.function_code->name = binding.name;
            binding.function_code->span = binding.span;
        } else if (const auto* param = std::get_if<ast::Param>(&item.node); param && at_top) {
            add(Binding::Kind::param, param->name)->param = param;
        } else if (const auto* import = std::get_if<ast::Import>(&item.node); import && at_top) {
            add(Binding::Kind::alias, import->alias);
        }
    }
    return bindings;
}

void Checker::check_definitions(const std::vector<Binding*>& bindings) {
    for (Binding* binding : bindings) {
        if (binding->kind == Binding::Kind::function) {
            ensure_function(*binding);
        } else {
            ensure(*binding);
        }
    }
}

/// Hands over what the scope's cells are computed from.
void Checker::close(Scope& scope, std::vector<CodePtr>& cells) {
    for (Binding* binding : scope.cells) {
        cells.push_back(std::move(binding->code));
    }
}

std::vector<ItemCode> Checker::items(const std::vector<ast::Item>& items, const Around& around,
                                     const Place& place) {
    std::vector<ItemCode> out;
    const Into into{around, place, out};
    for (const ast::Item& written : items) {
        std::visit([&](const auto& node) { item(node, written.span, into); }, written.node);
    }
    return out;
}

BodyCode Checker::body(const ast::Body& body, const Around& around, const Place& place) {
    BodyCode code;
    code.has_frame = defines_names(body.items);
    if (!code.has_frame) {
        code.items = items(body.items, around, place);
        return code;
    }
    Scope& scope = names_.add_scope(place.scope);
    const Place inner{&scope, place.owner, {}};
    check_definitions(declare(body.items, inner, false));
    code.items = items(body.items, around, inner);
    close(scope, code.cells);
    return code;
}

void Checker::item(const ast::Import& item, Span span, const Into& into) {
    if (!into.around.at_top) {
        diagnostics_.report(Diag::misplaced_item, span, "an `import`");
        return;
    }
    not_supported(span, "import");
    if (item.with) { // its values use names of this file
        Fields fields;
        body(*item.with, {nullptr, false, false, false, &fields}, into.place);
    }
}

void Checker::item(const ast::Param&, Span span, const Into& into) {
    if (!into.around.at_top) {
        diagnostics_.report(Diag::misplaced_item, span, "a `param`");
    }
}

// Definitions are checked with their scope, before its other items.
void Checker::item(const ast::Let&, Span, const Into&) {}
void Checker::item(const ast::Function&, Span, const Into&) {}

void Checker::item(const ast::For& item, Span span, const Into& into) {
    Typed range = expression(item.range, into.place.unnamed());
    Scope& scope = names_.add_scope(into.place.scope);
    const Place inner{&scope, into.place.owner, {}};
    bind(scope, Binding::Kind::variable, item.variable, into.place.owner).type =
        item.range ? element_of(range.type, item.range->span) : Type{};
    check_definitions(declare(item.body.items, inner, false));
    Around around = into.around;
    around.at_top = false;
    around.in_loop = true;
    constexpr std::uint32_t length_of_for = 3;
    const Span word{span.file, span.begin, span.begin + length_of_for};
    ForCode loop{
        std::move(range.code), {true, {}, items(item.body.items, around, inner)}, item.variable.text, word};
    close(scope, loop.body.cells);
    into.out.push_back({std::move(loop)});
}

void Checker::item(const ast::If& item, Span, const Into& into) {
    Typed condition = expression(item.condition, into.place.unnamed());
    if (item.condition) {
        expect("`if`", TypeKind::boolean, condition.type, *item.condition);
    }
    Around around = into.around;
    around.at_top = false;
    Fields in_first = *around.fields;
    Fields in_second = in_first;
    around.fields = &in_first;
    BodyCode yes = body(item.yes, around, into.place);
    around.fields = &in_second;
    BodyCode no = otherwise(item.otherwise.get(), around, into.place);
    into.around.fields->merge(in_first);
    into.around.fields->merge(in_second);
    into.out.push_back({IfCode{std::move(condition.code), std::move(yes), std::move(no)}});
}

BodyCode Checker::otherwise(const ast::Item* written, const Around& around, const Place& place) {
    if (!written) {
        return {};
    }
    if (const auto* block = std::get_if<ast::Block>(&written->node)) {
        return body(block->body, around, place);
    }
    BodyCode code;
    item(std::get<ast::If>(written->node), written->span, {around, place, code.items});
    return code;
}

/// A block is reached by way of its `if`.
void Checker::item(const ast::Block&, Span, const Into&) {}

void Checker::item(const ast::Child& item, Span, const Into& into) {
    if (!item.value || statement(item, into)) {
        return;
    }
    Typed value = expression(item.value, into.place.unnamed());
    if (child_fits(value.type, into.around, item.value->span)) {
        into.out.push_back({ChildCode{std::move(value.code)}});
    }
}

/// `assert(condition, "text")` and `print(value)`.
bool Checker::statement(const ast::Child& item, const Into& into) {
    const auto* call = std::get_if<ast::Call>(&item.value->node);
    const auto* name = call && call->callee ? std::get_if<ast::NameRef>(&call->callee->node) : nullptr;
    if (!name || !is_statement(name->name) || Names::find(into.place.scope, name->name)) {
        return false;
    }
    std::vector<Typed> values = arguments(*call, in_code(name->name), into.place);
    const bool is_print = name->name == "print";
    if (!argument_count(is_print ? 1 : 2, in_code(name->name), *call, item.value->span)) {
        return true;
    }
    if (is_print) {
        into.out.push_back({PrintCode{std::move(values[0].code)}});
        return true;
    }
    expect("`assert`", TypeKind::boolean, values[0].type, *call->arguments[0].value);
    expect("the text of `assert`", TypeKind::string, values[1].type, *call->arguments[1].value);
    into.out.push_back({AssertCode{std::move(values[0].code), std::move(values[1].code)}});
    return true;
}

} // namespace scc::lang
