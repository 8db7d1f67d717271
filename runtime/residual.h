#pragma once

#include "runtime/explanation.h"
#include "runtime/primitive.h"

#include <cmath>
#include <optional>

/// The equation of each shape, L12's f(p) = 0, at a point in the shape's space.
namespace scc::runtime {

namespace detail {

/// Along the axis from `from`, and away from it.
template <class R>
struct AboutAxis {
    R along, across, height;

    AboutAxis(const Vec3<R>& from, const Vec3<R>& to, const Vec3<R>& p) : height(length(to - from)) {
        const Vec3<R> axis = (to - from) * (1 / height);
        along = dot(p - from, axis);
        across = length((p - from) - axis * along);
    }
};

template <class R>
Residual residual_on_tube(const Vec3<R>& from, const Vec3<R>& to, R radius_from, R radius_to,
                          std::uint32_t part, const Vec3<R>& p) {
    const AboutAxis<R> at(from, to, p);
    if (part == 0) {
        const R radius = radius_from + (radius_to - radius_from) * at.along / at.height;
        return {"distance from the axis - radius", static_cast<double>(at.across - radius)};
    }
    return part == 1
               ? Residual{"distance along the axis from `from`", static_cast<double>(at.along)}
               : Residual{"distance along the axis from `to`", static_cast<double>(at.along - at.height)};
}

} // namespace detail

template <class R>
std::optional<Residual> residual_of(const Sphere<R>& s, std::uint32_t, const Vec3<R>& p) {
    return Residual{"|p - center|^2 - radius^2",
                    static_cast<double>(dot(p - s.center, p - s.center) - s.radius * s.radius)};
}
template <class R>
std::optional<Residual> residual_of(const Box<R>& b, std::uint32_t part, const Vec3<R>& p) {
    static constexpr std::string_view terms[] = {"p.x - min.x", "p.x - max.x", "p.y - min.y",
                                                 "p.y - max.y", "p.z - min.z", "p.z - max.z"};
    const R values[] = {p.x - b.min.x, p.x - b.max.x, p.y - b.min.y,
                        p.y - b.max.y, p.z - b.min.z, p.z - b.max.z};
    return Residual{terms[part], static_cast<double>(values[part])};
}
template <class R>
std::optional<Residual> residual_of(const Plane<R>& plane, std::uint32_t, const Vec3<R>& p) {
    return Residual{"normal.p - offset", static_cast<double>(dot(plane.normal, p) - plane.offset)};
}
template <class R>
std::optional<Residual> residual_of(const Cylinder<R>& c, std::uint32_t part, const Vec3<R>& p) {
    return detail::residual_on_tube(c.from, c.to, c.radius, c.radius, part, p);
}
template <class R>
std::optional<Residual> residual_of(const Cone<R>& c, std::uint32_t part, const Vec3<R>& p) {
    return detail::residual_on_tube(c.from, c.to, c.radius_from, c.radius_to, part, p);
}
template <class R>
std::optional<Residual> residual_of(const Disc<R>& d, std::uint32_t, const Vec3<R>& p) {
    return Residual{"normal.(p - center)", static_cast<double>(dot(d.normal, p - d.center))};
}
template <class R>
std::optional<Residual> residual_of(const Triangle<R>& t, std::uint32_t, const Vec3<R>& p) {
    const Vec3<R> normal = normalize(cross(t.points[1] - t.points[0], t.points[2] - t.points[0]));
    return Residual{"normal.(p - first corner)", static_cast<double>(dot(normal, p - t.points[0]))};
}
template <class R>
std::optional<Residual> residual_of(const Torus<R>& torus, std::uint32_t, const Vec3<R>& p) {
    const detail::AboutAxis<R> at(torus.center, torus.center + torus.axis, p);
    const R from_circle = at.across - torus.major;
    return Residual{
        "distance from the tube's middle - minor",
        static_cast<double>(square_root(from_circle * from_circle + at.along * at.along) - torus.minor)};
}
template <class R>
std::optional<Residual> residual_of(const Quadric<R>& q, std::uint32_t, const Vec3<R>& p) {
    const R squares = q.squares.x * p.x * p.x + q.squares.y * p.y * p.y + q.squares.z * p.z * p.z;
    const R products = q.products.x * p.x * p.y + q.products.y * p.y * p.z + q.products.z * p.z * p.x;
    return Residual{"squares + products + linear.p + constant",
                    static_cast<double>(squares + products + dot(q.linear, p) + q.constant)};
}

/// Nothing for meshes.
template <class S, class Shape, class R>
std::optional<Residual> residual_in(const S& scene, const Shape& shape, std::uint32_t part,
                                    const Vec3<R>& p) {
    if constexpr (is_implicit<Shape>) {
        if (part == field_part) {
            return Residual{"field(p)", static_cast<double>(field_of(scene, shape)(p))};
        }
        return shape.within.visit([&](const auto& container) { return residual_of(container, part, p); });
    } else if constexpr (is_mesh<Shape> || is_csg<Shape>) {
        return std::nullopt;
    } else {
        return residual_of(shape, part, p);
    }
}

} // namespace scc::runtime
