#pragma once

#include "runtime/math/trig.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"

#include <array>
#include <string_view>

namespace scc::runtime {

enum class Projection { perspective, orthographic, spherical };
inline constexpr auto projection_names =
    std::to_array<std::string_view>({"perspective", "orthographic", "spherical"});

/// L2, L11. The frame is resolved: u right, v up, n backwards, orthonormal. A ray through (x, y) of the
/// window (see window_x and window_y) is
///   perspective:  org = eye,                                  dir = -n + half_height (x u + y v)
///   orthographic: org = eye + half_height (x u + y v),        dir = -n
///   spherical:    org = eye,       dir = sin b v + cos b (sin a u - cos a n), a = half_width x, b =
///   half_height y
/// `dir` is not normalised for the perspective camera.
template <class R>
struct Camera {
    Projection projection = Projection::perspective;
    Vec3<R> eye{0, 0, 5};
    Vec3<R> u{1, 0, 0};
    Vec3<R> v{0, 1, 0};
    Vec3<R> n{0, 0, 1};
    R half_height = R(0.41421356237309503); ///< tan(fov_y / 2), or half the window's height, or fov_y / 2
    R shift_x = 0, shift_y = 0;             ///< of the window, in window heights
    R half_width = 0;                       ///< of the spherical camera: fov_x / 2 in radians
    R lens_radius = 0;                      ///< of the perspective camera; 0: a pinhole
    R focus = 1;                            ///< along the view axis, from the lens to what it shows sharp
    R near = R(0.1);                        ///< along the view axis: what a raster picture shows lies between
    R far = 1000;
};

/// Where a point of the picture lies in the window, in half window heights from its middle to the right or
/// up; for the spherical camera x is in half window widths. The picture's size and `column` and `row`, from
/// its top left corner, are in pixels.
template <class L, class R>
constexpr L window_x(const Camera<R>& camera, Projection projection, const L& column, int width, int height) {
    const int unit = projection == Projection::spherical ? width : height;
    return (2 * column - L(static_cast<R>(width))) / L(static_cast<R>(unit)) + L(2 * camera.shift_x);
}
template <class L, class R>
constexpr L window_y(const Camera<R>& camera, const L& row, int height) {
    const L h = L(static_cast<R>(height));
    return (h - 2 * row) / h + L(2 * camera.shift_y);
}

/// The ray through a point of the window (see window_x and window_y). The projection is an argument of its
/// own, so that a scene that knows it can pass a constant.
template <class L, class R>
constexpr Ray<L> camera_ray(const Camera<R>& camera, Projection projection, const L& x, const L& y) {
    if (projection == Projection::spherical) {
        const L longitude = x * L(camera.half_width), latitude = y * L(camera.half_height);
        const L level = cosine(latitude);
        return {lanes<L>(camera.eye), lanes<L>(camera.u) * (sine(longitude) * level) +
                                          lanes<L>(camera.v) * sine(latitude) -
                                          lanes<L>(camera.n) * (cosine(longitude) * level)};
    }
    const Vec3<L> offset = (lanes<L>(camera.u) * x + lanes<L>(camera.v) * y) * L(camera.half_height);
    if (projection == Projection::perspective) {
        return {lanes<L>(camera.eye), offset - lanes<L>(camera.n)};
    }
    return {lanes<L>(camera.eye) + offset, -lanes<L>(camera.n)};
}

/// The same of a perspective camera through another point of the lens than its middle, (x, y) lens radii from
/// there: both meet in the plane in focus.
template <class L, class R>
constexpr Ray<L> lens_ray(const Camera<R>& camera, const Ray<L>& middle, const L& x, const L& y) {
    const Vec3<L> offset = (lanes<L>(camera.u) * x + lanes<L>(camera.v) * y) * L(camera.lens_radius);
    return {middle.org + offset, middle.dir - offset * L(1 / camera.focus)};
}

} // namespace scc::runtime
