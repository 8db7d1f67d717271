#pragma once

#include <cstdint>

namespace scc::runtime {

inline constexpr int bvh_width = 8;
inline constexpr std::uint32_t bvh_max_leaf = 4;

/// A node with up to eight children, 224 bytes. Bounds are rounded outwards; a slot without a child has a box
/// that nothing meets (min = infinity, max = -infinity). The root is nodes[0] and never a leaf.
struct alignas(32) BvhNode {
    float min[3][bvh_width];
    float max[3][bvh_width];
    std::uint32_t child[bvh_width]; ///< an inner node's index or, with leaf_bit, a leaf (see leaf_of)

    static constexpr std::uint32_t leaf_bit = 1U << 31;
};
static_assert(sizeof(BvhNode) == 224);

/// The primitives [first, first + count) of the order that the builder returns.
struct BvhLeaf {
    std::uint32_t first;
    std::uint32_t count; ///< 1..bvh_max_leaf
};
inline constexpr std::uint32_t bvh_most_primitives = 1U << 29;

constexpr std::uint32_t child_of(const BvhLeaf& leaf) {
    return BvhNode::leaf_bit | (leaf.count - 1) << 29 | leaf.first;
}
constexpr bool is_leaf(std::uint32_t child) {
    return (child & BvhNode::leaf_bit) != 0;
}
constexpr BvhLeaf leaf_of(std::uint32_t child) {
    return {child & (bvh_most_primitives - 1), (child >> 29 & 3U) + 1};
}

/// No path from the root has more nodes; the builder sees to it.
inline constexpr int bvh_max_depth = 64;
/// What a traversal has to remember at most.
inline constexpr int bvh_stack_size = (bvh_width - 1) * bvh_max_depth + 1;

} // namespace scc::runtime
