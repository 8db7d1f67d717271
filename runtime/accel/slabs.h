#pragma once

#include "runtime/bounds.h"
#include "runtime/ray.h"

#include <array>
#include <cstddef>
#include <type_traits>

namespace scc::runtime {

/// Rays made ready for tests against the boxes of one hierarchy. Errs on the side of a hit: the boxes grow by
/// `pad`, 16 roundings of the largest difference between a coordinate of theirs and the origin, which exceeds
/// what the slab test itself and the primitives' tests lose. (An absolute pad and not a relative one on t,
/// after T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013: the primitive's error is across the ray.)
template <class L>
class SlabRay {
public:
    template <class C>
    struct Range {
        C near, far; ///< near > far: missed
    };

    SlabRay(const Ray<L>& ray, const Bounds<RealOf<L>>& root) {
        const Vec3<L> reach =
            maximum(absolute(lanes<L>(root.min) - ray.org), absolute(lanes<L>(root.max) - ray.org));
        const L pad = 16 * roundoff<L>() * largest_component(reach);
        set_axis(0, ray.org.x, ray.dir.x, pad);
        set_axis(1, ray.org.y, ray.dir.y, pad);
        set_axis(2, ray.org.z, ray.dir.z, pad);
    }

    /// The stretch of the ray in a box with these corners. The lanes are those of the rays or, for a single
    /// ray, of the boxes. Monotonic: a box inside another has a range inside the other's, also as rounded. A
    /// direction component of 0 gives infinities of the right sign, or a NaN on the face, which minimum and
    /// maximum ignore.
    template <class C>
    Range<C> range(const C (&min)[3], const C (&max)[3]) const {
        Range<C> result{-infinity<C>(), infinity<C>()};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const C low = (min[axis] - C(low_org_[axis])) * C(inverse_[axis]);
            const C high = (max[axis] - C(high_org_[axis])) * C(inverse_[axis]);
            if constexpr (std::is_same_v<MaskOf<L>, bool>) {
                result.near = maximum(result.near, negative_[axis] ? high : low);
                result.far = minimum(result.far, negative_[axis] ? low : high);
            } else {
                result.near = maximum(result.near, choose(negative_[axis], high, low));
                result.far = minimum(result.far, choose(negative_[axis], low, high));
            }
        }
        return result;
    }

private:
    void set_axis(std::size_t axis, const L& org, const L& dir, const L& pad) {
        inverse_[axis] = 1 / dir;
        negative_[axis] = inverse_[axis] < 0;
        // What the sums lose is put on top.
        const L padding = pad + 2 * roundoff<L>() * absolute(org);
        low_org_[axis] = org + padding;
        high_org_[axis] = org - padding;
    }

    std::array<L, 3> inverse_, low_org_, high_org_;
    std::array<MaskOf<L>, 3> negative_;
};

} // namespace scc::runtime
