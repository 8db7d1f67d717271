#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/accel/slabs.h"
#include "runtime/math/pack.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace scc::runtime {

/// Asks for memory that will be read soon.
inline void prefetch_bytes(const void* from, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += 64) {
        __builtin_prefetch(static_cast<const char*>(from) + i);
    }
}
inline void prefetch_node(const BvhNode& node) {
    prefetch_bytes(&node, sizeof node);
}

/// Visits the leaves that a test admits, near ones first. `test(node, near)` returns the node's children to
/// visit as bits and fills in where they begin; `is_due(near)` asks again before a visit, since what was
/// found meanwhile may lie before it; `leaf(node, slot, leaf)` returns true to end the search.
template <class Near, class Test, class IsDue, class Prefetch, class Leaf>
void traverse(const BvhNode* nodes, Test&& test, IsDue&& is_due, Prefetch&& prefetch, Leaf&& leaf) {
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
            const std::uint32_t child = nodes[node].child[slot];
            if (is_leaf(child)) {
                prefetch(leaf_of(child));
            } else {
                prefetch_node(nodes[child]);
            }
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

/// A distance >= 0 as a whole number, rounded down; the order stays.
template <class R>
std::uint32_t distance_key(R t) {
    if constexpr (sizeof(R) == sizeof(float)) {
        return std::bit_cast<std::uint32_t>(t);
    } else if constexpr (sizeof(R) == sizeof(double)) {
        return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(t) >> 32);
    } else {
        const std::uint32_t key = distance_key(static_cast<double>(t)); // which may have rounded up
        return key == 0 ? 0 : key - 1;
    }
}

/// Calls leaf(first, count) for the leaves whose boxes the ray meets in [t_min, nearest], near ones first,
/// until it returns true. `leaf` may lower `nearest`. Boxes at exactly `nearest` are looked at, for the sake
/// of ties. One ray waits for one node after the other, so what counts here is how soon the next is known: a
/// child and its distance are one word, sorted as a number.
template <class R, class Leaf>
void traverse_ray(const BvhNode* nodes, const SlabRay<R>& slabs, R t_min, const R& nearest, Leaf&& leaf) {
    std::array<std::uint64_t, bvh_stack_size> stack;
    std::uint64_t* top = stack.data();
    const BoxTest<R> test(slabs, t_min);
    std::uint32_t child = 0;
    R limit = nearest;
    for (;;) {
        if (!is_leaf(child)) {
            const BvhNode& node = nodes[child];
            alignas(64) R near[bvh_width];
            unsigned met = test(node, limit, near);
            if (met != 0) {
                const auto take = [&] {
                    const auto slot = static_cast<std::size_t>(__builtin_ctz(met));
                    met &= met - 1;
                    return std::uint64_t{distance_key(near[slot])} << 32 | node.child[slot];
                };
                std::uint64_t best = take();
                std::uint64_t* const base = top;
                while (met != 0) {
                    std::uint64_t other = take();
                    if (other < best) {
                        std::swap(other, best);
                    }
                    std::uint64_t* place = top++;
                    for (; place > base && place[-1] < other; --place) {
                        *place = place[-1];
                    }
                    *place = other;
                }
                child = static_cast<std::uint32_t>(best);
                continue;
            }
        } else {
            const BvhLeaf found = leaf_of(child);
            if (leaf(found.first, found.count)) {
                return;
            }
            limit = nearest;
        }
        do {
            if (top == stack.data()) {
                return;
            }
            --top;
        } while (*top >> 32 > distance_key(limit));
        child = static_cast<std::uint32_t>(*top);
    }
}

} // namespace scc::runtime
