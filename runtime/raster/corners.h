#pragma once

#include "runtime/mesh_trace.h"
#include "runtime/raster/model.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

/// The corners of a model's triangles, wherever they lie.
namespace scc::runtime::raster {

template <class R>
struct WorldTriangle {
    std::array<Vec3<R>, 3> corners;
    std::array<R, 3> weights{1, 1, 1}; ///< 0: the corner is a direction
};

/// Triangle `i` of those of a surface, in the world or, of a placed mesh, in the mesh's own space. `meshes`:
/// the scene's.
template <class R, class Meshes>
WorldTriangle<R> stored_triangle(const RasterModel<R>& model, const Meshes& meshes,
                                 const RasterSurface<R>& surface, std::uint32_t i) {
    WorldTriangle<R> result;
    if (surface.is_mesh) {
        const MeshData& mesh = meshes[surface.mesh];
        const Corners<R> corners = corners_at<R>(mesh, place_of(model.mesh_parts[surface.mesh][i]));
        result.corners = {corners.a, corners.b, corners.c};
        return result;
    }
    const RasterTriangle& triangle = model.triangles[surface.own + i];
    for (std::size_t k = 0; k < 3; ++k) {
        result.corners[k] = model.positions[triangle.positions[k]];
        result.weights[k] = surface.at_infinity && k != 0 ? R(0) : R(1);
    }
    return result;
}
template <class R, class Meshes>
WorldTriangle<R> world_triangle(const RasterModel<R>& model, const Meshes& meshes,
                                const RasterSurface<R>& surface, std::uint32_t i) {
    WorldTriangle<R> result = stored_triangle(model, meshes, surface, i);
    if (surface.is_placed) {
        for (Vec3<R>& corner : result.corners) {
            corner = transform_point(surface.world_from_object, corner);
        }
    }
    return result;
}

/// The corners of several triangles, each coordinate as a pack.
template <class L>
struct CornerPacks {
    std::array<Vec3<L>, 3> corners;
    std::array<L, 3> weights; ///< 0: the corner is a direction
};

namespace detail {

/// Of a mesh, from triangle `i` on, in its own space: a leaf's corners lie side by side.
template <class L>
std::array<Vec3<L>, 3> corners_in_mesh(const MeshData& mesh, const std::vector<std::uint32_t>& parts,
                                       std::uint32_t i, std::uint32_t count) {
    constexpr std::size_t most = 4; // triangles of a leaf; what a leaf lacks, the next one overwrites
    static_assert(bvh_max_leaf <= most && most <= triangle_padding);
    float numbers[9][lane_count<L> + most] = {};
    for (std::uint32_t k = 0; k < count;) {
        const TrianglePlace place = place_of(parts[i + k]);
        const float* from = triangle_word(mesh, place, 0);
        for (auto& component : numbers) {
            std::memcpy(component + k, std::exchange(from, from + place.count), most * sizeof(float));
        }
        k += place.count - place.which;
    }
    const auto vector = [&](std::size_t n) {
        return Vec3<L>{load_lanes<L>(numbers[n]), load_lanes<L>(numbers[n + 1]),
                       load_lanes<L>(numbers[n + 2])};
    };
    return {vector(0), vector(3), vector(6)};
}

} // namespace detail

/// As world_triangle, of `count` triangles of a surface from `i` on, which L has lanes for; the others have
/// any finite numbers.
template <class L, class Meshes>
CornerPacks<L> world_triangles(const RasterModel<RealOf<L>>& model, const Meshes& meshes,
                               const RasterSurface<RealOf<L>>& surface, std::uint32_t i,
                               std::uint32_t count) {
    using R = RealOf<L>;
    CornerPacks<L> result;
    if (surface.is_mesh) {
        result.corners =
            detail::corners_in_mesh<L>(meshes[surface.mesh], model.mesh_parts[surface.mesh], i, count);
        result.weights.fill(L(1));
        if (surface.is_placed) {
            for (Vec3<L>& corner : result.corners) {
                corner = transform_point(surface.world_from_object, corner);
            }
        }
        return result;
    }
    R numbers[9][lane_count<L>] = {};
    for (std::uint32_t k = 0; k < count; ++k) {
        const RasterTriangle& triangle = model.triangles[surface.own + i + k];
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3<R>& corner = model.positions[triangle.positions[c]];
            numbers[3 * c][k] = corner.x;
            numbers[3 * c + 1][k] = corner.y;
            numbers[3 * c + 2][k] = corner.z;
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
        const auto load = [&](std::size_t n) {
            L pack;
            std::memcpy(&pack.v, numbers[3 * c + n], sizeof pack.v);
            return pack;
        };
        result.corners[c] = {load(0), load(1), load(2)};
        result.weights[c] = L(surface.at_infinity && c != 0 ? R(0) : R(1));
    }
    return result;
}

/// Normals at its corners, for shading, or 0 where a mesh has none; in the world or, of a placed mesh, in the
/// mesh's own space.
template <class R, class Meshes>
std::array<Vec3<R>, 3> stored_normals(const RasterModel<R>& model, const Meshes& meshes,
                                      const RasterSurface<R>& surface, std::uint32_t i) {
    std::array<Vec3<R>, 3> normals{};
    if (!surface.is_mesh) {
        const RasterTriangle& triangle = model.triangles[surface.own + i];
        for (std::size_t k = 0; k < 3; ++k) {
            normals[k] = model.normals[triangle.normals[k]];
        }
        return normals;
    }
    const MeshData& mesh = meshes[surface.mesh];
    if (mesh.normals != nullptr) {
        const TrianglePlace place = place_of(model.mesh_parts[surface.mesh][i]);
        const std::uint32_t* index = mesh.normal_indices + std::size_t{3} * triangle_id(mesh, place);
        for (std::size_t k = 0; k < 3; ++k) {
            normals[k] = read_vector<R>(mesh.normals, index[k]);
        }
    }
    return normals;
}
/// In the world. Those of a placed mesh are not of unit length, so that interpolating them is linear as in
/// its own space.
template <class R, class Meshes>
std::array<Vec3<R>, 3> world_normals(const RasterModel<R>& model, const Meshes& meshes,
                                     const RasterSurface<R>& surface, std::uint32_t i) {
    std::array<Vec3<R>, 3> normals = stored_normals(model, meshes, surface, i);
    if (surface.is_placed) {
        for (Vec3<R>& normal : normals) {
            normal = transform_normal(surface.object_from_world, normal);
        }
    }
    return normals;
}

/// As ShapeHit::part.
template <class R>
std::uint32_t part_of_triangle(const RasterModel<R>& model, const RasterSurface<R>& surface,
                               std::uint32_t i) {
    return surface.is_mesh ? model.mesh_parts[surface.mesh][i] : model.triangles[surface.own + i].part;
}

/// Its number among those of its object in the source.
template <class R, class Meshes>
std::uint32_t rank_of_triangle(const RasterModel<R>& model, const Meshes& meshes,
                               const RasterSurface<R>& surface, std::uint32_t i) {
    return surface.is_mesh ? triangle_id(meshes[surface.mesh], place_of(model.mesh_parts[surface.mesh][i]))
                           : i;
}

/// The surface that a triangle of the model belongs to.
template <class R>
const RasterSurface<R>& surface_of_triangle(const RasterModel<R>& model, std::uint32_t triangle) {
    const auto after =
        std::upper_bound(model.surfaces.begin(), model.surfaces.end(), triangle,
                         [](std::uint32_t t, const RasterSurface<R>& surface) { return t < surface.first; });
    return *std::prev(after);
}

} // namespace scc::runtime::raster
