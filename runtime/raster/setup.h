#pragma once

#include "runtime/raster/bins.h"
#include "runtime/raster/clip.h"
#include "runtime/raster/corner_weights.h"
#include "runtime/raster/corners.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

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
        bin.fronts_of.resize(model_.surfaces.size());
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
        std::size_t surface = 0; ///< which they are of
    };
    Flags flags_of(const RasterSurface<R>& surface) const {
        Flags flags;
        flags.mirrored = surface.is_mirrored;
        flags.surface = static_cast<std::size_t>(&surface - model_.surfaces.data());
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
        const CornerPacks<L> world = world_triangles<L>(model_, scene_.meshes, surface, i, count);
        std::array<Corner, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
            corners[c] = view_.to_clip(view_.to_eye(world.corners[c], world.weights[c]));
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
    static ClipPoint<R> lane_of(const Corner& p, int k) {
        return {lane(p.x, k), lane(p.y, k), lane(p.z, k), lane(p.w, k)};
    }

    using Ints = GridPack<L>;
    static Ints least(const Ints& a, const Ints& b) { return a < b ? a : b; }
    static Ints most(const Ints& a, const Ints& b) { return a > b ? a : b; }

    /// Products are taken of all lanes, but have 32 bits in those of narrow triangles alone.
    using Bits = runtime::detail::VectorType<std::uint32_t, N>;
    static Bits bits_of(const Ints& a) { return reinterpret_cast<Bits>(a); }
    static Ints of_narrow(const Bits& a) { return reinterpret_cast<Ints>(a); }

    /// Triangles on the grid, and the samples, to the last, that are in their bounding boxes.
    struct OnGrid {
        std::array<Ints, 3> x, y;
        Ints x0, y0, x1, y1;
        Ints narrow; ///< -1 in lanes whose edge functions have 32 bits
    };
    static OnGrid on_grid_of(const std::array<Corner, 3>& p) {
        OnGrid t;
        for (std::size_t c = 0; c < 3; ++c) {
            t.x[c] = on_grid(p[c].x);
            t.y[c] = on_grid(p[c].y);
        }
        const Ints left = least(least(t.x[0], t.x[1]), t.x[2]), right = most(most(t.x[0], t.x[1]), t.x[2]),
                   top = least(least(t.y[0], t.y[1]), t.y[2]), bottom = most(most(t.y[0], t.y[1]), t.y[2]);
        t.x0 = (left + (grid - 1)) >> grid_bits;
        t.y0 = (top + (grid - 1)) >> grid_bits;
        t.x1 = right >> grid_bits;
        t.y1 = bottom >> grid_bits;
        t.narrow = (right - left <= most_narrow) & (bottom - top <= most_narrow);
        return t;
    }

    /// Whole triangles in the lanes of `among`. Most that are not seen are recognised all lanes at once, and
    /// nothing of them is stored.
    void place(const std::array<Corner, 3>& corners, const Flags& flags, std::uint32_t number, unsigned among,
               Bin<R>& bin) const {
        std::array<Corner, 3> p;
        for (std::size_t c = 0; c < 3; ++c) {
            const L inverse = L(1) / corners[c].w;
            p[c] = {corners[c].x * inverse, corners[c].y * inverse, corners[c].z * inverse, corners[c].w};
        }
        OnGrid t = on_grid_of(p);
        among &= may_cover(t);
        if (among == 0) {
            return;
        }
        const unsigned clockwise = turn(t, among);
        // Rows run downwards: what is counter-clockwise has a negative area.
        const unsigned back = flags.mirrored ? ~clockwise : clockwise;
        if (choice_.cull == Cull::back) {
            among &= ~back;
        }
        unsigned small = 0, narrow = 0;
        Ints covered{};
        Edges edges{};
        if (((flags.front | flags.back) & lets_light_through) == 0) {
            constexpr std::int32_t width = SmallTriangle<R>::width;
            const Ints few = (t.x1 - t.x0 < width) & (t.y1 - t.y0 < width) & t.narrow;
            const unsigned candidates = among & grid_bits_of<L>(few);
            narrow = among & grid_bits_of<L>(t.narrow) & ~candidates;
            edges = edges_of(t);
            if (candidates != 0) {
                covered = coverage(t, edges, candidates) & few;
                const Ints some = covered != 0;
                small = candidates & grid_bits_of<L>(some);
                among = (among & ~candidates) | small;
            }
        }
        if (among == 0) {
            return;
        }
        bin.fronts_of[flags.surface] += static_cast<std::uint32_t>(std::popcount(among & ~back));
        store(p, t, covered, edges, {among, small, narrow, back}, flags, number, bin);
    }
    /// The lanes in whose bounding boxes there are sample centres that are drawn.
    unsigned may_cover(const OnGrid& t) const {
        const SampleBox& box = tiles_.box();
        const Ints covered = (t.x0 <= t.x1) & (t.y0 <= t.y1) & (t.x0 < box.x1) & (t.y0 < box.y1) &
                             (t.x1 >= box.x0) & (t.y1 >= box.y0);
        return grid_bits_of<L>(covered);
    }
    /// Turns the triangles so that their edge functions are positive inside, and keeps their first corner,
    /// from which z is counted. The lanes whose triangles were clockwise as the picture shows them; those
    /// without an area leave `among`.
    static unsigned turn(OnGrid& t, unsigned& among) {
        const Ints area = of_narrow(bits_of(t.x[1] - t.x[0]) * bits_of(t.y[2] - t.y[0]) -
                                    bits_of(t.x[2] - t.x[0]) * bits_of(t.y[1] - t.y[0]));
        const Ints none = area == 0;
        Ints swapped = area < 0;
        const unsigned narrow = grid_bits_of<L>(t.narrow);
        unsigned flat = narrow & grid_bits_of<L>(none), counter = narrow & grid_bits_of<L>(swapped);
        for (unsigned wide = among & ~narrow; wide != 0; wide &= wide - 1) {
            const int k = __builtin_ctz(wide);
            const std::int64_t exactly = std::int64_t{t.x[1][k] - t.x[0][k]} * (t.y[2][k] - t.y[0][k]) -
                                         std::int64_t{t.x[2][k] - t.x[0][k]} * (t.y[1][k] - t.y[0][k]);
            flat |= exactly == 0 ? 1U << k : 0U;
            counter |= exactly < 0 ? 1U << k : 0U;
            swapped[k] = exactly < 0 ? -1 : 0;
        }
        among &= ~flat;
        for (auto* coordinate : {&t.x, &t.y}) {
            const Ints second = (*coordinate)[1], third = (*coordinate)[2];
            (*coordinate)[1] = swapped ? third : second;
            (*coordinate)[2] = swapped ? second : third;
        }
        return ~counter;
    }
    /// Edge functions as NarrowTriangle has them, of narrow lanes.
    struct Edges {
        std::array<Ints, 3> at, x, y;
    };
    static Edges edges_of(const OnGrid& t) {
        Edges edges;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t k = i == 2 ? 0 : i + 1;
            const Ints x = t.y[i] - t.y[k], y = t.x[k] - t.x[i];
            const Ints is_top_left = (x > 0) | ((x == 0) & (y > 0)); // -1 where so
            edges.at[i] = of_narrow(bits_of(y) * bits_of(t.y0 * grid - t.y[i]) +
                                    bits_of(x) * bits_of(t.x0 * grid - t.x[i]) - 1 - bits_of(is_top_left)) >>
                          grid_bits;
            edges.x[i] = x;
            edges.y[i] = y;
        }
        return edges;
    }
    /// Of small triangles, as SmallTriangle has it: the same as TileBuffer finds, for all lanes at once.
    static Ints coverage(const OnGrid& t, const Edges& edges, unsigned small) {
        std::array<Ints, 3> row_start = edges.at;
        const auto [columns, rows] = most_samples(t, small);
        Ints covered{};
        for (std::int32_t row = 0; row < rows; ++row) {
            Ints e0 = row_start[0], e1 = row_start[1], e2 = row_start[2];
            for (std::int32_t column = 0; column < columns; ++column) {
                const Ints inside = (e0 | e1 | e2) >= 0;
                covered |= inside & (1 << (SmallTriangle<R>::width * row + column));
                e0 += edges.x[0];
                e1 += edges.x[1];
                e2 += edges.x[2];
            }
            for (std::size_t i = 0; i < 3; ++i) {
                row_start[i] += edges.y[i];
            }
        }
        return covered;
    }
    /// Columns and rows of samples that some of these boxes have.
    static std::pair<std::int32_t, std::int32_t> most_samples(const OnGrid& t, unsigned small) {
        std::int32_t columns = 1, rows = 1;
        for (; columns < SmallTriangle<R>::width; ++columns) {
            const Ints more = t.x1 - t.x0 >= columns;
            if ((grid_bits_of<L>(more) & small) == 0) {
                break;
            }
        }
        for (; rows < SmallTriangle<R>::width; ++rows) {
            const Ints more = t.y1 - t.y0 >= rows;
            if ((grid_bits_of<L>(more) & small) == 0) {
                break;
            }
        }
        return {columns, rows};
    }

    /// Lanes: those that are stored, the small and the narrow ones of them, and those seen from behind.
    struct Lanes {
        unsigned among, small, narrow, back;
    };
    void store(const std::array<Corner, 3>& p, const OnGrid& t, const Ints& covered, const Edges& edges,
               const Lanes& lanes, const Flags& flags, std::uint32_t number, Bin<R>& bin) const {
        Ints first_x = t.x0, first_y = t.y0;
        const unsigned others = lanes.among & ~lanes.small & ~lanes.narrow;
        for (unsigned left = others; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            first_x[k] = t.x[0][k] >> grid_bits;
            first_y[k] = t.y[0][k] >> grid_bits;
        }
        const auto center = [](const Ints& v) {
            return L(__builtin_convertvector(v, typename L::Vector)) + L(R(0.5));
        };
        detail::DepthPlane<L> depth = detail::depth_plane(p, center(first_x), center(first_y));
        if (choice_.pushes_back) {
            depth.at = depth.at + maximum(absolute(depth.x), absolute(depth.y)) +
                       L(R(16) * R(std::numeric_limits<float>::epsilon()));
        }
        R z[N], z_x[N], z_y[N];
        store_lanes(z, depth.at);
        store_lanes(z_x, depth.x);
        store_lanes(z_y, depth.y);
        const auto set = [&](auto& to, int k) {
            to.id = id_of(flags, number, lanes.back, k);
            to.z = z[k];
            to.z_x = z_x[k];
            to.z_y = z_y[k];
        };
        for (unsigned left = lanes.small; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            SmallTriangle<R> small;
            set(small, k);
            small.covered = static_cast<std::uint16_t>(covered[k]);
            bin.add(small, t.x0[k], t.y0[k], tiles_);
        }
        for (unsigned left = lanes.narrow; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            NarrowTriangle<R> narrow;
            set(narrow, k);
            narrow.columns = static_cast<std::int8_t>(t.x1[k] - t.x0[k] + 1);
            narrow.rows = static_cast<std::int8_t>(t.y1[k] - t.y0[k] + 1);
            for (std::size_t i = 0; i < 3; ++i) {
                narrow.edge[i] = edges.at[i][k];
                narrow.edge_x[i] = static_cast<std::int16_t>(edges.x[i][k]);
                narrow.edge_y[i] = static_cast<std::int16_t>(edges.y[i][k]);
            }
            bin.add(narrow, t.x0[k], t.y0[k], tiles_);
        }
        for (unsigned left = others; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            ScreenTriangle<R> large;
            set(large, k);
            for (std::size_t c = 0; c < 3; ++c) {
                large.x[c] = t.x[c][k];
                large.y[c] = t.y[c][k];
            }
            const SampleBox box{t.x0[k], t.y0[k], t.x1[k] + 1, t.y1[k] + 1};
            bin.add(large, intersection(box, tiles_.box()), tiles_);
        }
    }
    static std::uint32_t id_of(const Flags& flags, std::uint32_t number, unsigned back, int k) {
        return (number + static_cast<std::uint32_t>(k)) | ((back >> k & 1U) != 0 ? flags.back : flags.front);
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

    const S& scene_;
    const RasterModel<R>& model_;
    const RasterView<R>& view_;
    DrawChoice choice_;
    const TileGrid& tiles_;
    ClipVolume<R> guard_;
    ClipVolume<R> window_; ///< what is beyond is not seen at all
};

} // namespace scc::runtime::raster
