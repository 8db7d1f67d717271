#pragma once

#include "runtime/math/dual.h"
#include "runtime/math/vec.h"

#include <numbers>

/// What the shapes' coordinates on their surfaces have in common: seen from outside, u grows to the right and
/// v upwards. T is a lane type or, for their derivatives, a dual number over one.
namespace scc::runtime {

template <class T>
constexpr T inverse_pi() {
    return T(std::numbers::inv_pi_v<typename RealOfNumber<T>::type>);
}

/// The angle about the y axis of a point at (x, z) from it, 0 to 1: 1/2 towards z, 3/4 towards x.
template <class T>
T around(const T& x, const T& z) {
    using R = typename RealOfNumber<T>::type;
    return arc_tangent(x, z) * (inverse_pi<T>() * R(0.5)) + R(0.5);
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
template <class R, class T>
constexpr Vec2<T> on_square(const Vec3<T>& from_center, const Vec3<R>& normal, const T& radius) {
    const PlanarAxes<R> axes = planar_axes(normal);
    const T scale = R(0.5) / radius;
    return {dot(from_center, lanes<T>(axes.u)) * scale + R(0.5),
            dot(from_center, lanes<T>(axes.v)) * scale + R(0.5)};
}

} // namespace scc::runtime
