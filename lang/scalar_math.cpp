#include "lang/scalar_math.h"

#include "lang/scalar_fold.h"

#include <algorithm>
#include <array>
#include <utility>

namespace scc::lang {
namespace {

constexpr std::array<std::string_view, scalar_op_count> names{
    "neg",         "add",        "sub",         "mul",    "div",    "mod",  "pow", "min",  "max",
    "abs",         "floor",      "ceil",        "sqrt",   "sin",    "cos",  "tan", "asin", "acos",
    "atan2",       "exp",        "log",         "eq",     "ne",     "lt",   "le",  "gt",   "ge",
    "logical_and", "logical_or", "logical_not", "select", "random", "noise"};

using Fold = double (*)(double, double, double);

template <std::size_t... op>
constexpr std::array<Fold, scalar_op_count> make_folds(std::index_sequence<op...>) {
    return {fold<static_cast<ScalarOp>(op)>...};
}
constexpr std::array<Fold, scalar_op_count> folds = make_folds(std::make_index_sequence<scalar_op_count>{});

double folded(ScalarOp op, const Scalar& a, const Scalar& b, const Scalar& c) {
    return folds[static_cast<std::size_t>(op)](a.value, b.value, c.value);
}

} // namespace

ScalarOp scalar_op(std::string_view name) {
    return static_cast<ScalarOp>(std::find(names.begin(), names.end(), name) - names.begin());
}

int arity(ScalarOp op) {
    switch (op) {
    case ScalarOp::neg:
    case ScalarOp::abs:
    case ScalarOp::floor:
    case ScalarOp::ceil:
    case ScalarOp::sqrt:
    case ScalarOp::sin:
    case ScalarOp::cos:
    case ScalarOp::tan:
    case ScalarOp::asin:
    case ScalarOp::acos:
    case ScalarOp::exp:
    case ScalarOp::log:
    case ScalarOp::logical_not:
        return 1;
    case ScalarOp::select:
    case ScalarOp::random:
    case ScalarOp::noise:
        return 3;
    default:
        return 2;
    }
}

std::string_view name_of(ScalarOp op) {
    return names[static_cast<std::size_t>(op)];
}

std::uint32_t ScalarMath::symbol(const Scalar& scalar) {
    return scalar.is_constant() ? builder_->constant(scalar.value) : scalar.symbol;
}

Scalar ScalarMath::apply(ScalarOp op, const Scalar& a) {
    if (a.is_constant()) {
        return {folded(op, a, {}, {})};
    }
    return {0, builder_->apply(name_of(op), {symbol(a)})};
}

Scalar ScalarMath::apply(ScalarOp op, const Scalar& a, const Scalar& b) {
    if (a.is_constant() && b.is_constant()) {
        return {folded(op, a, b, {})};
    }
    const std::uint32_t left = symbol(a); // before the right one: builders number their nodes
    return {0, builder_->apply(name_of(op), {left, symbol(b)})};
}

Scalar ScalarMath::apply(ScalarOp op, const Scalar& a, const Scalar& b, const Scalar& c) {
    if (a.is_constant() && b.is_constant() && c.is_constant()) {
        return {folded(op, a, b, c)};
    }
    const std::uint32_t first = symbol(a);
    const std::uint32_t second = symbol(b);
    return {0, builder_->apply(name_of(op), {first, second, symbol(c)})};
}

bool ScalarMath::require(ScalarOp op, const Scalar& a, const Scalar& b) {
    const bool matters = builder_ != nullptr && builder_->has_requirements();
    return !matters || require(apply(op, a, b));
}

bool ScalarMath::require(const Scalar& condition) {
    if (!condition.is_constant()) {
        builder_->require(condition.symbol);
        return true;
    }
    return condition.value != 0;
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
