#include "runtime/illumination.h"
#include "runtime/math/pack.h"
#include "runtime/primitive.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

#include <bit>

/// The formulas give the same bits in every lane of a pack as for that lane alone.
using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

template <class T>
class PackedFormulas : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PackedFormulas, Reals);

template <class T>
bool same(T a, T b) {
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b) || (a != a && b != b);
}
template <class L>
Vec3<RealOf<L>> lane_of(const Vec3<L>& v, int i) {
    return {lane(v.x, i), lane(v.y, i), lane(v.z, i)};
}
template <class T>
bool same(const Vec3<T>& a, const Vec3<T>& b) {
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}
template <class L>
void set(Vec3<L>& v, int i, const Vec3<RealOf<L>>& value) {
    set_lane(v.x, i, value.x);
    set_lane(v.y, i, value.y);
    set_lane(v.z, i, value.z);
}

/// Rays that meet the shape, miss it, run along axes and start on corners.
template <class R>
Ray<R> some_ray(Random<R>& random, const Vec3<R>& near) {
    Ray<R> ray{random.vector(4), random.direction()};
    if (random.number(0, 1) < 0.6) {
        ray.dir = near + random.vector(1) - ray.org;
    }
    if (random.number(0, 1) < 0.2) {
        ray.dir.x = 0;
    }
    if (random.number(0, 1) < 0.2) {
        ray.dir.y = R(-0.0);
    }
    if (random.number(0, 1) < 0.2) {
        ray.t_max = random.number(0, 5);
    }
    return ray;
}

template <class Shape, class R>
int compare_shape(const Shape& shape, const Vec3<R>& near, Random<R>& random) {
    using L = WidestLane<R>;
    Ray<R> single[lane_count<L>];
    Ray<L> packed;
    for (int i = 0; i < lane_count<L>; ++i) {
        single[i] = some_ray(random, near);
        set(packed.org, i, single[i].org);
        set(packed.dir, i, single[i].dir);
        set_lane(packed.t_max, i, single[i].t_max);
    }
    int hits = 0;
    const ShapeHit<L> hit = shape.intersect(packed);
    const Surface<L> surface = shape.surface(packed, hit);
    const Vec3<L> start = start_off(surface, packed.dir);
    for (int i = 0; i < lane_count<L>; ++i) {
        const ShapeHit<R> alone = shape.intersect(single[i]);
        EXPECT_TRUE(same(lane(hit.t, i), alone.t)) << lane(hit.t, i) << " not " << alone.t;
        if (alone.t < infinity<R>()) {
            ++hits;
            EXPECT_EQ(lane(hit.part, i), alone.part);
            const Surface<R> expected = shape.surface(single[i], alone);
            EXPECT_TRUE(same(lane_of(surface.point, i), expected.point));
            EXPECT_TRUE(same(lane_of(surface.error, i), expected.error));
            EXPECT_TRUE(same(lane_of(surface.normal, i), expected.normal));
            EXPECT_TRUE(same(lane_of(surface.shading_normal, i), expected.shading_normal));
            EXPECT_TRUE(same(lane_of(start, i), start_off(expected, single[i].dir)));
        }
    }
    return hits;
}

template <class R, class... Shape>
void compare_shapes(TypeList<Shape...>) {
    Random<R> random(3);
    const auto compare = [&]<class S>(S shape) {
        if constexpr (!is_mesh<S> && !is_implicit<S>) { // see implicit_test.cpp
            int hits = 0;
            for (int i = 0; i < 500; ++i) {
                randomize(shape, random, 1);
                Vec3<R> near{};
                if constexpr (is_bounded<S>) {
                    near = shape.bounds().center();
                }
                hits += compare_shape(shape, near, random);
            }
            EXPECT_GT(hits, 50) << S::name;
        }
    };
    (compare(Shape{}), ...);
}

TYPED_TEST(PackedFormulas, ShapesGiveTheScalarBits) {
    compare_shapes<TypeParam>(Primitives<TypeParam>{});
}

TYPED_TEST(PackedFormulas, SmoothTriangleGivesTheScalarBits) {
    Random<TypeParam> random(4);
    Triangle<TypeParam> triangle;
    triangle.smooth = true;
    for (int i = 0; i < 200; ++i) {
        randomize(triangle, random, 1);
        triangle.normals = {random.vector(2), random.vector(2), random.vector(2)};
        compare_shape(triangle, triangle.points[0], random);
    }
}

TYPED_TEST(PackedFormulas, TransformedSurfaceGivesTheScalarBits) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(5);
    for (int round = 0; round < 200; ++round) {
        const Affine<double> map = random.map(10);
        const Affine<R> to = affine_cast<R>(map), from = affine_cast<R>(inverse(map));
        Surface<L> packed;
        Surface<R> single[lane_count<L>];
        for (int i = 0; i < lane_count<L>; ++i) {
            single[i] = {random.vector(3), absolute(random.vector(1e-6)), random.direction(),
                         random.direction()};
            set(packed.point, i, single[i].point);
            set(packed.error, i, single[i].error);
            set(packed.normal, i, single[i].normal);
            set(packed.shading_normal, i, single[i].shading_normal);
        }
        const Surface<L> moved = transform_surface(to, from, packed);
        for (int i = 0; i < lane_count<L>; ++i) {
            const Surface<R> expected = transform_surface(to, from, single[i]);
            EXPECT_TRUE(same(lane_of(moved.point, i), expected.point));
            EXPECT_TRUE(same(lane_of(moved.error, i), expected.error));
            EXPECT_TRUE(same(lane_of(moved.normal, i), expected.normal));
        }
    }
}

// Absolutely, since highlights are added to colours of about 1; so what is below a rounding may be 0.
TYPED_TEST(PackedFormulas, PowersAreOffByAFewRoundingsOfOne) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(8);
    int zeros = 0;
    for (int round = 0; round < 20000; ++round) {
        const R y = random.number(0, 1) < 0.5 ? random.number(0, 3) : std::exp2(random.number(0, 30));
        // Mostly where the power is neither 0 nor 1.
        const R middle = std::exp2(-minimum(random.number(0, 40) / y, R(120)));
        const R x = round % 4 == 0 ? random.number(0, 1) : round % 100 == 1 ? R(round % 200 == 1) : middle;
        const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
        const R found = unit_power(x, y);
        EXPECT_LE(std::abs(static_cast<long double>(found) - exact), 4 * roundoff<R>()) << x << " ^ " << y;
        EXPECT_TRUE(same(lane(unit_power(L(x), L(y)), 0), found)) << x << " ^ " << y;
        zeros += found == 0 ? 1 : 0;
    }
    EXPECT_GT(zeros, 1000);
    EXPECT_EQ(unit_power(R(0), R(0)), 1);
}

TYPED_TEST(PackedFormulas, ShadingTermsGiveTheScalarBits) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(6);
    for (int round = 0; round < 500; ++round) {
        const PointLight<R> light{random.vector(5),    {1, 1, 1},          {1, 1, 1}, 1,
                                  random.number(0, 1), random.number(0, 1)};
        Vec3<L> point, normal, to_viewer;
        for (int i = 0; i < lane_count<L>; ++i) {
            set(point, i, random.vector(3));
            set(normal, i, random.direction());
            set(to_viewer, i, random.direction());
        }
        const R shininess = random.number(0, 200);
        const LightAt<L> seen = light_at(light, point);
        const L bright = highlight(normal, seen.to_light, to_viewer, L(shininess));
        const L weaker = attenuation(light, seen.distance);
        const Vec3<L> mirrored = reflect(to_viewer, normal);
        for (int i = 0; i < lane_count<L>; ++i) {
            const LightAt<R> one = light_at(light, lane_of(point, i));
            EXPECT_TRUE(same(lane_of(seen.to_light, i), one.to_light));
            EXPECT_TRUE(same(lane(bright, i),
                             highlight(lane_of(normal, i), one.to_light, lane_of(to_viewer, i), shininess)));
            EXPECT_TRUE(same(lane(weaker, i), attenuation(light, one.distance)));
            EXPECT_TRUE(same(lane_of(mirrored, i), reflect(lane_of(to_viewer, i), lane_of(normal, i))));
        }
    }
}

} // namespace
