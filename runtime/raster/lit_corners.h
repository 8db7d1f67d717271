#pragma once

#include "runtime/raster/corners.h"
#include "runtime/raster/screen_triangle.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace scc::runtime::raster {

/// What lighting needs of several triangles' corners, in the world; each triangle is a lane.
template <class L>
struct LitCorners {
    std::array<Vec3<L>, 3> points;
    std::array<L, 3> weights; ///< 0: the corner is a direction
    std::array<Vec3<L>, 3> normals;
    Vec3<L> geometric; ///< on the front side
    L side;            ///< -1: seen from behind
    IndexOf<L> material;
};

/// Triangles with the same value can be looked up together.
template <class R>
const RasterSurface<R>* placed_by(const RasterSurface<R>& surface) {
    return surface.is_placed ? &surface : nullptr;
}

/// Of triangles by their ids (see screen_triangle.h), with the same placed_by(). Not `two_sided`: backs have
/// the front's material.
template <bool two_sided, class L, class Meshes>
LitCorners<L> lit_corners(
    const RasterModel<RealOf<L>>& model, const Meshes& meshes,
    const std::array<const RasterSurface<RealOf<L>>*, static_cast<std::size_t>(lane_count<L>)>& surfaces,
    const std::array<std::uint32_t, static_cast<std::size_t>(lane_count<L>)>& ids) {
    using R = RealOf<L>;
    constexpr auto N = static_cast<std::size_t>(lane_count<L>);
    R values[23][N];
    typename IndexOf<L>::Number materials[N];
    for (std::size_t k = 0; k < N; ++k) {
        const RasterSurface<R>& surface = *surfaces[k];
        const std::uint32_t i = (ids[k] & triangle_number) - surface.first;
        const WorldTriangle<R> t = stored_triangle(model, meshes, surface, i);
        const auto normals = stored_normals(model, meshes, surface, i);
        for (std::size_t c = 0; c < 3; ++c) {
            values[4 * c][k] = t.corners[c].x;
            values[4 * c + 1][k] = t.corners[c].y;
            values[4 * c + 2][k] = t.corners[c].z;
            values[4 * c + 3][k] = t.weights[c];
            values[12 + 3 * c][k] = normals[c].x;
            values[13 + 3 * c][k] = normals[c].y;
            values[14 + 3 * c][k] = normals[c].z;
        }
        const bool back = (ids[k] & seen_from_back) != 0;
        values[21][k] = surface.is_mirrored ? R(-1) : R(1);
        values[22][k] = back ? R(-1) : R(1);
        materials[k] = two_sided && back ? surface.sides.back : surface.sides.front;
    }
    const auto number = [&](std::size_t n) {
        L result;
        std::memcpy(&result.v, values[n], sizeof result.v);
        return result;
    };
    const auto vector = [&](std::size_t n) { return Vec3<L>{number(n), number(n + 1), number(n + 2)}; };
    LitCorners<L> result;
    for (std::size_t c = 0; c < 3; ++c) {
        result.points[c] = vector(4 * c);
        result.weights[c] = number(4 * c + 3);
        result.normals[c] = vector(12 + 3 * c);
    }
    if (const RasterSurface<R>* placed = placed_by(*surfaces[0])) {
        for (std::size_t c = 0; c < 3; ++c) {
            result.points[c] = transform_point(placed->world_from_object, result.points[c]);
            result.normals[c] = transform_normal(placed->object_from_world, result.normals[c]);
        }
    }
    const auto edge = [&](std::size_t c) { return result.points[c] - result.points[0] * result.weights[c]; };
    result.geometric = normalize(cross(edge(1), edge(2))) * number(21);
    result.side = number(22);
    std::memcpy(&result.material.v, materials, sizeof materials);
    for (Vec3<L>& normal : result.normals) { // those that a mesh lacks
        const MaskOf<L> missing = (normal.x == 0) & (normal.y == 0) & (normal.z == 0);
        normal = choose(missing, result.geometric, normal);
    }
    return result;
}

} // namespace scc::runtime::raster
