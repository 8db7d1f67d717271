#pragma once

#include "runtime/math/affine.h"
#include "runtime/math/vec.h"

namespace scc::runtime {

/// A box that contains a shape; empty as initialised.
template <class R>
struct Bounds {
    Vec3<R> min{infinity<R>(), infinity<R>(), infinity<R>()};
    Vec3<R> max{-infinity<R>(), -infinity<R>(), -infinity<R>()};

    constexpr void add(const Vec3<R>& p) {
        min = minimum(min, p);
        max = maximum(max, p);
    }
    constexpr void add(const Bounds& b) {
        min = minimum(min, b.min);
        max = maximum(max, b.max);
    }
    constexpr Vec3<R> center() const { return min * R(0.5) + max * R(0.5); }
};

template <class R>
struct Ball {
    Vec3<R> center;
    R radius = 0;
};

template <class R>
constexpr Ball<R> ball_around(const Bounds<R>& box) {
    const Vec3<R> center = box.center();
    return {center, length(maximum(box.max - center, center - box.min))};
}

/// A box around a transformed box, with room for the rounding on the way.
template <class R>
constexpr Bounds<R> transform_bounds(const Affine<R>& a, const Bounds<R>& b) {
    const R roundoff = std::numeric_limits<R>::epsilon();
    const Vec3<R> center = b.center();
    const Vec3<R> half = maximum(b.max - center, center - b.min);
    const Vec3<R> reach = transform_magnitude(a, half);
    const Vec3<R> magnitude = transform_magnitude(a, absolute(center)) + absolute(translation_of(a)) + reach;
    const Vec3<R> extent = reach + magnitude * (8 * roundoff);
    const Vec3<R> moved = transform_point(a, center);
    return {moved - extent, moved + extent};
}

/// Neither unbounded nor empty.
template <class R>
constexpr bool is_finite(const Bounds<R>& b) {
    const Vec3<R> size = b.max - b.min;
    const R most = infinity<R>();
    return size.x >= 0 && size.y >= 0 && size.z >= 0 && size.x < most && size.y < most && size.z < most;
}

/// The same for one that may have no end, of which then nothing is known.
template <class R>
constexpr Bounds<R> transform_inside(const Affine<R>& a, const Bounds<R>& b) {
    const Vec3<R> all{infinity<R>(), infinity<R>(), infinity<R>()};
    return b.min.x > b.max.x ? Bounds<R>{} : is_finite(b) ? transform_bounds(a, b) : Bounds<R>{-all, all};
}

} // namespace scc::runtime
