#pragma once

#include "runtime/math/noise.h"
#include "runtime/math/trig.h"
#include "runtime/render_settings.h"

#include <cmath>
#include <cstdint>

/// L17. Sets of points that fill squares evenly, and filters. A point depends on its pixel and its number
/// alone, so that a picture depends on neither crops nor threads nor the lanes that a register holds.
namespace scc::runtime {

/// A pixel of the picture, also outside of it.
struct Pixel {
    int column = 0, row = 0;
};

/// Of a unit square, in units of 2^-32.
struct SquarePoint {
    std::uint32_t x = 0, y = 0;
};

namespace detail {

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
    x = (x & 0x55555555U) << 1 | (x >> 1 & 0x55555555U);
    x = (x & 0x33333333U) << 2 | (x >> 2 & 0x33333333U);
    x = (x & 0x0f0f0f0fU) << 4 | (x >> 4 & 0x0f0f0f0fU);
    x = (x & 0x00ff00ffU) << 8 | (x >> 8 & 0x00ff00ffU);
    return x << 16 | x >> 16;
}

/// A permutation in which each bit depends on the lower ones alone: Laine and Karras, Stratified Sampling for
/// Stochastic Transparency (2011), with the constants of N. Vegdahl, Building a Better LK Hash (2021).
constexpr std::uint32_t scrambled_upwards(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= seed >> 16 | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return x;
}

/// The second coordinate of Sobol's sequence, whose first is that of van der Corput.
constexpr std::uint32_t sobol_y(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1U << 31; index != 0; index >>= 1, direction ^= direction >> 1) {
        result ^= (index & 1U) != 0 ? direction : 0;
    }
    return result;
}

} // namespace detail

/// What points are for; those for different uses are independent.
enum class PointUse : std::uint64_t { pixel = 1, lens = 2 };

/// Sobol's sequence in two dimensions, of which each pixel takes the points in another order and scrambled
/// otherwise (Owen's scrambling), as in B. Burley, Practical Hash-based Owen Scrambling (JCGT 9:4, 2020).
/// Every power of two of the points from the first on are a (0, m, 2)-net.
class SobolPoints {
public:
    constexpr SobolPoints(const Pixel& pixel, PointUse use) {
        const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(pixel.row)) << 32 |
                           static_cast<std::uint32_t>(pixel.column);
        const std::uint64_t seeds = detail::mixed(place + static_cast<std::uint64_t>(use) * golden);
        order_ = static_cast<std::uint32_t>(detail::mixed(seeds + golden));
        x_ = static_cast<std::uint32_t>(seeds);
        y_ = static_cast<std::uint32_t>(seeds >> 32);
    }
    constexpr SquarePoint operator[](int number) const {
        using namespace detail;
        const auto start = static_cast<std::uint32_t>(number);
        const std::uint32_t index = reversed_bits(scrambled_upwards(reversed_bits(start), order_)) & most;
        return {reversed_bits(scrambled_upwards(index, x_)),
                reversed_bits(scrambled_upwards(reversed_bits(sobol_y(index)), y_))};
    }

private:
    static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;
    /// As many are kept together that low bits alone are looked at.
    static constexpr std::uint32_t most = 0xffff;
    static_assert(most_samples <= most);

    std::uint32_t order_, x_, y_;
};

/// In [0, 1).
template <class R>
constexpr R part_of_unit(std::uint32_t x) {
    if constexpr (sizeof(R) == sizeof(float)) {
        return static_cast<R>(x >> 8) * R(0x1p-24);
    } else {
        return static_cast<R>(x) * R(0x1p-32);
    }
}

/// A point of the unit disc for one of the unit square, so that equal areas stay equal: P. Shirley and
/// K. Chiu, A Low Distortion Map Between Disk and Square (1997).
template <Lane L>
Vec2<L> in_disc(const L& x, const L& y) {
    using R = RealOf<L>;
    const L a = 2 * x - 1, b = 2 * y - 1;
    const MaskOf<L> flat = absolute(a) > absolute(b);
    const L radius = choose(flat, a, b), across = choose(flat, b, a);
    const L part = across / choose(radius == 0, L(1), radius);
    const L angle = part * L(R(0.78539816339744831));
    const L along = radius * cosine(angle), beside = radius * sine(angle);
    return {choose(flat, along, beside), choose(flat, beside, along)};
}

/// How far from a pixel's centre, in pixels along each axis, samples count.
constexpr double radius_of(PixelFilter filter) {
    switch (filter) {
    case PixelFilter::box:
        return 0.5;
    case PixelFilter::mitchell:
        return 2;
    case PixelFilter::gaussian:
    case PixelFilter::blackman_harris:
        return 1.5;
    }
    return 0;
}

/// How many pixels around a pixel have samples that count in it.
constexpr int reach_of(PixelFilter filter) {
    const double reach = radius_of(filter) + 0.5;
    const int whole = static_cast<int>(reach);
    return whole == reach ? whole - 1 : whole;
}

/// The weight along one axis of a sample so many pixels from a pixel's centre, up to a factor:
///   mitchell:        B = C = 1/3 in D. Mitchell and A. Netravali, Reconstruction Filters in Computer
///   Graphics
///                    (1988), two pixels wide to either side
///   gaussian:        of standard deviation 1/2, less what it is at the radius 1.5, as in pbrt (Pharr, Jakob,
///                    Humphreys, Physically Based Rendering, 4th edition, 8.8.3)
///   blackman_harris: F. Harris, On the Use of Windows for Harmonic Analysis (1978), four terms, over three
///                    pixels, as Cycles has it for its width of 1.5
template <class R>
R filter_weight(PixelFilter filter, R distance) {
    const R x = absolute(distance);
    if (filter == PixelFilter::box) {
        return 1; // no other pixel asks
    }
    if (x >= R(radius_of(filter))) {
        return 0;
    }
    switch (filter) {
    case PixelFilter::box:
        break;
    case PixelFilter::mitchell:
        return x < 1 ? (R(7) * x - R(12)) * x * x + R(16) / R(3)
                     : ((R(-7) / R(3) * x + R(12)) * x - R(20)) * x + R(32) / R(3);
    case PixelFilter::gaussian: {
        constexpr R at_radius = R(0.011108996538242306); // exp(-4.5)
        return std::exp(opaque(R(-2) * x * x)) - at_radius;
    }
    case PixelFilter::blackman_harris: {
        const R angle = R(2.0943951023931953) * x; // of a window of three pixels, from its middle
        return R(0.35875) + R(0.48829) * cosine(angle) + R(0.14128) * cosine(2 * angle) +
               R(0.01168) * cosine(3 * angle);
    }
    }
    return 0;
}

} // namespace scc::runtime
