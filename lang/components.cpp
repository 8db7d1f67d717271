#include "lang/components.h"

#include <algorithm>

namespace scc::lang {
namespace {

bool is_componentwise(TypeKind kind) {
    return kind == TypeKind::number || kind == TypeKind::vec2 || kind == TypeKind::vec3 ||
           kind == TypeKind::color;
}

ScalarOp scalar_op(ast::BinaryOp op) {
    switch (op) {
    case ast::BinaryOp::add:
        return ScalarOp::add;
    case ast::BinaryOp::sub:
        return ScalarOp::sub;
    case ast::BinaryOp::mul:
        return ScalarOp::mul;
    case ast::BinaryOp::div:
        return ScalarOp::div;
    case ast::BinaryOp::mod:
        return ScalarOp::mod;
    case ast::BinaryOp::pow:
        return ScalarOp::pow;
    case ast::BinaryOp::lt:
        return ScalarOp::lt;
    case ast::BinaryOp::le:
        return ScalarOp::le;
    case ast::BinaryOp::gt:
        return ScalarOp::gt;
    case ast::BinaryOp::ge:
        return ScalarOp::ge;
    case ast::BinaryOp::ne:
        return ScalarOp::ne;
    default:
        return ScalarOp::eq;
    }
}

Value equality(ScalarMath& math, bool equal, const Value& left, const Value& right) {
    if (const auto* text = std::get_if<std::string>(&left.v)) {
        return boolean({(*text == std::get<std::string>(right.v)) == equal ? 1.0 : 0.0});
    }
    const Components a = components(left);
    const Components b = components(right);
    const ScalarOp op = equal ? ScalarOp::eq : ScalarOp::ne;
    Scalar result = math.apply(op, a[0], b[0]);
    for (std::size_t i = 1; i < a.count; ++i) {
        result = math.apply(equal ? ScalarOp::logical_and : ScalarOp::logical_or, result,
                            math.apply(op, a[i], b[i]));
    }
    return boolean(result);
}

} // namespace

Components components(const Value& value) {
    if (const auto* n = std::get_if<NumberValue>(&value.v)) {
        return {TypeKind::number, 1, {n->v}};
    }
    if (const auto* a = std::get_if<AngleValue>(&value.v)) {
        return {TypeKind::angle, 1, {a->radians}};
    }
    if (const auto* b = std::get_if<BoolValue>(&value.v)) {
        return {TypeKind::boolean, 1, {b->v}};
    }
    if (const auto* p = std::get_if<Vec2Value>(&value.v)) {
        return {TypeKind::vec2, 2, {p->v[0], p->v[1]}};
    }
    if (const auto* p = std::get_if<Vec3Value>(&value.v)) {
        return {TypeKind::vec3, 3, p->v};
    }
    if (const auto* c = std::get_if<ColorValue>(&value.v)) {
        return {TypeKind::color, 3, c->v};
    }
    return {};
}

Value compose(TypeKind kind, const std::array<Scalar, 3>& v) {
    switch (kind) {
    case TypeKind::number:
        return {NumberValue{v[0]}};
    case TypeKind::angle:
        return {AngleValue{v[0]}};
    case TypeKind::boolean:
        return {BoolValue{v[0]}};
    case TypeKind::vec2:
        return {Vec2Value{{v[0], v[1]}}};
    case TypeKind::vec3:
        return {Vec3Value{v}};
    case TypeKind::color:
        return {ColorValue{v}};
    default:
        return {ErrorValue{}};
    }
}

Value compose(const Components& parts) {
    return compose(parts.kind, parts.v);
}

Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a, const Components& b) {
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < std::max(a.count, b.count); ++i) {
        v[i] = math.apply(op, a[i], b[i]);
    }
    return compose(kind, v);
}

Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a) {
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < a.count; ++i) {
        v[i] = math.apply(op, a[i]);
    }
    return compose(kind, v);
}

TypeKind arithmetic_result(ast::BinaryOp op, TypeKind left, TypeKind right) {
    const bool same = left == right;
    const bool both_angles = same && left == TypeKind::angle;
    switch (op) {
    case ast::BinaryOp::add:
    case ast::BinaryOp::sub:
        return same && (is_componentwise(left) || both_angles) ? left : TypeKind::error;
    case ast::BinaryOp::mul:
        if (same) {
            return is_componentwise(left) ? left : TypeKind::error;
        }
        if (left == TypeKind::number) {
            return is_componentwise(right) || right == TypeKind::angle ? right : TypeKind::error;
        }
        return arithmetic_result(ast::BinaryOp::div, left, right);
    case ast::BinaryOp::div:
        if (both_angles) {
            return TypeKind::number;
        }
        return (same || right == TypeKind::number) && (is_componentwise(left) || left == TypeKind::angle)
                   ? left
                   : TypeKind::error;
    case ast::BinaryOp::mod:
        return both_angles || (same && left == TypeKind::number) ? left : TypeKind::error;
    case ast::BinaryOp::pow:
        return same && left == TypeKind::number ? left : TypeKind::error;
    default:
        return TypeKind::error;
    }
}

Value binary(ScalarMath& math, ast::BinaryOp op, const Value& left, const Value& right) {
    if (op == ast::BinaryOp::eq || op == ast::BinaryOp::ne) {
        return equality(math, op == ast::BinaryOp::eq, left, right);
    }
    const Components a = components(left);
    const Components b = components(right);
    const TypeKind kind = arithmetic_result(op, a.kind, b.kind);
    return each(math, scalar_op(op), kind == TypeKind::error ? TypeKind::boolean : kind, a, b);
}

Scalar dot(ScalarMath& math, const Components& a, const Components& b) {
    Scalar sum = math.apply(ScalarOp::mul, a[0], b[0]);
    for (std::size_t i = 1; i < a.count; ++i) {
        sum = math.apply(ScalarOp::add, sum, math.apply(ScalarOp::mul, a[i], b[i]));
    }
    return sum;
}

Components cross(ScalarMath& math, const Components& a, const Components& b) {
    Components result{TypeKind::vec3, 3, {}};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        const Scalar plus = math.apply(ScalarOp::mul, a[j], b[k]);
        result.v[i] = math.apply(ScalarOp::sub, plus, math.apply(ScalarOp::mul, a[k], b[j]));
    }
    return result;
}

bool is_constant(const Components& parts) {
    return std::all_of(parts.v.begin(), parts.v.begin() + parts.count,
                       [](const Scalar& s) { return s.is_constant(); });
}

} // namespace scc::lang
