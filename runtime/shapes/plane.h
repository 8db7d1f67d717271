#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/uv.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// dot(normalize(normal), p) = offset; unbounded.
template <class R>
struct Plane {
    static constexpr std::string_view name = "plane";

    Vec3<R> normal{0, 1, 0}; ///< unit
    R offset = 0;

    static constexpr auto fields() {
        return std::tuple{
            field("normal", &Plane::normal, Rule::direction, "points to the front side"),
            field("offset", &Plane::offset, Rule::any, "distance from the origin along the normal")};
    }

    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const Vec3<L> n = lanes<L>(normal);
        const L distance = L(offset) - dot(n, ray.org), slope = dot(n, ray.dir);
        if (none(((distance >= 0) & (slope > 0)) | ((distance <= 0) & (slope < 0)))) {
            return {}; // all leave it behind, as most that start on it do
        }
        const L t = distance / slope;
        return {choose((t >= ray.t_min) & (t <= ray.t_max), t, infinity<L>()), {}};
    }

    /// Of the ray's line behind the plane, on the side that the normal points away from.
    template <class L>
    constexpr Stretch<L> stretch(const Ray<L>& ray) const {
        const Vec3<L> n = lanes<L>(normal);
        const L distance = L(offset) - dot(n, ray.org), slope = dot(n, ray.dir);
        const L t = distance / slope, inf = infinity<L>();
        const L everywhere = choose(distance >= 0, inf, -inf);
        return {choose(slope < 0, t, choose(slope > 0, -inf, -everywhere)),
                choose(slope > 0, t, choose(slope < 0, inf, everywhere))};
    }
    /// A box around what lies behind the plane, as far as that has bounds.
    constexpr Bounds<R> inside_bounds() const {
        Bounds<R> box{{-infinity<R>(), -infinity<R>(), -infinity<R>()},
                      {infinity<R>(), infinity<R>(), infinity<R>()}};
        const R limit = offset + 16 * roundoff<R>() * absolute(offset);
        const auto bound = [&](R direction, R& low, R& high) {
            high = direction == 1 ? limit : high;
            low = direction == -1 ? -limit : low;
        };
        bound(normal.x, box.min.x, box.max.x);
        bound(normal.y, box.min.y, box.max.y);
        bound(normal.z, box.min.z, box.max.z);
        return box;
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const Vec3<L> n = lanes<L>(normal);
        const Vec3<L> reached = ray.org + hit.t * ray.dir;
        const Vec3<L> point = reached - n * (dot(n, reached) - L(offset));
        // n.p takes 4 roundings of its terms, here and in intersect; |offset| is at most their sum.
        return {point, absolute(point) * (16 * roundoff<L>()), n, n};
    }

    /// Lengths from the origin's foot along the plane's axes.
    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>&, const Vec3<T>& point) const {
        const PlanarAxes<R> axes = planar_axes(normal);
        return {dot(point, lanes<T>(axes.u)), dot(point, lanes<T>(axes.v))};
    }
};

} // namespace scc::runtime
