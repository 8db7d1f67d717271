#pragma once

#include "runtime/accel/bvh_node.h"
#include "runtime/math/vec.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scc::runtime {

/// A triangle mesh in object space as the kernels read it. Owns nothing: a program may map the arrays from a
/// file. All of them are plain numbers without padding.
///
/// `triangles` holds ten words for each triangle, in the order of the hierarchy's leaves; a leaf with n
/// triangles has n x coordinates of first corners, n y, n z, those of the second and third corners, and n
/// numbers that the triangles have in the source. So the triangles of a leaf fill lanes by plain loads, and
/// nothing is padded but the end, by `triangle_padding` words. Corners are seen counter-clockwise from the
/// front.
struct MeshData {
    const BvhNode* nodes = nullptr;
    const float* triangles = nullptr;
    const float* normals = nullptr;                ///< x y z each, or null: flat
    const std::uint32_t* normal_indices = nullptr; ///< 3 per triangle, by its number in the source
    const float* uvs = nullptr;                    ///< u v each, or null
    const std::uint32_t* uv_indices = nullptr;     ///< 3 per triangle, by its number in the source
    std::uint32_t node_count = 0;
    std::uint32_t triangle_count = 0;
    std::uint32_t normal_count = 0;
    std::uint32_t uv_count = 0;
    std::array<float, 3> min{}; ///< of all triangles, if there are any
    std::array<float, 3> max{};
};

inline constexpr std::size_t words_per_triangle = 10;
inline constexpr std::size_t triangle_padding = 16;
constexpr std::size_t triangle_words(std::uint32_t triangles) {
    return triangles == 0 ? 0 : words_per_triangle * triangles + triangle_padding;
}
constexpr std::uint32_t triangles_in(std::size_t words) {
    return words == 0 ? 0 : static_cast<std::uint32_t>((words - triangle_padding) / words_per_triangle);
}

/// A triangle's place in a mesh, as ShapeHit::part has it.
struct TrianglePlace {
    std::uint32_t first; ///< of its leaf
    std::uint32_t count; ///< of its leaf
    std::uint32_t which; ///< in its leaf
};
inline constexpr std::uint32_t mesh_most_triangles = 1U << 28;

constexpr std::uint32_t part_of(const TrianglePlace& place) {
    return place.first << 4 | place.which << 2 | (place.count - 1);
}
constexpr TrianglePlace place_of(std::uint32_t part) {
    return {part >> 4, (part & 3U) + 1, part >> 2 & 3U};
}

/// Word `component` (0..8 the corners, 9 the number) of a triangle.
inline const float* triangle_word(const MeshData& mesh, const TrianglePlace& place, std::uint32_t component) {
    return mesh.triangles + words_per_triangle * place.first + component * place.count + place.which;
}
inline std::uint32_t triangle_id(const MeshData& mesh, const TrianglePlace& place) {
    return std::bit_cast<std::uint32_t>(*triangle_word(mesh, place, 9));
}

/// The owner behind a MeshData that was built in this process (build_mesh in accel/build.h).
struct MeshStorage {
    std::vector<BvhNode> nodes;
    std::vector<float> triangles;
    std::vector<float> normals;
    std::vector<std::uint32_t> normal_indices;
    std::array<float, 3> min{};
    std::array<float, 3> max{};

    MeshData data() const {
        const bool smooth = !normals.empty();
        return {nodes.data(),
                triangles.data(),
                smooth ? normals.data() : nullptr,
                smooth ? normal_indices.data() : nullptr,
                nullptr,
                nullptr,
                static_cast<std::uint32_t>(nodes.size()),
                triangles_in(triangles.size()),
                static_cast<std::uint32_t>(normals.size() / 3),
                0,
                min,
                max};
    }
};

} // namespace scc::runtime
