#pragma once

#include "lang/scalar_math.h"
#include "runtime/math/noise.h"

#include <cmath>
#include <limits>

/// What every ScalarOp computes, written once: for one number at a time, and for many in a loop that knows
/// `op`.
namespace scc::lang {

/// The remainder with the sign of the divisor; exact, unlike a - b * floor(a / b).
inline double floored_mod(double a, double b) {
    constexpr double most = 0x1p51; // quotient and product of whole numbers below are exact enough
    if (std::abs(a) < most && std::abs(b) < most && b != 0 &&
        static_cast<double>(static_cast<std::int64_t>(a)) == a &&
        static_cast<double>(static_cast<std::int64_t>(b)) == b) {
        const double rest = a - std::floor(a / b) * b;
        return rest != 0 ? rest : std::copysign(0.0, a);
    }
    const double rest = std::fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

template <ScalarOp op>
double fold(double a, [[maybe_unused]] double b, [[maybe_unused]] double c) {
    const auto truth = [](bool value) { return value ? 1.0 : 0.0; };
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
        return a != 0 ? b : c;
    case ScalarOp::random:
        return runtime::random_number(a, b, c);
    case ScalarOp::noise:
        return runtime::noise_number(a, b, c);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

} // namespace scc::lang
