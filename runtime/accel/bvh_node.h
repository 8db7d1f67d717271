#pragma once

#include <cstdint>

namespace scc::runtime {

/// 32 bytes. Bounds are rounded outwards. An inner node's children are nodes[first] and nodes[first + 1]; a
/// leaf has the primitives [first, first + count) of the order that the builder returns. The root is
/// nodes[0].
struct BvhNode {
    float min[3];
    float max[3];
    std::uint32_t first;
    std::uint32_t count; ///< 0: inner node
};
static_assert(sizeof(BvhNode) == 32);

/// No path from the root is longer; the builder sees to it, and traversal has a stack of this size.
inline constexpr int bvh_max_depth = 64;

} // namespace scc::runtime
