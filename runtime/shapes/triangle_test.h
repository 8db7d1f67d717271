#pragma once

#include "runtime/ray.h"

#include <type_traits>

namespace scc::runtime {

template <class L>
struct Corners {
    Vec3<L> a, b, c;
};

/// The corners relative to a point.
template <class L>
constexpr Corners<L> relative_to(const Vec3<L>& org, const Corners<L>& corners) {
    return {corners.a - org, corners.b - org, corners.c - org};
}

/// A triangle as seen from a point, given its corners relative to that: for a ray from there, the products of
/// these vectors with its direction are the edge functions, twice the volumes that it spans with the edges.
/// All of one sign: the ray passes through. (The form of Embree's robust test: an edge times the sum of its
/// ends loses nothing when the triangle is small and far, and changes its sign exactly when the edge is
/// walked the other way.)
///
/// `tolerance` times the direction's largest component is at least what rounding does to an edge function.
/// (96 roundings: 5 for a sum of products, of which there are 6 terms, each at most `size` by twice
/// `distance`; as much again for the two factors' own.)
template <class L>
struct TriangleView {
    Vec3<L> a, b, c; ///< of the edges opposite to these corners
    L tolerance;

    constexpr TriangleView() = default;
    constexpr explicit TriangleView(const Corners<L>& to) {
        const Vec3<L> ab = to.b - to.a, bc = to.c - to.b, ca = to.a - to.c;
        a = cross(bc, to.b + to.c);
        b = cross(ca, to.c + to.a);
        c = cross(ab, to.a + to.b);
        const L size = largest_component(maximum(maximum(absolute(ab), absolute(bc)), absolute(ca)));
        const L distance = largest_component(absolute(to.a)) + size;
        tolerance = 96 * roundoff<L>() * (size * distance);
    }
};

/// A ray's edge functions; the corners' weights after division by their sum.
///
/// Watertight: whether a ray passes through is decided for the corners as rounded relative to its origin,
/// which make one mesh for all triangles. Where the sign of an edge function is unclear, float lanes are
/// calculated again in double; what is unclear in double counts as inside for both of an edge's triangles, so
/// that no ray passes between them, but a triangle that is seen edge-on is left to its neighbours.
template <class L>
struct EdgeFunctions {
    Vec3<L> e;
    L tolerance, smallest, largest;

    /// The view's lanes are the direction's or, of a triangle that all rays see from one point, just one.
    template <class V>
    constexpr EdgeFunctions(const TriangleView<V>& view, const Vec3<L>& dir, const L& dir_size)
        : e{dot(dir, lanes<L>(view.a)), dot(dir, lanes<L>(view.b)), dot(dir, lanes<L>(view.c))},
          tolerance(dir_size * L(view.tolerance)), smallest(minimum(minimum(e.x, e.y), e.z)),
          largest(maximum(maximum(e.x, e.y), e.z)) {}

    constexpr MaskOf<L> may_pass() const { return !((smallest < -tolerance) & (largest > tolerance)); }

    /// Of the lanes `among`, for which may_pass() is true. `relative(i)` gives lane i's relative corners.
    template <class Relative>
    constexpr MaskOf<L> pass(const MaskOf<L>& among, const Vec3<L>& dir, Relative&& relative) const {
        const MaskOf<L> clear = among & ((smallest > tolerance) | (largest < -tolerance));
        if constexpr (std::is_same_v<RealOf<L>, float>) {
            MaskOf<L> result = clear;
            for (unsigned left = bits(among & !clear); left != 0; left &= left - 1) {
                const int i = __builtin_ctz(left);
                const Corners<float> to = relative(i);
                const Corners<double> to_exactly{lanes<double>(to.a), lanes<double>(to.b),
                                                 lanes<double>(to.c)};
                const Vec3<double> ray{lane(dir.x, i), lane(dir.y, i), lane(dir.z, i)};
                const EdgeFunctions<double> exact(TriangleView<double>(to_exactly), ray,
                                                  largest_component(absolute(ray)));
                set_lane(result, i, exact.may_pass() && !exact.is_edge_on());
            }
            return result;
        } else {
            return clear | (among & !is_edge_on());
        }
    }

    constexpr MaskOf<L> is_edge_on() const { return absolute(e.x + e.y + e.z) <= tolerance; }
};

template <class L>
constexpr Corners<RealOf<L>> lane(const Corners<L>& corners, int i) {
    return {{lane(corners.a.x, i), lane(corners.a.y, i), lane(corners.a.z, i)},
            {lane(corners.b.x, i), lane(corners.b.y, i), lane(corners.b.z, i)},
            {lane(corners.c.x, i), lane(corners.c.y, i), lane(corners.c.z, i)}};
}

/// Of any length; from the corners themselves, since relative ones have lost what makes a sliver's direction.
template <class L>
constexpr Vec3<L> plane_normal(const Corners<L>& corners) {
    return cross(corners.b - corners.a, corners.c - corners.a);
}

/// t where the ray meets the triangle's plane, whose distance is accurate also for slivers and agrees with
/// triangle_surface about the side that a point near the triangle is on. `to_a` is the first corner relative
/// to the ray's origin. Each is of the lanes' type or the same for all lanes.
template <class L, class N, class V>
constexpr L distance_to_plane(const Vec3<N>& normal, const Vec3<V>& to_a, const Vec3<L>& dir) {
    if constexpr (std::is_same_v<N, V>) {
        return L(dot(normal, to_a)) / dot(lanes<L>(normal), dir);
    } else {
        const Vec3<L> n = lanes<L>(normal);
        return dot(n, lanes<L>(to_a)) / dot(n, dir);
    }
}

/// True wherever EdgeFunctions may find that a line passes through the triangle, and false almost everywhere
/// else, for less: most triangles that a single ray is tested against it misses by far. `to_a` is the first
/// corner relative to the ray's origin.
template <class L>
constexpr MaskOf<L> may_pass_through(const Corners<L>& corners, const Vec3<L>& to_a, const Vec3<L>& dir,
                                     const L& tolerance_per_size) {
    const Vec3<L> edge1 = corners.b - corners.a, edge2 = corners.c - corners.a;
    const Vec3<L> moment = cross(to_a, dir);
    const L v = dot(edge2, moment), w = -dot(edge1, moment);
    const L u = dot(cross(edge1, edge2), dir) - v - w;
    const L tolerance = tolerance_per_size * largest_component(maximum(absolute(edge1), absolute(edge2)));
    return !((minimum(minimum(u, v), w) < -tolerance) & (maximum(maximum(u, v), w) > tolerance));
}

/// For may_pass_through: no corner's coordinate differs by more than `reach` from the ray's origin.
///
/// The products there are half the edge functions (Moeller, Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", 1997), of the corners themselves. In roundings of size * reach * dir_size, each may be off
/// by 222: v and w by 45 (6 terms of 2, each 7 roundings), the slope by 84, the sum by 48. EdgeFunctions in
/// float decide for corners that are off by a rounding of the reach, so that the line passes the triangle at
/// most sqrt(3) times that away, which makes another 11; in double they forgive 96 of edges that may be twice
/// and distances that may be three times as large, half of which is 288.
template <class L>
constexpr L tolerance_per_size(const L& dir_size, const L& reach) {
    return 512 * roundoff<L>() * (dir_size * reach);
}

/// t where the ray meets the triangle, on either side of 0; infinity or NaN where it misses.
template <class L>
constexpr L intersect_triangle(const Corners<L>& corners, const Ray<L>& ray) {
    const Corners<L> relative = relative_to(ray.org, corners);
    const EdgeFunctions<L> edges(TriangleView<L>(relative), ray.dir, largest_component(absolute(ray.dir)));
    MaskOf<L> inside = edges.may_pass();
    if (none(inside)) {
        return infinity<L>();
    }
    inside = edges.pass(inside, ray.dir, [&](int i) { return lane(relative, i); });
    return choose(inside, distance_to_plane(plane_normal(corners), relative.a, ray.dir), infinity<L>());
}

/// The weights of the corners where the ray passes through the triangle, 0..1 each. All the same where
/// rounding leaves nothing of the triangle's volume, as of needles in float.
template <class L>
constexpr Vec3<L> barycentric(const Corners<L>& corners, const Ray<L>& ray) {
    const EdgeFunctions<L> edges(TriangleView<L>(relative_to(ray.org, corners)), ray.dir,
                                 largest_component(absolute(ray.dir)));
    const L inverse = 1 / (edges.e.x + edges.e.y + edges.e.z);
    const Vec3<L> zero{L(0), L(0), L(0)};
    const Vec3<L> inside = maximum(zero, edges.e * inverse); // rounding may put a ray on an edge beyond it
    const L sum = inside.x + inside.y + inside.z;
    const MaskOf<L> known = (sum > L(0)) & (sum < infinity<L>());
    const L third(RealOf<L>(1) / 3);
    return choose(known, inside * (1 / sum), Vec3<L>{third, third, third});
}

/// The gradients of two quantities that are linear over the triangle, by the point; each corner has its x and
/// y.
template <class L>
Vec2<Vec3<L>> corner_slopes(const Corners<L>& corners, const Corners<L>& values) {
    const Vec3<L> edge1 = corners.b - corners.a, edge2 = corners.c - corners.a;
    const Vec3<L> n = cross(edge1, edge2);
    const L inverse = 1 / dot(n, n);
    const Vec3<L> by_b = cross(edge2, n) * inverse, by_c = cross(n, edge1) * inverse; // of the weights
    const Vec3<L> value1 = values.b - values.a, value2 = values.c - values.a;
    return {by_b * value1.x + by_c * value2.x, by_b * value1.y + by_c * value2.y};
}

/// Of a triangle so many times as long as high, the weights say less about the point than the ray does: their
/// roundings are multiplied by the length.
inline constexpr int needle_aspect = 4096;

/// `t`: where the ray meets it.
template <class L>
constexpr Surface<L> triangle_surface(const Corners<L>& corners, const Vec3<L>& weights, const Ray<L>& ray,
                                      const L& t) {
    const L u = roundoff<L>();
    const Vec3<L> edge1 = corners.b - corners.a, edge2 = corners.c - corners.a;
    const Vec3<L> across = cross(edge1, edge2);
    const Vec3<L> n = normalize(across);
    const Vec3<L> in_plane = edge1 * weights.y + edge2 * weights.z;
    const Vec3<L> by_weights = corners.a + (in_plane - n * dot(n, in_plane));
    const Vec3<L> on_ray = ray.org + ray.dir * t;
    const Vec3<L> by_ray = on_ray - n * dot(n, on_ray - corners.a);
    const L size = maximum(largest_component(absolute(edge1)), largest_component(absolute(edge2)));
    const MaskOf<L> is_needle = size * size > L(needle_aspect) * largest_component(absolute(across));
    const Vec3<L> point = choose(is_needle, by_ray, by_weights);
    // 2: the sum. Then the in-plane vector's error, a few roundings of the edges, and the plane's distance in
    // distance_to_plane: 4 roundings of the terms of n.(a - org), which is at most as long as the edges.
    const Vec3<L> reach = absolute(edge1) + absolute(edge2);
    const Vec3<L> error =
        absolute(point) * (2 * u) + reach * (8 * u) + absolute(n) * (16 * u * dot(absolute(n), reach));
    return {point, error, n, n};
}

/// Barycentric and normalised, as POV-Ray's mesh2; the geometric normal where the sum vanishes.
template <class L>
constexpr Vec3<L> interpolate_normal(const Corners<L>& normals, const Vec3<L>& weights,
                                     const Vec3<L>& geometric) {
    const Vec3<L> sum = normals.a * weights.x + normals.b * weights.y + normals.c * weights.z;
    const L squared = dot(sum, sum);
    return choose(squared > 0, sum * (L(1) / square_root(squared)), geometric);
}

} // namespace scc::runtime
