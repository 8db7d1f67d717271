#pragma once

#include "runtime/math/interval.h"
#include "runtime/math/pack.h"
#include "runtime/math/unit_power.h"

#include <array>
#include <bit>
#include <cstdint>

/// `random` and `noise`: integer-hash functions of their arguments, so that they are the same on every
/// machine, in every order of evaluation, and in the compiler and the renderer.
namespace scc::runtime {

namespace detail {

/// Sebastiano Vigna's finalizer of SplitMix64.
constexpr std::uint64_t mixed(std::uint64_t h) {
    h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9U;
    h = (h ^ (h >> 27U)) * 0x94d049bb133111ebU;
    return h ^ (h >> 31U);
}

/// Of the bits of three numbers; the two zeros are one.
inline double random_of(double a, double b, double c) {
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;
    std::uint64_t h = golden;
    for (const double argument : {a, b, c}) {
        h = mixed((h ^ std::bit_cast<std::uint64_t>(argument + 0.0)) + golden);
    }
    return static_cast<double>(h >> 11U) * 0x1p-53;
}

} // namespace detail

/// In [0, 1); float may round it to 1.
template <Lane L>
L random_number(const L& a, const std::type_identity_t<L>& b, const std::type_identity_t<L>& c) {
    L result(0);
    for (int i = 0; i < lane_count<L>; ++i) {
        const auto argument = [i](const L& x) { return static_cast<double>(lane(x, i)); };
        set_lane(result, i, static_cast<RealOf<L>>(detail::random_of(argument(a), argument(b), argument(c))));
    }
    return result;
}

namespace detail {

/// To a number's bits when this is added, whole numbers are added as their two's complement.
template <class R>
inline constexpr R whole_shift = R(3) * R(1ULL << (BinaryFormat<R>::mantissa - 1));
/// Beyond, there is little or nothing between whole numbers.
template <class R>
inline constexpr R most_lattice = R(1ULL << (std::numeric_limits<R>::digits - 3));

/// Coordinates of lattice points, in whole numbers of the lanes' size, of which 32 bits count.
template <class L>
auto lattice_index(const L& whole) {
    return bits_of(whole + L(whole_shift<RealOf<L>>)) - bits_of(whole_shift<RealOf<L>>);
}
inline std::uint64_t lattice_index(long double whole) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
}

/// 32 bits as a number in [0, 1).
inline float unit_number(float, std::uint32_t h) {
    return static_cast<float>(h >> 9U) * 0x1p-23F;
}
template <int N>
Pack<float, N> unit_number(Pack<float, N> like, typename PackIndex<float, N>::Vector h) {
    return (real_of(like, (h >> 9U) | 0x4b000000U) - 0x1p23F) * 0x1p-23F;
}
template <std::floating_point T>
T unit_number(T, std::uint64_t h) {
    return static_cast<T>(h) * T(0x1p-32);
}
template <int N>
Pack<double, N> unit_number(Pack<double, N> like, typename PackIndex<double, N>::Vector h) {
    return (real_of(like, h | 0x4330000000000000U) - 0x1p52) * 0x1p-32;
}

/// The numbers in [0, 1) that the eight points about a cell of the whole-number lattice carry: a hash of 32
/// bits (Chris Wellons' lowbias32) of their coordinates modulo 2^32. Bit 0 of the index is the step in x.
template <class L>
struct NoiseCell {
    L corner[8];

    NoiseCell(const L& low_x, const L& low_y, const L& low_z) {
        constexpr std::uint32_t factors[] = {0x9e3779b1U, 0x85ebca77U, 0xc2b2ae3dU};
        const auto x = lattice_index(low_x) * factors[0], y = lattice_index(low_y) * factors[1],
                   z = lattice_index(low_z) * factors[2];
        for (unsigned i = 0; i < 8; ++i) {
            auto h = (x + (i & 1U) * factors[0]) ^ (y + (i >> 1U & 1U) * factors[1]) ^
                     (z + (i >> 2U) * factors[2]);
            h = h & 0xffffffffU;
            h = ((h ^ (h >> 16U)) * 0x7feb352dU) & 0xffffffffU;
            h = ((h ^ (h >> 15U)) * 0x846ca68bU) & 0xffffffffU;
            corner[i] = unit_number(low_x, h ^ (h >> 16U));
        }
    }
};

template <class L>
L between(const L& a, const L& b, const L& t) {
    return a + (b - a) * t;
}
/// From 0 to 1 with two derivatives of 0 at both ends.
template <class L>
L blend(const L& t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}
template <class L>
L blend_slope(const L& t) {
    const L s = t * (1 - t);
    return s * s * 30;
}
template <class R>
inline constexpr R steepest_blend = R(1.875);

/// Lanes in which there is noise; the others are 0.
template <class L>
MaskOf<L> is_on_lattice(const L& x, const L& y, const L& z) {
    const L most(most_lattice<RealOf<L>>);
    return (absolute(x) < most) & (absolute(y) < most) & (absolute(z) < most);
}

/// The derivative along one axis at a point of the cell, divided by the blend's: bilinear in the other two.
/// `axis`, `second` and `third` are bits of the corners' index.
template <class L>
L edge_mean(const NoiseCell<L>& cell, unsigned axis, unsigned second, unsigned third, const L& v,
            const L& w) {
    const auto edge = [&](unsigned i) { return cell.corner[i | axis] - cell.corner[i]; };
    return between(between(edge(0), edge(second), v), between(edge(third), edge(second | third), v), w);
}

} // namespace detail

/// Value noise in [0, 1): what the eight lattice points around carry, blended by 6 t^5 - 15 t^4 + 10 t^3, so
/// that two derivatives are continuous. 0 from about 2^50 on (2^21 in float), where little is between whole
/// numbers.
template <Lane L>
L noise_number(const L& x, const std::type_identity_t<L>& y, const std::type_identity_t<L>& z) {
    using detail::between;
    const MaskOf<L> here = detail::is_on_lattice(x, y, z);
    const L i = choose(here, round_down(x), L(0)), j = choose(here, round_down(y), L(0)),
            k = choose(here, round_down(z), L(0));
    const detail::NoiseCell<L> cell(i, j, k);
    const L u = detail::blend(x - i), v = detail::blend(y - j), w = detail::blend(z - k);
    const auto edge = [&](int n) { return between(cell.corner[n], cell.corner[n + 1], u); };
    return choose(here, between(between(edge(0), edge(2), v), between(edge(4), edge(6), v), w), L(0));
}

/// The noise's partial derivatives.
template <Lane L>
std::array<L, 3> noise_slopes(const L& x, const L& y, const L& z) {
    const MaskOf<L> here = detail::is_on_lattice(x, y, z);
    const L i = choose(here, round_down(x), L(0)), j = choose(here, round_down(y), L(0)),
            k = choose(here, round_down(z), L(0));
    const detail::NoiseCell<L> cell(i, j, k);
    const L s = x - i, t = y - j, r = z - k;
    const L u = detail::blend(s), v = detail::blend(t), w = detail::blend(r);
    return {choose(here, detail::blend_slope(s) * detail::edge_mean(cell, 1, 2, 4, v, w), L(0)),
            choose(here, detail::blend_slope(t) * detail::edge_mean(cell, 2, 1, 4, u, w), L(0)),
            choose(here, detail::blend_slope(r) * detail::edge_mean(cell, 4, 1, 2, u, v), L(0))};
}

// ---- intervals
// ------------------------------------------------------------------------------------------------

namespace detail {

template <class L>
MaskOf<L> are_exact(const Interval<L>& a, const Interval<L>& b, const Interval<L>& c) {
    return (a.min == a.max) & (b.min == b.max) & (c.min == c.max);
}

} // namespace detail

template <class L>
Interval<L> random_number(const Interval<L>& a, const std::type_identity_t<Interval<L>>& b,
                          const std::type_identity_t<Interval<L>>& c) {
    const MaskOf<L> exact = detail::are_exact(a, Interval<L>(b), Interval<L>(c));
    const Interval<L> anything(L(0), L(1));
    if (none(exact)) {
        return anything;
    }
    const L value = random_number(a.min, b.min, c.min);
    return detail::choose_lanes(exact, Interval<L>(detail::below(value), detail::above(value)), anything);
}

namespace detail {

/// Where a box lies in the lattice. What is in several cells has the bounds of all noise.
template <class L>
struct NoiseBox {
    Interval<L> t[3];        ///< within the cell
    MaskOf<L> in_cell{true}; ///< in one
    L low[3];

    NoiseBox(const Interval<L>& x, const Interval<L>& y, const Interval<L>& z) {
        const Interval<L>* const box[] = {&x, &y, &z};
        in_cell = is_on_lattice(x.min, y.min, z.min) & is_on_lattice(x.max, y.max, z.max);
        for (int i = 0; i < 3; ++i) {
            const L cell = round_down(box[i]->min);
            in_cell = in_cell & (cell == round_down(box[i]->max));
            low[i] = cell;
        }
        for (int i = 0; i < 3; ++i) {
            low[i] = choose(in_cell, low[i], L(0));
            t[i] = choose_lanes(in_cell, {box[i]->min - low[i], box[i]->max - low[i]}, Interval<L>(L(0)));
        }
    }
    NoiseCell<L> cell() const { return {low[0], low[1], low[2]}; }
};

/// Bounds of the values, which are right to a few roundings of 1, at the corners of a box.
template <class L>
void extend(Interval<L>& bounds, const L& value) {
    bounds = hull(bounds, Interval<L>(value));
}
template <class L>
inline constexpr RealOf<L> noise_error = 16 * std::numeric_limits<RealOf<L>>::epsilon();

template <class L>
Interval<L> blend_bounds(const Interval<L>& t) {
    const L slack(noise_error<L>);
    return {maximum(blend(t.min) - slack, L(0)), minimum(blend(t.max) + slack, L(1))};
}
template <class L>
Interval<L> blend_slope_bounds(const Interval<L>& t) {
    const L slack(noise_error<L>), p = blend_slope(t.min), q = blend_slope(t.max);
    const L highest = choose(contains(t, L(RealOf<L>(0.5))), L(steepest_blend<RealOf<L>>), maximum(p, q));
    return {maximum(minimum(p, q) - slack, L(0)), highest + slack};
}

/// Bilinear, so the extremes are at the corners.
template <class L>
Interval<L> edge_mean(const NoiseCell<L>& cell, unsigned axis, unsigned second, unsigned third,
                      const Interval<L>& v, const Interval<L>& w) {
    Interval<L> result(edge_mean(cell, axis, second, third, v.min, w.min));
    extend(result, edge_mean(cell, axis, second, third, v.max, w.min));
    extend(result, edge_mean(cell, axis, second, third, v.min, w.max));
    extend(result, edge_mean(cell, axis, second, third, v.max, w.max));
    return {result.min - L(noise_error<L>), result.max + L(noise_error<L>)};
}

} // namespace detail

/// Trilinear in the blends, so the extremes are at the corners.
template <class L>
Interval<L> noise_number(const Interval<L>& x, const std::type_identity_t<Interval<L>>& y,
                         const std::type_identity_t<Interval<L>>& z) {
    using detail::between;
    const detail::NoiseBox<L> box(x, y, z);
    const Interval<L> anything(L(0), L(1));
    if (none(box.in_cell)) {
        return anything;
    }
    const detail::NoiseCell<L> cell = box.cell();
    const Interval<L> u = detail::blend_bounds(box.t[0]), v = detail::blend_bounds(box.t[1]),
                      w = detail::blend_bounds(box.t[2]);
    Interval<L> result(L(1), L(0));
    for (const L& at_x : {u.min, u.max}) {
        const auto edge = [&](int n) { return between(cell.corner[n], cell.corner[n + 1], at_x); };
        const L edges[] = {edge(0), edge(2), edge(4), edge(6)};
        for (const L& at_y : {v.min, v.max}) {
            const L low = between(edges[0], edges[1], at_y), high = between(edges[2], edges[3], at_y);
            detail::extend(result, between(low, high, w.min));
            detail::extend(result, between(low, high, w.max));
        }
    }
    const L slack(detail::noise_error<L>);
    return detail::choose_lanes(box.in_cell, Interval<L>(result.min - slack, result.max + slack), anything);
}

template <class L>
std::array<Interval<L>, 3> noise_slopes(const Interval<L>& x, const Interval<L>& y, const Interval<L>& z) {
    const detail::NoiseBox<L> box(x, y, z);
    const L most(detail::steepest_blend<RealOf<L>> + detail::noise_error<L>);
    const Interval<L> anything(-most, most);
    if (none(box.in_cell)) {
        return {anything, anything, anything};
    }
    const detail::NoiseCell<L> cell = box.cell();
    const Interval<L> u = detail::blend_bounds(box.t[0]), v = detail::blend_bounds(box.t[1]),
                      w = detail::blend_bounds(box.t[2]);
    const auto slope = [&](int axis, const Interval<L>& mean) {
        return detail::choose_lanes(box.in_cell, detail::blend_slope_bounds(box.t[axis]) * mean, anything);
    };
    return {slope(0, detail::edge_mean(cell, 1, 2, 4, v, w)),
            slope(1, detail::edge_mean(cell, 2, 1, 4, u, w)),
            slope(2, detail::edge_mean(cell, 4, 1, 2, u, v))};
}

} // namespace scc::runtime
