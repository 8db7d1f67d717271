#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/bounds.h"
#include "runtime/ray.h"

#include <array>

namespace scc::runtime {

/// A ray made ready for tests against the boxes of one hierarchy. Errs on the side of a hit: the boxes grow by `pad`,
/// 16 roundings of the largest difference between a coordinate of theirs and the origin, which exceeds what the slab
/// test itself and the primitives' tests lose. (An absolute pad and not a relative one on t, after T. Ize, "Robust BVH
/// Ray Traversal", JCGT 2(2), 2013: the primitive's error is across the ray.)
template <class R>
class SlabRay {
public:
    struct Range {
        R near, far; ///< near > far: missed
    };

    SlabRay(const Ray<R>& ray, const Bounds<R>& root) {
        const Vec3<R> reach = maximum(absolute(root.min - ray.org), absolute(root.max - ray.org));
        const R pad = 16 * roundoff<R>() * largest_component(reach);
        set_axis(0, ray.org.x, ray.dir.x, pad);
        set_axis(1, ray.org.y, ray.dir.y, pad);
        set_axis(2, ray.org.z, ray.dir.z, pad);
    }

    /// The stretch of the ray in a box with these corners. Monotonic: a box inside another has a range inside the
    /// other's, also as rounded. A direction component of 0 gives infinities of the right sign, or a NaN on the face,
    /// which minimum and maximum ignore.
    template <class T>
    Range range(const T* min, const T* max) const {
        Range result{-infinity<R>(), infinity<R>()};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const R low = (R(min[axis]) - low_org_[axis]) * inverse_[axis];
            const R high = (R(max[axis]) - high_org_[axis]) * inverse_[axis];
            result.near = maximum(result.near, negative_[axis] ? high : low);
            result.far = minimum(result.far, negative_[axis] ? low : high);
        }
        return result;
    }

private:
    void set_axis(std::size_t axis, R org, R dir, R pad) {
        inverse_[axis] = 1 / dir;
        negative_[axis] = inverse_[axis] < 0;
        low_org_[axis] = org + pad;
        high_org_[axis] = org - pad;
    }

    std::array<R, 3> inverse_, low_org_, high_org_;
    std::array<bool, 3> negative_;
};

template <class R>
Bounds<R> bounds_of(const BvhNode& node) {
    return {{R(node.min[0]), R(node.min[1]), R(node.min[2])}, {R(node.max[0]), R(node.max[1]), R(node.max[2])}};
}

/// Calls leaf(first, count) for the leaves whose boxes the ray meets in [t_min, nearest], near ones first, until it
/// returns true. `leaf` may lower `nearest`. Boxes at exactly `nearest` are looked at, for the sake of ties.
template <class R, class Leaf>
void traverse(const BvhNode* nodes, const SlabRay<R>& slabs, R t_min, const R& nearest, Leaf&& leaf) {
    struct Entry {
        std::uint32_t node;
        R near;
    };
    std::array<Entry, bvh_max_depth> stack;
    std::size_t size = 0;
    const auto met = [&](const typename SlabRay<R>::Range& range) {
        return range.near <= range.far && range.far >= t_min && range.near <= nearest;
    };
    if (!met(slabs.range(nodes[0].min, nodes[0].max))) {
        return;
    }
    std::uint32_t current = 0;
    while (true) {
        const BvhNode& node = nodes[current];
        bool descended = false;
        if (node.count > 0) {
            if (leaf(node.first, node.count)) {
                return;
            }
        } else {
            const BvhNode& left = nodes[node.first];
            const BvhNode& right = nodes[node.first + 1];
            const auto left_range = slabs.range(left.min, left.max);
            const auto right_range = slabs.range(right.min, right.max);
            const bool left_met = met(left_range), right_met = met(right_range);
            const bool right_first = right_met && (!left_met || right_range.near < left_range.near);
            current = node.first + (right_first ? 1U : 0U);
            if (left_met && right_met) {
                stack[size++] = right_first ? Entry{node.first, left_range.near}
                                            : Entry{node.first + 1, right_range.near};
            }
            descended = left_met || right_met;
        }
        while (!descended) {
            if (size == 0) {
                return;
            }
            const Entry& entry = stack[--size];
            current = entry.node;
            descended = entry.near <= nearest;
        }
    }
}

} // namespace scc::runtime
