#pragma once

#include "runtime/math/interval.h"
#include "runtime/math/noise.h"

#include <array>
#include <concepts>

/// Values with their derivatives by n variables (forward-mode differentiation), over lanes or over intervals
/// of lanes. Over intervals a derivative is bounded only where the function is Lipschitz: where it may jump,
/// its derivative is the whole line. At kinks (min, abs, ...) lanes get one side's derivative and intervals
/// both.
namespace scc::runtime {

template <class T>
struct RealOfNumber {
    using type = typename T::Real;
};
template <Lane L>
struct RealOfNumber<L> {
    using type = RealOf<L>;
};

template <class T, int n>
struct Dual {
    using Real = typename RealOfNumber<T>::type;

    T v{};
    T d[n]{};

    Dual() = default;
    /// A constant.
    constexpr Dual(const T& value) : v(value) { fill(T(Real(0))); }
    constexpr Dual(Real value) requires(!std::is_same_v<T, Real>) : v(value) { fill(T(Real(0))); }
    /// The variable with this index.
    static constexpr Dual variable(const T& value, int index) {
        Dual result(value);
        result.d[index] = T(Real(1));
        return result;
    }

private:
    constexpr void fill(const T& value) {
        for (T& one : d) {
            one = value;
        }
    }
};

namespace detail {

/// derivative(i) for each variable.
template <class T, int n, class F>
Dual<T, n> dual(const T& value, F&& derivative) {
    Dual<T, n> result(value);
    for (int i = 0; i < n; ++i) {
        result.d[i] = derivative(i);
    }
    return result;
}
/// The chain rule.
template <class T, int n>
Dual<T, n> chained(const T& value, const T& slope, const Dual<T, n>& inner) {
    return dual<T, n>(value, [&](int i) { return slope * inner.d[i]; });
}

/// The derivative of what stays the same between steps.
template <Lane L>
L step_slope(const L&) {
    return L(0);
}
template <class L>
Interval<L> step_slope(const Interval<L>& value) {
    return choose_lanes(value.min == value.max, Interval<L>(L(0)), Interval<L>::whole());
}
/// That of one of two functions that need not meet where the choice changes.
template <Lane L>
L chosen_slope(const MaskOf<L>& which, const L& a, const L& b) {
    return choose(which, a, b);
}
template <class L>
Interval<L> chosen_slope(const Truth<L>& which, const Interval<L>& a, const Interval<L>& b) {
    return choose_lanes(MaskOf<L>(which.maybe & which.maybe_not), Interval<L>::whole(), choose(which, a, b));
}
template <Lane L>
MaskOf<L> is_zero(const L& x) {
    return x == 0;
}
template <class L>
MaskOf<L> is_zero(const Interval<L>& x) {
    return (x.min == 0) & (x.max == 0);
}
template <Lane L>
L where(const MaskOf<L>& mask, const L& a, const L& b) {
    return choose(mask, a, b);
}
template <class L>
Interval<L> where(const MaskOf<L>& mask, const Interval<L>& a, const Interval<L>& b) {
    return choose_lanes(mask, a, b);
}

} // namespace detail

template <class T, int n>
Dual<T, n> operator-(const Dual<T, n>& a) {
    return detail::dual<T, n>(-a.v, [&](int i) { return -a.d[i]; });
}

namespace detail {

template <class T, int n>
Dual<T, n> sum(const Dual<T, n>& a, const Dual<T, n>& b) {
    return dual<T, n>(a.v + b.v, [&](int i) { return a.d[i] + b.d[i]; });
}
template <class T, int n>
Dual<T, n> difference(const Dual<T, n>& a, const Dual<T, n>& b) {
    return dual<T, n>(a.v - b.v, [&](int i) { return a.d[i] - b.d[i]; });
}
template <class T, int n>
Dual<T, n> product(const Dual<T, n>& a, const Dual<T, n>& b) {
    return dual<T, n>(a.v * b.v, [&](int i) { return a.d[i] * b.v + a.v * b.d[i]; });
}
template <class T, int n>
Dual<T, n> quotient(const Dual<T, n>& a, const Dual<T, n>& b) {
    const T value = a.v / b.v;
    return dual<T, n>(value, [&](int i) { return (a.d[i] - value * b.d[i]) / b.v; });
}

} // namespace detail

#define SCC_DUAL_OPERATOR(op, function)                                                                      \
    template <class T, int n>                                                                                \
    Dual<T, n> operator op(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {                 \
        return detail::function(a, b);                                                                       \
    }                                                                                                        \
    template <class T, int n>                                                                                \
    Dual<T, n> operator op(typename Dual<T, n>::Real a, const Dual<T, n>& b) {                               \
        return detail::function(Dual<T, n>(a), b);                                                           \
    }
SCC_DUAL_OPERATOR(+, sum)
SCC_DUAL_OPERATOR(-, difference)
SCC_DUAL_OPERATOR(*, product)
SCC_DUAL_OPERATOR(/, quotient)
#undef SCC_DUAL_OPERATOR

#define SCC_DUAL_COMPARISON(op)                                                                              \
    template <class T, int n>                                                                                \
    auto operator op(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {                       \
        return a.v op b.v;                                                                                   \
    }
SCC_DUAL_COMPARISON(<)
SCC_DUAL_COMPARISON(<=)
SCC_DUAL_COMPARISON(>)
SCC_DUAL_COMPARISON(>=)
SCC_DUAL_COMPARISON(==)
SCC_DUAL_COMPARISON(!=)
#undef SCC_DUAL_COMPARISON

/// Conditions, which are 1 or 0, have no derivatives: they serve to choose only.
template <class Mask, class T, int n>
Dual<T, n> choose(const Mask& which, const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {
    return detail::dual<T, n>(choose(which, a.v, b.v),
                              [&](int i) { return detail::chosen_slope(which, a.d[i], b.d[i]); });
}

template <class T, int n>
Dual<T, n> minimum(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {
    return detail::dual<T, n>(minimum(a.v, b.v), [&](int i) { return choose(b.v < a.v, b.d[i], a.d[i]); });
}
template <class T, int n>
Dual<T, n> maximum(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {
    return detail::dual<T, n>(maximum(a.v, b.v), [&](int i) { return choose(b.v > a.v, b.d[i], a.d[i]); });
}
template <class T, int n>
Dual<T, n> absolute(const Dual<T, n>& a) {
    return detail::dual<T, n>(absolute(a.v), [&](int i) { return choose(a.v < 0, -a.d[i], a.d[i]); });
}
template <class T, int n>
Dual<T, n> round_down(const Dual<T, n>& a) {
    const T value = round_down(a.v), slope = detail::step_slope(value);
    return detail::dual<T, n>(value, [&](int) { return slope; });
}
template <class T, int n>
Dual<T, n> round_up(const Dual<T, n>& a) {
    return -round_down(-a);
}
template <class T, int n>
Dual<T, n> floored_mod(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {
    const Dual<T, n> turned = a - b * round_down(a / b);
    return detail::dual<T, n>(floored_mod(a.v, b.v), [&](int i) { return turned.d[i]; });
}

template <class T, int n>
Dual<T, n> square(const Dual<T, n>& a) {
    return detail::chained(square(a.v), a.v + a.v, a);
}
template <class T, int n>
Dual<T, n> square_root(const Dual<T, n>& a) {
    const T root = square_root(a.v);
    return detail::dual<T, n>(root, [&](int i) { return a.d[i] / (root + root); });
}
/// A constant exponent's logarithm does not matter, nor its base's sign.
template <class T, int n>
Dual<T, n> power(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b) {
    const T value = power(a.v, b.v), slope = b.v * power(a.v, b.v - T(typename Dual<T, n>::Real(1)));
    return detail::dual<T, n>(value, [&](int i) {
        const T by_base = slope * a.d[i];
        return detail::where(detail::is_zero(b.d[i]), by_base, by_base + value * logarithm(a.v) * b.d[i]);
    });
}
template <class T, int n>
Dual<T, n> exponential(const Dual<T, n>& a) {
    const T value = exponential(a.v);
    return detail::chained(value, value, a);
}
template <class T, int n>
Dual<T, n> logarithm(const Dual<T, n>& a) {
    return detail::dual<T, n>(logarithm(a.v), [&](int i) { return a.d[i] / a.v; });
}
template <class T, int n>
Dual<T, n> sine(const Dual<T, n>& a) {
    return detail::chained(sine(a.v), cosine(a.v), a);
}
template <class T, int n>
Dual<T, n> cosine(const Dual<T, n>& a) {
    return detail::chained(cosine(a.v), -sine(a.v), a);
}

namespace detail {

template <Lane L>
L between_poles(const L&, const L& slope) {
    return slope;
}
template <class L>
Interval<L> between_poles(const Interval<L>& value, const Interval<L>& slope) {
    const MaskOf<L> bounded = (value.min > -infinity<L>()) & (value.max < infinity<L>());
    return choose_lanes(bounded, slope, Interval<L>::whole());
}

} // namespace detail

template <class T, int n>
Dual<T, n> tangent(const Dual<T, n>& a) {
    const T value = tangent(a.v);
    return detail::chained(value, detail::between_poles(value, 1 + square(value)), a);
}
template <class T, int n>
Dual<T, n> arc_sine(const Dual<T, n>& a) {
    const T side = square_root(1 - square(a.v));
    return detail::dual<T, n>(arc_sine(a.v), [&](int i) { return a.d[i] / side; });
}
template <class T, int n>
Dual<T, n> arc_cosine(const Dual<T, n>& a) {
    const T side = square_root(1 - square(a.v));
    return detail::dual<T, n>(arc_cosine(a.v), [&](int i) { return -a.d[i] / side; });
}

namespace detail {

template <Lane L>
L uncut(const L&, const L&, const L& slope) {
    return slope;
}
template <class L>
Interval<L> uncut(const Interval<L>& y, const Interval<L>& x, const Interval<L>& slope) {
    return choose_lanes(crosses_the_cut(y, x), Interval<L>::whole(), slope);
}

} // namespace detail

template <class T, int n>
Dual<T, n> arc_tangent(const Dual<T, n>& y, const std::type_identity_t<Dual<T, n>>& x) {
    const T squared = square(x.v) + square(y.v);
    return detail::dual<T, n>(arc_tangent(y.v, x.v), [&](int i) {
        return detail::uncut(y.v, x.v, (x.v * y.d[i] - y.v * x.d[i]) / squared);
    });
}

namespace detail {

template <Lane L>
L random_slope(const L&, const L&, const L&) {
    return L(0);
}
template <class L>
Interval<L> random_slope(const Interval<L>& a, const Interval<L>& b, const Interval<L>& c) {
    return choose_lanes(are_exact(a, b, c), Interval<L>(L(0)), Interval<L>::whole());
}

} // namespace detail

template <class T, int n>
Dual<T, n> random_number(const Dual<T, n>& a, const std::type_identity_t<Dual<T, n>>& b,
                         const std::type_identity_t<Dual<T, n>>& c) {
    const T slope = detail::random_slope(a.v, b.v, c.v);
    return detail::dual<T, n>(random_number(a.v, b.v, c.v), [&](int) { return slope; });
}
template <class T, int n>
Dual<T, n> noise_number(const Dual<T, n>& x, const std::type_identity_t<Dual<T, n>>& y,
                        const std::type_identity_t<Dual<T, n>>& z) {
    const std::array<T, 3> slopes = noise_slopes(x.v, y.v, z.v);
    return detail::dual<T, n>(noise_number(x.v, y.v, z.v), [&](int i) {
        return slopes[0] * x.d[i] + slopes[1] * y.d[i] + slopes[2] * z.d[i];
    });
}

} // namespace scc::runtime
