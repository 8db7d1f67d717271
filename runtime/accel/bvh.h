#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/accel/slabs.h"
#include "runtime/math/pack.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace scc::runtime {

/// Visits the leaves that a test admits, near ones first. `test(node, near)` returns the node's children to
/// visit as bits and fills in where they begin; `is_due(near)` asks again before a visit, since what was
/// found meanwhile may lie before it; `leaf(node, slot, leaf)` returns true to end the search.
template <class Near, class Test, class IsDue, class Leaf>
void traverse(const BvhNode* nodes, Test&& test, IsDue&& is_due, Leaf&& leaf) {
    struct Entry {
        Near near;
        std::uint32_t node, slot;
    };
    std::array<Entry, bvh_stack_size> stack;
    std::size_t size = 0;
    std::uint32_t node = 0;
    for (;;) {
        alignas(64) Near near[bvh_width];
        unsigned met = test(nodes[node], near);
        const std::size_t base = size;
        for (; met != 0; met &= met - 1) {
            const auto slot = static_cast<std::uint32_t>(__builtin_ctz(met));
            std::size_t place = size++;
            for (; place > base && stack[place - 1].near < near[slot]; --place) {
                stack[place] = stack[place - 1];
            }
            stack[place] = {near[slot], node, slot};
        }
        for (;;) {
            if (size == 0) {
                return;
            }
            const Entry entry = stack[--size];
            if (!is_due(entry.near)) {
                continue;
            }
            const BvhNode& parent = nodes[entry.node];
            const std::uint32_t child = parent.child[entry.slot];
            if (!is_leaf(child)) {
                node = child;
                break;
            }
            if (leaf(parent, entry.slot, leaf_of(child))) {
                return;
            }
        }
    }
}

namespace detail {

/// The eight children's numbers as lanes of R, and the lanes' stores.
template <class R>
struct ChildLanes {
    using type = Pack<R, bvh_width>;
};
template <class R>
requires(sizeof(R) > sizeof(double)) struct ChildLanes<R> {
    using type = R;
};

template <class R>
unsigned test_children(const BvhNode& node, const SlabRay<R>& slabs, R t_min, R nearest,
                       R (&near)[bvh_width]) {
    using C = typename ChildLanes<R>::type;
    unsigned met = 0;
    for (int i = 0; i < bvh_width; i += lane_count<C>) {
        const C min[3] = {load_lanes<C>(node.min[0] + i), load_lanes<C>(node.min[1] + i),
                          load_lanes<C>(node.min[2] + i)};
        const C max[3] = {load_lanes<C>(node.max[0] + i), load_lanes<C>(node.max[1] + i),
                          load_lanes<C>(node.max[2] + i)};
        const auto range = slabs.range(min, max);
        const MaskOf<C> here =
            (range.near <= range.far) & (range.far >= C(t_min)) & (range.near <= C(nearest));
        met |= bits(here) << i;
        store_lanes(near + i, range.near);
    }
    return met;
}

} // namespace detail

/// Calls leaf(first, count) for the leaves whose boxes the ray meets in [t_min, nearest], near ones first,
/// until it returns true. `leaf` may lower `nearest`. Boxes at exactly `nearest` are looked at, for the sake
/// of ties.
template <class R, class Leaf>
void traverse_ray(const BvhNode* nodes, const SlabRay<R>& slabs, R t_min, const R& nearest, Leaf&& leaf) {
    traverse<R>(
        nodes,
        [&](const BvhNode& node, R(&near)[bvh_width]) {
            return detail::test_children(node, slabs, t_min, nearest, near);
        },
        [&](R near) { return near <= nearest; },
        [&](const BvhNode&, std::uint32_t, const BvhLeaf& found) { return leaf(found.first, found.count); });
}

} // namespace scc::runtime
