#include "lang/checker.h"
#include "lang/components.h"
#include "lang/units.h"
#include "lang/wording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scc::lang {
namespace {

double decode_srgb(std::uint32_t byte) {
    const double encoded = byte / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Typed constant(Type type, Value value, Span span) {
    return {std::move(type), make_code(code::Constant{std::move(value)}, span)};
}

bool is_comparison(ast::BinaryOp op) {
    return op >= ast::BinaryOp::eq && op <= ast::BinaryOp::ge;
}

bool can_compare(ast::BinaryOp op, TypeKind kind) {
    const bool ordered = kind == TypeKind::number || kind == TypeKind::angle;
    const bool equality = op == ast::BinaryOp::eq || op == ast::BinaryOp::ne;
    const bool equal = kind == TypeKind::boolean || kind == TypeKind::string || kind == TypeKind::vec2 ||
                       kind == TypeKind::vec3 || kind == TypeKind::color;
    return ordered || (equality && equal);
}

TypeKind result_kind(ast::BinaryOp op, TypeKind left, TypeKind right) {
    const bool same = left == right;
    if (is_comparison(op)) {
        return same && can_compare(op, left) ? TypeKind::boolean : TypeKind::error;
    }
    switch (op) {
    case ast::BinaryOp::then:
        return same && left == TypeKind::transform ? left : TypeKind::error;
    case ast::BinaryOp::logical_or:
    case ast::BinaryOp::logical_and:
        return same && left == TypeKind::boolean ? left : TypeKind::error;
    case ast::BinaryOp::range:
        return same && left == TypeKind::number ? TypeKind::range : TypeKind::error;
    default:
        return arithmetic_result(op, left, right);
    }
}

/// A function value of what is most likely meant: the overload that takes numbers, else the first one.
std::string as_lambda(const Builtin& builtin) {
    const auto takes_numbers = [](const Overload& overload) {
        return std::all_of(overload.parameters.begin(), overload.parameters.end(),
                           [](const Type& type) { return type.kind == TypeKind::number; });
    };
    const auto& overloads = builtin.overloads;
    auto chosen = std::find_if(overloads.begin(), overloads.end(), takes_numbers);
    chosen = chosen == overloads.end() ? overloads.begin() : chosen;
    std::string formals;
    std::string names;
    for (std::size_t i = 0; i < chosen->parameters.size(); ++i) {
        const char* joint = i == 0 ? "" : ", ";
        formals += fmt::format("{}{}: {}", joint, chosen->names[i], to_string(chosen->parameters[i]));
        names += fmt::format("{}{}", joint, chosen->names[i]);
    }
    return fmt::format("fn({}) = {}({})", formals, builtin.name, names);
}

} // namespace

Typed Checker::expression(const ast::ExprPtr& expr, const Place& place) {
    if (!expr) {
        return {};
    }
    if (stack_.exhausted()) {
        diagnostics_.report(Diag::too_deep, expr->span);
        unused_is_known_ = false;
        return {{}, make_code(code::Failed{}, expr->span)};
    }
    Typed typed = std::visit([&](const auto& node) { return check(node, *expr, place); }, expr->node);
    if (!typed.code) {
        typed.code = make_code(code::Failed{}, expr->span);
    }
    return typed;
}

Typed Checker::check(const ast::ErrorExpr&, const ast::Expr&, const Place&) {
    return {};
}

Typed Checker::check(const ast::Number& node, const ast::Expr& expr, const Place&) {
    switch (node.unit) {
    case ast::Unit::none:
        return constant(TypeKind::number, number(node.value), expr.span);
    case ast::Unit::deg:
        return constant(TypeKind::angle, {AngleValue{{node.value * std::numbers::pi / 180}}}, expr.span);
    case ast::Unit::rad:
        return constant(TypeKind::angle, {AngleValue{{node.value}}}, expr.span);
    default:
        return constant(TypeKind::number, number(in_world_units(node.value, node.unit, world_unit_)),
                        expr.span);
    }
}

Typed Checker::check(const ast::String& node, const ast::Expr& expr, const Place&) {
    if (node.value.size() > limits_.string_length) {
        diagnostics_.report(Diag::string_too_long, expr.span, limits_.string_length);
    }
    return constant(TypeKind::string, {node.value}, expr.span);
}

Typed Checker::check(const ast::HexColor& node, const ast::Expr& expr, const Place&) {
    const std::array<Scalar, 3> v{Scalar{decode_srgb(node.rgb >> 16 & 0xff)},
                                  Scalar{decode_srgb(node.rgb >> 8 & 0xff)},
                                  Scalar{decode_srgb(node.rgb & 0xff)}};
    return constant(TypeKind::color, {ColorValue{v}}, expr.span);
}

Typed Checker::check(const ast::Bool& node, const ast::Expr& expr, const Place&) {
    return constant(TypeKind::boolean, boolean({node.value ? 1.0 : 0.0}), expr.span);
}

Typed Checker::check(const ast::NameRef& node, const ast::Expr& expr, const Place& place) {
    if (Binding* binding = Names::find(place.scope, node.name)) {
        return reference(*binding, expr.span, place);
    }
    if (node.name == "pi") {
        return constant(TypeKind::number, number(std::numbers::pi), expr.span);
    }
    if (is_frame_name(node.name) && !is_lost(node.name)) {
        return frame_number(node.name, expr.span);
    }
    return unknown_name(node, expr.span, place);
}

Typed Checker::unknown_name(const ast::NameRef& node, Span span, const Place& place) {
    if (schema_.find(node.name)) {
        diagnostics_.report(Diag::bare_constructor, span, node.name).suggest(span, node.name + " { }");
    } else if (is_statement(node.name)) {
        diagnostics_.report(Diag::misplaced_statement, span, node.name);
    } else if (find_builtin(node.name) || is_list_function(node.name)) {
        Diagnostic& diagnostic = diagnostics_.report(Diag::bare_builtin, span, in_code(node.name));
        if (const Builtin* builtin = find_builtin(node.name)) {
            diagnostic.suggest(span, as_lambda(*builtin));
        }
    } else {
        return unknown(node.name, span, place, {"pi", "frame", "time"});
    }
    return {};
}

Typed Checker::check(const ast::Tuple& node, const ast::Expr& expr, const Place& place) {
    code::Tuple tuple;
    for (const ast::ExprPtr& element : node.elements) {
        Typed part = expression(element, place.unnamed());
        expect("a vector's component", TypeKind::number, part, *element);
        tuple.elements.push_back(std::move(part.code));
    }
    return {node.elements.size() == 2 ? TypeKind::vec2 : TypeKind::vec3,
            make_code(std::move(tuple), expr.span)};
}

Typed Checker::check(const ast::List& node, const ast::Expr& expr, const Place& place) {
    code::List list;
    Type element;
    for (const ast::ExprPtr& written : node.elements) {
        Typed part = expression(written, place);
        if (fits(element, part.type)) {
            element = joined(element, part.type);
        } else {
            diagnostics_.report(Diag::element_mismatch, written->span, described(element),
                                described(part.type));
            part.code = make_code(code::Failed{}, written->span);
        }
        list.elements.push_back(std::move(part.code));
    }
    return {bounded(Type::list_of(element), expr.span), make_code(std::move(list), expr.span)};
}

Type Checker::element_of(const Type& range, Span span) {
    if (range.kind == TypeKind::range) {
        return TypeKind::number;
    }
    if (range.kind == TypeKind::list) {
        return range.args[0];
    }
    if (range.kind != TypeKind::error) {
        diagnostics_.report(Diag::not_iterable, span, described(range));
    }
    return {};
}

Typed Checker::check(const ast::Comprehension& node, const ast::Expr& expr, const Place& place) {
    Typed range = expression(node.range, place.unnamed());
    Scope& scope = names_.add_scope(place.scope, expr.span);
    Binding& variable = bind(scope, Binding::Kind::variable, node.variable, place.owner);
    variable.type = node.range ? element_of(range.type, node.range->span) : Type{};
    Typed element = expression(node.element, {&scope, place.owner, place.thing_name});
    code::Comprehension loop{
        std::move(range.code), std::move(element.code), variable.name, variable.span, {}};
    loop.cells.resize(1);
    return {bounded(Type::list_of(element.type), expr.span), make_code(std::move(loop), expr.span)};
}

Typed Checker::check(const ast::Conditional& node, const ast::Expr& expr, const Place& place) {
    Typed condition = expression(node.condition, place.unnamed());
    expect("`if`", TypeKind::boolean, condition, *node.condition);
    Typed yes = expression(node.yes, place);
    Typed no = expression(node.no, place);
    if (!fits(yes.type, no.type)) {
        diagnostics_.report(Diag::branch_mismatch, node.no->span, described(yes.type), described(no.type))
            .note(node.yes->span, "the first branch is here");
        return {};
    }
    return {joined(yes.type, no.type),
            make_code(code::Conditional{std::move(condition.code), std::move(yes.code), std::move(no.code)},
                      expr.span)};
}

Typed Checker::check(const ast::Unary& node, const ast::Expr& expr, const Place& place) {
    Typed operand = expression(node.operand, place.unnamed());
    const TypeKind kind = operand.type.kind;
    if (node.op == ast::UnaryOp::logical_not) {
        expect("`not`", TypeKind::boolean, operand, *node.operand);
        return {TypeKind::boolean, make_code(code::Unary{node.op, std::move(operand.code)}, expr.span)};
    }
    if (kind != TypeKind::error && arithmetic_result(ast::BinaryOp::add, kind, kind) == TypeKind::error) {
        diagnostics_.report(Diag::type_mismatch, node.operand->span, "`-`",
                            "a number, angle, vector or color", described(operand.type));
        return {};
    }
    return {kind, make_code(code::Unary{node.op, std::move(operand.code)}, expr.span)};
}

Typed Checker::check(const ast::Binary& node, const ast::Expr& expr, const Place& place) {
    Typed left = expression(node.left, place.unnamed());
    Typed right = expression(node.right, place.unnamed());
    if (left.type.kind == TypeKind::error || right.type.kind == TypeKind::error) {
        return is_comparison(node.op) ? Typed{TypeKind::boolean, nullptr} : Typed{};
    }
    const TypeKind kind = result_kind(node.op, left.type.kind, right.type.kind);
    if (kind == TypeKind::error) {
        diagnostics_.report(Diag::operand_mismatch, node.op_span, described(left.type),
                            sources_.text(node.op_span), described(right.type));
        return is_comparison(node.op) ? Typed{TypeKind::boolean, nullptr} : Typed{};
    }
    return {kind, make_code(code::Binary{node.op, std::move(left.code), std::move(right.code)}, expr.span)};
}

Typed Checker::check(const ast::Member& node, const ast::Expr& expr, const Place& place) {
    if (Binding* import = node.object ? import_named(*node.object, place) : nullptr) {
        return imported_member(*import, node.member, expr.span, place);
    }
    Typed object = expression(node.object, place.unnamed());
    if (symbols_) {
        symbols_->members.push_back({node.member.span, object.type});
    }
    if (object.type.kind == TypeKind::error) {
        return {};
    }
    const std::vector<std::string_view> members = members_of(object.type.kind);
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (members[i] != node.member.text) {
            continue;
        }
        if (object.type.kind != TypeKind::surface) {
            return {TypeKind::number, make_code(code::Component{std::move(object.code), i}, expr.span)};
        }
        const TypeKind kind = members[i] == "uv" ? TypeKind::vec2 : TypeKind::vec3;
        return {kind, make_code(code::SurfaceInput{std::move(object.code), members[i]}, expr.span)};
    }
    unknown_member(described(object.type), node.member, members);
    return {};
}

void Checker::unknown_member(std::string_view object, const ast::Name& member,
                             const std::vector<std::string_view>& members) {
    const auto best = nearest(member.text, members);
    Diagnostic& diagnostic =
        diagnostics_.report(Diag::unknown_member, member.span, object, member.text, did_you_mean(best));
    if (best) {
        diagnostic.suggest(member.span, std::string(*best));
    }
}

Typed Checker::check(const ast::Index& node, const ast::Expr& expr, const Place& place) {
    Typed object = expression(node.object, place.unnamed());
    Typed index = expression(node.index, place.unnamed());
    if (object.type.kind == TypeKind::error) {
        return {};
    }
    expect("an index", TypeKind::number, index, *node.index);
    if (object.type.kind != TypeKind::list) {
        diagnostics_.report(Diag::not_indexable, node.object->span, described(object.type));
        return {};
    }
    return {object.type.args[0],
            make_code(code::Index{std::move(object.code), std::move(index.code)}, expr.span)};
}

} // namespace scc::lang
