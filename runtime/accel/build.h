#pragma once

#include "runtime/accel/build_bvh.h"
#include "runtime/primitive.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace scc::runtime {

struct BuildOptions {
    int threads = 1;
    BuildQuality quality = BuildQuality::high;
};

namespace detail {

/// What a loader has of a triangle mesh: three indices per triangle.
struct MeshSource {
    std::span<const float> positions;
    std::span<const std::uint32_t> indices;

    Vec3<float> corner(std::size_t triangle, std::size_t i) const {
        return read_vector<float>(positions.data(), indices[3 * triangle + i]);
    }
};

inline constexpr std::size_t triangles_per_task = 16384;

inline std::vector<BoxRef> triangle_boxes(const MeshSource& source, int threads) {
    const std::size_t count = source.indices.size() / 3;
    std::vector<BoxRef> refs(count);
    share_work((count + triangles_per_task - 1) / triangles_per_task, threads, [&](std::size_t task) {
        const std::size_t end = std::min(count, (task + 1) * triangles_per_task);
        for (std::size_t i = task * triangles_per_task; i < end; ++i) {
            Bounds<float> box;
            for (std::size_t k = 0; k < 3; ++k) {
                box.add(source.corner(i, k));
            }
            refs[i] = box_ref(box, static_cast<std::uint32_t>(i));
        }
    });
    return refs;
}

/// Writes a leaf's words as MeshData describes them.
inline void store_leaf(const MeshSource& source, const Bvh& bvh, const BvhLeaf& leaf, float* triangles) {
    float* words = triangles + words_per_triangle * leaf.first;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        const std::uint32_t id = bvh.order[leaf.first + i];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3<float> corner = source.corner(id, k);
            words[(3 * k + 0) * leaf.count + i] = corner.x;
            words[(3 * k + 1) * leaf.count + i] = corner.y;
            words[(3 * k + 2) * leaf.count + i] = corner.z;
        }
        words[9 * leaf.count + i] = std::bit_cast<float>(id);
    }
}

inline Bounds<float> root_bounds(const std::vector<BvhNode>& nodes) {
    Bounds<float> box;
    if (!nodes.empty()) {
        for (std::size_t i = 0; i < bvh_width; ++i) {
            box.add(box_of(nodes[0], i));
        }
    }
    return box;
}

} // namespace detail

/// Three indices per triangle, of at most mesh_most_triangles. `normals` and `normal_indices` empty: flat;
/// else as many normal indices as indices.
inline MeshStorage build_mesh(std::span<const float> positions, std::span<const std::uint32_t> indices,
                              std::vector<float> normals = {}, std::vector<std::uint32_t> normal_indices = {},
                              const BuildOptions& options = {}) {
    const detail::MeshSource source{positions, indices};
    Bvh bvh = build_bvh(detail::triangle_boxes(source, options.threads), options.threads, options.quality);
    MeshStorage mesh;
    mesh.normals = std::move(normals);
    mesh.normal_indices = std::move(normal_indices);
    if (bvh.nodes.empty()) {
        return mesh;
    }
    mesh.triangles.resize(triangle_words(static_cast<std::uint32_t>(bvh.order.size())));
    constexpr std::size_t nodes_per_task = 1024;
    detail::share_work((bvh.nodes.size() + nodes_per_task - 1) / nodes_per_task, options.threads,
                       [&](std::size_t task) {
                           const std::size_t end = std::min(bvh.nodes.size(), (task + 1) * nodes_per_task);
                           for (std::size_t n = task * nodes_per_task; n < end; ++n) {
                               for (const std::uint32_t child : bvh.nodes[n].child) {
                                   if (is_leaf(child)) {
                                       detail::store_leaf(source, bvh, leaf_of(child), mesh.triangles.data());
                                   }
                               }
                           }
                       });
    const Bounds<float> box = detail::root_bounds(bvh.nodes);
    mesh.min = {box.min.x, box.min.y, box.min.z};
    mesh.max = {box.max.x, box.max.y, box.max.z};
    mesh.nodes = std::move(bvh.nodes);
    return mesh;
}

namespace detail {

/// How wide a beam may be: the more shapes there are, the smaller is what lies between them. The best of what
/// was tried on scenes of 300 to 16000 shapes.
inline float spread_for(std::size_t shapes) {
    return std::clamp(2 / std::sqrt(static_cast<float>(shapes)), 0.01F, 0.15F);
}

} // namespace detail

/// The hierarchy over the scene's bounded shapes, however few.
template <SceneModel S>
Accelerator build_accelerator(const S& scene, const BuildOptions& options = {}) {
    std::vector<BoxRef> boxes;
    std::vector<PrimitiveRef> refs;
    for_each_bounded(scene, [&]<std::uint32_t kind>(const auto& primitive, std::uint32_t index) {
        boxes.push_back(
            box_ref(round_outwards(bounds_of(scene, primitive)), static_cast<std::uint32_t>(refs.size())));
        refs.push_back({kind, index});
    });
    // One in a leaf: a box that most rays and whole beams miss costs far less than a shape's own test.
    Bvh bvh = build_bvh(std::move(boxes), options.threads, options.quality, 1);
    Accelerator result;
    result.box = detail::root_bounds(bvh.nodes);
    result.most_spread = detail::spread_for(refs.size());
    result.nodes = std::move(bvh.nodes);
    result.primitives.reserve(refs.size());
    for (const std::uint32_t i : bvh.order) {
        result.primitives.push_back(refs[i]);
    }
    return result;
}

template <SceneModel S>
std::size_t bounded_primitives(const S& scene) {
    std::size_t count = 0;
    for_each_bounded(scene, [&]<std::uint32_t>(const auto&, std::uint32_t) { ++count; });
    return count;
}

/// To be called when the tables and meshes are filled, before rendering.
template <SceneModel S>
void prepare(S& scene, const BuildOptions& options = {}) {
    if constexpr (S::traits.accelerator) {
        scene.accelerator = bounded_primitives(scene) > accelerator_threshold
                                ? build_accelerator(scene, options)
                                : Accelerator{};
    }
}

} // namespace scc::runtime
