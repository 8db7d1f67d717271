#pragma once

#include "runtime/math/vec.h"

#include <numbers>

/// What the shapes' coordinates on their surfaces have in common: seen from outside, u grows to the right and
/// v upwards.
namespace scc::runtime {

template <class L>
constexpr L inverse_pi() {
    return L(std::numbers::inv_pi_v<RealOf<L>>);
}

/// The angle about the y axis of a point at (x, z) from it, 0 to 1: 1/2 towards z, 3/4 towards x.
template <class L>
L around(const L& x, const L& z) {
    return arc_tangent(x, z) * (inverse_pi<L>() * RealOf<L>(0.5)) + RealOf<L>(0.5);
}

template <class R>
struct PlanarAxes {
    Vec3<R> u, v; ///< unit
};

/// Those of a flat surface: v is the direction that comes nearest to y or, where the unit normal is nearer to
/// the y axis than to the others, to -z at the top and z at the bottom.
template <class R>
constexpr PlanarAxes<R> planar_axes(const Vec3<R>& normal) {
    const Vec3<R> size = absolute(normal);
    const bool is_level = size.y >= size.x && size.y >= size.z;
    const Vec3<R> up = is_level ? Vec3<R>{0, 0, normal.y < 0 ? R(1) : R(-1)} : Vec3<R>{0, 1, 0};
    const Vec3<R> u = normalize(cross(up, normal));
    return {u, cross(normal, u)};
}

/// 0 to 1 over the square around a circle, for a point relative to its centre.
template <class R, class L>
constexpr Vec2<L> on_square(const Vec3<L>& from_center, const Vec3<R>& normal, const L& radius) {
    const PlanarAxes<R> axes = planar_axes(normal);
    const L scale = RealOf<L>(0.5) / radius;
    return {dot(from_center, lanes<L>(axes.u)) * scale + RealOf<L>(0.5),
            dot(from_center, lanes<L>(axes.v)) * scale + RealOf<L>(0.5)};
}

} // namespace scc::runtime
