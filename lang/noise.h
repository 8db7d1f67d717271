#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// `random` and `noise`: integer-hash functions of their arguments, so that they are the same on every
/// machine and in every order of evaluation.
namespace scc::lang {

/// Sebastiano Vigna's finalizer of SplitMix64.
constexpr std::uint64_t mixed(std::uint64_t h) {
    h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9U;
    h = (h ^ (h >> 27U)) * 0x94d049bb133111ebU;
    return h ^ (h >> 31U);
}

/// In [0, 1), of the bits of three numbers; the two zeros are one.
inline double random_number(double a, double b, double c) {
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;
    std::uint64_t h = golden;
    for (const double argument : {a, b, c}) {
        h = mixed((h ^ std::bit_cast<std::uint64_t>(argument + 0.0)) + golden);
    }
    return static_cast<double>(h >> 11U) * 0x1p-53;
}

/// The number that a point of the whole-number lattice carries, in [0, 1): a hash of 32 bits (Chris Wellons'
/// lowbias32) of its coordinates modulo 2^32.
constexpr double lattice_number(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::uint32_t h = x * 0x9e3779b1U ^ y * 0x85ebca77U ^ z * 0xc2b2ae3dU;
    h = (h ^ (h >> 16U)) * 0x7feb352dU;
    h = (h ^ (h >> 15U)) * 0x846ca68bU;
    return (h ^ (h >> 16U)) * 0x1p-32;
}

/// Value noise in [0, 1): what the eight lattice points around carry, blended by 6 t^5 - 15 t^4 + 10 t^3, so
/// that two derivatives are continuous. 0 beyond 2^52, where there is nothing between whole numbers.
inline double noise_number(double x, double y, double z) {
    if (!(std::abs(x) < 0x1p52 && std::abs(y) < 0x1p52 && std::abs(z) < 0x1p52)) {
        return 0;
    }
    struct Axis {
        std::uint32_t low;
        double blend;
    };
    const auto axis = [](double v) {
        const auto truncated = static_cast<std::int64_t>(v);
        const std::int64_t low = truncated - (v < static_cast<double>(truncated) ? 1 : 0);
        const double t = v - static_cast<double>(low);
        return Axis{static_cast<std::uint32_t>(low), t * t * t * (t * (t * 6 - 15) + 10)};
    };
    const auto between = [](double a, double b, double t) { return a + (b - a) * t; };
    const Axis i = axis(x);
    const Axis j = axis(y);
    const Axis k = axis(z);
    const auto edge = [&](std::uint32_t dy, std::uint32_t dz) {
        return between(lattice_number(i.low, j.low + dy, k.low + dz),
                       lattice_number(i.low + 1, j.low + dy, k.low + dz), i.blend);
    };
    return between(between(edge(0, 0), edge(1, 0), j.blend), between(edge(0, 1), edge(1, 1), j.blend),
                   k.blend);
}

} // namespace scc::lang
