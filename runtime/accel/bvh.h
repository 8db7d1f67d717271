#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/bounds.h"
#include "runtime/ray.h"

#include <array>
#include <cstddef>
#include <utility>

namespace scc::runtime {

/// Rays made ready for tests against the boxes of one hierarchy. Errs on the side of a hit: the boxes grow by
/// `pad`, 16 roundings of the largest difference between a coordinate of theirs and the origin, which exceeds
/// what the slab test itself and the primitives' tests lose. (An absolute pad and not a relative one on t,
/// after T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013: the primitive's error is across the ray.)
template <class L>
class SlabRay {
public:
    struct Range {
        L near, far; ///< near > far: missed
    };

    SlabRay(const Ray<L>& ray, const Bounds<RealOf<L>>& root) {
        const Vec3<L> reach =
            maximum(absolute(lanes<L>(root.min) - ray.org), absolute(lanes<L>(root.max) - ray.org));
        const L pad = 16 * roundoff<L>() * largest_component(reach);
        set_axis(0, ray.org.x, ray.dir.x, pad);
        set_axis(1, ray.org.y, ray.dir.y, pad);
        set_axis(2, ray.org.z, ray.dir.z, pad);
    }

    /// The stretch of the ray in a box with these corners. Monotonic: a box inside another has a range inside
    /// the other's, also as rounded. A direction component of 0 gives infinities of the right sign, or a NaN
    /// on the face, which minimum and maximum ignore.
    template <class T>
    Range range(const T* min, const T* max) const {
        Range result{-infinity<L>(), infinity<L>()};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const L low = (to_lane(min[axis]) - low_org_[axis]) * inverse_[axis];
            const L high = (to_lane(max[axis]) - high_org_[axis]) * inverse_[axis];
            result.near = maximum(result.near, choose(negative_[axis], high, low));
            result.far = minimum(result.far, choose(negative_[axis], low, high));
        }
        return result;
    }

private:
    static L to_lane(float x) { return L(static_cast<RealOf<L>>(x)); }
    template <class T>
    static L to_lane(const T& x) {
        return L(x);
    }

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

template <class R>
Bounds<R> bounds_of(const BvhNode& node) {
    return {{R(node.min[0]), R(node.min[1]), R(node.min[2])},
            {R(node.max[0]), R(node.max[1]), R(node.max[2])}};
}

/// Calls leaf(first, count) for the leaves whose boxes some ray meets in [t_min, nearest], near ones first,
/// until it returns true. `leaf` may lower `nearest`. Boxes at exactly `nearest` are looked at, for the sake
/// of ties. The lanes share one path; a lane with nearest < t_min takes no part.
template <class L, class Leaf>
void traverse(const BvhNode* nodes, const SlabRay<L>& slabs, const L& t_min, const L& nearest, Leaf&& leaf) {
    struct Entry {
        std::uint32_t node;
        L near; ///< infinity in lanes that miss
    };
    std::array<Entry, bvh_max_depth> stack;
    std::size_t size = 0;
    const auto entry_of = [&](std::uint32_t node) {
        const auto range = slabs.range(nodes[node].min, nodes[node].max);
        const MaskOf<L> met = (range.near <= range.far) & (range.far >= t_min) & (t_min <= nearest);
        return Entry{node, choose(met, range.near, infinity<L>())};
    };
    const auto is_due = [&](const Entry& entry) {
        return any((entry.near <= nearest) & (entry.near < infinity<L>()));
    };
    stack[size++] = entry_of(0);
    while (size > 0) {
        Entry current = stack[--size];
        if (!is_due(current)) {
            continue;
        }
        while (nodes[current.node].count == 0) {
            const std::uint32_t child = nodes[current.node].first;
            Entry near = entry_of(child), far = entry_of(child + 1);
            if (none(near.near < far.near)) {
                std::swap(near, far);
            }
            if (is_due(far)) {
                stack[size++] = far;
            }
            current = near;
            if (!is_due(current)) {
                break;
            }
        }
        const BvhNode& node = nodes[current.node];
        if (node.count > 0 && is_due(current) && leaf(node.first, node.count)) {
            return;
        }
    }
}

} // namespace scc::runtime
