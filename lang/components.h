#pragma once

#include "lang/ast.h"
#include "lang/colorimetry.h"
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
    SpectralPart spectral{}; ///< of a colour that has spectra

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

/// Applies `op` to each component of both, one of which may be a single number; the result is of `kind`. For
/// colours that have spectra see takes_spectra.
Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a, const Components& b);
Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a);

/// `+ - * / % ^` and the comparisons, for operands that the checker let through.
Value binary(ScalarMath& math, ast::BinaryOp op, const Value& left, const Value& right);

/// The kind of `left op right` for `+ - * / % ^`; error if the operands do not go together.
TypeKind arithmetic_result(ast::BinaryOp op, TypeKind left, TypeKind right);

Scalar dot(ScalarMath& math, const Components& a, const Components& b);
/// The matrix, given by its rows, times a vec3 or a plain colour.
Components transformed(ScalarMath& math, const std::array<Triple, 3>& matrix, const Components& v);
Components cross(ScalarMath& math, const Components& a, const Components& b);

/// `op` for the colours of a choice by an unknown condition, and everything else that has components.
Value select(ScalarMath& math, const Scalar& condition, const Components& yes, const Components& no);

/// Whether `a op b` is a colour again where one of them has spectra: sums, products, and quotients by
/// numbers.
bool takes_spectra(ast::BinaryOp op, const Components& a, const Components& b);
inline bool has_spectra(const Value& value) {
    const auto* color = std::get_if<ColorValue>(&value.v);
    return color != nullptr && color->spectral;
}
/// Of a known colour, as that of a surface.
Spectrum spectrum_of(const Components& color);
/// The CIE XYZ of a colour, its spectra taken as those of lights.
Components xyz_of(ScalarMath& math, const Components& color);

/// True if every component is known.
bool is_constant(const Components& parts);

} // namespace scc::lang
