#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/triangle_test.h"

#include <array>
#include <string_view>
#include <tuple>

namespace scc::runtime {

/// The front side is the one from which the points run counter-clockwise. With `smooth`, the vertex normals
/// are interpolated for shading. The front end makes sure that the points do not lie on a line.
template <class R>
struct Triangle {
    static constexpr std::string_view name = "triangle";

    std::array<Vec3<R>, 3> points{};
    std::array<Vec3<R>, 3> normals{};
    bool smooth = false;
    std::array<Vec2<R>, 3> uvs{{{0, 0}, {1, 0}, {0, 1}}};
    bool has_uvs = false; ///< the author's

    static constexpr auto fields() {
        return std::tuple{required_field("points", &Triangle::points, Rule::any, "the three corners"),
                          optional_field("normals", &Triangle::normals, &Triangle::smooth,
                                         Rule::nonzero_vector,
                                         "normals at the corners, interpolated for shading"),
                          optional_field("uvs", &Triangle::uvs, &Triangle::has_uvs, Rule::any,
                                         "`s.uv` at the corners; else (0, 0), (1, 0) and (0, 1)")};
    }

    constexpr Bounds<R> bounds() const {
        Bounds<R> result;
        for (const Vec3<R>& p : points) {
            result.add(p);
        }
        const Vec3<R> size = result.max - result.min;
        const Vec3<R> magnitude = maximum(absolute(result.min), absolute(result.max));
        const R slack = 32 * roundoff<R>() * (largest_component(size) + largest_component(magnitude));
        return {result.min - Vec3<R>{slack, slack, slack}, result.max + Vec3<R>{slack, slack, slack}};
    }

    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const Corners<L> corners{lanes<L>(points[0]), lanes<L>(points[1]), lanes<L>(points[2])};
        const L t = intersect_triangle(corners, ray);
        return {choose((t >= ray.t_min) & (t <= ray.t_max), t, infinity<L>()), {}};
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const Corners<L> corners{lanes<L>(points[0]), lanes<L>(points[1]), lanes<L>(points[2])};
        const Vec3<L> weights = barycentric(corners, ray);
        Surface<L> result = triangle_surface(corners, weights, ray, hit.t);
        if (smooth) {
            const Corners<L> n{lanes<L>(normalize(normals[0])), lanes<L>(normalize(normals[1])),
                               lanes<L>(normalize(normals[2]))};
            result.shading_normal = interpolate_normal(n, weights, result.normal);
        }
        return result;
    }

    /// Barycentric.
    template <class L>
    constexpr Vec2<L> uv(const Ray<L>& ray, const ShapeHit<L>&, const Vec3<L>&) const {
        const Corners<L> corners{lanes<L>(points[0]), lanes<L>(points[1]), lanes<L>(points[2])};
        const Vec3<L> weights = barycentric(corners, ray);
        const auto interpolate = [&](R a, R b, R c) {
            return L(a) * weights.x + L(b) * weights.y + L(c) * weights.z;
        };
        return {interpolate(uvs[0].x, uvs[1].x, uvs[2].x), interpolate(uvs[0].y, uvs[1].y, uvs[2].y)};
    }
    /// Gradients of u and v by the point.
    template <class L>
    Vec2<Vec3<L>> uv_slopes() const {
        const auto value = [&](std::size_t i) { return Vec3<L>{L(uvs[i].x), L(uvs[i].y), L(0)}; };
        return corner_slopes(Corners<L>{lanes<L>(points[0]), lanes<L>(points[1]), lanes<L>(points[2])},
                             Corners<L>{value(0), value(1), value(2)});
    }
};

} // namespace scc::runtime
