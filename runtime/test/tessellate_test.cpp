#include "runtime/tessellate/shapes.h"
#include "runtime/test/mesh_checks.h"
#include "runtime/test/random_scene.h"
#include "runtime/test/signed_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

template <class Shape>
class TessellatedShape : public testing::Test {};
using Formulas = testing::Types<Sphere<double>, Box<double>, Cylinder<double>, Cone<double>, Disc<double>,
                                Triangle<double>, Torus<double>, Sphere<float>, Cone<float>>;
TYPED_TEST_SUITE(TessellatedShape, Formulas);

template <class Shape>
bool is_open(const Shape& shape) {
    if constexpr (requires { shape.caps; }) {
        return !shape.caps;
    } else {
        return !is_solid<Shape>;
    }
}

template <class R>
Vec3<R> flat_normal(const Triangles<R>& mesh, const Triangle3& t) {
    const Vec3<R>&a = mesh.positions[t.positions[0]], &b = mesh.positions[t.positions[1]],
          &c = mesh.positions[t.positions[2]];
    return normalize(cross(b - a, c - a));
}

TYPED_TEST(TessellatedShape, KeepsToToleranceWithoutCracks) {
    using Shape = TypeParam;
    using R = decltype(Shape{}.bounds().min.x);
    const R slack = 64 * std::numeric_limits<R>::epsilon();
    Random<R> random(21);
    for (const double wanted : {0.1, 0.01, 0.0015}) {
        for (int i = 0; i < 12; ++i) {
            Shape shape{};
            randomize(shape, random, 1);
            const Tolerance<R> tolerance{R(wanted), R(0.4)};
            const Triangles<R> mesh = tessellate(shape, tolerance);
            const EdgeCounts edges = edges_of(mesh);
            EXPECT_EQ(edges.wrong, 0U);
            EXPECT_EQ(edges.open != 0, is_open(shape));
            EXPECT_TRUE(is_open(shape) || pinched_points(mesh) == 0);
            double farthest = 0, widest = 1, normals_off = 0;
            for_samples(mesh, [&](const Vec3<R>& p, const Triangle3& t) {
                const Wide towards = lanes<long double>(flat_normal(mesh, t));
                const Wide side = is_solid<Shape> ? lanes<long double>(mesh.normals[t.normals[0]]) : towards;
                farthest = std::max(farthest, std::abs(static_cast<double>(
                                                  signed_distance(shape, lanes<long double>(p), side))));
            });
            for (const Triangle3& t : mesh.triangles) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3<R>&n = mesh.normals[t.normals[k]], &m = mesh.normals[t.normals[(k + 1) % 3]];
                    widest = std::min(widest, double(dot(n, m)));
                    normals_off = std::max(normals_off, std::abs(double(length(n)) - 1));
                    EXPECT_GT(dot(n, flat_normal(mesh, t)), 0);
                }
            }
            EXPECT_LE(farthest, wanted + double(slack * 8));
            EXPECT_GE(widest, std::cos(0.4) - double(slack));
            EXPECT_LE(normals_off, double(slack));
            if (!is_open(shape)) {
                EXPECT_GT(signed_volume(mesh), 0);
            }
        }
    }
}

TYPED_TEST(TessellatedShape, IsRightInTheWorldUnderAnyMap) {
    using Shape = TypeParam;
    using R = decltype(Shape{}.bounds().min.x);
    Random<R> random(22);
    for (int i = 0; i < 4; ++i) {
        Shape shape{};
        randomize(shape, random, 1);
        const Affine<R> map = affine_cast<R>(random.map(2));
        const Triangles<R> mesh = tessellate_in_world(shape, map, Tolerance<R>{R(0.02), R(0.9)});
        const Affine<R> back = inverse(map);
        for (const Triangle3& t : mesh.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3<R>&n = mesh.normals[t.normals[k]], &m = mesh.normals[t.normals[(k + 1) % 3]];
                EXPECT_GT(dot(n, flat_normal(mesh, t)), 0);
                EXPECT_GE(dot(n, m), R(std::cos(0.9)) - R(1e-5));
            }
        }
        // A distance in the world is at most one in object space, along the normal, stretched.
        for_samples(mesh, [&](const Vec3<R>& p, const Triangle3& t) {
            const Vec3<R> normal = normalize(transform_normal(map, mesh.normals[t.normals[0]]));
            const auto off = std::abs(signed_distance(shape, lanes<long double>(transform_point(back, p)),
                                                      lanes<long double>(normal)));
            EXPECT_LE(static_cast<double>(off) * double(stretch_bounds(map).least), 0.0201);
        });
    }
}

TEST(Tessellation, OfAPlaneCoversTheBall) {
    const Plane<double> plane{normalize(Vec3<double>{1, 2, 3}), 0.5};
    const Ball<double> ball{{4, -1, 2}, 3};
    const Triangles<double> mesh = tessellate(plane, ball);
    ASSERT_EQ(mesh.triangles.size(), 2U);
    double area = 0;
    for (const Triangle3& t : mesh.triangles) {
        const auto &a = mesh.positions[t.positions[0]], &b = mesh.positions[t.positions[1]],
                   &c = mesh.positions[t.positions[2]];
        area += length(cross(b - a, c - a)) / 2;
        EXPECT_NEAR(dot(plane.normal, a), 0.5, 1e-12);
        EXPECT_GT(dot(plane.normal, flat_normal(mesh, t)), 0.999);
    }
    EXPECT_NEAR(area, 36, 1e-9);
}

/// Four times as many triangles make a fourth of the error.
TEST(Tessellation, SpheresConvergeQuadratically) {
    std::size_t before = 0;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const Triangles<double> mesh = tessellate(Sphere<double>{}, Tolerance<double>{tolerance, 3});
        EXPECT_NEAR(signed_volume(mesh), 4 * std::numbers::pi / 3, 13 * tolerance);
        if (before > 0) {
            EXPECT_LT(mesh.triangles.size(), before * 13);
        }
        before = mesh.triangles.size();
    }
}

} // namespace
