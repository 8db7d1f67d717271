#include "runtime/accel/build.h"
#include "runtime/math/pack.h"
#include "runtime/raycast.h"
#include "runtime/test/random_scene.h"
#include "runtime/test/solid_oracle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

template <class R>
class SolidScene : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SolidScene, Reals);

/// What is wrong with a hit, or with finding none, as far as points of the ray tell.
template <class R>
std::string problem(const Solid<R>& solid, const Ray<R>& ray, const Hit<R>& hit, long double blur) {
    const auto at = [&](long double t) {
        return lanes<long double>(ray.org) + lanes<long double>(ray.dir) * t;
    };
    const bool starts_inside = solid.contains(at(0));
    const bool met = is_hit(hit);
    const long double end =
        met ? static_cast<long double>(hit.shape.t) : 30 / length(lanes<long double>(ray.dir));
    constexpr int samples = 400;
    for (int i = 1; i < samples; ++i) {
        const long double t = (end - blur) * i / samples;
        if (t > blur && solid.contains(at(t)) != starts_inside) {
            return "the solid is met before";
        }
    }
    if (!met) {
        return "";
    }
    if (solid.contains(at(end - blur)) == solid.contains(at(end + blur))) {
        return "no change at the hit";
    }
    std::string wrong;
    for_each_primitive(
        solid.scene, hit, true, [&](const auto& primitive, bool here, bool inverted, std::uint32_t) {
            Vec3<R> object_point;
            Surface<R> surface = surface_of(solid.scene, primitive, ray, hit.shape, here, object_point);
            surface = inverted ? turned_over(surface) : surface;
            const Wide p = lanes<long double>(surface.point), n = lanes<long double>(surface.normal);
            if (length(p - at(end)) > blur * 4) {
                wrong = "the surface is elsewhere";
            } else if (!solid.contains(p - n * blur) || solid.contains(p + n * blur)) {
                wrong = "the normal does not point out of the solid";
            }
        });
    return wrong;
}

template <class R>
Ray<R> ray_at(const Solid<R>& solid, Random<R>& random) {
    const Vec3<R> org = random.number(0, 1) < 0.2 ? solid.center() : random.direction() * random.number(5, 9);
    const Vec3<R> target = solid.center() + random.vector(1.2);
    return {org, (target - org) * random.number(0.3, 3)};
}

TYPED_TEST(SolidScene, FirstHitIsWhereTheSolidBegins) {
    using R = TypeParam;
    Random<R> random(11);
    const long double blur = std::is_same_v<R, float> ? 3e-4L : 1e-8L;
    int hits = 0, rays = 0, wrong = 0;
    for (int i = 0; i < property_count(100); ++i) {
        const Solid<R> solid(random, 3);
        for (int k = 0; k < 40; ++k) {
            const Ray<R> ray = ray_at(solid, random);
            const Hit<R> hit = closest_hit(solid.scene, ray);
            hits += is_hit(hit);
            ++rays;
            const std::string what = problem(solid, ray, hit, blur);
            wrong += !what.empty();
            if (std::is_same_v<R, double>) {
                EXPECT_EQ(what, "") << "solid " << i << " ray " << k;
            }
        }
    }
    EXPECT_GT(hits, rays / 4);
    // Rays that pass an edge within the blur.
    EXPECT_LE(wrong, rays / 200);
}

TYPED_TEST(SolidScene, PacksGiveTheScalarBits) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(12);
    for (int i = 0; i < 300; ++i) {
        const Solid<R> solid(random, 3);
        Ray<L> pack;
        std::array<Ray<R>, lane_count<L>> single;
        for (int k = 0; k < lane_count<L>; ++k) {
            single[k] = ray_at(solid, random);
            single[k].t_max = random.number(0, 1) < 0.3 ? random.number(0, 3) : infinity<R>();
            if (random.number(0, 1) < 0.1) {
                single[k].t_max = -infinity<R>();
            }
            set_ray(pack, k, single[k]);
        }
        const Hit<L> hits = closest_hit(solid.scene, pack);
        const MaskOf<L> blocked = any_hit(solid.scene, pack);
        for (int k = 0; k < lane_count<L>; ++k) {
            const Hit<R> expected = closest_hit(solid.scene, single[k]), hit = lane(hits, k);
            EXPECT_EQ(hit.shape.t, expected.shape.t);
            EXPECT_EQ(hit.kind, expected.kind);
            EXPECT_EQ((bits(blocked) >> k & 1U) != 0, is_hit(expected));
            if (is_hit(expected)) {
                EXPECT_EQ(hit.shape.part, expected.shape.part);
                EXPECT_EQ(hit.index, expected.index);
                EXPECT_EQ(hit.id, expected.id);
            }
        }
    }
}

/// Rays that start on a solid's surface neither meet it there again nor miss what is behind.
TYPED_TEST(SolidScene, RaysThatLeaveASurfaceDoNotMeetItAgain) {
    using R = TypeParam;
    Random<R> random(13);
    const long double blur = std::is_same_v<R, float> ? 3e-4L : 1e-8L;
    int spawned = 0, wrong = 0;
    for (int i = 0; i < property_count(300); ++i) {
        const Solid<R> solid(random, 3);
        for (int k = 0; k < 20; ++k) {
            const Ray<R> ray = ray_at(solid, random);
            const Hit<R> hit = closest_hit(solid.scene, ray);
            if (!is_hit(hit)) {
                continue;
            }
            const Surface<R> surface = solid.surface(ray, hit);
            const Vec3<R> dir = random.direction();
            const Ray<R> next{start_off(surface, dir), dir, spawned_t_min<R>(), infinity<R>()};
            const Hit<R> second = closest_hit(solid.scene, next);
            ++spawned;
            wrong += !problem(solid, next, second, blur).empty();
        }
    }
    EXPECT_GT(spawned, 1000);
    EXPECT_LE(wrong, spawned / 100);
}

// ---- particular solids ---------------------------------------------------------------------------------

template <class R>
Hit<R> along_z(const Solid<R>& solid, R x, R y, R z = 10) {
    return closest_hit(solid.scene, Ray<R>{{x, y, z}, {0, 0, -1}});
}
template <class R>
Vec3<R> normal_along_z(const Solid<R>& solid, R x, R y) {
    const Ray<R> ray{{x, y, 10}, {0, 0, -1}};
    return solid.surface(ray, closest_hit(solid.scene, ray)).normal;
}
template <class R>
Node<R> box(const Vec3<R>& min, const Vec3<R>& max) {
    return {CsgOp::member, {}, Box<R>{min, max}};
}
template <class R>
Node<R> ball(const Vec3<R>& center, R radius) {
    return {CsgOp::member, {}, Sphere<R>{center, radius}};
}

TYPED_TEST(SolidScene, FlushCutLeavesNoFilm) {
    using R = TypeParam;
    // A box with a hole whose cutter ends in the box's faces, moved there by a map that rounds.
    Node<R> cutter = box<R>({-1, -1, -1}, {1, 1, 1});
    Affine<double> map;
    const double angle = 0.7;
    map.m[0][0] = map.m[1][1] = 0.3 * std::cos(angle);
    map.m[0][1] = -(map.m[1][0] = 0.3 * std::sin(angle));
    map.m[2][2] = 0.35;
    map.m[2][3] = 0.75; // from 0.4 to 1.1
    cutter.place = map;
    const Solid<R> solid({CsgOp::subtract, {box<R>({-1, -1, R(0.4)}, {1, 1, R(1.1)}), cutter}, {}});
    Random<R> random(5);
    for (int i = 0; i < 20000; ++i) {
        const Vec3<R> through{random.number(-0.2, 0.2), random.number(-0.2, 0.2), R(1.1)};
        const Vec3<R> org =
            through + Vec3<R>{random.number(-0.3, 0.3), random.number(-0.3, 0.3), 1} * random.number(1, 50);
        const Ray<R> ray{org, (through - org) * random.number(0.01, 2)};
        const Hit<R> hit = closest_hit(solid.scene, ray);
        const R z = is_hit(hit) ? (ray.org + ray.dir * hit.shape.t).z : R(0);
        ASSERT_LT(z, R(1.0999)) << "a film at ray " << i;
    }
}

TYPED_TEST(SolidScene, CommonFacesBelongToTheFirstOperand) {
    using R = TypeParam;
    for (const CsgOp op : {CsgOp::unite, CsgOp::intersect}) {
        const Solid<R> solid({op, {box<R>({-1, -1, -1}, {1, 1, 1}), box<R>({-2, -1, -1}, {0, 1, 1})}, {}});
        const Hit<R> hit = along_z<R>(solid, R(-0.5), 0);
        EXPECT_EQ(hit.shape.t, R(9));
        EXPECT_EQ(hit.id, 1U);
    }
}

TYPED_TEST(SolidScene, SurfacesBetweenUnitedSolidsAreNotSeen) {
    using R = TypeParam;
    const Solid<R> solid(
        {CsgOp::unite,
         {box<R>({-1, -1, -1}, {1, 1, 0}), box<R>({-1, -1, 0}, {1, 1, 1}), ball<R>({0, 0, 0}, R(0.9))},
         {}});
    EXPECT_EQ(along_z<R>(solid, R(0.1), R(0.2)).shape.t, R(9));
    // From within, the outside is the first that is met.
    EXPECT_EQ(along_z<R>(solid, R(0.1), R(0.2), R(0.5)).shape.t, R(1.5));
}

TYPED_TEST(SolidScene, SubtractedSubtractionFacesOutwards) {
    using R = TypeParam;
    // A - (B - C): a box with a spherical hollow, in which there stands a smaller ball.
    const Node<R> inner{CsgOp::subtract, {ball<R>({0, 0, 1}, R(0.8)), ball<R>({0, 0, 1}, R(0.4))}, {}};
    const Solid<R> solid({CsgOp::subtract, {box<R>({-1, -1, -1}, {1, 1, 1}), inner}, {}});
    EXPECT_NEAR(static_cast<double>(normal_along_z<R>(solid, 0, 0).z), 1, 1e-6); // the box's face
    const Vec3<R> hollow = normal_along_z<R>(solid, R(0.6), 0);
    EXPECT_LT(hollow.x, 0); // towards the hollow's centre
    EXPECT_GT(hollow.z, 0);
}

TYPED_TEST(SolidScene, DifferenceWithItselfIsEmpty) {
    using R = TypeParam;
    Random<R> random(8);
    for (int i = 0; i < 50; ++i) {
        const Node<R> part = random_node(random, 2);
        const Solid<R> solid({CsgOp::subtract, {part, part}, {}});
        for (int k = 0; k < 50; ++k) {
            EXPECT_FALSE(is_hit(closest_hit(solid.scene, ray_at(solid, random))));
        }
    }
}

TYPED_TEST(SolidScene, PolyhedronOfHalfSpacesIsBounded) {
    using R = TypeParam;
    Node<R> cube{CsgOp::intersect, {}, {}};
    for (int i = 0; i < 6; ++i) {
        Vec3<R> normal{};
        (i / 2 == 0 ? normal.x : i / 2 == 1 ? normal.y : normal.z) = i % 2 == 0 ? R(1) : R(-1);
        cube.operands.push_back({CsgOp::member, {}, Plane<R>{normal, R(1)}});
    }
    const Solid<R> solid(cube);
    const Bounds<R> bounds = bounds_of(solid.scene, solid.scene.primitives(Of<Bare<Csg<R>>>{})[0]);
    EXPECT_NEAR(static_cast<double>(bounds.min.x), -1, 1e-5);
    EXPECT_NEAR(static_cast<double>(bounds.max.z), 1, 1e-5);
    EXPECT_EQ(along_z<R>(solid, R(0.3), R(0.4)).shape.t, R(9));
    EXPECT_FALSE(is_hit(along_z<R>(solid, R(1.3), R(0.4))));
}

/// Two octahedra in one mesh, which have a part in common; rays go through corners and edges of both.
TYPED_TEST(SolidScene, MeshThatOverlapsItselfIsOneBody) {
    using R = TypeParam;
    std::vector<float> positions = octahedron_corners();
    std::vector<std::uint32_t> indices(std::begin(octahedron_triangles), std::end(octahedron_triangles));
    for (const float corner : octahedron_corners(0.5F)) {
        positions.push_back(corner);
    }
    for (const std::uint32_t corner : octahedron_triangles) {
        indices.push_back(corner + 6);
    }
    const MeshStorage both = build_mesh(positions, indices);
    const auto crossings = [&](Ray<R> ray) {
        std::vector<R> result;
        for (Crossing<R> next; (next = cross_mesh<R>(both.data(), ray)).hit.t < infinity<R>();) {
            EXPECT_EQ(next.outwards, result.size() % 2 == 1);
            result.push_back(ray.org.x + next.hit.t * ray.dir.x);
            ray.t_min = next.hit.t + R(1e-4);
        }
        return result;
    };
    EXPECT_EQ(crossings({{-4, 0, 0}, {1, 0, 0}}), (std::vector<R>{-0.75, 1.25})); // corners
    EXPECT_EQ(crossings({{-4, 0.25, 0}, {1, 0, 0}}), (std::vector<R>{-0.5, 1}));  // edges
    EXPECT_EQ(crossings({{-4, 0.125, 0.125}, {1, 0, 0}}), (std::vector<R>{-0.5, 1}));
    EXPECT_EQ(crossings({{-4, 0.625, 0}, {1, 0, 0}}), (std::vector<R>{-0.125, 0.125, 0.375, 0.625}));
    EXPECT_EQ(crossings({{-4, 0.75, 0}, {1, 0, 0}}), std::vector<R>{}); // an outline
    const Crossing<R> out = cross_mesh<R>(both.data(), {{1, 0, 0}, {0, -1, 0}});
    EXPECT_EQ(out.hit.t, R(0.25));
    EXPECT_TRUE(out.outwards);
}

TYPED_TEST(SolidScene, HierarchyMeetsTheSame) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(9);
    for (int i = 0; i < 10; ++i) {
        Solid<R> solid(ball<R>({0, 0, 0}, R(0.2)));
        for (int k = 0; k < 20; ++k) {
            solid.add({CsgOp::intersect, {random_node(random, 2), box<R>({-2, -2, -2}, {2, 2, 2})}});
            solid.scene.add(Bare<Sphere<R>>{{random.vector(2), R(0.3)}, {solid.next_id++, {}}});
        }
        DynamicScene<R> with_hierarchy = solid.scene;
        prepare(with_hierarchy);
        ASSERT_FALSE(with_hierarchy.accelerator.nodes.empty());
        for (int k = 0; k < 30; ++k) {
            Ray<L> pack;
            for (int n = 0; n < lane_count<L>; ++n) {
                set_ray(pack, n, ray_at(solid, random));
            }
            const Hit<L> expected = closest_hit(solid.scene, pack), hit = closest_hit(with_hierarchy, pack);
            for (int n = 0; n < lane_count<L>; ++n) {
                EXPECT_EQ(lane(hit, n).shape.t, lane(expected, n).shape.t);
                EXPECT_EQ(lane(hit, n).id, lane(expected, n).id);
            }
        }
    }
}

} // namespace
