#pragma once

#include "runtime/math/vec.h"

namespace scc::runtime {

/// org + t dir for t in [t_min, t_max]. `dir` has any length other than 0: t is shared between object and
/// world space (L13).
template <class L>
struct Ray {
    Vec3<L> org;
    Vec3<L> dir;
    L t_min{0};
    L t_max = infinity<L>();
};

template <class L>
Ray<RealOf<L>> lane(const Ray<L>& ray, int i) {
    return {{lane(ray.org.x, i), lane(ray.org.y, i), lane(ray.org.z, i)},
            {lane(ray.dir.x, i), lane(ray.dir.y, i), lane(ray.dir.z, i)},
            lane(ray.t_min, i),
            lane(ray.t_max, i)};
}

/// What a shape's `intersect` returns. `part` tells the shape's `surface` which of its pieces was hit.
template <class L>
struct ShapeHit {
    L t = infinity<L>(); ///< infinity: missed
    IndexOf<L> part{};
};

/// Where a ray passes through a solid's surface.
template <class L>
struct Crossing {
    ShapeHit<L> hit;
    MaskOf<L> outwards; ///< the ray leaves the solid there; without a hit: it is inside for good
};

/// The t from `near` to `far`; none where near > far or one of them is not a number.
template <class L>
struct Stretch {
    L near, far;
};

/// A hit in detail, in one space. `error` bounds, per component, how far `point` may be from the surface and
/// from where the shape's `intersect` will find it to be when a ray starts there; at least 2 roundings of
/// `point` itself.
template <class L>
struct Surface {
    Vec3<L> point;
    Vec3<L> error;
    Vec3<L> normal;         ///< geometric, unit
    Vec3<L> shading_normal; ///< unit
};

/// The same place seen as the boundary of what is on its other side.
template <class L>
constexpr Surface<L> turned_over(const Surface<L>& s) {
    return {s.point, s.error, -s.normal, -s.shading_normal};
}

/// Half the distance from 1 to the next number: one operation's relative error.
template <class L>
constexpr L roundoff() {
    return L(std::numeric_limits<RealOf<L>>::epsilon() / 2);
}

/// The smaller of two hits within the ray's range, or infinity.
template <class L>
constexpr L first_in_range(const Ray<L>& ray, const L& near, const L& far) {
    const L t = choose(near >= ray.t_min, near, far);
    return choose((t >= ray.t_min) & (t <= ray.t_max), t, infinity<L>());
}

/// Where a ray that leaves the surface in the direction `dir` starts: off the surface by twice the bound,
/// along the geometric normal, on the side that the ray goes to. (After "Managing Rounding Error" in Pharr,
/// Jakob, Humphreys, Physically Based Rendering; twice the bound instead of their stepping to the next float,
/// which the rounding of the sum cannot undo, since the bound is at least 2 roundings of the point.)
template <class L>
constexpr Vec3<L> start_off(const Surface<L>& surface, const Vec3<L>& dir) {
    const L distance = 2 * dot(absolute(surface.normal), surface.error);
    const L side = choose(dot(dir, surface.normal) < 0, -distance, distance);
    return surface.point + side * surface.normal;
}

/// The smallest t of a ray that starts off a surface. Where a surface's equation is exact in zero (a plane
/// through the origin), the bound is 0 and the ray starts on the surface, at t = 0 exactly.
template <class L>
constexpr L spawned_t_min() {
    return L(std::numeric_limits<RealOf<L>>::min());
}

} // namespace scc::runtime
