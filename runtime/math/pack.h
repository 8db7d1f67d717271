#pragma once

#include "runtime/math/lane.h"
#include "runtime/math/registers.h"

#include <cstring>

namespace scc::runtime {

/// The masks of Pack<T, N>: all bits of a lane are set or none.
template <class T, int N>
struct PackMask {
    using RealVector = detail::VectorType<T, N>;
    using Vector = decltype(RealVector{} < RealVector{});
    Vector v{};

    PackMask() = default;
    explicit PackMask(Vector x) : v(x) {}
    explicit PackMask(bool x) : v(Vector{} == Vector{}) { v = x ? v : Vector{}; }

    friend PackMask operator&(PackMask a, PackMask b) { return PackMask(a.v & b.v); }
    friend PackMask operator|(PackMask a, PackMask b) { return PackMask(a.v | b.v); }
    friend PackMask operator!(PackMask a) { return PackMask(~a.v); }
    friend PackMask operator==(PackMask a, PackMask b) { return PackMask(~(a.v ^ b.v)); }

    friend bool any(PackMask mask) { return bits(mask) != 0; }
    friend bool none(PackMask mask) { return bits(mask) == 0; }
    friend bool all(PackMask mask) { return bits(mask) == static_cast<unsigned>((1ULL << N) - 1); }

    /// Bit i is lane i.
    friend unsigned bits(PackMask mask) {
        const auto lanes = reinterpret_cast<RealVector>(mask.v);
        if constexpr (requires { detail::sign_bits(lanes); }) {
            return detail::sign_bits(lanes);
        } else if constexpr (N > 2) { // wider than a register
            detail::VectorType<T, N / 2> half[2];
            std::memcpy(half, &lanes, sizeof lanes);
            using HalfMask = PackMask<T, N / 2>;
            using HalfVector = typename HalfMask::Vector;
            return bits(HalfMask(reinterpret_cast<HalfVector>(half[0]))) |
                   bits(HalfMask(reinterpret_cast<HalfVector>(half[1]))) << N / 2;
        } else {
            unsigned result = 0;
            for (int i = 0; i < N; ++i) {
                result |= (mask.v[i] != 0 ? 1U : 0U) << i;
            }
            return result;
        }
    }
};

/// Whole numbers beside a Pack<T, N>, of T's size so that they share its masks; 32 bits of each are used.
template <class T, int N>
struct PackIndex {
    using Number = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned>;
    using Vector = detail::VectorType<Number, N>;
    Vector v{};

    PackIndex() = default;
    explicit PackIndex(Vector x) : v(x) {}
    explicit PackIndex(std::uint32_t x) : v(Vector{} + x) {}

    friend PackMask<T, N> operator==(PackIndex a, PackIndex b) { return mask(a.v == b.v); }
    friend PackMask<T, N> operator!=(PackIndex a, PackIndex b) { return mask(a.v != b.v); }
    friend PackMask<T, N> operator<(PackIndex a, PackIndex b) { return mask(a.v < b.v); }
    friend PackIndex choose(PackMask<T, N> where, PackIndex a, PackIndex b) {
        return PackIndex(where.v ? a.v : b.v);
    }

private:
    template <class V>
    static PackMask<T, N> mask(V compared) {
        return PackMask<T, N>(reinterpret_cast<typename PackMask<T, N>::Vector>(compared));
    }
};

/// N lanes of float or double in one register of 16, 32 or 64 bytes, whichever the target has.
template <class T, int N>
struct Pack {
    using Vector = detail::VectorType<T, N>;
    Vector v{};

    Pack() = default;
    explicit Pack(Vector x) : v(x) {}
    Pack(T x) : v(x - Vector{}) {} // not {} + x, which loses the sign of -0

    friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
    friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
    friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
    friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
    friend Pack operator-(Pack a) { return Pack(-a.v); }

    using Mask = PackMask<T, N>;
    friend Mask operator<(Pack a, Pack b) { return Mask(a.v < b.v); }
    friend Mask operator<=(Pack a, Pack b) { return Mask(a.v <= b.v); }
    friend Mask operator>(Pack a, Pack b) { return Mask(a.v > b.v); }
    friend Mask operator>=(Pack a, Pack b) { return Mask(a.v >= b.v); }
    friend Mask operator==(Pack a, Pack b) { return Mask(a.v == b.v); }
    friend Mask operator!=(Pack a, Pack b) { return Mask(a.v != b.v); }
    friend Pack choose(Mask where, Pack a, Pack b) { return Pack(where.v ? a.v : b.v); }
};

template <class T, int N>
struct LaneTraits<Pack<T, N>> {
    using Real = T;
    using Mask = PackMask<T, N>;
    using Index = PackIndex<T, N>;
    static constexpr int count = N;
};

template <class T, int N>
Pack<T, N> truth(PackMask<T, N> mask) {
    return choose(mask, Pack<T, N>(1), Pack<T, N>(0));
}

template <class T, int N>
T lane(const Pack<T, N>& x, int i) {
    return x.v[i];
}
template <class T, int N>
std::uint32_t lane(const PackIndex<T, N>& x, int i) {
    return static_cast<std::uint32_t>(x.v[i]);
}
template <class T, int N>
void set_lane(Pack<T, N>& x, int i, T value) {
    x.v[i] = value;
}
template <class T, int N>
void set_lane(PackMask<T, N>& x, int i, bool value) {
    x.v[i] = value ? -1 : 0;
}
template <class T, int N>
void set_lane(PackIndex<T, N>& x, int i, std::uint32_t value) {
    x.v[i] = value;
}
template <class L>
requires(lane_count<L> > 1) L load_lanes(const float* numbers) {
    detail::VectorType<float, lane_count<L>> loaded;
    std::memcpy(&loaded, numbers, sizeof loaded);
    return L(detail::converted<typename L::Vector>(loaded));
}
template <class T, int N>
void store_lanes(T* numbers, const Pack<T, N>& x) {
    std::memcpy(numbers, &x.v, sizeof x.v);
}
template <class T, int N>
void store_lanes(typename PackIndex<T, N>::Number* numbers, const PackIndex<T, N>& x) {
    std::memcpy(numbers, &x.v, sizeof x.v);
}

namespace detail {

template <class T, int N, class Combine>
T fold(const Pack<T, N>& x, Combine&& combine) {
    if constexpr (N == 1) {
        return x.v[0];
    } else {
        VectorType<T, N / 2> half[2];
        std::memcpy(half, &x.v, sizeof half);
        if constexpr (N == 2) {
            return combine(half[0][0], half[1][0]);
        } else {
            return fold(combine(Pack<T, N / 2>(half[0]), Pack<T, N / 2>(half[1])), combine);
        }
    }
}

} // namespace detail

template <class T, int N>
T smallest(const Pack<T, N>& x) {
    return detail::fold(x, [](const auto& a, const auto& b) { return minimum(a, b); });
}
template <class T, int N>
T largest(const Pack<T, N>& x) {
    return detail::fold(x, [](const auto& a, const auto& b) { return maximum(a, b); });
}
template <class T, int N>
int first_lane(PackMask<T, N> mask) {
    return __builtin_ctz(bits(mask));
}
template <class T, int N>
std::uint64_t count_lanes(PackMask<T, N> mask) {
    return static_cast<std::uint64_t>(__builtin_popcount(bits(mask)));
}

namespace detail {

template <class T, int N, class F>
Pack<T, N> each_lane(F&& f) {
    Pack<T, N> result;
    for (int i = 0; i < N; ++i) {
        result.v[i] = f(i);
    }
    return result;
}

} // namespace detail

template <class T, int N>
Pack<T, N> absolute(Pack<T, N> x) {
    using Bits = typename PackIndex<T, N>::Vector;
    constexpr auto magnitude =
        static_cast<typename PackIndex<T, N>::Number>(~0ULL >> (sizeof(T) == 8 ? 1 : 33));
    return Pack<T, N>(reinterpret_cast<typename Pack<T, N>::Vector>(reinterpret_cast<Bits>(x.v) & magnitude));
}

template <class T, int N>
Pack<T, N> square_root(Pack<T, N> x) {
    if constexpr (requires { detail::vector_root(x.v); }) {
        return Pack<T, N>(detail::vector_root(x.v));
    } else {
        return detail::each_lane<T, N>([&](int i) { return square_root(T(x.v[i])); });
    }
}

namespace detail {

/// Adding 2^52 (2^23) and taking it off again rounds to a whole number; larger ones are whole already.
template <class T, int N>
Pack<T, N> to_nearest_whole(Pack<T, N> x) {
    const Pack<T, N> shift(sizeof(T) == 8 ? T(4503599627370496.0) : T(8388608.0));
    const Pack<T, N> size = absolute(x);
    const Pack<T, N> rounded = (size + shift) - shift;
    return choose(size < shift, choose(x < 0, -rounded, rounded), x);
}

} // namespace detail

template <class T, int N>
Pack<T, N> round_down(Pack<T, N> x) {
    const Pack<T, N> whole = detail::to_nearest_whole(x);
    return choose(whole > x, whole - 1, choose(whole == x, x, whole)); // x itself: -0 stays
}
template <class T, int N>
Pack<T, N> round_up(Pack<T, N> x) {
    return -round_down(-x);
}

template <class T, int N>
Pack<T, N> power(Pack<T, N> x, std::type_identity_t<Pack<T, N>> y) {
    return detail::each_lane<T, N>([&](int i) { return power(T(x.v[i]), T(y.v[i])); });
}
template <class T, int N>
Pack<T, N> arc_tangent(Pack<T, N> y, std::type_identity_t<Pack<T, N>> x) {
    return detail::each_lane<T, N>([&](int i) { return arc_tangent(T(y.v[i]), T(x.v[i])); });
}
template <class T, int N>
Pack<T, N> tangent(Pack<T, N> x) {
    return detail::each_lane<T, N>([&](int i) { return tangent(T(x.v[i])); });
}
template <class T, int N>
Pack<T, N> arc_sine(Pack<T, N> x) {
    return detail::each_lane<T, N>([&](int i) { return arc_sine(T(x.v[i])); });
}
template <class T, int N>
Pack<T, N> arc_cosine(Pack<T, N> x) {
    return detail::each_lane<T, N>([&](int i) { return arc_cosine(T(x.v[i])); });
}
template <class T, int N>
Pack<T, N> exponential(Pack<T, N> x) {
    return detail::each_lane<T, N>([&](int i) { return exponential(T(x.v[i])); });
}
template <class T, int N>
Pack<T, N> logarithm(Pack<T, N> x) {
    return detail::each_lane<T, N>([&](int i) { return logarithm(T(x.v[i])); });
}

namespace detail {

template <class R>
struct WidestLane {
    using type = R;
};
template <class R>
requires(sizeof(R) <= sizeof(double)) struct WidestLane<R> {
    using type = Pack<R, detail::register_bytes / static_cast<int>(sizeof(R))>;
};

} // namespace detail

/// The lane type to calculate in: a register full of R, or R where there are no such registers (long double).
template <class R>
using WidestLane = typename detail::WidestLane<R>::type;

} // namespace scc::runtime
