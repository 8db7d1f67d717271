#pragma once

#include "runtime/math/vec.h"

namespace scc::runtime {

enum class Projection { perspective, orthographic };

/// L2, L11. The frame is resolved: u right, v up, n backwards, orthonormal. A ray through (x, y) of the view plane,
/// x and y in units of half the picture's height measured from its centre, is
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

} // namespace scc::runtime
