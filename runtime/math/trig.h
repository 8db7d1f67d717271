#pragma once

#include "runtime/math/pack.h"

/// Sine and cosine of lanes, with the same bits in any number of them.
namespace scc::runtime {

namespace detail {

/// Of how a number type's circle is reduced to |r| <= pi/4: pi/2 in three parts, of which the first two have
/// so few digits that their products with whole numbers up to `most_turns` are exact. After Cody and Waite;
/// the coefficients of the series are those of fdlibm's __kernel_sin and __kernel_cos (Sun Microsystems,
/// 1993) and, for float, of Moshier's Cephes.
template <class R>
struct Circle;
template <>
struct Circle<double> {
    static constexpr double half_pi[] = {1.57079632673412561417e+00, 6.07710050630396597660e-11,
                                         2.02226624879595073240e-21};
    static constexpr double most_turns = 1 << 19;
    static constexpr double sine[] = {1.58969099521155010221e-10, -2.50507602534068634195e-08,
                                      2.75573137070700676789e-06, -1.98412698298579493134e-04,
                                      8.33333333332248946124e-03, -1.66666666666666324348e-01};
    static constexpr double cosine[] = {-1.13596475577881948265e-11, 2.08757232129817482790e-09,
                                        -2.75573143513906633035e-07, 2.48015872894767294178e-05,
                                        -1.38888888888741095749e-03, 4.16666666666666019037e-02};
};
template <>
struct Circle<float> {
    static constexpr float half_pi[] = {1.5703125F, 4.837512969970703125e-4F, 7.54978995489188216e-8F};
    static constexpr float most_turns = 1 << 12;
    static constexpr float sine[] = {-1.9515295891e-4F, 8.3321608736e-3F, -1.6666654611e-1F};
    static constexpr float cosine[] = {2.443315711809948e-5F, -1.388731625493765e-3F, 4.166664568298827e-2F};
};

template <class R, std::size_t n, class L>
L series(const R (&coefficients)[n], const L& z) {
    L sum(coefficients[0]);
    for (std::size_t i = 1; i < n; ++i) {
        sum = sum * z + L(coefficients[i]);
    }
    return sum;
}

/// The sine of x + quarter_turns pi/2, for |x| up to most_turns pi/2.
template <class L>
L sine_of_near(const L& x, int quarter_turns) {
    using C = Circle<RealOf<L>>;
    using R = RealOf<L>;
    const L turns = round_down(x * L(R(0.636619772367581343076)) + L(R(0.5)));
    const L r = ((x - turns * L(C::half_pi[0])) - turns * L(C::half_pi[1])) - turns * L(C::half_pi[2]);
    const L z = r * r;
    const L odd = r + (r * z) * series(C::sine, z);
    const L half = z * L(R(0.5)), rest = 1 - half;
    const L even = rest + (((1 - rest) - half) + (z * z) * series(C::cosine, z));
    const L shifted = turns + L(static_cast<R>(quarter_turns));
    const L quarter = shifted - round_down(shifted * L(R(0.25))) * L(R(4)); // 0, 1, 2 or 3
    const L value = choose((quarter == 1) | (quarter == 3), even, odd);
    return choose(quarter >= 2, -value, value);
}

/// The library's function in the lanes that are too far off for the reduction.
template <class L, class Far>
L sine_of(const L& x, int quarter_turns, Far&& far) {
    using R = RealOf<L>;
    const MaskOf<L> near = absolute(x) <= L(Circle<R>::most_turns);
    L result = sine_of_near(x, quarter_turns);
    if (!all(near)) {
        for (int i = 0; i < lane_count<L>; ++i) {
            const R one = lane(x, i);
            if (!(absolute(one) <= Circle<R>::most_turns)) {
                set_lane(result, i, far(opaque(one)));
            }
        }
    }
    return result;
}

} // namespace detail

/// To three roundings of the result where that is above 1/4, else to three of 1/4. NaN at infinity.
template <Lane L>
L sine(const L& x) {
    const auto library = [](RealOf<L> one) { return std::sin(one); };
    if constexpr (sizeof(RealOf<L>) > sizeof(double)) {
        return library(x);
    } else {
        return detail::sine_of(x, 0, library);
    }
}
template <Lane L>
L cosine(const L& x) {
    const auto library = [](RealOf<L> one) { return std::cos(one); };
    if constexpr (sizeof(RealOf<L>) > sizeof(double)) {
        return library(x);
    } else {
        return detail::sine_of(x, 1, library);
    }
}

} // namespace scc::runtime
