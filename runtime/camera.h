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

/// The ray through a point of the picture of the given size, in pixels from its top left corner. The
/// projection is an argument of its own, so that a scene that knows it can pass a constant.
template <class L, class R>
constexpr Ray<L> camera_ray(const Camera<R>& camera, Projection projection, const L& column, const L& row,
                            int width, int height) {
    const L w = L(static_cast<R>(width)), h = L(static_cast<R>(height));
    const L x = (2 * column - w) / h + L(2 * camera.shift_x);
    const L y = (h - 2 * row) / h + L(2 * camera.shift_y);
    const Vec3<L> offset = (lanes<L>(camera.u) * x + lanes<L>(camera.v) * y) * L(camera.half_height);
    if (projection == Projection::perspective) {
        return {lanes<L>(camera.eye), offset - lanes<L>(camera.n)};
    }
    return {lanes<L>(camera.eye) + offset, -lanes<L>(camera.n)};
}

} // namespace scc::runtime
