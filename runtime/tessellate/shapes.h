#pragma once

#include "runtime/scene.h"
#include "runtime/tessellate/triangles.h"

#include <algorithm>
#include <concepts>
#include <numbers>
#include <type_traits>

/// Meshes of the shapes that have a formula: `tessellate(shape, tolerance)` in object space. Vertices lie on
/// the surface. A new shape is an overload here.
namespace scc::runtime {

namespace detail {

inline constexpr int most_segments = 1 << 14;      ///< of a circle: right to 2e-8 of its radius
inline constexpr int most_sphere_divisions = 1024; ///< right to 1e-6 of its radius, with 8 million triangles

/// Of a regular polygon in a circle. Its edges' middles are radius * (1 - cos(pi / n)) inside.
template <class R>
int circle_segments(R radius, const Tolerance<R>& tolerance) {
    const R cosine = std::max(R(-0.5), 1 - tolerance.distance / radius);
    // 1 - c by the half angle: acos(1 - x) loses half the digits of a small x.
    const R half = 2 * std::asin(std::sqrt((1 - cosine) / 2));
    const R pi = std::numbers::pi_v<R>;
    const R needed = std::max(pi / half, 2 * pi / tolerance.angle);
    return std::clamp(static_cast<int>(std::ceil(std::min(needed, R(most_segments)))), 3, most_segments);
}

/// Unit vectors across an axis, counter-clockwise seen from its end. `offset` in segments.
template <class R>
std::vector<Vec3<R>> directions_around(const Vec3<R>& axis, int segments, R offset = 0) {
    const auto [u, v] = frame_around(axis);
    std::vector<Vec3<R>> result;
    for (int i = 0; i < segments; ++i) {
        const R angle = 2 * std::numbers::pi_v<R> * (R(i) + offset) / R(segments);
        result.push_back(u * std::cos(angle) + v * std::sin(angle));
    }
    return result;
}

/// A convex polygon of one normal, without a fan's slivers: every second corner is cut off, again and again.
template <class R>
void fill(Triangles<R>& mesh, std::vector<std::uint32_t> ring, const Vec3<R>& normal, std::uint32_t part) {
    const std::uint32_t n = mesh.add_normal(normal);
    while (ring.size() > 2) {
        std::vector<std::uint32_t> left;
        for (std::size_t i = 0; i < ring.size(); i += 2) {
            left.push_back(ring[i]);
            if (i + 1 < ring.size()) {
                mesh.add_flat(ring[i], ring[i + 1], ring[(i + 2) % ring.size()], n, part);
            }
        }
        ring = std::move(left);
    }
}

template <class R>
std::vector<std::uint32_t> add_ring(Triangles<R>& mesh, const Vec3<R>& center, R radius,
                                    const std::vector<Vec3<R>>& around) {
    std::vector<std::uint32_t> ring;
    for (const Vec3<R>& direction : around) {
        ring.push_back(mesh.add_position(center + direction * radius));
    }
    return ring;
}

/// A tube from ring to ring, of whose normals along the way the second is the slope: those of a cone. A ring
/// of radius 0 is a tip, at which each triangle has the normal of its own middle.
template <class R>
Triangles<R> tube(const Vec3<R>& from, const Vec3<R>& to, R radius_from, R radius_to, bool caps,
                  const Tolerance<R>& tolerance) {
    const R height = length(to - from);
    const Vec3<R> axis = (to - from) * (1 / height);
    const int n = circle_segments(std::max(radius_from, radius_to), tolerance);
    const std::vector<Vec3<R>> around = directions_around(axis, n),
                               between = directions_around(axis, n, R(0.5));
    const R slope = (radius_to - radius_from) / height;
    const auto normal_at = [&](const Vec3<R>& direction) { return normalize(direction - axis * slope); };
    Triangles<R> mesh;
    std::uint32_t tip = 0;
    const bool sharp_from = radius_from == 0, sharp_to = radius_to == 0;
    if (sharp_from || sharp_to) {
        tip = mesh.add_position(sharp_from ? from : to);
    }
    const auto low = sharp_from ? std::vector<std::uint32_t>{} : add_ring(mesh, from, radius_from, around);
    const auto high = sharp_to ? std::vector<std::uint32_t>{} : add_ring(mesh, to, radius_to, around);
    std::vector<std::uint32_t> normals;
    for (const Vec3<R>& direction : around) {
        normals.push_back(mesh.add_normal(normal_at(direction)));
    }
    for (std::size_t i = 0; i < around.size(); ++i) {
        const std::size_t k = (i + 1) % around.size();
        if (sharp_from || sharp_to) {
            const std::uint32_t at_tip = mesh.add_normal(normal_at(between[i]));
            if (sharp_to) {
                mesh.triangles.push_back({{low[i], low[k], tip}, {normals[i], normals[k], at_tip}, 0});
            } else {
                mesh.triangles.push_back({{tip, high[k], high[i]}, {at_tip, normals[k], normals[i]}, 0});
            }
        } else {
            mesh.triangles.push_back({{low[i], low[k], high[k]}, {normals[i], normals[k], normals[k]}, 0});
            mesh.triangles.push_back({{low[i], high[k], high[i]}, {normals[i], normals[k], normals[i]}, 0});
        }
    }
    if (caps && !sharp_from) {
        fill(mesh, {low.rbegin(), low.rend()}, -axis, 1);
    }
    if (caps && !sharp_to) {
        fill(mesh, high, axis, 2);
    }
    return mesh;
}

/// The unit sphere from its poles in rings of 4, 8, ... points, 2 * divisions strips in all, which has
/// triangles of nearly equal size: 8 divisions^2 of them.
template <class R>
Triangles<R> unit_sphere(int divisions) {
    Triangles<R> mesh;
    const auto in_quarter = [&](int ring) { return std::min(ring, 2 * divisions - ring); };
    std::vector<std::uint32_t> first;
    for (int ring = 0; ring <= 2 * divisions; ++ring) {
        const int count = std::max(1, 4 * in_quarter(ring));
        first.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        const R polar = std::numbers::pi_v<R> * R(ring) / R(2 * divisions);
        for (int i = 0; i < count; ++i) {
            const R turn = 2 * std::numbers::pi_v<R> * R(i) / R(count);
            mesh.add_position(
                {std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn)});
        }
    }
    mesh.normals = mesh.positions;
    const auto point = [&](int ring, int quarter, int i) {
        const int count = std::max(1, 4 * in_quarter(ring));
        return first[static_cast<std::size_t>(ring)] +
               static_cast<std::uint32_t>((quarter * in_quarter(ring) + i) % count);
    };
    for (int ring = 0; ring < 2 * divisions; ++ring) {
        const bool widens = ring < divisions;
        const int wide = widens ? ring + 1 : ring, narrow = widens ? ring : ring + 1;
        for (int quarter = 0; quarter < 4; ++quarter) {
            const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                widens ? mesh.add_smooth(a, b, c) : mesh.add_smooth(a, c, b);
            };
            for (int i = 0; i < in_quarter(wide); ++i) {
                add(point(narrow, quarter, i), point(wide, quarter, i), point(wide, quarter, i + 1));
                if (i < in_quarter(narrow)) {
                    add(point(narrow, quarter, i), point(wide, quarter, i + 1),
                        point(narrow, quarter, i + 1));
                }
            }
        }
    }
    return mesh;
}

/// How far a mesh with vertices on the unit sphere is inside of it: each triangle's plane at its nearest.
template <class R>
R depth_in_unit_sphere(const Triangles<R>& mesh) {
    R depth = 0;
    for (const Triangle3& t : mesh.triangles) {
        const Vec3<R>&a = mesh.positions[t.positions[0]], &b = mesh.positions[t.positions[1]],
              &c = mesh.positions[t.positions[2]];
        depth = std::max(depth, 1 - dot(normalize(cross(b - a, c - a)), a));
    }
    return depth;
}

} // namespace detail

/// The depth is measured: largest near the poles, where it is about 0.8 / divisions^2, and edges subtend
/// pi^2 / 4 / divisions.
template <class R>
Triangles<R> tessellate(const Sphere<R>& sphere, const Tolerance<R>& tolerance) {
    const R relative = tolerance.distance / sphere.radius;
    const R needed = std::max(std::sqrt(R(0.7) / relative), R(2.47) / tolerance.angle);
    int divisions = static_cast<int>(std::ceil(std::min(needed, R(detail::most_sphere_divisions))));
    Triangles<R> mesh = detail::unit_sphere<R>(divisions);
    while (detail::depth_in_unit_sphere(mesh) > relative && divisions < detail::most_sphere_divisions) {
        divisions += 1 + divisions / 16;
        mesh = detail::unit_sphere<R>(divisions);
    }
    for (Vec3<R>& p : mesh.positions) {
        p = sphere.center + p * sphere.radius;
    }
    return mesh;
}

template <class R>
Triangles<R> tessellate(const Box<R>& box, const Tolerance<R>&) {
    Triangles<R> mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.add_position({(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                           (i & 4) != 0 ? box.max.z : box.min.z});
    }
    constexpr std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (std::uint32_t face = 0; face < 6; ++face) {
        Vec3<R> normal{};
        (face / 2 == 0 ? normal.x : face / 2 == 1 ? normal.y : normal.z) = face % 2 == 0 ? R(-1) : R(1);
        const auto& ring = faces[face];
        detail::fill(mesh, {ring[0], ring[1], ring[2], ring[3]}, normal, face);
    }
    return mesh;
}

template <class R>
Triangles<R> tessellate(const Cylinder<R>& c, const Tolerance<R>& tolerance) {
    return detail::tube(c.from, c.to, c.radius, c.radius, c.caps, tolerance);
}

template <class R>
Triangles<R> tessellate(const Cone<R>& c, const Tolerance<R>& tolerance) {
    return detail::tube(c.from, c.to, c.radius_from, c.radius_to, c.caps, tolerance);
}

/// A grid of quadrangles: a fine tube needs as many around it as its own circle, and as many along it as the
/// outer one.
template <class R>
Triangles<R> tessellate(const Torus<R>& torus, const Tolerance<R>& tolerance) {
    // What the two circles are inside adds up.
    const Tolerance<R> half{tolerance.distance / 2, tolerance.angle / 2};
    const int along = detail::circle_segments(torus.major + torus.minor, half),
              around = detail::circle_segments(torus.minor, half);
    Triangles<R> mesh;
    const auto outwards = detail::directions_around(torus.axis, along);
    for (int i = 0; i < along; ++i) {
        for (int k = 0; k < around; ++k) {
            const R turn = 2 * std::numbers::pi_v<R> * R(k) / R(around);
            const Vec3<R>& out = outwards[static_cast<std::size_t>(i)];
            const Vec3<R> normal = out * std::cos(turn) + torus.axis * std::sin(turn);
            mesh.add_position(torus.center + out * torus.major + normal * torus.minor);
            mesh.add_normal(normal);
        }
    }
    const auto at = [&](int i, int k) {
        return static_cast<std::uint32_t>((i % along) * around + k % around);
    };
    for (int i = 0; i < along; ++i) {
        for (int k = 0; k < around; ++k) {
            mesh.add_smooth(at(i, k), at(i + 1, k), at(i + 1, k + 1));
            mesh.add_smooth(at(i, k), at(i + 1, k + 1), at(i, k + 1));
        }
    }
    return mesh;
}

template <class R>
Triangles<R> tessellate(const Disc<R>& disc, const Tolerance<R>& tolerance) {
    Triangles<R> mesh;
    const Tolerance<R> any_angle{tolerance.distance, 2 * std::numbers::pi_v<R>}; // it is flat
    const auto around =
        detail::directions_around(disc.normal, detail::circle_segments(disc.radius, any_angle));
    const auto outer = detail::add_ring(mesh, disc.center, disc.radius, around);
    if (disc.hole == 0) {
        detail::fill(mesh, outer, disc.normal, 0);
        return mesh;
    }
    const auto inner = detail::add_ring(mesh, disc.center, disc.hole, around);
    const std::uint32_t normal = mesh.add_normal(disc.normal);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const std::size_t k = (i + 1) % around.size();
        mesh.add_flat(outer[i], outer[k], inner[k], normal);
        mesh.add_flat(outer[i], inner[k], inner[i], normal);
    }
    return mesh;
}

template <class R>
Triangles<R> tessellate(const Triangle<R>& triangle, const Tolerance<R>&) {
    Triangles<R> mesh;
    const auto& [a, b, c] = triangle.points;
    mesh.positions = {a, b, c};
    if (triangle.smooth) {
        for (const Vec3<R>& n : triangle.normals) {
            mesh.add_normal(normalize(n));
        }
        mesh.add_smooth(0, 1, 2);
    } else {
        mesh.add_flat(0, 1, 2, mesh.add_normal(normalize(cross(b - a, c - a))));
    }
    return mesh;
}

/// Of a plane, which is unbounded, what lies in the ball: a square around it.
template <class R>
Triangles<R> tessellate(const Plane<R>& plane, const Ball<R>& extent) {
    const auto [u, v] = frame_around(plane.normal);
    const Vec3<R> middle = extent.center + plane.normal * (plane.offset - dot(plane.normal, extent.center));
    Triangles<R> mesh;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        mesh.add_position(middle + (u * R(x) + v * R(y)) * extent.radius);
    }
    detail::fill(mesh, {0, 1, 2, 3}, plane.normal, 0);
    return mesh;
}

/// Whether it has an overload above: a formula, and an end.
template <class Shape, class R>
concept Tessellable = requires(const Shape& shape, const Tolerance<R>& tolerance) {
    { tessellate(shape, tolerance) } -> std::same_as<Triangles<R>>;
};

/// In the world, to a tolerance in its units.
template <class Shape, class R>
requires Tessellable<Shape, R> Triangles<R>
tessellate_in_world(const Shape& shape, const Affine<R>& world_from_object, const Tolerance<R>& tolerance) {
    return transformed(tessellate(shape, tolerance_in_object(tolerance, world_from_object)),
                       world_from_object);
}

} // namespace scc::runtime
