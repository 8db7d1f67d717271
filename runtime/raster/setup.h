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

template <class R>
struct DepthPlane {
    R at, x, y; ///< at a place, and its slopes
};

/// Of z* over a triangle, at (column, row). Of one that is so thin that the grid moves its edges by a good
/// part of its width, along its longest edge alone: across, its slope would be accidental.
template <class R>
DepthPlane<R> depth_plane(const std::array<ClipPoint<R>, 3>& p, R column, R row) {
    const auto length = [&](std::size_t i) {
        const std::size_t k = (i + 1) % 3;
        return square(p[k].x - p[i].x) + square(p[k].y - p[i].y);
    };
    const R x1 = p[1].x - p[0].x, y1 = p[1].y - p[0].y, x2 = p[2].x - p[0].x, y2 = p[2].y - p[0].y;
    const R z1 = p[1].z - p[0].z, z2 = p[2].z - p[0].z;
    const R area = x1 * y2 - x2 * y1;
    const std::array<R, 3> lengths{length(0), length(1), length(2)};
    const std::size_t longest =
        static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
    DepthPlane<R> result{};
    std::size_t from = 0;
    if (area * area > lengths[longest] * square(thin_width<R>)) {
        result.x = (z1 * y2 - z2 * y1) / area;
        result.y = (z2 * x1 - z1 * x2) / area;
    } else {
        from = longest;
        const ClipPoint<R>&a = p[from], &b = p[(from + 1) % 3];
        const R slope = lengths[longest] > 0 ? (b.z - a.z) / lengths[longest] : R(0);
        result.x = slope * (b.x - a.x);
        result.y = slope * (b.y - a.y);
    }
    result.at = p[from].z + result.x * (column - p[from].x) + result.y * (row - p[from].y);
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
        for (; among != 0; among &= among - 1) {
            const int k = __builtin_ctz(among);
            ScreenTriangle<R> t;
            for (std::size_t c = 0; c < 3; ++c) {
                t.x[c] = x[c][k];
                t.y[c] = y[c][k];
            }
            store({lane_of(p[0], k), lane_of(p[1], k), lane_of(p[2], k)}, flags,
                  number + static_cast<std::uint32_t>(k), t, bin);
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
        std::array<ClipPoint<R>, 3 + ClipVolume<R>::planes> divided;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const ClipPoint<R>& p = polygon.corners[i];
            const R inverse = 1 / p.w;
            divided[i] = {p.x * inverse, p.y * inverse, p.z * inverse, p.w};
            if (!(absolute(divided[i].x - view_.guard_x()) <= 2 * view_.guard() &&
                  absolute(divided[i].y - view_.guard_y()) <= 2 * view_.guard() &&
                  absolute(divided[i].z) < most_coordinate<R>)) {
                return; // too close to the eye, or too far away, to be calculated with
            }
        }
        for (std::size_t i = 2; i < polygon.count; ++i) {
            const std::array<ClipPoint<R>, 3> p{divided[0], divided[i - 1], divided[i]};
            ScreenTriangle<R> t;
            for (std::size_t c = 0; c < 3; ++c) {
                t.x[c] = on_grid(p[c].x);
                t.y[c] = on_grid(p[c].y);
            }
            store(p, flags, number, t, bin);
        }
    }

    /// `p`: where the corners are exactly.
    void store(const std::array<ClipPoint<R>, 3>& p, const Flags& flags, std::uint32_t number,
               ScreenTriangle<R>& t, Bin<R>& bin) const {
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
        const auto depth =
            detail::depth_plane(p, static_cast<R>(t.z_column()) + R(0.5), static_cast<R>(t.z_row()) + R(0.5));
        t.z = depth.at;
        t.z_x = depth.x;
        t.z_y = depth.y;
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
