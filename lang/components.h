#pragma once

#include "lang/ast.h"
#include "lang/scalar_math.h"
#include "lang/value.h"

#include <array>
#include <cstddef>

/// Arithmetic over everything that is made of numbers, component by component.
namespace scc::lang {

/// A number, angle, bool, vector or colour taken apart; kind is error for anything else.
struct Components {
    TypeKind kind = TypeKind::error;
    std::size_t count = 0;
    std::array<Scalar, 3> v{};

    /// One component stands for all of them.
    const Scalar& operator[](std::size_t i) const { return v[count == 1 ? 0 : i]; }
};

Components components(const Value& value);
Value compose(const Components& parts);
Value compose(TypeKind kind, const std::array<Scalar, 3>& v);

inline Value number(double value) {
    return {NumberValue{{value}}};
}
inline Value number(const Scalar& value) {
    return {NumberValue{value}};
}
inline Value boolean(const Scalar& value) {
    return {BoolValue{value}};
}

/// Applies `op` to each component of both, one of which may be a single number; the result is of `kind`.
Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a, const Components& b);
Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a);

/// `+ - * / % ^` and the comparisons, for operands that the checker let through.
Value binary(ScalarMath& math, ast::BinaryOp op, const Value& left, const Value& right);

/// The kind of `left op right` for `+ - * / % ^`; error if the operands do not go together.
TypeKind arithmetic_result(ast::BinaryOp op, TypeKind left, TypeKind right);

Scalar dot(ScalarMath& math, const Components& a, const Components& b);
Components cross(ScalarMath& math, const Components& a, const Components& b);

/// True if every component is known.
bool is_constant(const Components& parts);

} // namespace scc::lang
