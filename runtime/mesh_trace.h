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

template <class L>
Corners<L> corners_of(const MeshData& mesh, const MeshTriangle& triangle) {
    using R = RealOf<L>;
    return {lanes<L>(read_vector<R>(mesh.positions, triangle.corners[0])),
            lanes<L>(read_vector<R>(mesh.positions, triangle.corners[1])),
            lanes<L>(read_vector<R>(mesh.positions, triangle.corners[2]))};
}

/// t, moved to where the ray is in the triangle's box if rounding put it outside (a ray along the triangle).
/// So no box around it begins after the hit, and the hierarchy finds the same hit as a test of every
/// triangle.
template <class L>
L intersect_in_box(const Corners<L>& corners, const Shear<L>& shear, const SlabRay<L>& slabs,
                   const Ray<L>& ray) {
    const L t = intersect_triangle(corners, shear, ray);
    const MaskOf<L> met = (t >= ray.t_min) & (t < infinity<L>());
    if (none(met)) {
        return infinity<L>();
    }
    const Vec3<L> min = minimum(minimum(corners.a, corners.b), corners.c);
    const Vec3<L> max = maximum(maximum(corners.a, corners.b), corners.c);
    const L low[3] = {min.x, min.y, min.z}, high[3] = {max.x, max.y, max.z};
    const auto range = slabs.range(low, high);
    const L inside = minimum(maximum(t, range.near), range.far);
    return choose(met & (range.near <= range.far) & (inside >= ray.t_min), inside, infinity<L>());
}

/// The part is the triangle's place in mesh.triangles. With AnyHit: some hit in the range.
template <bool AnyHit, class L>
ShapeHit<L> intersect_mesh(const MeshData& mesh, const Ray<L>& ray) {
    if (mesh.node_count == 0) {
        return {};
    }
    using Index = IndexOf<L>;
    const SlabRay<L> slabs(ray, bounds_of<RealOf<L>>(mesh.nodes[0]));
    const Shear<L> shear(ray.dir);
    ShapeHit<L> best;
    Index best_id(~0U);
    L nearest = ray.t_max;
    traverse(mesh.nodes, slabs, ray.t_min, nearest, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i) {
            const MeshTriangle& triangle = mesh.triangles[i];
            const L t = intersect_in_box(corners_of<L>(mesh, triangle), shear, slabs, ray);
            const MaskOf<L> found =
                (t < nearest) | ((t == nearest) & (t < infinity<L>()) & (Index(triangle.id) < best_id));
            if (none(found)) {
                continue;
            }
            best.t = choose(found, t, best.t);
            best.part = choose(found, Index(i), best.part);
            best_id = choose(found, Index(triangle.id), best_id);
            nearest = choose(found, AnyHit ? -infinity<L>() : t, nearest);
            if (AnyHit && none(nearest >= ray.t_min)) {
                return true;
            }
        }
        return false;
    });
    return best;
}

namespace detail {

/// Three vectors of each lane's triangle; zeros where not `needed`. `indices_of` gives a triangle's three
/// indices.
template <class L, class IndicesOf>
Corners<L> gather_corners(const MeshData& mesh, const float* numbers, const IndexOf<L>& part,
                          const MaskOf<L>& needed, IndicesOf&& indices_of) {
    using R = RealOf<L>;
    Corners<L> result{};
    const auto put = [](Vec3<L>& to, int i, const Vec3<R>& from) {
        set_lane(to.x, i, from.x);
        set_lane(to.y, i, from.y);
        set_lane(to.z, i, from.z);
    };
    for (unsigned left = bits(needed); left != 0; left &= left - 1) {
        const int i = __builtin_ctz(left);
        const std::uint32_t* index = indices_of(mesh.triangles[lane(part, i)]);
        put(result.a, i, read_vector<R>(numbers, index[0]));
        put(result.b, i, read_vector<R>(numbers, index[1]));
        put(result.c, i, read_vector<R>(numbers, index[2]));
    }
    return result;
}

} // namespace detail

/// Of the lanes in `needed`, which have hit this mesh.
template <bool SmoothNormals, class L>
Surface<L> mesh_surface(const MeshData& mesh, const Ray<L>& ray, const ShapeHit<L>& hit,
                        const MaskOf<L>& needed) {
    const Corners<L> corners =
        detail::gather_corners<L>(mesh, mesh.positions, hit.part, needed,
                                  [](const MeshTriangle& triangle) { return triangle.corners; });
    const Vec3<L> weights = barycentric(corners, Shear<L>(ray.dir), ray.org);
    Surface<L> result = triangle_surface(corners, weights);
    if constexpr (SmoothNormals) {
        if (mesh.normals != nullptr) {
            const Corners<L> normals = detail::gather_corners<L>(
                mesh, mesh.normals, hit.part, needed, [&](const MeshTriangle& triangle) {
                    return mesh.normal_indices + std::size_t{3} * triangle.id;
                });
            result.shading_normal = interpolate_normal(normals, weights, result.normal);
        }
    }
    return result;
}

} // namespace scc::runtime
