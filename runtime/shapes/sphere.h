#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/quadratic.h"
#include "runtime/shapes/uv.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

template <class R>
struct Sphere {
    static constexpr std::string_view name = "sphere";

    Vec3<R> center{0, 0, 0};
    R radius = 1;

    static constexpr auto fields() {
        return std::tuple{field("center", &Sphere::center, Rule::any, "centre"),
                          field("radius", &Sphere::radius, Rule::positive, "radius")};
    }

    constexpr Bounds<R> bounds() const {
        // The sum's rounding, and the point's error bound.
        const R slack = 16 * roundoff<R>() * (largest_component(absolute(center)) + radius);
        const Vec3<R> reach{radius + slack, radius + slack, radius + slack};
        return {center - reach, center + reach};
    }

    /// Holds the points that bounds() holds.
    constexpr Ball<R> ball() const { return {center, bounds().max.x - center.x}; }

    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const L r = L(radius);
        const Vec3<L> from_center = ray.org - lanes<L>(center);
        const CircleRoots<L> roots = intersect_circle(from_center, ray.dir, r);
        if (none(roots.real)) {
            return {};
        }
        return {choose(roots.real, first_in_range(ray, roots.near, roots.far), infinity<L>()), {}};
    }

    /// Of the ray's line within.
    template <class L>
    constexpr Stretch<L> stretch(const Ray<L>& ray) const {
        const CircleRoots<L> roots = intersect_circle(ray.org - lanes<L>(center), ray.dir, L(radius));
        return {choose(roots.real, roots.near, infinity<L>()), choose(roots.real, roots.far, -infinity<L>())};
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const L u = roundoff<L>();
        const Vec3<L> c = lanes<L>(center);
        const Vec3<L> normal = normalize((ray.org - c) + hit.t * ray.dir);
        const Vec3<L> point = c + normal * L(radius);
        // 2: the sum. 16 radii: c' = |f|^2 - r^2 and the discriminant near the surface, 8 roundings of r^2
        // each, which is 4 of r in distance, and the normal's and the product's own.
        const Vec3<L> error = absolute(point) * (2 * u) + absolute(normal) * (16 * u * L(radius));
        return {point, error, normal, normal};
    }

    /// Longitude and latitude about the y axis, 0 to 1: the middle of a picture faces the z axis.
    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>&, const Vec3<T>& point) const {
        const Vec3<T> d = point - lanes<T>(center);
        return {around(d.x, d.z),
                arc_tangent(d.y, square_root(d.x * d.x + d.z * d.z)) * inverse_pi<T>() + R(0.5)};
    }
};

} // namespace scc::runtime
