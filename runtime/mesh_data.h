#pragma once

#include "runtime/accel/bvh_node.h"

#include <cstdint>
#include <vector>

namespace scc::runtime {

/// 16 bytes. Corners as seen counter-clockwise from the front.
struct MeshTriangle {
    std::uint32_t corners[3]; ///< indices into positions
    std::uint32_t id;         ///< in the source; of two hits at equal distance the smaller counts
};
static_assert(sizeof(MeshTriangle) == 16);

/// A triangle mesh in object space as the kernels read it. Owns nothing: a program may map the arrays from a
/// file. All of them are plain numbers without padding.
struct MeshData {
    const float* positions = nullptr; ///< x y z each
    const float* normals = nullptr;   ///< x y z each, or null: flat
    const std::uint32_t* normal_indices =
        nullptr;                             ///< 3 per triangle, by MeshTriangle::id; null where normals is
    const MeshTriangle* triangles = nullptr; ///< in the order of the hierarchy's leaves
    const BvhNode* nodes = nullptr;
    std::uint32_t position_count = 0;
    std::uint32_t normal_count = 0;
    std::uint32_t triangle_count = 0;
    std::uint32_t node_count = 0;
};

/// The owner behind a MeshData that was built in this process (build_mesh in accel/build.h).
struct MeshStorage {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<std::uint32_t> normal_indices;
    std::vector<MeshTriangle> triangles;
    std::vector<BvhNode> nodes;

    MeshData data() const {
        const bool smooth = !normals.empty();
        return {positions.data(),
                smooth ? normals.data() : nullptr,
                smooth ? normal_indices.data() : nullptr,
                triangles.data(),
                nodes.data(),
                static_cast<std::uint32_t>(positions.size() / 3),
                static_cast<std::uint32_t>(normals.size() / 3),
                static_cast<std::uint32_t>(triangles.size()),
                static_cast<std::uint32_t>(nodes.size())};
    }
};

} // namespace scc::runtime
