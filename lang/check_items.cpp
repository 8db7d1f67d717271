#include "lang/imports.h"
#include "lang/wording.h"

namespace scc::lang {
namespace {

template <class Item>
constexpr bool is_definition = std::is_same_v<Item, ast::Let> || std::is_same_v<Item, ast::Function> ||
                               std::is_same_v<Item, ast::Param> || std::is_same_v<Item, ast::Import>;

/// What the text of an expression begins with.
const ast::Expr& leftmost(const ast::Expr& expr) {
    if (const auto* binary = std::get_if<ast::Binary>(&expr.node)) {
        return leftmost(*binary->left);
    }
    if (const auto* index = std::get_if<ast::Index>(&expr.node)) {
        return leftmost(*index->object);
    }
    if (const auto* call = std::get_if<ast::Call>(&expr.node)) {
        return leftmost(*call->callee);
    }
    const auto* member = std::get_if<ast::Member>(&expr.node);
    return member ? leftmost(*member->object) : expr;
}

bool defines_names(const std::vector<ast::Item>& items) {
    for (const ast::Item& item : items) {
        const bool defines = std::visit(
            [](const auto& node) { return is_definition<std::decay_t<decltype(node)>>; }, item.node);
        if (defines) {
            return true;
        }
    }
    return false;
}

} // namespace

CheckedFile Checker::run(const ast::File& file, const std::vector<Definition>& given) {
    lost_names_ = &file.lost_names;
    find_unit(file);
    CheckedFile checked;
    Scope& scope = names_.add_scope(nullptr);
    file_scope_ = &scope;
    const Place place{&scope, nullptr, {}};
    check_definitions(declare(file.items, place, true));
    Fields fields;
    checked.body.has_frame = true;
    bool is_sound = true;
    const Around around{.is_file = true, .at_top = true, .fields = &fields, .is_sound = &is_sound};
    checked.body.items = items(file.items, around, place);
    for (Binding* binding : scope.cells) {
        if (binding->kind == Binding::Kind::param) {
            checked.params.push_back(param_code(*binding));
        }
    }
    names_.report_cycles();
    if (is_imported_) {
        Names::export_all(scope);
    }
    if (unused_is_known_) { // a misspelt use would leave its name unused
        names_.warn_unused([this](std::string_view name) { return is_lost(name); });
    }
    close(scope, checked.body.cells);
    checked.imports = std::move(imports_);
    for (const Definition& definition : given) {
        this->definition(definition, definition.name, checked);
    }
    checked.functions = std::move(functions_);
    checked.given = std::move(given_);
    checked.expanded = std::move(expanded_);
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
        } else if (const auto* param = std::get_if<ast::Param>(&item.node)) {
            add(at_top ? Binding::Kind::param : Binding::Kind::misplaced, param->name)->param = param;
        } else if (const auto* import = std::get_if<ast::Import>(&item.node)) {
            Binding& binding = *add(at_top ? Binding::Kind::import : Binding::Kind::misplaced, import->alias);
            if (at_top) {
                import_file(*import, binding);
            }
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
        const std::size_t reports = diagnostics_.count();
        std::visit([&](const auto& node) { item(node, written.span, into); }, written.node);
        item_reported_ = diagnostics_.count() > reports;
    }
    return out;
}

BodyCode Checker::body(const ast::Body& body, const Around& around, const Place& place) {
    const Around within = inside(body, around);
    const Open open(open_bodies_, body.is_open);
    BodyCode code;
    code.has_frame = defines_names(body.items);
    if (!code.has_frame) {
        code.items = items(body.items, within, place);
        return code;
    }
    Scope& scope = names_.add_scope(place.scope);
    const Place inner{&scope, place.owner, {}};
    check_definitions(declare(body.items, inner, false));
    code.items = items(body.items, within, inner);
    close(scope, code.cells);
    return code;
}

/// What stands in braces that are never closed may belong anywhere.
Checker::Around Checker::inside(const ast::Body& body, const Around& around) {
    *around.is_sound = *around.is_sound && !body.has_gaps && !body.is_open;
    Around within = around;
    within.is_open = around.is_open || body.is_open;
    return within;
}

void Checker::misplaced(Span span, std::string_view what, const Around& around) {
    if (open_bodies_ == 0) {
        diagnostics_.report(Diag::misplaced_item, span, what);
    }
    *around.is_sound = false;
}

void Checker::item(const ast::Param&, Span span, const Into& into) {
    if (!into.around.at_top) {
        misplaced(span, "a `param`", into.around);
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
    Around around = inside(item.body, into.around);
    around.at_top = false;
    around.in_loop = true;
    constexpr std::uint32_t length_of_for = 3;
    const Span word{span.file, span.begin, span.begin + length_of_for};
    const Open open(open_bodies_, item.body.is_open);
    if (item.body.is_open) { // nobody knows what it repeats
        range.code = make_code(code::Failed{}, range.code->span);
    }
    ForCode loop{
        std::move(range.code), {true, {}, items(item.body.items, around, inner)}, item.variable.text, word};
    close(scope, loop.body.cells);
    into.out.push_back({std::move(loop)});
}

void Checker::item(const ast::If& item, Span, const Into& into) {
    Typed condition = expression(item.condition, into.place.unnamed());
    if (item.condition) {
        expect("`if`", TypeKind::boolean, condition, *item.condition);
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
    if (statement(item, into) || unassigned_field(*item.value, into)) {
        return;
    }
    Typed value = expression(item.value, into.place.unnamed());
    if (child_fits(value.type, into.around, item.value->span)) {
        into.out.push_back({ChildCode{std::move(value.code)}});
    }
}

/// `radius -1`, `points [a, b]`: a field without its `=` reads as an expression.
bool Checker::unassigned_field(const ast::Expr& value, const Into& into) {
    const ast::Expr& first = leftmost(value);
    const auto* word = std::get_if<ast::NameRef>(&first.node);
    const bool is_field = word && into.around.thing && into.around.thing->find(word->name);
    if (!is_field || &first == &value || Names::find(into.place.scope, word->name)) {
        return false;
    }
    const std::string_view rest = sources_.text({value.span.file, first.span.end, value.span.end});
    const std::size_t blanks = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
    const std::uint32_t next = first.span.end + static_cast<std::uint32_t>(blanks);
    const Span gap{value.span.file, first.span.end, first.span.end};
    diagnostics_
        .report(Diag::field_assignment, {value.span.file, next, next + 1}, rest.substr(blanks, 1), word->name)
        .suggest(gap, blanks == 0 ? " = " : " =");
    *into.around.is_sound = false;
    return true;
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
    expect("`assert`", TypeKind::boolean, values[0], *call->arguments[0].value);
    expect("the text of `assert`", TypeKind::string, values[1], *call->arguments[1].value);
    into.out.push_back({AssertCode{std::move(values[0].code), std::move(values[1].code)}});
    return true;
}

} // namespace scc::lang
