#pragma once

#include "runtime/math/pack.h"

#include <bit>
#include <cstdint>

/// Powers of numbers up to about 1, over lanes.
namespace scc::runtime {

namespace detail {

/// Where an IEEE 754 number keeps what, and how far the series below go for it.
template <class T>
struct BinaryFormat;
template <>
struct BinaryFormat<float> {
    using Bits = std::uint32_t;
    static constexpr int mantissa = 23, bias = 127, log_terms = 6, exp_terms = 8;
    static constexpr Bits root_half = 0x3f3504f3;
};
template <>
struct BinaryFormat<double> {
    using Bits = std::uint64_t;
    static constexpr int mantissa = 52, bias = 1023, log_terms = 12, exp_terms = 15;
    static constexpr Bits root_half = 0x3fe6a09e667f3bcd;
};

inline std::uint32_t bits_of(float x) {
    return std::bit_cast<std::uint32_t>(x);
}
inline std::uint64_t bits_of(double x) {
    return std::bit_cast<std::uint64_t>(x);
}
template <class T, int N>
auto bits_of(const Pack<T, N>& x) {
    return reinterpret_cast<typename PackIndex<T, N>::Vector>(x.v);
}
inline float real_of(float, std::uint32_t bits) {
    return std::bit_cast<float>(bits);
}
inline double real_of(double, std::uint64_t bits) {
    return std::bit_cast<double>(bits);
}
template <class T, int N>
Pack<T, N> real_of(Pack<T, N>, typename PackIndex<T, N>::Vector bits) {
    return Pack<T, N>(reinterpret_cast<typename Pack<T, N>::Vector>(bits));
}

/// Of normal numbers > 0, to a few roundings of the result also near 1: log2(2^e m) with m in [sqrt(1/2),
/// sqrt(2)) is e + 2 / ln 2 (s + s^3 / 3 + s^5 / 5 + ...) with s = (m - 1) / (m + 1).
template <class L>
L log2_of(const L& x) {
    using Format = BinaryFormat<RealOf<L>>;
    using R = RealOf<L>;
    constexpr auto one = typename Format::Bits{Format::bias} << Format::mantissa;
    // The bits of 2^mantissa: what is added to them is added to its value.
    constexpr auto whole = typename Format::Bits{Format::bias + Format::mantissa} << Format::mantissa;
    const auto bits = bits_of(x);
    const auto biased = (bits - Format::root_half + one) >> Format::mantissa;
    const L exponent =
        real_of(x, biased | whole) - L(R(typename Format::Bits{1} << Format::mantissa) + R(Format::bias));
    const L m = real_of(x, bits - (biased << Format::mantissa) + one);
    const L s = (m - 1) / (m + 1), square = s * s;
    L series(R(1) / R(2 * Format::log_terms + 1));
    for (int i = Format::log_terms - 1; i >= 1; --i) {
        series = series * square + L(R(1) / R(2 * i + 1));
    }
    constexpr R scale = R(2.88539008177792681472); // 2 / ln 2
    return exponent + (s * scale + (s * scale) * (square * series));
}

/// 2^t for t > -bias. 2^(n + f) with |f| <= 1/2 is 2^n times the series of e^(f ln 2).
template <class L>
L exp2_of(const L& t) {
    using Format = BinaryFormat<RealOf<L>>;
    using R = RealOf<L>;
    constexpr R to_whole = R(typename Format::Bits{3} << (Format::mantissa - 1)); // rounds to whole numbers
    const L shifted = t + L(to_whole);
    const L f = (t - (shifted - L(to_whole))) * L(R(0.69314718055994530942));
    L series(R(1));
    for (int i = Format::exp_terms - 1; i >= 1; --i) {
        series = series * (f * L(R(1) / R(i))) + L(R(1));
    }
    const auto power = (bits_of(shifted) + typename Format::Bits{Format::bias}) << Format::mantissa;
    return series * real_of(t, power);
}

} // namespace detail

/// x^y for 0 <= x <= 1 or a little more (x no denormal number) and y >= 0. The error is at most 4 roundings
/// of 1, absolutely, which is what a colour's term needs; library functions bound the relative error and work
/// on one number at a time. So powers below half a rounding of 1 are 0, as those of most highlights are in
/// most places. The same bits in any number of lanes.
template <Lane L>
L unit_power(const L& x, const L& y) {
    if constexpr (sizeof(RealOf<L>) > sizeof(double)) {
        return power(x, y);
    } else {
        using R = RealOf<L>;
        constexpr R digits = std::numeric_limits<R>::digits;
        // log2(x) <= (x - 1) / ln 2; by 1 more than the digits, so that rounding does not matter.
        if (none(y * (x - 1) > L(-(digits + 2) * R(0.69314718055994530942)))) {
            return L(0);
        }
        constexpr R largest = R(detail::BinaryFormat<R>::bias - 1);
        const L t = y * detail::log2_of(maximum(x, L(std::numeric_limits<R>::min())));
        const L result = detail::exp2_of(minimum(maximum(t, L(-digits - 1)), L(largest)));
        return choose(y > 0, choose((x > 0) & (t > L(-digits - 1)), result, L(0)), L(1));
    }
}

} // namespace scc::runtime
