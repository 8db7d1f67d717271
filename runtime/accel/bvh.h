#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/accel/slabs.h"
#include "runtime/bounds.h"
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

/// Of one of the node's children.
inline Bounds<float> box_of(const BvhNode& node, std::size_t slot) {
    return {{node.min[0][slot], node.min[1][slot], node.min[2][slot]},
            {node.max[0][slot], node.max[1][slot], node.max[2][slot]}};
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

/// The search of up to n single rays, which take turns: while one waits for what it has read or calculated,
/// the others go on, and hardly a branch depends on what is found. A child and its distance are one word,
/// sorted as a number.
template <class R, int n>
class RaysInTurns {
public:
    static_assert(n <= 64, "sets of rays are bits");

    /// The rays from `first` on, as many as L has lanes, of which those in `active` take part.
    template <class L>
    void add(std::size_t first, const SlabRay<L>& slabs, const L& t_min, const MaskOf<L>& active) {
        boxes_.set(first, slabs, t_min);
        active_ |= std::uint64_t{bits(active)} << first;
    }

    /// Calls leaf(ray, first, count) for the leaves whose boxes a ray meets in [t_min, nearest[ray]], near
    /// ones first, until it returns true. `leaf` may lower nearest[ray]. Boxes at exactly `nearest` are
    /// looked at, for the sake of ties.
    template <class Leaf>
    void run(const BvhNode* nodes, const R* nearest, Leaf&& leaf) {
        // The rays, as bits, by the two uppermost bits of the child they are at: a node, the end, leaves.
        std::uint64_t at[4] = {std::exchange(active_, 0), 0, 0, 0};
        for_each_in(at[0], [&](std::size_t ray) {
            child_[ray] = 0;
            stack_[ray] = the_end;
            top_[ray] = stack_ + ray + n;
        });
        const auto go_on = [&](std::size_t ray, std::uint64_t* top) {
            const std::uint32_t child = child_[ray] = pop(ray, top, nearest[ray]);
            at[child >> 30] |= std::uint64_t{1} << ray;
        };
        do {
            for_each_in(std::exchange(at[0], 0), [&](std::size_t ray) {
                go_on(ray, push_children(ray, nodes[child_[ray]], nearest[ray]));
            });
            for_each_in(std::exchange(at[2], 0) | std::exchange(at[3], 0), [&](std::size_t ray) {
                const BvhLeaf found = leaf_of(child_[ray]);
                if (!leaf(ray, found.first, found.count)) {
                    go_on(ray, top_[ray]);
                }
            });
        } while ((at[0] | at[2] | at[3]) != 0);
    }

private:
    /// Neither a node's index nor a leaf; at distance 0, so that it is always due.
    static constexpr std::uint32_t the_end = 1U << 30;

    template <class F>
    static void for_each_in(std::uint64_t rays, F&& f) {
        for (; rays != 0; rays &= rays - 1) {
            f(static_cast<std::size_t>(__builtin_ctzll(rays)));
        }
    }

    /// Puts the node's children that the ray meets on its stack, the nearest on top, and returns where it
    /// ends then. Few nodes have more than two such children, so that these go without a branch.
    std::uint64_t* push_children(std::size_t ray, const BvhNode& node, R nearest) const {
        alignas(64) R near[bvh_width];
        const unsigned met = boxes_(ray, node, nearest, near);
        const auto word = [&](int slot) {
            return std::uint64_t{distance_key(near[slot])} << 32 | node.child[slot];
        };
        const std::uint64_t first = word(__builtin_ctz(met | 1U << (bvh_width - 1)));
        const std::uint64_t last = word(31 - __builtin_clz(met | 1U)); // the same if it is the only one
        std::uint64_t* const top = top_[ray];
        top[0] = first < last ? last : first;
        top[n] = first < last ? first : last;
        const int count = __builtin_popcount(met);
        if (count > 2) [[unlikely]] {
            std::uint64_t* end = top + 2 * n;
            for (unsigned left = met & (met - 1); (left & (left - 1)) != 0; left &= left - 1) {
                const std::uint64_t other = word(__builtin_ctz(left));
                std::uint64_t* place = end;
                for (; place > top && place[-n] < other; place -= n) {
                    *place = place[-n];
                }
                *place = other;
                end += n;
            }
        }
        return top + count * n;
    }

    /// The child on top of the ray's stack that is still due.
    std::uint32_t pop(std::size_t ray, std::uint64_t* top, R nearest) {
        const std::uint32_t limit = distance_key(nearest);
        do {
            top -= n;
        } while (*top >> 32 > limit);
        top_[ray] = top;
        return static_cast<std::uint32_t>(*top);
    }

    BoxTests<R, n> boxes_;
    std::uint64_t active_ = 0;
    std::uint32_t child_[n];                        ///< where a ray is
    std::uint64_t* top_[n];                         ///< after the last entry of its stack
    std::uint64_t stack_[(bvh_stack_size + 1) * n]; ///< every n-th entry is one ray's
};

/// A ray by itself waits for one node after the other, so what counts here is how soon the next is known.
template <class R>
class RaysInTurns<R, 1> {
public:
    void add(std::size_t, const SlabRay<R>& slabs, R t_min, bool active) {
        box_.set(0, slabs, t_min);
        active_ = active;
    }

    template <class Leaf>
    void run(const BvhNode* nodes, const R* nearest, Leaf&& leaf) {
        if (!std::exchange(active_, false)) {
            return;
        }
        std::array<std::uint64_t, bvh_stack_size> stack;
        std::uint64_t* top = stack.data();
        std::uint32_t child = 0;
        R limit = *nearest;
        for (;;) {
            if (!is_leaf(child)) {
                const BvhNode& node = nodes[child];
                alignas(64) R near[bvh_width];
                unsigned met = box_(0, node, limit, near);
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
                if (leaf(std::size_t{0}, found.first, found.count)) {
                    return;
                }
                limit = *nearest;
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

private:
    BoxTests<R, 1> box_;
    bool active_ = false;
};

} // namespace scc::runtime
