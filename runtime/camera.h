#pragma once

#include "runtime/math/vec.h"
#include "runtime/ray.h"

namespace scc::runtime {

enum class Projection { perspective, orthographic };

/// L2, L11. The frame is resolved: u right, v up, n backwards, orthonormal. A ray through (x, y) of the view
/// plane, x and y in units of half the picture's height measured from its centre, is
///   perspective:  org = eye,                                  dir = -n + half_height (x u + y v)
///   orthographic: org = eye + half_height (x u + y v),        dir = -n
/// `dir` is not normalised for the perspective camera.
template <class R>
struct Camera {
    Projection projection = Projection::perspective;
    Vec3<R> eye{0, 0, 5};
    Vec3<R> u{1, 0, 0};
    Vec3<R> v{0, 1, 0};
    Vec3<R> n{0, 0, 1};
    R half_height = R(0.41421356237309503); ///< tan(fov_y / 2), or half the window's height
    R shift_x = 0, shift_y = 0;             ///< of the window, in window heights
};

/// Where a point of the picture lies in the window, in half window heights from its middle to the right or
/// up. The picture's size and `column` and `row`, from its top left corner, are in pixels.
template <class L, class R>
constexpr L window_x(const Camera<R>& camera, const L& column, int width, int height) {
    return (2 * column - L(static_cast<R>(width))) / L(static_cast<R>(height)) + L(2 * camera.shift_x);
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
    const Vec3<L> offset = (lanes<L>(camera.u) * x + lanes<L>(camera.v) * y) * L(camera.half_height);
    if (projection == Projection::perspective) {
        return {lanes<L>(camera.eye), offset - lanes<L>(camera.n)};
    }
    return {lanes<L>(camera.eye) + offset, -lanes<L>(camera.n)};
}

} // namespace scc::runtime
