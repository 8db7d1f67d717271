#include "runtime/tessellate/solid.h"
#include "runtime/test/mesh_checks.h"
#include "runtime/test/solid_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

using Mesh3 = SolidMesh<double>;
using Point = Vec3<double>;

void expect_closed_manifold(const Triangles<double>& mesh, const std::string& what) {
    const EdgeCounts edges = edges_of(mesh);
    EXPECT_EQ(edges.open, 0U) << what;
    EXPECT_EQ(edges.wrong, 0U) << what;
    EXPECT_EQ(pinched_points(mesh), 0U) << what;
}

Mesh3 mesh_of(const Solid<double>& solid, double tolerance) {
    return tessellate_solid(solid.scene, 0, Tolerance<double>{tolerance});
}
Node<double> box(const Point& min, const Point& max) {
    return {CsgOp::member, {}, Box<double>{min, max}};
}
Node<double> ball(const Point& center, double radius) {
    return {CsgOp::member, {}, Sphere<double>{center, radius}};
}
Node<double> bounded(Node<double> node) {
    return {CsgOp::intersect, {std::move(node), box({-2, -2, -2}, {2, 2, 2})}, {}};
}

/// Whether the solid begins or ends within a distance of the point, as far as points around it tell.
bool is_near_surface(const Solid<double>& solid, const Point& p, double distance) {
    const bool inside = solid.contains(lanes<long double>(p));
    for (double radius = distance; radius > distance / 100; radius /= 2) { // walls may be thin
        for (int x = -2; x <= 2; ++x) {
            for (int y = -2; y <= 2; ++y) {
                for (int z = -2; z <= 2; ++z) {
                    const Point way{double(x), double(y), double(z)};
                    if ((x != 0 || y != 0 || z != 0) &&
                        solid.contains(lanes<long double>(p + way * (radius / length(way)))) != inside) {
                        return true;
                    }
                }
            }
        }
    }
    return false;
}

TEST(SolidMesh, RandomSolidsAreClosedManifoldsWithinTolerance) {
    constexpr double tolerance = 0.03;
    Random<double> random(41);
    int rays = 0, missing = 0, samples = 0, away = 0;
    for (int i = 0; i < 16; ++i) {
        const Solid<double> solid(bounded(random_node(random, 2, Members::with_fields)));
        const Mesh3 result = mesh_of(solid, tolerance);
        expect_closed_manifold(result.mesh, "solid " + std::to_string(i));
        EXPECT_LE(result.deviation, tolerance) << i;
        // The mesh is where the solid's surface is,
        const std::size_t step = 1 + result.mesh.triangles.size() / 5;
        std::size_t count = 0;
        for_samples(result.mesh, [&](const Point& p, const Triangle3&) {
            ++count;
            if (count % step == 0) {
                ++samples;
                away += is_near_surface(solid, p, tolerance * 1.5) ? 0 : 1;
            }
        });
        // and it is everywhere where that is.
        for (int k = 0; k < 40; ++k) {
            const Point org = random.direction() * 6.0;
            const Ray<double> ray{org, random.vector(1.5) - org};
            const Hit<double> hit = closest_hit(solid.scene, ray);
            if (is_hit(hit)) {
                ++rays;
                missing += distance_to(result.mesh, ray.org + ray.dir * hit.shape.t) > tolerance * 1.5;
            }
        }
    }
    EXPECT_GT(samples, 300);
    EXPECT_GT(rays, 150);
    EXPECT_EQ(away, 0);
    // Films and slivers thinner than the tolerance.
    EXPECT_LE(missing, rays / 200);
}

TEST(SolidMesh, BelongsToTheMembersWithTheirNormals) {
    const Solid<double> solid({CsgOp::subtract, {box({-1, -1, -1}, {1, 1, 1}), ball({0, 0, 1}, 0.5)}, {}});
    const Mesh3 result = mesh_of(solid, 1e-3);
    expect_closed_manifold(result.mesh, "");
    EXPECT_NEAR(signed_volume(result.mesh), 8 - 2 * std::numbers::pi / 3 / 8, 2e-3);
    std::set<std::uint32_t> kinds;
    for (const Triangle3& t : result.mesh.triangles) {
        const SolidFace<double>& face = result.faces[t.part];
        kinds.insert(face.member.kind);
        const bool of_ball = result.surfaces[face.surface].kind == SmoothSurface<double>::Kind::ball;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point &p = result.mesh.positions[t.positions[k]], &n = result.mesh.normals[t.normals[k]];
            const Point expected = of_ball ? normalize(Point{0, 0, 1} - p) : n;
            EXPECT_NEAR(dot(n, expected), 1, 1e-9);
            if (!of_ball) { // a corner of a face may be on the rim, but the normal is the face's
                EXPECT_EQ(std::abs(n.x) + std::abs(n.y) + std::abs(n.z), 1);
            }
        }
    }
    EXPECT_EQ(kinds.size(), 2U);
}

TEST(SolidMesh, SharpEdgesAreWhereTheMembersMeet) {
    const Solid<double> solid({CsgOp::subtract, {box({-1, -1, -1}, {1, 1, 1}), ball({0, 0, 1}, 0.5)}, {}});
    const Mesh3 result = mesh_of(solid, 1e-3);
    for (const double z : {-1.0, 1.0}) {
        EXPECT_LT(distance_to(result.mesh, Point{1, 1, z}), 1e-9);
    }
    for (int i = 0; i < 50; ++i) {
        const double a = 0.1 + i;
        EXPECT_LT(distance_to(result.mesh, Point{0.5 * std::cos(a), 0.5 * std::sin(a), 1}), 1e-3);
    }
}

TEST(SolidMesh, FacesThatTouchLeaveNoFilm) {
    const Solid<double> united(
        {CsgOp::unite,
         {box({-1, -1, -1}, {1, 1, 0}), box({-1, -1, 0}, {1, 1, 1}), ball({0, 0, 0}, 0.9)},
         {}});
    const Mesh3 cube = mesh_of(united, 1e-4);
    expect_closed_manifold(cube.mesh, "united");
    EXPECT_NEAR(signed_volume(cube.mesh), 8, 1e-9);
    EXPECT_LT(cube.mesh.triangles.size(), 5000U);

    const Solid<double> cut(
        {CsgOp::subtract, {box({-1, -1, -1}, {1, 1, 1}), box({-0.5, -0.5, 0}, {0.5, 0.5, 1})}, {}});
    const Mesh3 open = mesh_of(cut, 1e-4);
    expect_closed_manifold(open.mesh, "cut");
    EXPECT_NEAR(signed_volume(open.mesh), 7, 1e-9);
    EXPECT_LT(open.mesh.triangles.size(), 5000U);

    Random<double> random(8);
    for (int i = 0; i < 5; ++i) {
        const Node<double> part = bounded(random_node(random, 1, Members::with_fields));
        EXPECT_TRUE(mesh_of(Solid<double>({CsgOp::subtract, {part, part}, {}}), 0.05).mesh.triangles.empty());
    }
}

TEST(SolidMesh, OfNothingOrOfTheUnboundedIsEmpty) {
    EXPECT_TRUE(mesh_of(Solid<double>({CsgOp::intersect, {ball({0, 0, 0}, 1), ball({3, 0, 0}, 1)}, {}}), 0.1)
                    .mesh.triangles.empty());
    const Node<double> half_space{CsgOp::member, {}, Plane<double>{}};
    EXPECT_TRUE(mesh_of(Solid<double>({CsgOp::unite, {ball({0, 0, 0}, 1), half_space}, {}}), 0.1)
                    .mesh.triangles.empty());
}

/// Implicit surfaces, by the index of their fields.
struct Fields : SceneBase<double> {
    static constexpr SceneTraits traits{};
    enum : std::int32_t { gyroid_walls, torus, terraces, noise, crease };

    template <class T>
    T field_function(std::int32_t index, const Vec3<T>& p) const {
        switch (index) {
        case gyroid_walls: {
            const Vec3<T> q{p.x * T(6.0), p.y * T(6.0), p.z * T(6.0)};
            return absolute(sine(q.x) * cosine(q.y) + sine(q.y) * cosine(q.z) + sine(q.z) * cosine(q.x)) -
                   T(0.25);
        }
        case torus: {
            const T around = square(p.x) + square(p.z);
            return square(around + square(p.y) + T(0.75)) - around * T(4.0);
        }
        case terraces:
            return p.y * T(4.0) - round_down(p.x * T(3.0));
        case noise:
            return noise_number(p.x * T(9.0), p.y * T(9.0), p.z * T(9.0)) - T(0.5);
        default:
            return maximum(absolute(p.x) - T(0.5), absolute(p.y) - p.z * T(0.5) - T(0.4));
        }
    }
};
Mesh3 mesh_of(std::int32_t field, double tolerance, const Container<double>& within,
              const SolidLimits& limits = {}) {
    return tessellate_implicit(Fields{}, Bare<Implicit<double>>{{field, within}},
                               Tolerance<double>{tolerance, 0.5}, limits);
}
const auto unit_ball = Container<double>::of(Sphere<double>{});
const auto cube = Container<double>::of(Box<double>{{-1.6, -1.6, -1.6}, {1.6, 1.6, 1.6}});

TEST(ImplicitMesh, ThinWallsAreWholeAndEndAtTheContainer) {
    const auto half_ball = Container<double>::of(Sphere<double>{{0, 0, 0}, 0.5});
    const Mesh3 result = mesh_of(Fields::gyroid_walls, 0.03, half_ball);
    expect_closed_manifold(result.mesh, "");
    EXPECT_EQ(result.uncertain, 0U);
    EXPECT_LE(result.deviation, 0.03);
    std::size_t rim = 0;
    const Fields scene;
    for (const Point& p : result.mesh.positions) {
        const double ball = length(p) - 0.5, field = scene.field_function(Fields::gyroid_walls, p);
        EXPECT_LT(ball, 1e-9);
        EXPECT_LT(field, 1e-6);
        EXPECT_TRUE(ball > -1e-6 || field > -1e-6);
        rim += ball > -1e-9 && field > -1e-6 ? 1 : 0;
    }
    EXPECT_GT(rim, 100U);
    Random<double> random(3);
    int inside = 0;
    constexpr int count = 40000;
    for (int i = 0; i < count; ++i) {
        const Point p = random.vector(0.5);
        inside += length(p) < 0.5 && scene.field_function(Fields::gyroid_walls, p) < 0;
    }
    EXPECT_NEAR(signed_volume(result.mesh), 1.0 * inside / count, 0.01);
}

/// A fourth of the tolerance, about four times the triangles; and it is kept everywhere.
TEST(ImplicitMesh, ConvergesToATorus) {
    const double volume = 2 * std::numbers::pi * std::numbers::pi / 4;
    for (const double tolerance : {0.03, 0.007}) {
        const Mesh3 result = mesh_of(Fields::torus, tolerance, cube);
        expect_closed_manifold(result.mesh, "");
        double farthest = 0;
        for_samples(result.mesh, [&](const Point& p, const Triangle3& t) {
            const double around = std::hypot(p.x, p.z) - 1;
            farthest = std::max(farthest, std::abs(std::hypot(around, p.y) - 0.5));
            EXPECT_EQ(result.faces[t.part].part, field_part);
        });
        EXPECT_LE(farthest, tolerance);
        EXPECT_NEAR(signed_volume(result.mesh), volume, 20 * tolerance);
    }
}

TEST(ImplicitMesh, ClosesWhereAFieldJumps) {
    const Mesh3 result = mesh_of(Fields::terraces, 0.1, unit_ball);
    expect_closed_manifold(result.mesh, "");
    EXPECT_GT(signed_volume(result.mesh), 1.5);
    for (const Point& n : result.mesh.normals) {
        EXPECT_NEAR(length(n), 1, 1e-9);
    }
}

/// Far too few cells for the field: what its signs show is a manifold all the same.
TEST(ImplicitMesh, IsAManifoldWhereCellsRunOut) {
    for (const std::size_t cells : {600U, 5000U, 20000U}) {
        const Mesh3 result = mesh_of(Fields::noise, 1e-3, cube, {cells});
        expect_closed_manifold(result.mesh, std::to_string(cells));
        EXPECT_GT(result.uncertain, 0U);
        EXPECT_GT(result.deviation, 1e-3) << "it says so";
    }
}

TEST(ImplicitMesh, KeepsCreasesOfFields) {
    const Mesh3 result = mesh_of(Fields::crease, 0.01, unit_ball);
    expect_closed_manifold(result.mesh, "");
    EXPECT_LE(result.deviation, 0.01);
    for (const Triangle3& t : result.mesh.triangles) {
        const Point &a = result.mesh.positions[t.positions[0]], &b = result.mesh.positions[t.positions[1]],
                    &c = result.mesh.positions[t.positions[2]];
        const Point flat = cross(b - a, c - a);
        if (result.faces[t.part].part == field_part && length(flat) > 1e-5) {
            for (const std::uint32_t n : t.normals) {
                EXPECT_GT(dot(normalize(flat), result.mesh.normals[n]), 0.45);
            }
        }
    }
}

TEST(ImplicitMesh, MeetsTheSameToleranceWhenPlaced) {
    Random<double> random(12);
    const Affine<double> map = random.map(3);
    const Placed<Implicit<double>, double> placed{{Fields::torus, cube}, map, inverse(map)};
    const Mesh3 result = tessellate_implicit(Fields{}, placed, Tolerance<double>{0.1, 0.8});
    expect_closed_manifold(result.mesh, "");
    EXPECT_NEAR(signed_volume(result.mesh),
                std::abs(determinant(map)) * std::numbers::pi * std::numbers::pi / 2, 0.5);
}

} // namespace
