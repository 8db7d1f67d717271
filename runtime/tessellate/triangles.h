#pragma once

#include "runtime/math/affine.h"
#include "runtime/math/vec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

/// Surfaces as triangles.
namespace scc::runtime {

/// How far a mesh may be from its surface.
template <class R>
struct Tolerance {
    R distance;          ///< of any point of the mesh from the surface
    R angle = R(0.2618); ///< between the normals at a triangle's corners, in radians
};

/// Corners are seen counter-clockwise from the side that the normals point to.
struct Triangle3 {
    std::array<std::uint32_t, 3> positions; ///< indices into Triangles::positions
    std::array<std::uint32_t, 3> normals;   ///< indices into Triangles::normals
    std::uint32_t part = 0;                 ///< of a shape: as ShapeHit::part; of a solid: see solid.h
};

/// Neighbours share positions, so that there is no crack between them; at a sharp edge they have normals of
/// their own.
template <class R>
struct Triangles {
    std::vector<Vec3<R>> positions;
    std::vector<Vec3<R>> normals; ///< unit, exact at the position they stand at
    std::vector<Triangle3> triangles;

    std::uint32_t add_position(const Vec3<R>& p) {
        positions.push_back(p);
        return static_cast<std::uint32_t>(positions.size() - 1);
    }
    std::uint32_t add_normal(const Vec3<R>& n) {
        normals.push_back(n);
        return static_cast<std::uint32_t>(normals.size() - 1);
    }
    /// Positions a, b, c with normals of the same numbers.
    void add_smooth(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t part = 0) {
        triangles.push_back({{a, b, c}, {a, b, c}, part});
    }
    void add_flat(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t normal,
                  std::uint32_t part = 0) {
        triangles.push_back({{a, b, c}, {normal, normal, normal}, part});
    }
};

/// Two unit vectors that with a unit one make a right-handed frame.
template <class R>
std::array<Vec3<R>, 2> frame_around(const Vec3<R>& w) {
    const Vec3<R> size = absolute(w);
    const Vec3<R> axis = size.x <= size.y && size.x <= size.z ? Vec3<R>{1, 0, 0}
                         : size.y <= size.z                   ? Vec3<R>{0, 1, 0}
                                                              : Vec3<R>{0, 0, 1};
    const Vec3<R> u = normalize(cross(axis, w));
    return {u, cross(w, u)};
}

/// How much a map can lengthen and can shorten vectors: bounds, by the norms of its columns and of its
/// inverse's.
template <class R>
struct Stretch2 {
    R most, least;
};
template <class R>
Stretch2<R> stretch_bounds(const Affine<R>& map) {
    const auto norm = [](const Affine<R>& a) {
        R sum = 0;
        for (const auto& row : a.m) {
            sum += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
        }
        return std::sqrt(sum);
    };
    const auto is_similar = [](const Affine<R>& a) {
        const auto column = [&](int i) { return Vec3<R>{a.m[0][i], a.m[1][i], a.m[2][i]}; };
        const R size = dot(column(0), column(0)), slack = size * R(1e-5);
        return std::abs(dot(column(1), column(1)) - size) <= slack &&
               std::abs(dot(column(2), column(2)) - size) <= slack &&
               std::abs(dot(column(0), column(1))) <= slack && std::abs(dot(column(1), column(2))) <= slack &&
               std::abs(dot(column(2), column(0))) <= slack;
    };
    if (is_similar(map)) {
        const R scale = norm(map) / std::sqrt(R(3));
        return {scale, scale};
    }
    return {norm(map), 1 / norm(inverse(map))};
}

/// What a mesh in object space has to keep to, so that it keeps to `world` after the map.
template <class R>
Tolerance<R> tolerance_in_object(const Tolerance<R>& world, const Affine<R>& world_from_object) {
    const Stretch2<R> stretch = stretch_bounds(world_from_object);
    return {world.distance / stretch.most, world.angle * (stretch.least / stretch.most)};
}

template <class R>
Triangles<R> transformed(Triangles<R> mesh, const Affine<R>& map) {
    const Affine<R> back = inverse(map);
    for (Vec3<R>& p : mesh.positions) {
        p = transform_point(map, p);
    }
    for (Vec3<R>& n : mesh.normals) {
        n = normalize(transform_normal(back, n));
    }
    if (determinant(map) < 0) {
        for (Triangle3& t : mesh.triangles) {
            std::swap(t.positions[1], t.positions[2]);
            std::swap(t.normals[1], t.normals[2]);
        }
    }
    return mesh;
}

} // namespace scc::runtime
