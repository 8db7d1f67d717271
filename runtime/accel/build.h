#pragma once

#include "runtime/accel/build_bvh.h"
#include "runtime/primitive.h"

#include <utility>

namespace scc::runtime {

/// Three indices per triangle. `normals` and `normal_indices` empty: flat; else as many normal indices as
/// indices.
inline MeshStorage build_mesh(std::vector<float> positions, const std::vector<std::uint32_t>& indices,
                              std::vector<float> normals = {},
                              std::vector<std::uint32_t> normal_indices = {}) {
    const std::size_t count = indices.size() / 3;
    std::vector<Bounds<float>> boxes(count);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        boxes[i / 3].add(read_vector<float>(positions.data(), indices[i]));
    }
    Bvh bvh = build_bvh(boxes);
    MeshStorage mesh;
    mesh.triangles.reserve(count);
    for (const std::uint32_t id : bvh.order) {
        const std::uint32_t* corner = &indices[std::size_t{3} * id];
        mesh.triangles.push_back({{corner[0], corner[1], corner[2]}, id});
    }
    mesh.positions = std::move(positions);
    mesh.normals = std::move(normals);
    mesh.normal_indices = std::move(normal_indices);
    mesh.nodes = std::move(bvh.nodes);
    return mesh;
}

namespace detail {

template <class S, std::uint32_t kind>
void collect_bounds(const S& scene, std::vector<Bounds<float>>& boxes, std::vector<PrimitiveRef>& refs) {
    using R = typename S::Real;
    if constexpr (uses_kind(S::traits, kind) && is_bounded<ShapeOfKind<R, kind>>) {
        const auto& table = scene.primitives(Of<PrimitiveOfKind<R, kind>>{});
        for (std::size_t i = 0; i < table.size(); ++i) {
            boxes.push_back(round_outwards(bounds_of(scene, table[i])));
            refs.push_back({kind, static_cast<std::uint32_t>(i)});
        }
    }
}

} // namespace detail

/// The hierarchy over the scene's bounded shapes, however few.
template <SceneModel S>
Accelerator build_accelerator(const S& scene) {
    std::vector<Bounds<float>> boxes;
    std::vector<PrimitiveRef> refs;
    [&]<std::uint32_t... kind>(std::integer_sequence<std::uint32_t, kind...>) {
        (detail::collect_bounds<S, kind>(scene, boxes, refs), ...);
    }
    (std::make_integer_sequence<std::uint32_t, primitive_kinds>{});
    Bvh bvh = build_bvh(boxes);
    Accelerator result;
    result.nodes = std::move(bvh.nodes);
    result.primitives.reserve(refs.size());
    for (const std::uint32_t i : bvh.order) {
        result.primitives.push_back(refs[i]);
    }
    return result;
}

template <SceneModel S>
std::size_t bounded_primitives(const S& scene) {
    const auto count = [&]<std::uint32_t kind>(std::integral_constant<std::uint32_t, kind>) -> std::size_t {
        using R = typename S::Real;
        if constexpr (uses_kind(S::traits, kind) && is_bounded<ShapeOfKind<R, kind>>) {
            return scene.primitives(Of<PrimitiveOfKind<R, kind>>{}).size();
        } else {
            return 0;
        }
    };
    return [&]<std::uint32_t... kind>(std::integer_sequence<std::uint32_t, kind...>) {
        return (count(std::integral_constant<std::uint32_t, kind>{}) + ...);
    }
    (std::make_integer_sequence<std::uint32_t, primitive_kinds>{});
}

/// To be called when the tables and meshes are filled, before rendering.
template <SceneModel S>
void prepare(S& scene) {
    if constexpr (S::traits.accelerator) {
        scene.accelerator =
            bounded_primitives(scene) > accelerator_threshold ? build_accelerator(scene) : Accelerator{};
    }
}

} // namespace scc::runtime
