#pragma once

#include "runtime/accel/bvh.h"
#include "runtime/mesh_data.h"
#include "runtime/shapes/triangle_test.h"

namespace scc::runtime {

template <class R>
Vec3<R> read_vector(const float* numbers, std::uint32_t index) {
    const float* v = numbers + std::size_t{3} * index;
    return {R(v[0]), R(v[1]), R(v[2])};
}

template <class R>
Corners<R> corners_of(const MeshData& mesh, const MeshTriangle& triangle) {
    return {read_vector<R>(mesh.positions, triangle.corners[0]), read_vector<R>(mesh.positions, triangle.corners[1]),
            read_vector<R>(mesh.positions, triangle.corners[2])};
}

/// t, moved to where the ray is in the triangle's box if rounding put it outside (a ray along the triangle). So no box
/// around it begins after the hit, and the hierarchy finds the same hit as a test of every triangle.
template <class R>
R intersect_in_box(const Corners<R>& corners, const Shear<R>& shear, const SlabRay<R>& slabs, const Ray<R>& ray) {
    const R t = intersect_triangle(corners, shear, ray);
    if (!(t >= ray.t_min && t < infinity<R>())) {
        return infinity<R>();
    }
    const Vec3<R> min = minimum(minimum(corners.a, corners.b), corners.c);
    const Vec3<R> max = maximum(maximum(corners.a, corners.b), corners.c);
    const R low[3] = {min.x, min.y, min.z}, high[3] = {max.x, max.y, max.z};
    const auto range = slabs.range(low, high);
    const R inside = minimum(maximum(t, range.near), range.far);
    return range.near <= range.far && inside >= ray.t_min ? inside : infinity<R>();
}

/// The part is the triangle's place in mesh.triangles. With AnyHit: some hit in the range.
template <bool AnyHit, class R>
ShapeHit<R> intersect_mesh(const MeshData& mesh, const Ray<R>& ray) {
    if (mesh.node_count == 0) {
        return {};
    }
    const SlabRay<R> slabs(ray, bounds_of<R>(mesh.nodes[0]));
    const Shear<R> shear(ray.dir);
    ShapeHit<R> best;
    R nearest = ray.t_max;
    traverse(mesh.nodes, slabs, ray.t_min, nearest, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i) {
            const R t = intersect_in_box(corners_of<R>(mesh, mesh.triangles[i]), shear, slabs, ray);
            const bool found = t < nearest || (t == nearest && t < infinity<R>() &&
                                               (best.t > t || mesh.triangles[i].id < mesh.triangles[best.part].id));
            if (found) {
                nearest = t;
                best = {t, i};
                if constexpr (AnyHit) {
                    return true;
                }
            }
        }
        return false;
    });
    return best;
}

template <bool SmoothNormals, class R>
Surface<R> mesh_surface(const MeshData& mesh, const Ray<R>& ray, const ShapeHit<R>& hit) {
    const MeshTriangle& triangle = mesh.triangles[hit.part];
    const Corners<R> corners = corners_of<R>(mesh, triangle);
    const Vec3<R> weights = barycentric(corners, Shear<R>(ray.dir), ray.org);
    Surface<R> result = triangle_surface(corners, weights);
    if constexpr (SmoothNormals) {
        if (mesh.normals != nullptr) {
            const std::uint32_t* index = mesh.normal_indices + std::size_t{3} * triangle.id;
            const Corners<R> normals{read_vector<R>(mesh.normals, index[0]), read_vector<R>(mesh.normals, index[1]),
                                     read_vector<R>(mesh.normals, index[2])};
            result.shading_normal = interpolate_normal(normals, weights, result.normal);
        }
    }
    return result;
}

} // namespace scc::runtime
