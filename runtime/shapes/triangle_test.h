#pragma once

#include "runtime/ray.h"

namespace scc::runtime {

template <class L>
struct Corners {
    Vec3<L> a, b, c;
};

/// A ray's direction as the z axis: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1),
/// 2013. Every edge shared by two triangles gets exactly opposite values from both, so no ray passes between
/// them.
template <class L>
struct Shear {
    MaskOf<L> x_major, z_major;
    L x, y, z; ///< the shear's entries; z: 1 / dir along the major axis

    explicit constexpr Shear(const Vec3<L>& dir) {
        const Vec3<L> size = absolute(dir);
        z_major = (size.z >= size.x) & (size.z >= size.y);
        x_major = (size.x >= size.y) & !z_major;
        const Vec3<L> turned = turn(dir);
        z = 1 / turned.z;
        x = turned.x * z;
        y = turned.y * z;
    }

    /// Renames the axes so that the major one is z.
    constexpr Vec3<L> turn(const Vec3<L>& v) const {
        return {choose(z_major, v.x, choose(x_major, v.y, v.z)),
                choose(z_major, v.y, choose(x_major, v.z, v.x)),
                choose(z_major, v.z, choose(x_major, v.x, v.y))};
    }
};

/// Twice the signed areas that the ray spans with the edges, seen along it; the weights of the corners after
/// division by their sum. All of one sign, or 0: the ray passes through.
template <class L>
constexpr Vec3<L> edge_functions(const Corners<L>& corners, const Shear<L>& shear, const Vec3<L>& org) {
    const Vec3<L> a = shear.turn(corners.a - org), b = shear.turn(corners.b - org),
                  c = shear.turn(corners.c - org);
    const L ax = a.x - shear.x * a.z, ay = a.y - shear.y * a.z;
    const L bx = b.x - shear.x * b.z, by = b.y - shear.y * b.z;
    const L cx = c.x - shear.x * c.z, cy = c.y - shear.y * c.z;
    Vec3<L> e{cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax};
    if constexpr (sizeof(RealOf<L>) < sizeof(double)) {
        // A product may have vanished or two become equal: the sign decides which triangle has the hit.
        const MaskOf<L> unclear = (e.x == 0) | (e.y == 0) | (e.z == 0);
        if (any(unclear)) {
            e = choose(unclear,
                       Vec3<L>{difference_of_products(cx, by, cy, bx), difference_of_products(ax, cy, ay, cx),
                               difference_of_products(bx, ay, by, ax)},
                       e);
        }
    }
    return e;
}

/// t where the ray meets the triangle, on either side of 0; infinity or NaN where it misses. The edge
/// functions decide whether, the plane through the corners decides where: its distance is accurate also for
/// slivers and agrees with triangle_surface about the side that a point near the triangle is on.
template <class L>
constexpr L intersect_triangle(const Corners<L>& corners, const Shear<L>& shear, const Ray<L>& ray) {
    const Vec3<L> e = edge_functions(corners, shear, ray.org);
    const MaskOf<L> outside = ((e.x < 0) | (e.y < 0) | (e.z < 0)) & ((e.x > 0) | (e.y > 0) | (e.z > 0));
    const MaskOf<L> inside = (e.x + e.y + e.z != 0) & !outside;
    if (none(inside)) {
        return infinity<L>();
    }
    const Vec3<L> n = cross(corners.b - corners.a, corners.c - corners.a);
    return choose(inside, dot(n, corners.a - ray.org) / dot(n, ray.dir), infinity<L>());
}

/// The weights of the corners where the ray passes through the triangle.
template <class L>
constexpr Vec3<L> barycentric(const Corners<L>& corners, const Shear<L>& shear, const Vec3<L>& org) {
    const Vec3<L> e = edge_functions(corners, shear, org);
    return e * (1 / (e.x + e.y + e.z));
}

template <class L>
constexpr Surface<L> triangle_surface(const Corners<L>& corners, const Vec3<L>& weights) {
    const L u = roundoff<L>();
    const Vec3<L> edge1 = corners.b - corners.a, edge2 = corners.c - corners.a;
    const Vec3<L> n = normalize(cross(edge1, edge2));
    const Vec3<L> in_plane = edge1 * weights.y + edge2 * weights.z;
    const Vec3<L> point = corners.a + (in_plane - n * dot(n, in_plane));
    // 2: the sum. Then the in-plane vector's error, a few roundings of the edges, and the plane's distance in
    // intersect_triangle: 4 roundings of the terms of n.(a - org), which is at most as long as the edges.
    const Vec3<L> reach = absolute(edge1) + absolute(edge2);
    const Vec3<L> error =
        absolute(point) * (2 * u) + reach * (8 * u) + absolute(n) * (16 * u * dot(absolute(n), reach));
    return {point, error, n, n};
}

/// Barycentric and normalised, as POV-Ray's mesh2; the geometric normal where the sum vanishes.
template <class L>
constexpr Vec3<L> interpolate_normal(const Corners<L>& normals, const Vec3<L>& weights,
                                     const Vec3<L>& geometric) {
    const Vec3<L> sum = normals.a * weights.x + normals.b * weights.y + normals.c * weights.z;
    const L squared = dot(sum, sum);
    return choose(squared > 0, sum * (L(1) / square_root(squared)), geometric);
}

} // namespace scc::runtime
