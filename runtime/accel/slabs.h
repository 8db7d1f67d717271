#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/bounds.h"
#include "runtime/math/pack.h"
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

    SlabRay() = default;
    SlabRay(const Ray<L>& ray, const Bounds<RealOf<L>>& root)
        : reach_(largest_component(
              maximum(absolute(lanes<L>(root.min) - ray.org), absolute(lanes<L>(root.max) - ray.org)))) {
        const L pad = 16 * roundoff<L>() * reach_;
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
            const MaskOf<C> negative(negative_[axis]);
            result.near = maximum(result.near, choose(negative, high, low));
            result.far = minimum(result.far, choose(negative, low, high));
        }
        return result;
    }

    /// The largest difference between a coordinate of the boxes and the origin.
    const L& reach() const { return reach_; }
    const L& inverse(std::size_t axis) const { return inverse_[axis]; }
    /// To be taken off a box's lower or upper bound.
    const L& low_org(std::size_t axis) const { return low_org_[axis]; }
    const L& high_org(std::size_t axis) const { return high_org_[axis]; }

    friend SlabRay<RealOf<L>> lane(const SlabRay& rays, int i) {
        SlabRay<RealOf<L>> ray;
        ray.reach_ = lane(rays.reach_, i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ray.inverse_[axis] = lane(rays.inverse_[axis], i);
            ray.low_org_[axis] = lane(rays.low_org_[axis], i);
            ray.high_org_[axis] = lane(rays.high_org_[axis], i);
            ray.negative_[axis] = ray.inverse_[axis] < 0;
        }
        return ray;
    }

private:
    template <class>
    friend class SlabRay;

    void set_axis(std::size_t axis, const L& org, const L& dir, const L& pad) {
        inverse_[axis] = 1 / dir;
        negative_[axis] = inverse_[axis] < 0;
        // What the sums lose is put on top.
        const L padding = pad + 2 * roundoff<L>() * absolute(org);
        low_org_[axis] = org + padding;
        high_org_[axis] = org - padding;
    }

    L reach_;
    std::array<L, 3> inverse_, low_org_, high_org_;
    std::array<MaskOf<L>, 3> negative_;
};

/// n single rays' tests against a node's eight boxes: SlabRay::range with the planes that come first along a
/// ray looked up instead of selected.
template <class R, int n>
class BoxTests {
public:
    /// The rays from `first` on, as many as L has lanes.
    template <class L>
    void set(std::size_t first, const SlabRay<L>& slabs, const L& t_min) {
        using Index = IndexOf<L>;
        store_lanes(t_min_ + first, t_min);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const MaskOf<L> negative = slabs.inverse(axis) < 0;
            store_lanes(inverse_[axis] + first, slabs.inverse(axis));
            store_lanes(near_org_[axis] + first, choose(negative, slabs.high_org(axis), slabs.low_org(axis)));
            store_lanes(far_org_[axis] + first, choose(negative, slabs.low_org(axis), slabs.high_org(axis)));
            const Index low(
                static_cast<std::uint32_t>(bvh_width * axis)); // the upper bounds follow the lower
            const Index high(static_cast<std::uint32_t>(bvh_width * (axis + 3)));
            store_lanes(near_row_[axis] + first, choose(negative, high, low));
            store_lanes(far_row_[axis] + first, choose(negative, low, high));
        }
    }

    /// The children that a ray meets in [t_min, nearest], as bits, and where, but not before t_min.
    unsigned operator()(std::size_t ray, const BvhNode& node, R nearest, R (&near)[bvh_width]) const {
        unsigned met = 0;
        const float* rows = &node.min[0][0];
        for (int i = 0; i < bvh_width; i += lane_count<C>) {
            C begin(t_min_[ray]), end(nearest);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const C first = load_lanes<C>(rows + near_row_[axis][ray] + i);
                const C last = load_lanes<C>(rows + far_row_[axis][ray] + i);
                const C inverse(inverse_[axis][ray]);
                begin = maximum(begin, (first - C(near_org_[axis][ray])) * inverse);
                end = minimum(end, (last - C(far_org_[axis][ray])) * inverse);
            }
            met |= bits(begin <= end) << i;
            store_lanes(near + i, begin);
        }
        return met;
    }

private:
    using C = std::conditional_t<sizeof(R) <= sizeof(double), Pack<R, bvh_width>, R>;
    using Row = std::conditional_t<sizeof(R) == sizeof(double), unsigned long long, unsigned>;

    alignas(64) R t_min_[n];
    R inverse_[3][n], near_org_[3][n], far_org_[3][n];
    Row near_row_[3][n], far_row_[3][n];
};

} // namespace scc::runtime
