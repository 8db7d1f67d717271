#pragma once

#include "runtime/raster/bins.h"
#include "runtime/raster/clip.h"
#include "runtime/raster/corner_weights.h"
#include "runtime/raster/corners.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

/// From triangles in the world to triangles on the grid of samples.
namespace scc::runtime::raster {

namespace detail {

template <class L>
struct DepthPlane {
    L at, x, y; ///< at a place, and its slopes
};

/// Of z* over triangles, at (column, row). Of one that is so thin that the grid moves its edges by a good
/// part of its width, along its longest edge alone: across, its slope would be accidental.
template <class L>
DepthPlane<L> depth_plane(const std::array<ClipPoint<L>, 3>& p, const L& column, const L& row) {
    using R = RealOf<L>;
    const L x1 = p[1].x - p[0].x, y1 = p[1].y - p[0].y, z1 = p[1].z - p[0].z;
    const L x2 = p[2].x - p[0].x, y2 = p[2].y - p[0].y, z2 = p[2].z - p[0].z;
    const L x3 = x2 - x1, y3 = y2 - y1, z3 = z2 - z1;
    const L area = x1 * y2 - x2 * y1, inverse = L(1) / area;
    const L first = x1 * x1 + y1 * y1, second = x2 * x2 + y2 * y2, third = x3 * x3 + y3 * y3;
    const L longest = maximum(maximum(first, second), third);
    DepthPlane<L> result{{}, (z1 * y2 - z2 * y1) * inverse, (z2 * x1 - z1 * x2) * inverse};
    const MaskOf<L> thin = !(area * area > longest * L(square(thin_width<R>)));
    MaskOf<L> from_second(false);
    if (any(thin)) {
        const MaskOf<L> is_first = first == longest, is_second = second == longest;
        from_second = thin & !is_first & !is_second;
        const L x = choose(is_first, x1, choose(is_second, x2, x3)),
                y = choose(is_first, y1, choose(is_second, y2, y3)),
                z = choose(is_first, z1, choose(is_second, z2, z3));
        const L slope = choose(longest > 0, z / longest, L(0));
        result.x = choose(thin, slope * x, result.x);
        result.y = choose(thin, slope * y, result.y);
    }
    const auto from = [&](const L& a, const L& b) { return choose(from_second, b, a); };
    result.at = from(p[0].z, p[1].z) + result.x * (column - from(p[0].x, p[1].x)) +
                result.y * (row - from(p[0].y, p[1].y));
    return result;
}

} // namespace detail

/// What is drawn of a model.
struct DrawChoice {
    Cull cull = Cull::none;
    bool pushes_back = false; ///< surfaces are moved away from the eye by a little, so that lines on them win
    bool all_opaque = false;  ///< what lets light through is drawn as what does not
    bool lines = true;
};

/// The first stage: transforms a run of a model's triangles, drops what is out of sight, clips, divides,
/// rounds to the grid, and puts what is left into a Bin for the tiles that it may cover.
template <SceneModel S, class L>
class TriangleSetup {
    using R = typename S::Real;
    static constexpr int N = lane_count<L>;

public:
    TriangleSetup(const S& scene, const RasterModel<R>& model, const RasterView<R>& view,
                  const DrawChoice& choice, const TileGrid& tiles)
        : scene_(scene), model_(model), view_(view), choice_(choice), tiles_(tiles),
          guard_(ClipVolume<R>::guard(view)),
          window_(view, static_cast<R>(tiles.box().x0), static_cast<R>(tiles.box().y0),
                  static_cast<R>(tiles.box().x1), static_cast<R>(tiles.box().y1)) {}

    /// Triangles [first, last) of the model.
    void run(std::uint32_t first, std::uint32_t last, Bin<R>& bin) const {
        for (const RasterSurface<R>& surface : model_.surfaces) {
            const std::uint32_t begin = std::max(first, surface.first),
                                end = std::min(last, surface.first + surface.count);
            if (begin < end) {
                const Flags flags = flags_of(surface);
                for (std::uint32_t i = begin; i < end; i += N) {
                    add(surface, flags, i - surface.first, std::min<std::uint32_t>(N, end - i), bin);
                }
            }
        }
    }

private:
    /// Of the two faces.
    struct Flags {
        std::uint32_t front = 0, back = seen_from_back;
        bool mirrored = false;
    };
    Flags flags_of(const RasterSurface<R>& surface) const {
        Flags flags;
        flags.mirrored = surface.is_mirrored;
        if constexpr (S::traits.transmission) {
            const auto flag = [&](std::uint32_t material) {
                return !choice_.all_opaque && lets_through(Phong<R>(scene_.materials[material]))
                           ? lets_light_through
                           : 0U;
            };
            flags.front |= flag(surface.sides.front);
            flags.back |= flag(S::traits.two_sided ? surface.sides.back : surface.sides.front);
        }
        return flags;
    }

    using Corner = ClipPoint<L>;

    /// `count` triangles of a surface, from `i` of its own on.
    void add(const RasterSurface<R>& surface, const Flags& flags, std::uint32_t i, std::uint32_t count,
             Bin<R>& bin) const {
        R numbers[12][N] = {};
        for (std::uint32_t k = 0; k < count; ++k) {
            const WorldTriangle<R> t = world_triangle(model_, scene_.meshes, surface, i + k);
            for (std::size_t c = 0; c < 3; ++c) {
                numbers[4 * c][k] = t.corners[c].x;
                numbers[4 * c + 1][k] = t.corners[c].y;
                numbers[4 * c + 2][k] = t.corners[c].z;
                numbers[4 * c + 3][k] = t.weights[c];
            }
        }
        std::array<Corner, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto load = [&](std::size_t n) { return pack_from(numbers[4 * c + n]); };
            corners[c] = view_.to_clip(view_.to_eye(Vec3<L>{load(0), load(1), load(2)}, load(3)));
        }
        using Mask = MaskOf<L>;
        Mask usable(true), cut(false);
        for (const Corner& p : corners) {
            const L size =
                maximum(maximum(absolute(p.x), absolute(p.y)), maximum(absolute(p.z), absolute(p.w)));
            // NaN compares false, but maximum() drops it: it is looked for by itself.
            usable = usable & (size < L(most_coordinate<R>)) & (p.x == p.x) & (p.y == p.y) & (p.z == p.z) &
                     (p.w == p.w);
        }
        for (int plane = 0; plane < ClipVolume<R>::planes; ++plane) {
            Mask all_out(true);
            for (const Corner& p : corners) {
                all_out = all_out & (window_.inside(plane, p) < 0);
                cut = cut | (guard_.inside(plane, p) < 0);
            }
            usable = usable & !all_out;
        }
        unsigned left = bits(usable) & ((1U << count) - 1);
        const unsigned to_cut = left & bits(cut);
        left &= ~to_cut;
        const std::uint32_t number = surface.first + i;
        if (left != 0) {
            place(corners, flags, number, left, bin);
        }
        for (unsigned rest = to_cut; rest != 0; rest &= rest - 1) {
            const int k = __builtin_ctz(rest);
            clip({lane_of(corners[0], k), lane_of(corners[1], k), lane_of(corners[2], k)}, flags,
                 number + static_cast<std::uint32_t>(k), bin);
        }
    }
    static L pack_from(const R* numbers) {
        L result;
        std::memcpy(&result.v, numbers, sizeof result.v);
        return result;
    }
    static ClipPoint<R> lane_of(const Corner& p, int k) {
        return {lane(p.x, k), lane(p.y, k), lane(p.z, k), lane(p.w, k)};
    }

    /// Whole triangles in the lanes of `among`.
    void place(const std::array<Corner, 3>& corners, const Flags& flags, std::uint32_t number, unsigned among,
               Bin<R>& bin) const {
        std::array<Corner, 3> p;
        std::array<GridPack<L>, 3> x, y;
        for (std::size_t c = 0; c < 3; ++c) {
            const L inverse = L(1) / corners[c].w;
            p[c] = {corners[c].x * inverse, corners[c].y * inverse, corners[c].z * inverse, corners[c].w};
            x[c] = on_grid(p[c].x);
            y[c] = on_grid(p[c].y);
        }
        among &= may_cover(x, y);
        if (among == 0) {
            return;
        }
        const auto sample = [](const GridPack<L>& v) {
            const GridPack<L> whole = v >> grid_bits;
            return L(__builtin_convertvector(whole, typename L::Vector)) + L(R(0.5));
        };
        const detail::DepthPlane<L> depth = detail::depth_plane(p, sample(x[0]), sample(y[0]));
        for (; among != 0; among &= among - 1) {
            const int k = __builtin_ctz(among);
            ScreenTriangle<R> t;
            for (std::size_t c = 0; c < 3; ++c) {
                t.x[c] = x[c][k];
                t.y[c] = y[c][k];
            }
            t.z = lane(depth.at, k);
            t.z_x = lane(depth.x, k);
            t.z_y = lane(depth.y, k);
            store(flags, number + static_cast<std::uint32_t>(k), t, bin);
        }
    }
    /// The lanes in whose bounding boxes there are sample centres that are drawn.
    unsigned may_cover(const std::array<GridPack<L>, 3>& x, const std::array<GridPack<L>, 3>& y) const {
        const auto least = [](const GridPack<L>& a, const GridPack<L>& b) { return a < b ? a : b; };
        const auto most = [](const GridPack<L>& a, const GridPack<L>& b) { return a > b ? a : b; };
        const SampleBox& box = tiles_.box();
        const GridPack<L> x0 = (least(least(x[0], x[1]), x[2]) + (grid - 1)) >> grid_bits,
                          x1 = most(most(x[0], x[1]), x[2]) >> grid_bits,
                          y0 = (least(least(y[0], y[1]), y[2]) + (grid - 1)) >> grid_bits,
                          y1 = most(most(y[0], y[1]), y[2]) >> grid_bits;
        const GridPack<L> covered =
            (x0 <= x1) & (y0 <= y1) & (x0 < box.x1) & (y0 < box.y1) & (x1 >= box.x0) & (y1 >= box.y0);
        return grid_bits_of<L>(covered);
    }

    void clip(const std::array<ClipPoint<R>, 3>& corners, const Flags& flags, std::uint32_t number,
              Bin<R>& bin) const {
        const std::uint32_t codes =
            guard_.outcode(corners[0]) | guard_.outcode(corners[1]) | guard_.outcode(corners[2]);
        const ClippedPolygon<R> polygon = clip_triangle(guard_, corners, codes);
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const ClipPoint<R>& p = polygon.corners[i];
            const R inverse = 1 / p.w;
            if (!(absolute(p.x * inverse - view_.guard_x()) <= 2 * view_.guard() &&
                  absolute(p.y * inverse - view_.guard_y()) <= 2 * view_.guard() &&
                  absolute(p.z * inverse) < most_coordinate<R>)) {
                return; // too close to the eye, or too far away, to be calculated with
            }
        }
        for (std::size_t i = 2; i < polygon.count; ++i) {
            std::array<Corner, 3> p;
            std::size_t c = 0;
            for (const std::size_t corner : {std::size_t{0}, i - 1, i}) {
                const ClipPoint<R>& q = polygon.corners[corner];
                p[c++] = {L(q.x), L(q.y), L(q.z), L(q.w)};
            }
            place(p, flags, number, 1, bin);
        }
    }

    void store(const Flags& flags, std::uint32_t number, ScreenTriangle<R>& t, Bin<R>& bin) const {
        const std::int64_t area = std::int64_t{t.x[1] - t.x[0]} * (t.y[2] - t.y[0]) -
                                  std::int64_t{t.x[2] - t.x[0]} * (t.y[1] - t.y[0]);
        if (area == 0) {
            return;
        }
        // Rows run downwards: what is counter-clockwise has a negative area.
        const bool back = (area > 0) != flags.mirrored;
        if (back && choice_.cull == Cull::back) {
            return;
        }
        const SampleBox box = intersection(box_of(t), tiles_.box());
        if (box.empty()) {
            return;
        }
        t.id = number | (back ? flags.back : flags.front);
        if (choice_.pushes_back) {
            t.z += std::max(absolute(t.z_x), absolute(t.z_y)) + 16 * std::numeric_limits<float>::epsilon();
        }
        if (area < 0) {
            // Not the first, from which z is counted.
            std::swap(t.x[1], t.x[2]);
            std::swap(t.y[1], t.y[2]);
        }
        bin.add(t, box, tiles_);
    }

    const S& scene_;
    const RasterModel<R>& model_;
    const RasterView<R>& view_;
    DrawChoice choice_;
    const TileGrid& tiles_;
    ClipVolume<R> guard_;
    ClipVolume<R> window_; ///< what is beyond is not seen at all
};

} // namespace scc::runtime::raster
