#include "lang/checker.h"
#include "lang/wording.h"

#include <algorithm>

namespace scc::lang {
namespace {

bool is_scene_item(TypeKind kind) {
    return kind == TypeKind::shape || kind == TypeKind::light || kind == TypeKind::camera ||
           kind == TypeKind::setting || kind == TypeKind::scene;
}

const Type& innermost(const Type& type) {
    return type.kind == TypeKind::list ? innermost(type.args[0]) : type;
}

} // namespace

Typed Checker::check(const ast::Construct& node, const ast::Expr& expr, const Place& place) {
    const Constructor* row = schema_.find(node.constructor.text);
    if (!row) {
        unknown_constructor(node, place);
        unknown_body(node.body, place);
        return {};
    }
    if (!row->supported) {
        not_supported(node.constructor.span, row->name);
        unknown_body(node.body, place);
        return {row->type, nullptr};
    }
    Fields fields;
    bool is_sound = true;
    const Around around{.thing = row, .fields = &fields, .is_sound = &is_sound};
    code::Construct thing{
        row, body(node.body, around, place.unnamed()), place.thing_name, node.constructor.span, {}, false};
    for (const Field& field : row->fields) {
        if (field.required && fields.contains(field.name)) {
            thing.required.push_back(&field);
        } else if (field.required && is_sound) { // else it may be what was reported
            diagnostics_.report(Diag::missing_field, node.constructor.span, in_code(row->name), field.name);
            is_sound = false;
        }
    }
    thing.is_sound = is_sound;
    return {row->type, make_code(std::move(thing), expr.span)};
}

/// The expressions within a thing of which nothing is known.
void Checker::unknown_body(const ast::Body& inside, const Place& place) {
    body(inside, {.fields = &any_fields_, .is_sound = &any_soundness_}, place.unnamed());
}

void Checker::unknown_constructor(const ast::Construct& node, const Place& place) {
    const ast::Name& name = node.constructor;
    if (is_lost(name.text)) {
        return;
    }
    const Binding* binding = Names::find(place.scope, name.text);
    const bool is_function = binding ? binding->kind == Binding::Kind::function
                                     : find_builtin(name.text) || is_list_function(name.text);
    if (is_function) {
        diagnostics_.report(Diag::braces_on_function, name.span, name.text);
        return;
    }
    std::vector<std::string_view> names;
    for (const Constructor& constructor : schema_.constructors) {
        names.push_back(constructor.name);
    }
    const auto best = nearest(name.text, names);
    Diagnostic& diagnostic =
        diagnostics_.report(Diag::unknown_constructor, name.span, name.text, did_you_mean(best));
    if (best) {
        diagnostic.suggest(name.span, std::string(*best));
    }
}

/// What stands within an unknown or unsupported thing is checked as an expression only.
void Checker::item(const ast::Field& item, Span, const Into& into) {
    const Around& around = into.around;
    const Field* row = around.thing ? around.thing->find(item.name.text) : nullptr;
    if (row && row->supported) {
        field_value(item, *row, into);
        return;
    }
    if (row) {
        not_supported(item.name.span, row->name);
    } else if (around.thing && !around.is_open && !item.name.text.empty()) {
        unknown_field(item, *around.thing);
    }
    *around.is_sound = false;
    expression(item.value, into.place.unnamed());
}

void Checker::unknown_field(const ast::Field& item, const Constructor& thing) {
    std::vector<std::string_view> names;
    for (const Field& field : thing.fields) {
        names.push_back(field.name);
    }
    const auto best = nearest(item.name.text, names);
    Diagnostic& diagnostic = diagnostics_.report(Diag::unknown_field, item.name.span, thing.name,
                                                 item.name.text, did_you_mean(best));
    if (best) {
        diagnostic.suggest(item.name.span, std::string(*best));
    }
}

void Checker::field_value(const ast::Field& item, const Field& row, const Into& into) {
    const auto [first, is_first] = into.around.fields->try_emplace(row.name, item.name.span);
    if (into.around.is_open) {
        // it may be the field of another thing
    } else if (!is_first) {
        diagnostics_.report(Diag::duplicate_field, item.name.span, row.name)
            .note(first->second, "it is set here");
    } else if (into.around.in_loop) {
        diagnostics_.report(Diag::field_in_loop, item.name.span, row.name);
    }
    const bool is_only = is_first && !into.around.in_loop;
    *into.around.is_sound = *into.around.is_sound && is_only;
    Typed value = expression(item.value, into.place.unnamed());
    if (!item.value) {
        return;
    }
    const Type per_point = Type::function({TypeKind::surface}, row.type);
    if (!row.per_point || !fits(per_point, value.type)) {
        const bool is_function = row.per_point && value.type.kind == TypeKind::function;
        expect(in_code(row.name), row.type, value, *item.value,
               is_function ? " or a function `" + to_string(per_point) + "`" : "");
    }
    if (!check_choice(*item.value, row)) {
        value.code = make_code(code::Failed{}, item.value->span);
    }
    const bool is_unit = into.around.thing->name == "world" && row.name == "unit";
    if (is_unit && value.type.kind == TypeKind::string &&
        std::find(unit_fields_.begin(), unit_fields_.end(), &item) == unit_fields_.end()) {
        diagnostics_.report(Diag::unit_not_literal, item.value->span);
        value.code = make_code(code::Failed{}, item.value->span);
    }
    into.out.push_back({FieldCode{&row, std::move(value.code), item.name.span}});
}

/// Choices are checked once more where they are evaluated; here a misspelt one is found in code that does not
/// run.
bool Checker::check_choice(const ast::Expr& value, const Field& row) {
    const auto* text = std::get_if<ast::String>(&value.node);
    if (!text || row.choices.empty() ||
        std::find(row.choices.begin(), row.choices.end(), text->value) != row.choices.end()) {
        return true;
    }
    Diagnostic& diagnostic = diagnostics_.report(Diag::unknown_choice, value.span, row.name,
                                                 to_string(Value{text->value}), choice_rule(row));
    if (const auto best = nearest(text->value, row.choices)) {
        diagnostic.suggest(value.span, to_string(Value{std::string(*best)}));
    }
    return false;
}

bool Checker::child_fits(const Type& type, const Around& around, Span span) {
    const Type& item = innermost(type);
    if (item.kind == TypeKind::error) {
        return true;
    }
    if (open_bodies_ > 0) {
        return false;
    }
    if (around.is_file) {
        if (!is_scene_item(item.kind)) {
            diagnostics_.report(Diag::unexpected_item, span, "the top of a file",
                                "shapes, lights, cameras and settings", described(type));
        }
        return is_scene_item(item.kind);
    }
    if (!around.thing) {
        return false;
    }
    const bool holds_shapes = item.kind == TypeKind::shape || item.kind == TypeKind::scene;
    const bool fits_here = around.thing->takes_children && holds_shapes;
    *around.is_sound = *around.is_sound && fits_here;
    if (!fits_here) {
        diagnostics_.report(Diag::unexpected_item, span, in_code(around.thing->name),
                            around.thing->takes_children ? "shapes" : "only fields", described(type));
    }
    return fits_here;
}

} // namespace scc::lang
