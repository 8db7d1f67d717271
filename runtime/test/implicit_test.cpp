#include "runtime/raycast.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

constexpr auto unit_ball = [](const auto& p) { return square(p.x) + square(p.y) + square(p.z) - 1; };

/// Around the y axis.
struct Torus {
    /// Of radii 1 and 1/2.
    template <class V>
    auto operator()(const V& p) const {
        const auto around = square(p.x) + square(p.z);
        return square(around + square(p.y) + 0.75F) - around * 4;
    }
};

constexpr auto gyroid = [](const auto& p) {
    return sine(p.x) * cosine(p.y) + sine(p.y) * cosine(p.z) + sine(p.z) * cosine(p.x);
};

template <class R>
Implicit<R> inside_box(R half) {
    return {0, Container<R>::of(Box<R>{{-half, -half, -half}, {half, half, half}})};
}

template <class R>
Ray<R> random_ray(Random<R>& random, double target) {
    const Vec3<R> org = random.direction() * random.number(3, 10);
    return {org, (random.vector(target) - org) * random.number(0.2, 3)};
}

template <class R>
R nothing() {
    return infinity<R>();
}

/// Where a field first changes its sign along a ray, by looking everywhere in long double.
template <class Field>
long double first_change(const Ray<double>& ray, double begin, double end, const Field& field) {
    using Wide = long double;
    const auto value = [&](Wide t) { return field(lanes<Wide>(ray.org) + lanes<Wide>(ray.dir) * t); };
    constexpr int steps = 4000;
    Wide before = begin;
    const Wide sign = value(before);
    for (int i = 1; i <= steps; ++i) {
        Wide after = begin + (Wide(end) - begin) * i / steps;
        if (value(after) * sign < 0) {
            for (int k = 0; k < 80; ++k) {
                const Wide middle = (before + after) / 2;
                (value(middle) * sign < 0 ? after : before) = middle;
            }
            return after;
        }
        before = after;
    }
    return infinity<Wide>();
}

template <class R>
class ImplicitIn : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ImplicitIn, Reals);

TYPED_TEST(ImplicitIn, ABallIsTheSphere) {
    using R = TypeParam;
    constexpr R eps = std::numeric_limits<R>::epsilon();
    Random<R> random(31);
    const Sphere<R> sphere;
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const Ray<R> ray = random_ray(random, 1.3);
        const ShapeHit<R> expected = sphere.intersect(ray);
        const ShapeHit<R> hit = intersect_implicit(inside_box(R(2)), ray, unit_ball);
        if (!(expected.t < infinity<R>())) {
            EXPECT_EQ(hit.t, infinity<R>());
            continue;
        }
        const auto surface = sphere.surface(ray, expected);
        if (dot(surface.normal, ray.dir) < R(-0.02) * length(ray.dir)) {
            ++hits;
            ASSERT_NEAR(hit.t, expected.t, 1000 * eps * expected.t);
            const auto at = implicit_surface(inside_box(R(2)), ray, hit, unit_ball);
            EXPECT_LT(length(at.normal - surface.normal), 1000 * eps);
        }
    }
    EXPECT_GT(hits, 700);
}

TYPED_TEST(ImplicitIn, RaysThatLeaveDoNotMeetTheSurfaceAgain) {
    using R = TypeParam;
    Random<R> random(32);
    int left = 0, crossed = 0;
    const auto check = [&](const Implicit<R>& shape, const auto& field, bool convex) {
        for (int i = 0; i < 600; ++i) {
            const Ray<R> ray = random_ray(random, 1.2);
            const ShapeHit<R> hit = intersect_implicit(shape, ray, field);
            if (!(hit.t < infinity<R>())) {
                continue;
            }
            const Surface<R> at = implicit_surface(shape, ray, hit, field);
            for (const double slope : {3.0, 0.1, 1e-3, 1e-5, 0.0}) {
                const Vec3<R> tangent = normalize(cross(at.normal, random.direction()));
                const Vec3<R> out = tangent + at.normal * R(slope), in = tangent - at.normal * R(1 + slope);
                if (convex && dot(out, at.normal) > 0) {
                    const Ray<R> away{start_off(at, out), out, spawned_t_min<R>(), infinity<R>()};
                    ASSERT_EQ(intersect_implicit(shape, away, field).t, nothing<R>()) << slope;
                    ++left;
                }
                const Ray<R> inwards{start_off(at, in), in, spawned_t_min<R>(), infinity<R>()};
                const ShapeHit<R> far = intersect_implicit(shape, inwards, field);
                if (far.t < infinity<R>()) {
                    ++crossed;
                    ASSERT_GT(dot(implicit_surface(shape, inwards, far, field).normal, in), 0)
                        << "leaves there";
                }
            }
        }
    };
    check(inside_box(R(2)), unit_ball, true);
    check({0, Container<R>::of(Sphere<R>{{0, 0, 0}, R(0.9)})}, unit_ball, true);
    check({0, Container<R>::of(Cylinder<R>{{0, R(-0.5), 0}, {0, R(0.5), 0}, 1})}, unit_ball, true);
    check(inside_box(R(2)), Torus{}, false);
    check(
        {0, Container<R>::of(Sphere<R>{{0, 0, 0}, 2})},
        [](const auto& p) {
            return gyroid(Vec3<std::decay_t<decltype(p.x)>>{p.x * 4, p.y * 4, p.z * 4});
        },
        false);
    EXPECT_GT(left, 3000);
    EXPECT_GT(crossed, 5000);
}

TYPED_TEST(ImplicitIn, PacksFindWhatSingleRaysFind) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(33);
    const Implicit<R> shape{0, Container<R>::of(Sphere<R>{{0, 0, 0}, 6})};
    for (int i = 0; i < 200; ++i) {
        Ray<R> rays[lane_count<L>];
        Ray<L> pack;
        for (int k = 0; k < lane_count<L>; ++k) {
            rays[k] = random_ray(random, 5);
            rays[k].t_max = k % 5 == 3 ? R(0.7) : infinity<R>();
            set_lane(pack.org.x, k, rays[k].org.x);
            set_lane(pack.org.y, k, rays[k].org.y);
            set_lane(pack.org.z, k, rays[k].org.z);
            set_lane(pack.dir.x, k, rays[k].dir.x);
            set_lane(pack.dir.y, k, rays[k].dir.y);
            set_lane(pack.dir.z, k, rays[k].dir.z);
            set_lane(pack.t_max, k, rays[k].t_max);
        }
        const ShapeHit<L> hit = intersect_implicit(shape, pack, gyroid);
        const Surface<L> at = implicit_surface(shape, pack, hit, gyroid);
        for (int k = 0; k < lane_count<L>; ++k) {
            const ShapeHit<R> alone = intersect_implicit(shape, rays[k], gyroid);
            ASSERT_EQ(lane(hit.t, k), alone.t);
            if (alone.t < infinity<R>()) {
                ASSERT_EQ(lane(hit.part, k), alone.part);
                ASSERT_EQ(lane(at.normal.x, k), implicit_surface(shape, rays[k], alone, gyroid).normal.x);
            }
        }
    }
}

TYPED_TEST(ImplicitIn, TheRangeEndsAtTheHit) {
    using R = TypeParam;
    Random<R> random(34);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        Ray<R> ray = random_ray(random, 1.5);
        const ShapeHit<R> hit = intersect_implicit(inside_box(R(2)), ray, Torus{});
        if (hit.t < infinity<R>()) {
            ++hits;
            ray.t_max = hit.t;
            EXPECT_EQ(intersect_implicit(inside_box(R(2)), ray, Torus{}).t, hit.t);
            ray.t_max = std::nextafter(hit.t, R(0));
            EXPECT_EQ(intersect_implicit(inside_box(R(2)), ray, Torus{}).t, infinity<R>());
        }
    }
    EXPECT_GT(hits, 100);
}

template <class Field>
void expect_first_changes(const Field& field, const Container<double>& container, double target, int count) {
    Random<double> random(35);
    int hits = 0;
    for (int i = 0; i < count; ++i) {
        const Ray<double> ray = random_ray(random, target);
        const Passage<double> inside = passage(container, ray);
        const ShapeHit<double> hit = intersect_implicit(Implicit<double>{0, container}, ray, field);
        if (!(inside.near.t < infinity<double>())) {
            ASSERT_EQ(hit.t, infinity<double>());
            continue;
        }
        const double begin = std::max(inside.near.t, 0.0);
        if (field(ray.org + begin * ray.dir) < 0) {
            if (inside.near.t >= 0) {
                ASSERT_EQ(hit.t, begin);
            }
            continue;
        }
        const long double expected = first_change(ray, begin, inside.far.t, field);
        if (expected < infinity<long double>()) {
            ++hits;
            ASSERT_LE(hit.t, expected + 1e-12L * std::abs(expected)) << i;
        }
        // The steps of the search here may have gone over what is thin.
        if (hit.t < infinity<double>() && hit.t < static_cast<double>(expected) - 1e-3) {
            const Vec3<double> before = ray.org + (hit.t - 1e-9) * ray.dir,
                               after = ray.org + (hit.t + 1e-9) * ray.dir;
            ASSERT_LT(field(after), field(before));
        } else if (expected < infinity<long double>()) {
            ASSERT_NEAR(hit.t, static_cast<double>(expected), 1e-11 * (1 + static_cast<double>(expected)))
                << i;
        }
    }
    EXPECT_GT(hits, count / 10);
}

TEST(Implicit, FindsTheFirstChangeOfSign) {
    expect_first_changes(Torus{}, Container<double>::of(Box<double>{{-2, -1, -2}, {2, 1, 2}}), 1.5, 600);
    expect_first_changes(gyroid, Container<double>::of(Sphere<double>{{0, 0, 0}, 8}), 6, 300);
    expect_first_changes([](const auto& p) { return absolute(gyroid(p)) - 0.02; },
                         Container<double>::of(Cylinder<double>{{0, -4, 0}, {0, 4, 0}, 4}), 4, 300);
    expect_first_changes([](const auto& p) { return noise_number(p.x * 2, p.y * 2, p.z * 2) - 0.5; },
                         Container<double>::of(Sphere<double>{{0, 0, 0}, 3}), 2, 200);
}

TEST(Implicit, DoesNotDependOnTheFieldsScale) {
    Random<double> random(36);
    for (int i = 0; i < 500; ++i) {
        const Ray<double> ray = random_ray(random, 1.4);
        const ShapeHit<double> hit = intersect_implicit(inside_box(2.0), ray, Torus{});
        for (const double scale : {0x1p-60, 0x1p-40, 0x1p40, 0x1p200}) {
            const auto stiff = [scale](const auto& p) { return Torus{}(p)*scale; };
            const double t = intersect_implicit(inside_box(2.0), ray, stiff).t;
            ASSERT_TRUE(t == hit.t || std::abs(t - hit.t) < 1e-14 * hit.t) << scale;
        }
        // 1e-12 to 1e12 over the container, through the same zeros
        const auto steep = [](const auto& p) { return exponential(p.y * 13) * Torus{}(p); };
        const ShapeHit<double> other = intersect_implicit(inside_box(2.0), ray, steep);
        ASSERT_EQ(other.t < nothing<double>(), hit.t < nothing<double>());
        if (hit.t < nothing<double>()) {
            const Vec3<double> n = implicit_surface(inside_box(2.0), ray, hit, Torus{}).normal;
            if (dot(n, ray.dir) < -0.05 * length(ray.dir)) {
                ASSERT_NEAR(other.t, hit.t, 1e-12);
            }
        }
    }
}

TEST(Implicit, ThinShellsHaveTwoSides) {
    for (const double half : {1e-2, 1e-5, 1e-8, 1e-11}) {
        const auto shell = [half](const auto& p) {
            return absolute(square_root(unit_ball(p) + 1) - 1) - half;
        };
        Random<double> random(37);
        for (int i = 0; i < 100; ++i) {
            const Ray<double> ray{random.direction() * 4.0, random.direction() * 0.3, 0, infinity<double>()};
            const Ray<double> inwards{ray.org, ray.dir - ray.org, 0, infinity<double>()};
            const ShapeHit<double> hit = intersect_implicit(inside_box(2.0), inwards, shell);
            ASSERT_NEAR(length(inwards.org + hit.t * inwards.dir), 1 + half, 1e-14);
            Ray<double> rest = inwards;
            rest.t_min = std::nextafter(hit.t, 10.0);
            const ShapeHit<double> inner = intersect_implicit(inside_box(2.0), rest, shell);
            ASSERT_NEAR(length(inwards.org + inner.t * inwards.dir), 1 - half, 1e-14);
        }
    }
}

TEST(Implicit, WhatOnlyTouchesIsCountedAndNotDrawn) {
    const std::uint64_t before = field_counts.undecided;
    const auto sheet = [](const auto& p) { return square(p.y); };
    EXPECT_EQ(intersect_implicit(inside_box(1.0), Ray<double>{{0.1, 5, 0.2}, {0.1, -1, 0.05}}, sheet).t,
              infinity<double>());
    EXPECT_EQ(field_counts.undecided, before + 1);
    // A ray past the ball by more than rounding is decided; one that touches it is not or is a hit.
    EXPECT_EQ(intersect_implicit(inside_box(2.0), Ray<double>{{1 + 1e-12, 5, 0}, {0, -1, 0}}, unit_ball).t,
              infinity<double>());
    EXPECT_EQ(field_counts.undecided, before + 1);
    EXPECT_LT(intersect_implicit(inside_box(2.0), Ray<double>{{1 - 1e-12, 5, 0}, {0, -1, 0}}, unit_ball).t,
              infinity<double>());
    EXPECT_EQ(field_counts.undecided, before + 1);
    const ShapeHit<double> touching =
        intersect_implicit(inside_box(2.0), Ray<double>{{1, 5, 0}, {0, -1, 0}}, unit_ball);
    EXPECT_TRUE(touching.t < infinity<double>() || field_counts.undecided == before + 2);
}

TEST(Implicit, AFieldThatIsZeroOnAStretchEnds) {
    const auto flat = [](const auto& p) { return maximum(unit_ball(p), 0); };
    EXPECT_EQ(intersect_implicit(inside_box(2.0), Ray<double>{{0.1, 5, 0.2}, {0, -1, 0}}, flat).t,
              infinity<double>());
    const auto outer = [](const auto& p) { return minimum(unit_ball(p), 0); };
    EXPECT_NEAR(intersect_implicit(inside_box(2.0), Ray<double>{{0, 5, 0}, {0, -1, 0}}, outer).t, 4, 1e-6);
}

TEST(Implicit, JumpsAndRootsWithoutSlopeAreSurfaces) {
    const Ray<double> along_x{{-5, 0.1, 0.2}, {1, 0, 0}};
    const auto t = [&](const auto& field) { return intersect_implicit(inside_box(2.0), along_x, field).t; };
    EXPECT_NEAR(t([](const auto& p) { return 0.5 - round_down(p.x); }), 6, 1e-13) << "jumps at 1";
    EXPECT_NEAR(t([](const auto& p) { return choose(p.x < 0.25, 1 + p.x * 0, p.x * 0 - 1); }), 5.25, 1e-13);
    EXPECT_NEAR(t([](const auto& p) { return square_root(absolute(p.x)) - 0.5; }), 4.75, 1e-13);
    EXPECT_NEAR(t([](const auto& p) { return -(p.x * square(p.x)); }), 5, 1e-4) << "a triple root";
    EXPECT_EQ(t([](const auto& p) { return p.x - 3; }), 3) << "inside everywhere: the container";
    EXPECT_EQ(t([](const auto& p) { return 3 - p.x; }), nothing<double>());
    EXPECT_EQ(intersect_implicit(inside_box(2.0), Ray<double>{{0, 0, 0}, {1, 0, 0}},
                                 [](const auto& p) { return p.x - 3; })
                  .t,
              2)
        << "from within, the container's far side";
}

} // namespace
