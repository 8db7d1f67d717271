#pragma once

#include "runtime/math/pack.h"
#include "runtime/math/trig.h"

#include <numbers>
#include <type_traits>

/// Interval arithmetic over lanes: for each lane all real values between two numbers. Every operation
/// encloses the exact results for all exact operands, where the operation is defined; what it gives for
/// operands where it is nowhere defined is unspecified. Ends are rounded outwards by a few roundings rather
/// than by the processor's rounding modes, which vectors of constants and compilers do not heed.
namespace scc::runtime {

/// min <= max; no end is NaN, min is below +infinity and max above -infinity.
template <class L>
struct Interval {
    using Real = RealOf<L>;

    L min{}, max{};

    Interval() = default;
    constexpr Interval(const L& value) : min(value), max(value) {}
    constexpr Interval(Real value) requires(!std::is_same_v<L, Real>) : min(value), max(value) {}
    constexpr Interval(const L& from, const L& to) : min(from), max(to) {}

    static constexpr Interval whole() { return {-infinity<L>(), infinity<L>()}; }
};

/// What a comparison of intervals can turn out to be.
template <class L>
struct Truth {
    MaskOf<L> maybe, maybe_not;
};

namespace detail {

/// Twice what one rounding can be off, so that the rounding of the widening itself is covered.
template <class L>
inline constexpr RealOf<L> outwards = 2 * std::numeric_limits<RealOf<L>>::epsilon();

/// More than an underflow can be off; so large that products with `outwards` are normal numbers, which are
/// fast.
template <class L>
inline constexpr RealOf<L> underflow = std::numeric_limits<RealOf<L>>::min() /
                                       (outwards<L> * std::numeric_limits<RealOf<L>>::epsilon());

/// A number that is not above anything which rounds to x; -infinity for NaN.
template <class L>
L below(const L& x) {
    const L lower = x - absolute(x) * L(outwards<L>);
    return choose(lower <= x, lower, -infinity<L>());
}
template <class L>
L above(const L& x) {
    const L upper = x + absolute(x) * L(outwards<L>);
    return choose(upper >= x, upper, infinity<L>());
}
/// Sums are exact where they are small. For everything else.
template <class L>
Interval<L> rounded(const L& min, const L& max) {
    return {below(min - L(underflow<L>)), above(max + L(underflow<L>))};
}
/// `many` times as wide.
template <class L>
Interval<L> rounded(const L& min, const L& max, int many) {
    const L relative(static_cast<RealOf<L>>(many) * outwards<L>);
    return rounded(min - absolute(min) * relative, max + absolute(max) * relative);
}

/// NaN is ignored.
template <class L>
L least(const L& a, const L& b, const L& c, const L& d) {
    return minimum(minimum(minimum(minimum(infinity<L>(), a), b), c), d);
}
template <class L>
L greatest(const L& a, const L& b, const L& c, const L& d) {
    return maximum(maximum(maximum(maximum(-infinity<L>(), a), b), c), d);
}

template <class L>
Interval<L> choose_lanes(const MaskOf<L>& where, const Interval<L>& a, const Interval<L>& b) {
    return {choose(where, a.min, b.min), choose(where, a.max, b.max)};
}

} // namespace detail

template <class L>
Interval<L> hull(const Interval<L>& a, const Interval<L>& b) {
    return {minimum(a.min, b.min), maximum(a.max, b.max)};
}
/// Of intervals that have something in common.
template <class L>
Interval<L> intersection(const Interval<L>& a, const Interval<L>& b) {
    return {maximum(a.min, b.min), minimum(a.max, b.max)};
}
template <class L>
MaskOf<L> contains(const Interval<L>& a, const L& value) {
    return (a.min <= value) & (value <= a.max);
}

// ---- arithmetic
// ---------------------------------------------------------------------------------------------

template <class L>
Interval<L> operator-(const Interval<L>& a) {
    return {-a.max, -a.min};
}

namespace detail {

template <class L>
Interval<L> sum(const Interval<L>& a, const Interval<L>& b) {
    return {below(a.min + b.min), above(a.max + b.max)};
}
// 0 times infinity stands for 0 times a real number; the other ends then give the bound.
template <class L>
Interval<L> product(const Interval<L>& a, const Interval<L>& b) {
    const L p = a.min * b.min, q = a.min * b.max, r = a.max * b.min, s = a.max * b.max;
    return rounded(least(p, q, r, s), greatest(p, q, r, s));
}
template <class L>
Interval<L> quotient(const Interval<L>& a, const Interval<L>& b) {
    const MaskOf<L> apart = (b.min > 0) | (b.max < 0);
    const Interval<L> inverse = rounded(1 / b.max, 1 / b.min);
    return choose_lanes(apart, product(a, inverse), Interval<L>::whole());
}

} // namespace detail

// Friends of no class, so that whole numbers convert to either operand.
#define SCC_INTERVAL_OPERATOR(op, function)                                                                  \
    template <class L>                                                                                       \
    Interval<L> operator op(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {              \
        return detail::function(a, b);                                                                       \
    }                                                                                                        \
    template <class L>                                                                                       \
    Interval<L> operator op(typename Interval<L>::Real a, const Interval<L>& b) {                            \
        return detail::function(Interval<L>(a), b);                                                          \
    }
SCC_INTERVAL_OPERATOR(+, sum)
SCC_INTERVAL_OPERATOR(*, product)
SCC_INTERVAL_OPERATOR(/, quotient)
#undef SCC_INTERVAL_OPERATOR
template <class L>
Interval<L> operator-(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {
    return a + -b;
}
template <class L>
Interval<L> operator-(typename Interval<L>::Real a, const Interval<L>& b) {
    return Interval<L>(a) + -b;
}

template <class L>
Interval<L> absolute(const Interval<L>& a) {
    const L p = absolute(a.min), q = absolute(a.max);
    return {choose(contains(a, L(0)), L(0), minimum(p, q)), maximum(p, q)};
}
template <class L>
Interval<L> square(const Interval<L>& a) {
    const Interval<L> size = absolute(a);
    const Interval<L> squared = detail::rounded(size.min * size.min, size.max * size.max);
    return {maximum(squared.min, L(0)), squared.max};
}
template <class L>
Interval<L> minimum(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {
    return {minimum(a.min, b.min), minimum(a.max, b.max)};
}
template <class L>
Interval<L> maximum(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {
    return {maximum(a.min, b.min), maximum(a.max, b.max)};
}
template <class L>
Interval<L> round_down(const Interval<L>& a) {
    return {round_down(a.min), round_down(a.max)};
}
template <class L>
Interval<L> round_up(const Interval<L>& a) {
    return {round_up(a.min), round_up(a.max)};
}

/// Where the quotient may or may not reach a whole number: the remainder's whole range.
template <class L>
Interval<L> floored_mod(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {
    const Interval<L> range{choose(b.min > 0, L(0), b.min), choose(b.max < 0, L(0), b.max)};
    const Interval<L> turns = round_down(a / b);
    const Interval<L> rest = intersection(a - b * turns, range);
    return detail::choose_lanes((turns.min == turns.max) & (rest.min <= rest.max), rest, range);
}

// ---- elementary functions
// --------------------------------------------------------------------------------------- The library's are
// taken to be right to 8 roundings; those of glibc are to 1 or 2.

template <class L>
Interval<L> square_root(const Interval<L>& a) {
    return {maximum(detail::below(square_root(maximum(a.min, L(0)))), L(0)),
            detail::above(square_root(maximum(a.max, L(0))))};
}
template <class L>
Interval<L> exponential(const Interval<L>& a) {
    const Interval<L> result = detail::rounded(exponential(a.min), exponential(a.max), 4);
    return {maximum(result.min, L(0)), result.max};
}
template <class L>
Interval<L> logarithm(const Interval<L>& a) {
    return detail::rounded(logarithm(maximum(a.min, L(0))), logarithm(maximum(a.max, L(0))), 4);
}

namespace detail {

/// Of a base that is nowhere negative, a power takes its extremes in the corners.
template <class L>
Interval<L> power_of_positive(const L& low, const L& high, const Interval<L>& b) {
    const L p = power(low, b.min), q = power(low, b.max), r = power(high, b.min), s = power(high, b.max);
    return {least(p, q, r, s), greatest(p, q, r, s)};
}
/// A base below 0 has powers with whole exponents only, of either sign where there are several of these.
template <class L>
Interval<L> power_of_negative(const L& low, const L& high, const Interval<L>& b) {
    const MaskOf<L> one_whole = (b.min == b.max) & (round_down(b.min) == b.min);
    const L p = power(low, b.min), q = power(high, b.min);
    const L size = power_of_positive(-high, -low, b).max;
    return choose_lanes(one_whole, Interval<L>(minimum(p, q), maximum(p, q)), Interval<L>(-size, size));
}

} // namespace detail

template <class L>
Interval<L> power(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {
    const Interval<L> exponent = b;
    const MaskOf<L> has_negative = a.min < 0, has_positive = a.max >= 0;
    Interval<L> ends = detail::power_of_positive(maximum(a.min, L(0)), maximum(a.max, L(0)), exponent);
    if (any(has_negative)) {
        const Interval<L> negative =
            detail::power_of_negative(minimum(a.min, L(0)), minimum(a.max, L(0)), exponent);
        ends = detail::choose_lanes(has_negative,
                                    detail::choose_lanes(has_positive, hull(ends, negative), negative), ends);
    }
    const MaskOf<L> may_divide_by_zero = contains(a, L(0)) & (b.min < 0);
    return detail::choose_lanes(may_divide_by_zero, Interval<L>::whole(),
                                detail::rounded(ends.min, ends.max, 4));
}

namespace detail {

/// Whether some x = first + 2 pi k lies in the interval or close by.
template <class L>
MaskOf<L> contains_turn(const Interval<L>& a, RealOf<L> first) {
    using R = RealOf<L>;
    constexpr R turn = 2 * std::numbers::pi_v<R>;
    const L slack = (absolute(a.min) + absolute(a.max) + L(R(8))) * L(4 * outwards<L>);
    const L k = round_up((a.min - slack - L(first)) * L(1 / turn) - L(4 * outwards<L>));
    return L(first) + k * L(turn) <= a.max + slack;
}
/// From the values at the ends of `a`, which are right to `outwards` of 1.
template <class L>
Interval<L> wave(const Interval<L>& a, const L& p, const L& q, RealOf<L> trough, RealOf<L> crest) {
    const L low = minimum(p, q) - L(outwards<L>), high = maximum(p, q) + L(outwards<L>);
    const MaskOf<L> known = a.max - a.min < L(2 * std::numbers::pi_v<RealOf<L>>);
    return {choose(known & !contains_turn(a, trough), maximum(low, L(-1)), L(-1)),
            choose(known & !contains_turn(a, crest), minimum(high, L(1)), L(1))};
}

} // namespace detail

template <class L>
Interval<L> sine(const Interval<L>& a) {
    constexpr RealOf<L> quarter = std::numbers::pi_v<RealOf<L>> / 2;
    return detail::wave(a, sine(a.min), sine(a.max), -quarter, quarter);
}
template <class L>
Interval<L> cosine(const Interval<L>& a) {
    return detail::wave(a, cosine(a.min), cosine(a.max), std::numbers::pi_v<RealOf<L>>, RealOf<L>(0));
}
template <class L>
Interval<L> tangent(const Interval<L>& a) {
    using R = RealOf<L>;
    const L slack = (absolute(a.min) + absolute(a.max)) * L(4 * detail::outwards<L>);
    const auto branch = [](const L& x) { return round_down(x * L(1 / std::numbers::pi_v<R>) + L(R(0.5))); };
    const MaskOf<L> one_branch = branch(a.min - slack) == branch(a.max + slack);
    return detail::choose_lanes(one_branch, detail::rounded(tangent(a.min), tangent(a.max), 4),
                                Interval<L>::whole());
}
template <class L>
Interval<L> arc_sine(const Interval<L>& a) {
    const auto inside = [](const L& x) { return minimum(maximum(x, L(-1)), L(1)); };
    return detail::rounded(arc_sine(inside(a.min)), arc_sine(inside(a.max)), 4);
}
template <class L>
Interval<L> arc_cosine(const Interval<L>& a) {
    const auto inside = [](const L& x) { return minimum(maximum(x, L(-1)), L(1)); };
    return detail::rounded(arc_cosine(inside(a.max)), arc_cosine(inside(a.min)), 4);
}

namespace detail {

/// Whether the angle of (x, y) may jump from pi to -pi, or has no limit at 0.
template <class L>
MaskOf<L> crosses_the_cut(const Interval<L>& y, const Interval<L>& x) {
    return (x.min <= 0) & contains(y, L(0));
}

} // namespace detail

/// Apart from its cut the angle takes its extremes over a rectangle in the corners.
template <class L>
Interval<L> arc_tangent(const Interval<L>& y, const std::type_identity_t<Interval<L>>& x) {
    const L p = arc_tangent(y.min, x.min), q = arc_tangent(y.min, x.max), r = arc_tangent(y.max, x.min),
            s = arc_tangent(y.max, x.max);
    const Interval<L> corners = detail::rounded(detail::least(p, q, r, s), detail::greatest(p, q, r, s), 4);
    const L pi(std::numbers::pi_v<RealOf<L>>);
    const MaskOf<L> exact = (x.min == x.max) & (y.min == y.max);
    return detail::choose_lanes(detail::crosses_the_cut(y, x) & !exact,
                                Interval<L>(detail::below(-pi), detail::above(pi)), corners);
}

// ---- conditions
// ------------------------------------------------------------------------------------------------

#define SCC_INTERVAL_COMPARISON(op, is_maybe, is_maybe_not)                                                  \
    template <class L>                                                                                       \
    Truth<L> operator op(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {                 \
        return {MaskOf<L>(is_maybe), MaskOf<L>(is_maybe_not)};                                               \
    }
SCC_INTERVAL_COMPARISON(<, a.min < b.max, a.max >= b.min)
SCC_INTERVAL_COMPARISON(<=, a.min <= b.max, a.max > b.min)
SCC_INTERVAL_COMPARISON(>, a.max > b.min, a.min <= b.max)
SCC_INTERVAL_COMPARISON(>=, a.max >= b.min, a.min < b.max)
SCC_INTERVAL_COMPARISON(==, (a.min <= b.max) & (b.min <= a.max), !((a.min == b.max) & (b.min == a.max)))
SCC_INTERVAL_COMPARISON(!=, !((a.min == b.max) & (b.min == a.max)), (a.min <= b.max) & (b.min <= a.max))
#undef SCC_INTERVAL_COMPARISON
template <class L>
Interval<L> truth(const Truth<L>& a) {
    return {choose(a.maybe_not, L(0), L(1)), choose(a.maybe, L(1), L(0))};
}
/// Where it is open which one: both.
template <class L>
Interval<L> choose(const Truth<L>& which, const Interval<L>& a, const std::type_identity_t<Interval<L>>& b) {
    const MaskOf<L> first = !which.maybe_not, second = !which.maybe;
    return detail::choose_lanes(first, a, detail::choose_lanes(second, Interval<L>(b), hull(a, b)));
}

} // namespace scc::runtime
