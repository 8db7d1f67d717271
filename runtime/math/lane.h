#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

/// The vocabulary in which every formula is written. A lane type L is float, double, long double or a Pack of
/// them (pack.h); comparisons give a MaskOf<L>, which is combined by & | ! and used by choose. A formula for
/// one lane has no branch on data, except "nobody needs the rest": if (none(mask)) return.
namespace scc::runtime {

template <class L>
struct LaneTraits;

template <std::floating_point T>
struct LaneTraits<T> {
    using Real = T;
    using Mask = bool;
    using Index = std::uint32_t;
    static constexpr int count = 1;
};

template <class L>
using RealOf = typename LaneTraits<L>::Real;
template <class L>
using MaskOf = typename LaneTraits<L>::Mask;
template <class L>
using IndexOf = typename LaneTraits<L>::Index; ///< a small whole number per lane

template <class L>
concept Lane = requires {
    typename LaneTraits<L>::Real;
};

template <Lane L>
constexpr L infinity() {
    return L(std::numeric_limits<RealOf<L>>::infinity());
}

template <class L>
inline constexpr int lane_count = LaneTraits<L>::count;

/// Lane i of a value. Those of a scalar are itself.
template <class T>
requires std::is_arithmetic_v<T>
constexpr T lane(T x, int) {
    return x;
}
template <std::floating_point T>
constexpr void set_lane(T& x, int, T value) {
    x = value;
}
/// As many of the numbers as L has lanes.
template <std::floating_point L>
constexpr L load_lanes(const float* numbers) {
    return static_cast<L>(*numbers);
}
template <std::floating_point L>
constexpr void store_lanes(L* numbers, L x) {
    *numbers = x;
}
template <std::unsigned_integral Number>
constexpr void store_lanes(Number* numbers, std::uint32_t x) {
    *numbers = x;
}
template <std::floating_point T>
constexpr T smallest(T x) {
    return x;
}
template <std::floating_point T>
constexpr T largest(T x) {
    return x;
}
constexpr void set_lane(bool& x, int, bool value) {
    x = value;
}
constexpr void set_lane(std::uint32_t& x, int, std::uint32_t value) {
    x = value;
}
constexpr int first_lane(bool) {
    return 0;
}
constexpr std::uint64_t count_lanes(bool mask) {
    return mask ? 1 : 0;
}
constexpr unsigned bits(bool mask) {
    return mask ? 1 : 0;
}

constexpr bool any(bool mask) {
    return mask;
}
constexpr bool all(bool mask) {
    return mask;
}
constexpr bool none(bool mask) {
    return !mask;
}

template <class T>
requires std::is_arithmetic_v<T>
constexpr T choose(bool mask, T where_true, T where_false) {
    return mask ? where_true : where_false;
}

/// 1 or 0. A float converts to every lane type without loss; assign it to one before calculating on.
constexpr float truth(bool mask) {
    return mask ? 1.0F : 0.0F;
}

/// b where b < a, else a: a NaN in b is ignored, a NaN in a stays.
template <Lane L>
constexpr L minimum(L a, std::type_identity_t<L> b) {
    return choose(b < a, b, a);
}
/// b where b > a, else a: a NaN in b is ignored, a NaN in a stays.
template <Lane L>
constexpr L maximum(L a, std::type_identity_t<L> b) {
    return choose(b > a, b, a);
}

template <std::floating_point T>
constexpr T absolute(T x) {
    // Not x < 0 ? -x : x, which keeps the sign of -0. The builtin is a constant expression in both compilers.
    if constexpr (std::is_same_v<T, float>) {
        return __builtin_fabsf(x);
    } else if constexpr (std::is_same_v<T, double>) {
        return __builtin_fabs(x);
    } else {
        return __builtin_fabsl(x);
    }
}
template <Lane L>
constexpr L square(const L& x) {
    return x * x;
}
template <std::floating_point T>
T square_root(T x) {
    return std::sqrt(x);
}
template <std::floating_point T>
T round_down(T x) {
    return std::floor(x);
}
template <std::floating_point T>
T round_up(T x) {
    return std::ceil(x);
}

/// a - b floor(a / b): takes the sign of b; NaN where b = 0.
template <Lane L>
L floored_mod(L a, std::type_identity_t<L> b) {
    return a - b * round_down(a / b);
}

/// x, of which the compiler knows nothing any more. Compilers fold elementary functions of known arguments
/// with other rounding than the library's (and turn pow(x, 2) into x * x, sin and cos into one call): without
/// this, a program compiled for one scene would draw other bits than the generic one.
template <std::floating_point T>
T opaque(T x) {
#if defined(__x86_64__)
    if constexpr (sizeof(T) <= sizeof(double)) {
        asm volatile("" : "+x"(x));
        return x;
    }
#elif defined(__aarch64__)
    if constexpr (sizeof(T) <= sizeof(double)) {
        asm volatile("" : "+w"(x));
        return x;
    }
#endif
    asm volatile("" : "+m"(x));
    return x;
}

template <std::floating_point T>
T power(T x, std::type_identity_t<T> y) {
    return std::pow(opaque(x), opaque(y));
}
template <std::floating_point T>
T tangent(T x) {
    return std::tan(opaque(x));
}
template <std::floating_point T>
T arc_sine(T x) {
    return std::asin(opaque(x));
}
template <std::floating_point T>
T arc_cosine(T x) {
    return std::acos(opaque(x));
}
/// The angle of the point (x, y).
template <std::floating_point T>
T arc_tangent(T y, std::type_identity_t<T> x) {
    return std::atan2(opaque(y), opaque(x));
}
template <std::floating_point T>
T exponential(T x) {
    return std::exp(opaque(x));
}
template <std::floating_point T>
T logarithm(T x) {
    return std::log(opaque(x));
}

} // namespace scc::runtime
