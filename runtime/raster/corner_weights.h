#pragma once

#include "runtime/raster/screen_triangle.h"
#include "runtime/raster/view.h"

#include <array>
#include <cstddef>

/// What a triangle's corners weigh at the picture's samples.
namespace scc::runtime::raster {

/// Less wide triangles than this, in samples, have attributes along their longest edge alone: the grid moves
/// their edges by a good part of their width, so that across it samples may lie far outside of them.
template <class R>
inline constexpr R thin_width = R(1) / 128;

/// at + x column + y row, over a tile's samples.
template <class L>
struct Linear {
    L at, x, y;

    friend Linear operator+(const Linear& a, const Linear& b) { return {a.at + b.at, a.x + b.x, a.y + b.y}; }
    friend Linear operator*(const Linear& a, const L& s) { return {a.at * s, a.x * s, a.y * s}; }
};
using runtime::choose; // of numbers, which the next one would hide
template <class L>
Linear<L> choose(const MaskOf<L>& mask, const Linear<L>& a, const Linear<L>& b) {
    return {choose(mask, a.at, b.at), choose(mask, a.x, b.x), choose(mask, a.y, b.y)};
}

namespace detail {

/// Of corners before the division, seen from the tile's first sample: but for a common factor, the weights at
/// a sample are the cross products of the corners' places as seen from there, which are linear. So nothing
/// need be divided, what lies behind the eye need not be clipped, and what is interpolated is right in
/// perspective. (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997.)
template <class L>
std::array<Linear<L>, 3> weights_by_area(const std::array<ClipPoint<L>, 3>& p) {
    std::array<Linear<L>, 3> weights;
    for (std::size_t i = 0; i < 3; ++i) {
        const ClipPoint<L>&a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
        weights[i] = {a.x * b.y - b.x * a.y, b.w * a.y - a.w * b.y, a.w * b.x - b.w * a.x};
    }
    return weights;
}

/// The same along the longest edge of triangles in front of the eye, at p / w.
template <class L>
std::array<Linear<L>, 3> weights_along_edge(const std::array<ClipPoint<L>, 3>& p,
                                            const std::array<L, 3>& lengths) {
    std::array<Linear<L>, 3> weights{};
    const L longest = maximum(maximum(lengths[0], lengths[1]), lengths[2]);
    MaskOf<L> open(true);
    for (std::size_t i = 0; i < 3; ++i) {
        const MaskOf<L> here = open & (lengths[i] == longest);
        open = open & !here;
        const std::size_t k = (i + 1) % 3;
        const ClipPoint<L>&a = p[i], &b = p[k];
        const L x = b.x / b.w - a.x / a.w, y = b.y / b.w - a.y / a.w;
        const L scale = choose(longest > 0, L(1) / longest, L(0));
        const Linear<L> along{-(a.x * x + a.y * y) / a.w * scale, x * scale, y * scale}; // 0 at a, 1 at b
        const Linear<L> one{L(1), L(0), L(0)};
        weights[i] = choose(here, (one + along * L(-1)) * (L(1) / a.w), weights[i]);
        weights[k] = choose(here, along * (L(1) / b.w), weights[k]);
    }
    return weights;
}

} // namespace detail

/// Up to a common factor. `p`: by samples from the centre of the tile's first one, see RasterView::to_clip.
template <class L>
std::array<Linear<L>, 3> corner_weights(std::array<ClipPoint<L>, 3> p) {
    using R = RealOf<L>;
    L size(0);
    for (const ClipPoint<L>& c : p) {
        size = maximum(size, maximum(maximum(absolute(c.x), absolute(c.y)), absolute(c.w)));
    }
    const L scale = L(1) / size; // products of what is large or small would leave the numbers' range
    MaskOf<L> ahead(true);
    for (ClipPoint<L>& c : p) {
        c = {c.x * scale, c.y * scale, c.z, c.w * scale};
        ahead = ahead & (c.w > 0);
    }
    std::array<Linear<L>, 3> weights = detail::weights_by_area(p);
    if (any(ahead)) {
        std::array<L, 3> lengths;
        for (std::size_t i = 0; i < 3; ++i) {
            const ClipPoint<L>&a = p[i], &b = p[(i + 1) % 3];
            lengths[i] = square(b.x / b.w - a.x / a.w) + square(b.y / b.w - a.y / a.w);
        }
        const L longest = maximum(maximum(lengths[0], lengths[1]), lengths[2]);
        const L x1 = p[1].x / p[1].w - p[0].x / p[0].w, y1 = p[1].y / p[1].w - p[0].y / p[0].w,
                x2 = p[2].x / p[2].w - p[0].x / p[0].w, y2 = p[2].y / p[2].w - p[0].y / p[0].w;
        const L twice = x1 * y2 - x2 * y1;
        const MaskOf<L> thin = ahead & !(twice * twice > longest * L(square(thin_width<R>)));
        if (any(thin)) {
            const auto along = detail::weights_along_edge(p, lengths);
            for (std::size_t i = 0; i < 3; ++i) {
                weights[i] = choose(thin, along[i], weights[i]);
            }
        }
    }
    return weights;
}

} // namespace scc::runtime::raster
