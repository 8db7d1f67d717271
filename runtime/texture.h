#pragma once

#include "runtime/math/dual.h"
#include "runtime/math/interval.h"
#include "runtime/math/pack.h"
#include "runtime/math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace scc::runtime {

enum class Wrap : std::uint32_t { repeat, clamp };
enum class Filter : std::uint32_t { bilinear, nearest };

/// A picture as per-point functions look it up: over the unit square, v upwards, the centre of texel (i, j)
/// at
/// ((i + 1/2) / width, (j + 1/2) / height). Owns nothing: a program may map the texels from a file. Rows run
/// from the bottom, each texel has 1 channel (grey) or 3, and is either a code, decoded by the table, or a
/// float; both in linear light.
struct ImageData {
    const std::uint8_t* codes = nullptr; ///< or null:
    const float* values = nullptr;
    const float* decoded = nullptr; ///< of the 256 codes
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint32_t channels = 3;
    Wrap wrap = Wrap::repeat;
    Filter filter = Filter::bilinear;
    std::array<float, 3> min{}; ///< of all texels, per channel
    std::array<float, 3> max{};

    std::size_t size() const { return std::size_t{width} * height * channels; }
    float texel(std::uint32_t x, std::uint32_t y, std::uint32_t channel) const {
        const std::size_t i =
            (std::size_t{y} * width + x) * channels + (channel < channels ? channel : channels - 1);
        return codes != nullptr ? decoded[codes[i]] : values[i];
    }
};

namespace detail {

/// The two texels along one axis that a coordinate lies between, and how far it is from the first to the
/// second.
template <class L>
struct BetweenTexels {
    std::array<std::uint32_t, static_cast<std::size_t>(lane_count<L>)> first, second;
    L fraction;

    /// A coordinate that is no number counts as 0.
    BetweenTexels(const ImageData& image, const L& coordinate, std::uint32_t size) : fraction(0) {
        using R = RealOf<L>;
        const bool repeats = image.wrap == Wrap::repeat;
        const L whole = round_down(coordinate);
        const L wrapped = repeats ? coordinate - whole : minimum(coordinate, L(1));
        const L inside = choose((wrapped >= 0) & (wrapped <= 1), wrapped, L(0));
        const bool blends = image.filter == Filter::bilinear;
        const L at = blends ? inside * R(size) - R(0.5) : inside * R(size);
        const L base = round_down(at); // -1 to size
        if (blends) {
            fraction = at - base;
        }
        const auto last = static_cast<std::int64_t>(size) - 1;
        const auto place = [&](std::int64_t texel) {
            const std::int64_t below = repeats && blends ? last : 0, above = repeats && blends ? 0 : last;
            return static_cast<std::uint32_t>(texel < 0 ? below : texel > last ? above : texel);
        };
        for (int i = 0; i < lane_count<L>; ++i) {
            const auto texel = static_cast<std::int64_t>(lane(base, i));
            first[static_cast<std::size_t>(i)] = place(texel);
            second[static_cast<std::size_t>(i)] = place(blends ? texel + 1 : texel);
        }
    }
};

/// A channel at the four texels around a point.
template <class L>
struct TexelPatch {
    BetweenTexels<L> x, y;
    L low_left{0}, low_right{0}, high_left{0}, high_right{0};

    TexelPatch(const ImageData& image, std::uint32_t channel, const L& u, const L& v)
        : x(image, u, image.width), y(image, v, image.height) {
        for (int i = 0; i < lane_count<L>; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const auto put = [&](L& to, std::uint32_t column, std::uint32_t row) {
                set_lane(to, i, static_cast<RealOf<L>>(image.texel(column, row, channel)));
            };
            put(low_left, x.first[k], y.first[k]);
            put(low_right, x.second[k], y.first[k]);
            put(high_left, x.first[k], y.second[k]);
            put(high_right, x.second[k], y.second[k]);
        }
    }

    L value() const {
        const L low = low_left + x.fraction * (low_right - low_left);
        const L high = high_left + x.fraction * (high_right - high_left);
        return low + y.fraction * (high - low);
    }
    /// By x and y in texels.
    Vec2<L> slopes() const {
        const L low = low_right - low_left, high = high_right - high_left;
        const L left = high_left - low_left, right = high_right - low_right;
        return {low + y.fraction * (high - low), left + x.fraction * (right - left)};
    }
};

} // namespace detail

/// A channel of the image (0 red, 1 green, 2 blue) at a point.
template <Lane L>
L image_channel(const ImageData& image, std::uint32_t channel, const L& u, const L& v) {
    return detail::TexelPatch<L>(image, channel, u, v).value();
}

/// Bounds over the whole image.
template <class L>
Interval<L> image_channel(const ImageData& image, std::uint32_t channel, const Interval<L>&,
                          const Interval<L>&) {
    using R = RealOf<L>;
    return {L(static_cast<R>(image.min[channel])), L(static_cast<R>(image.max[channel]))};
}

namespace detail {

/// The image's derivatives by u and v; where it jumps from texel to texel, those within one.
template <Lane L>
Vec2<L> image_slopes(const ImageData& image, std::uint32_t channel, const L& u, const L& v) {
    if (image.filter == Filter::nearest) {
        return {L(0), L(0)};
    }
    using R = RealOf<L>;
    const Vec2<L> slopes = TexelPatch<L>(image, channel, u, v).slopes();
    return {slopes.x * R(image.width), slopes.y * R(image.height)};
}
template <class L>
Vec2<Interval<L>> image_slopes(const ImageData& image, std::uint32_t channel, const Interval<L>&,
                               const Interval<L>&) {
    if (image.filter == Filter::nearest) {
        return {Interval<L>::whole(), Interval<L>::whole()};
    }
    using R = RealOf<L>;
    const R range = static_cast<R>(image.max[channel]) - static_cast<R>(image.min[channel]);
    const L by_u(range * R(image.width)), by_v(range * R(image.height));
    return {Interval<L>(-by_u, by_u), Interval<L>(-by_v, by_v)};
}

} // namespace detail

template <class T, int n>
Dual<T, n> image_channel(const ImageData& image, std::uint32_t channel, const Dual<T, n>& u,
                         const Dual<T, n>& v) {
    const Vec2<T> slopes = detail::image_slopes(image, channel, u.v, v.v);
    return detail::dual<T, n>(image_channel(image, channel, u.v, v.v),
                              [&](int i) { return slopes.x * u.d[i] + slopes.y * v.d[i]; });
}

} // namespace scc::runtime
