#include "lang/scalar_math.h"

#include <array>
#include <cmath>

namespace scc::lang {
namespace {

constexpr std::array<std::string_view, 31> names{
    "neg",  "add",  "sub", "mul", "div", "mod",         "pow",        "min",         "max",   "abs", "floor",
    "ceil", "sqrt", "sin", "cos", "tan", "asin",        "acos",       "atan2",       "exp",   "log", "eq",
    "ne",   "lt",   "le",  "gt",  "ge",  "logical_and", "logical_or", "logical_not", "select"};

/// The remainder with the sign of the divisor; exact, unlike a - b * floor(a / b).
double floored_mod(double a, double b) {
    const double rest = std::fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

double truth(bool value) {
    return value ? 1 : 0;
}

double fold(ScalarOp op, double a, double b) {
    switch (op) {
    case ScalarOp::neg:
        return -a;
    case ScalarOp::add:
        return a + b;
    case ScalarOp::sub:
        return a - b;
    case ScalarOp::mul:
        return a * b;
    case ScalarOp::div:
        return a / b;
    case ScalarOp::mod:
        return floored_mod(a, b);
    case ScalarOp::pow:
        return std::pow(a, b);
    case ScalarOp::min:
        return b < a ? b : a;
    case ScalarOp::max:
        return b > a ? b : a;
    case ScalarOp::abs:
        return std::abs(a);
    case ScalarOp::floor:
        return std::floor(a);
    case ScalarOp::ceil:
        return std::ceil(a);
    case ScalarOp::sqrt:
        return std::sqrt(a);
    case ScalarOp::sin:
        return std::sin(a);
    case ScalarOp::cos:
        return std::cos(a);
    case ScalarOp::tan:
        return std::tan(a);
    case ScalarOp::asin:
        return std::asin(a);
    case ScalarOp::acos:
        return std::acos(a);
    case ScalarOp::atan2:
        return std::atan2(a, b);
    case ScalarOp::exp:
        return std::exp(a);
    case ScalarOp::log:
        return std::log(a);
    case ScalarOp::eq:
        return truth(a == b);
    case ScalarOp::ne:
        return truth(a != b);
    case ScalarOp::lt:
        return truth(a < b);
    case ScalarOp::le:
        return truth(a <= b);
    case ScalarOp::gt:
        return truth(a > b);
    case ScalarOp::ge:
        return truth(a >= b);
    case ScalarOp::logical_and:
        return a * b;
    case ScalarOp::logical_or:
        return a > b ? a : b;
    case ScalarOp::logical_not:
        return 1 - a;
    case ScalarOp::select:
        break; // has three operands
    }
    return std::nan("");
}

} // namespace

std::string_view name_of(ScalarOp op) {
    return names[static_cast<std::size_t>(op)];
}

std::uint32_t ScalarMath::symbol(const Scalar& scalar) {
    return scalar.is_constant() ? builder_->constant(scalar.value) : scalar.symbol;
}

Scalar ScalarMath::apply(ScalarOp op, const Scalar& a) {
    if (a.is_constant()) {
        return {fold(op, a.value, 0)};
    }
    return {0, builder_->apply(name_of(op), {symbol(a)})};
}

Scalar ScalarMath::apply(ScalarOp op, const Scalar& a, const Scalar& b) {
    if (a.is_constant() && b.is_constant()) {
        return {fold(op, a.value, b.value)};
    }
    const std::uint32_t left = symbol(a); // before the right one: builders number their nodes
    return {0, builder_->apply(name_of(op), {left, symbol(b)})};
}

Scalar ScalarMath::select(const Scalar& condition, const Scalar& yes, const Scalar& no) {
    if (condition.is_constant()) {
        return condition.value != 0 ? yes : no;
    }
    if (yes == no) {
        return yes;
    }
    const std::uint32_t left = symbol(yes);
    return {0, builder_->apply(name_of(ScalarOp::select), {condition.symbol, left, symbol(no)})};
}

} // namespace scc::lang
