#pragma once

#include "compiler/function_builder.h"
#include "runtime/math/vec.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

/// Formulas of per-point functions that the compiler makes.
namespace scc::compiler {

/// A value of the function that is being built.
struct Term {
    FunctionBuilder* builder;
    std::uint32_t node;

    Term of(std::string_view op, const std::vector<std::uint32_t>& operands) const {
        return {builder, builder->apply(op, operands)};
    }
    Term constant(double value) const { return {builder, builder->constant(value)}; }

    friend Term operator+(const Term& a, const Term& b) { return a.of("add", {a.node, b.node}); }
    friend Term operator-(const Term& a, const Term& b) { return a.of("sub", {a.node, b.node}); }
    friend Term operator*(const Term& a, const Term& b) { return a.of("mul", {a.node, b.node}); }
    friend Term operator+(const Term& a, double b) { return b == 0 ? a : a + a.constant(b); }
    friend Term operator-(const Term& a, double b) { return a + -b; }
    friend Term operator*(const Term& a, double b) { return b == 1 ? a : a * a.constant(b); }
    friend Term operator/(const Term& a, const Term& b) { return a.of("div", {a.node, b.node}); }
    friend Term operator<=(const Term& a, const Term& b) { return a.of("le", {a.node, b.node}); }
};
inline Term absolute(const Term& a) {
    return a.of("abs", {a.node});
}
inline Term negative(const Term& a) {
    return a.of("neg", {a.node});
}
inline Term smaller(const Term& a, const Term& b) {
    return a.of("min", {a.node, b.node});
}
inline Term larger(const Term& a, const Term& b) {
    return a.of("max", {a.node, b.node});
}
inline Term root(const Term& a) {
    return a.of("sqrt", {a.node});
}
inline Term angle(const Term& y, const Term& x) {
    return y.of("atan2", {y.node, x.node});
}
inline Term choose(const Term& truth, const Term& a, const Term& b) {
    return truth.of("select", {truth.node, a.node, b.node});
}

using Terms = runtime::Vec2<Term>;
/// In the space of a shape.
struct Point {
    Term x, y, z;

    Point relative_to(const runtime::Vec3<double>& p) const { return {x - p.x, y - p.y, z - p.z}; }
    Term along(const runtime::Vec3<double>& d) const {
        const std::pair<Term, double> parts[] = {{x, d.x}, {y, d.y}, {z, d.z}};
        std::optional<Term> sum;
        for (const auto& [coordinate, factor] : parts) {
            if (factor != 0) {
                const Term part = coordinate * factor;
                sum = sum ? *sum + part : part;
            }
        }
        return sum.value_or(x.constant(0));
    }
};

} // namespace scc::compiler
