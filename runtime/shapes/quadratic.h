#pragma once

#include "runtime/math/vec.h"

namespace scc::runtime {

/// The two values of t, near <= far, where a ray is at distance r from a point or, given the parts of org and
/// dir that are perpendicular to an axis, from the axis. `real`: the ray gets that near; the rest is
/// undefined elsewhere.
template <class L>
struct CircleRoots {
    L near, far;
    MaskOf<L> real;
    L excess; ///< |org|^2 - r^2: not positive where the ray starts inside
};

/// `org` relative to the centre. The discriminant comes from the distance of the ray's point nearest to the
/// centre, and only one root from a sum, so that neither cancels for small or far spheres (Haines, Guenther,
/// Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019). dir = 0 (a
/// ray along the cylinder's axis): not real.
template <class L>
constexpr CircleRoots<L> intersect_circle(const Vec3<L>& org, const Vec3<L>& dir, const L& r) {
    const L a = dot(dir, dir), inverse = 1 / a;
    const L b = -dot(org, dir);
    const Vec3<L> nearest = org + (b * inverse) * dir;
    const L squared_radius = r * r;
    const L discriminant = squared_radius - dot(nearest, nearest);
    const L excess = dot(org, org) - squared_radius;
    CircleRoots<L> result{L(0), L(0), discriminant >= 0, excess};
    if (none(result.real)) {
        return result;
    }
    const L root = square_root(maximum(L(0), a * discriminant));
    const L q = b + choose(b < 0, -root, root);
    const L t0 = q * inverse;
    const L t1 = excess / q; // NaN where q = 0: touching, at t0 = 0
    result.near = minimum(t0, t1);
    result.far = maximum(t0, t1);
    return result;
}

} // namespace scc::runtime
