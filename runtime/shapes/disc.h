#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/uv.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// A flat ring; `hole` is the inner radius. The front end makes sure that hole < radius.
template <class R>
struct Disc {
    static constexpr std::string_view name = "disc";

    Vec3<R> center{0, 0, 0};
    Vec3<R> normal{0, 1, 0}; ///< unit
    R radius = 1;
    R hole = 0;

    static constexpr auto fields() {
        return std::tuple{field("center", &Disc::center, Rule::any, "centre"),
                          field("normal", &Disc::normal, Rule::direction, "points to the front side"),
                          field("radius", &Disc::radius, Rule::positive, "outer radius"),
                          field("hole", &Disc::hole, Rule::non_negative, "inner radius")};
    }

    constexpr Bounds<R> bounds() const {
        const R slack = 16 * roundoff<R>() * (largest_component(absolute(center)) + radius);
        // Along an axis the disc reaches radius times the sine of the angle between axis and normal.
        const auto reach = [&](R cosine) {
            return radius * square_root(maximum(R(0), 1 - cosine * cosine)) + slack;
        };
        const Vec3<R> half{reach(normal.x), reach(normal.y), reach(normal.z)};
        return {center - half, center + half};
    }

    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const Vec3<L> n = lanes<L>(normal);
        const Vec3<L> to_center = lanes<L>(center) - ray.org;
        const L t = dot(n, to_center) / dot(n, ray.dir);
        MaskOf<L> inside = (t >= ray.t_min) & (t <= ray.t_max);
        if (none(inside)) {
            return {};
        }
        const Vec3<L> from_center = t * ray.dir - to_center;
        const L distance = dot(from_center, from_center);
        inside = inside & (distance <= L(radius) * L(radius)) & (distance >= L(hole) * L(hole));
        return {choose(inside, t, infinity<L>()), {}};
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const L u = roundoff<L>();
        const Vec3<L> n = lanes<L>(normal);
        const Vec3<L> c = lanes<L>(center);
        const Vec3<L> from_center = (ray.org - c) + hit.t * ray.dir;
        const Vec3<L> point = c + (from_center - n * dot(n, from_center));
        // 16 radii: n.(c - p), here and in intersect.
        return {point, absolute(point) * (2 * u) + absolute(n) * (16 * u * L(radius)), n, n};
    }

    /// 0 to 1 over the square around the disc.
    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>&, const Vec3<T>& point) const {
        return on_square(point - lanes<T>(center), normal, T(radius));
    }
};

} // namespace scc::runtime
