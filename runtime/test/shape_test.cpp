#include "runtime/raycast.h"
#include "runtime/test/contains.h"
#include "runtime/test/random_scene.h"
#include "runtime/test/signed_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <type_traits>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

template <class... Lists>
struct Joined;
template <class... A>
struct Joined<TypeList<A...>> {
    using list = TypeList<A...>;
    using types = testing::Types<A...>;
};
template <class... A, class... B, class... Rest>
struct Joined<TypeList<A...>, TypeList<B...>, Rest...> : Joined<TypeList<A..., B...>, Rest...> {};

template <class Shape>
struct RealOfShape;
template <template <class> class Shape, class R>
struct RealOfShape<Shape<R>> {
    using type = R;
};

template <class Shape>
class EveryShape : public testing::Test {
public:
    using Real = typename RealOfShape<Shape>::type;
    static constexpr double eps = static_cast<double>(std::numeric_limits<Real>::epsilon());

    /// f(single, random) for bare and placed shapes, near the origin and farther off.
    template <class F>
    static void for_scenes(int count, F&& f) {
        Random<Real> random(7);
        count = property_count(count);
        for (const double distance : {2.0, 300.0}) {
            for (int i = 0; i < count; ++i) {
                f(SingleShape<Shape, Real>(random, i % 2 == 1, distance), random);
            }
        }
    }

    /// f(single, random, ray, hit, surface) for hits of such scenes.
    template <class F>
    static void for_hits(int count, F&& f) {
        int hits = 0;
        for_scenes(count, [&](const SingleShape<Shape, Real>& single, Random<Real>& random) {
            for (int i = 0; i < 20; ++i) {
                const Ray<Real> ray = single.ray_towards(random);
                const Hit<Real> hit = closest_hit(single.scene, ray);
                if (is_hit(hit)) {
                    ++hits;
                    f(single, random, ray, hit, single.surface(ray, hit));
                }
            }
        });
        EXPECT_GT(hits, property_count(count) * 4);
    }

    /// Whether no ray that starts on the surface, on the side that `dir` goes to, can meet the shape again.
    static bool is_left_for_good(const SingleShape<Shape, Real>& single,
                                 const typename SingleShape<Shape, Real>::Place& at, const Vec3<Real>& dir) {
        const bool outwards = dot(at.surface.normal, dir) > 0;
        if constexpr (requires { single.shape.hole; } || std::is_same_v<Shape, Triangle<Real>> ||
                      std::is_same_v<Shape, Plane<Real>>) {
            return true;
        }
        if constexpr (requires { Shape().cross(Ray<Real>{}); }) { // not convex
            const Affine<long double> back = inverse(affine_cast<long double>(single.world_from_object));
            const Vec3<Real> org = start_off(at.surface, dir);
            const Ray<long double> ray{transform_point(back, lanes<long double>(org)),
                                       transform_vector(back, lanes<long double>(dir))};
            return !(wide(single.shape).intersect(ray).t < infinity<long double>());
        }
        return outwards && !is_mesh<Shape>;
    }
    /// In long double, which knows whether a ray meets a shape again.
    static Torus<long double> wide(const Torus<Real>& s) {
        return {lanes<long double>(s.center), lanes<long double>(s.axis), s.major, s.minor};
    }
    static Quadric<long double> wide(const Quadric<Real>& s) {
        return {lanes<long double>(s.squares), lanes<long double>(s.products), lanes<long double>(s.linear),
                s.constant};
    }

    /// Whether a ray that starts inside of the side that it left is outside of another, since the shape is
    /// thinner there than the bound by which rays start off its surface.
    static bool is_beyond_a_thin_part(const SingleShape<Shape, Real>& single,
                                      const typename SingleShape<Shape, Real>::Place& at,
                                      const Vec3<Real>& org) {
        const Affine<long double> back = inverse(affine_cast<long double>(single.world_from_object));
        const Wide p = transform_point(back, lanes<long double>(org)),
                   slack = transform_magnitude(back, lanes<long double>(at.surface.error)) * 0.5L;
        for (const Wide& shift : {Wide{slack.x, 0, 0}, Wide{0, slack.y, 0}, Wide{0, 0, slack.z}}) {
            if (!is_in(single, p - shift) || !is_in(single, p + shift)) {
                return true;
            }
        }
        return false;
    }
    static bool is_in(const SingleShape<Shape, Real>& single, const Wide& p) {
        if constexpr (is_mesh<Shape>) { // a convex one
            const MeshData mesh = single.mesh.data();
            for (const TrianglePlace& place : places_of(single.mesh)) {
                const auto corners = corners_at<float>(mesh, place);
                const Wide a = lanes<long double>(corners.a);
                if (dot(cross(lanes<long double>(corners.b) - a, lanes<long double>(corners.c) - a), p - a) >
                    0) {
                    return false;
                }
            }
            return true;
        } else if constexpr (is_implicit<Shape>) { // see add_field
            const Wide from_center = p - lanes<long double>(single.shape.within.first);
            return dot(from_center, from_center) <
                   static_cast<long double>(single.shape.within.radius * single.shape.within.radius *
                                            Real(0.75));
        } else if constexpr (requires { contains(single.shape, p); }) {
            return contains(single.shape, p);
        } else {
            return false; // has no inside
        }
    }

    /// Whether a ray that starts off the surface by the bound and more all but touches it at the hit: what
    /// rounding cannot tell from touching it.
    static bool all_but_touches(const SingleShape<Shape, Real>& single, const Ray<Real>& ray,
                                const Hit<Real>& hit) {
        if constexpr (requires(Wide p) { signed_distance(single.shape, p, p); }) {
            const auto at = single.surface(ray, hit);
            const Affine<long double> map = affine_cast<long double>(single.world_from_object),
                                      back = inverse(map);
            const Wide n = normalize(transform_normal(map, lanes<long double>(at.surface.normal)));
            const auto distance = [&](long double t) {
                const Wide p = lanes<long double>(ray.org) + lanes<long double>(ray.dir) * t;
                return std::abs(signed_distance(single.shape, transform_point(back, p), n));
            };
            const long double bound =
                dot(absolute(n), transform_magnitude(back, lanes<long double>(at.surface.error)));
            return distance(0) >= bound / 2 && distance(hit.shape.t) <= bound / 4;
        } else {
            return false;
        }
    }
};

using AllShapes = Joined<Primitives<float>, Primitives<double>, Primitives<long double>>::types;
TYPED_TEST_SUITE(EveryShape, AllShapes);

template <bool keep, class Shape>
using If = std::conditional_t<keep, TypeList<Shape>, TypeList<>>;

template <class>
struct WithBounds;
template <class... Shape>
struct WithBounds<TypeList<Shape...>> : Joined<If<is_bounded<Shape>, Shape>...> {};
template <class>
struct WithFormula;
template <class... Shape>
struct WithFormula<TypeList<Shape...>> : Joined<If<!is_mesh<Shape> && !is_implicit<Shape>, Shape>...> {};

template <class Shape>
class BoundedShape : public EveryShape<Shape> {};
using BoundedShapes = WithBounds<Primitives<double>>::types;
TYPED_TEST_SUITE(BoundedShape, BoundedShapes);

/// Shapes whose surface has a formula, in precisions that long double can judge.
template <class Shape>
class ShapeWithFormula : public EveryShape<Shape> {};
using ShapesWithFormulas = WithFormula<Joined<Primitives<float>, Primitives<double>>::list>::types;
TYPED_TEST_SUITE(ShapeWithFormula, ShapesWithFormulas);

TYPED_TEST(BoundedShape, HitIsInsideTheBounds) {
    using R = typename RealOfShape<TypeParam>::type;
    this->for_hits(200, [&](const auto& single, auto&, const auto&, const auto&, const auto& at) {
        const Bounds<R> b = single.bounds();
        const Vec3<R> p = at.surface.point, e = at.surface.error;
        EXPECT_TRUE(b.min.x <= p.x + e.x && p.x - e.x <= b.max.x);
        EXPECT_TRUE(b.min.y <= p.y + e.y && p.y - e.y <= b.max.y);
        EXPECT_TRUE(b.min.z <= p.z + e.z && p.z - e.z <= b.max.z);
    });
}

TYPED_TEST(ShapeWithFormula, HitIsOnTheSurfaceWithinTheStatedBound) {
    this->for_hits(200, [&](const auto& single, auto&, const auto&, const auto&, const auto& at) {
        const Affine<long double> map = affine_cast<long double>(single.world_from_object);
        const Affine<long double> back = inverse(map);
        const Wide p = transform_point(back, lanes<long double>(at.surface.point));
        const Wide n = normalize(transform_normal(map, lanes<long double>(at.surface.normal)));
        const Wide bound = transform_magnitude(back, lanes<long double>(at.surface.error));
        EXPECT_LE(std::abs(signed_distance(single.shape, p, n)), dot(absolute(n), bound));
    });
}

/// Within the bound of the point: near a cone's tip or on a thin tube, that is not the gradient at the point.
TYPED_TEST(ShapeWithFormula, NormalIsTheNormalisedGradient) {
    this->for_hits(200, [&](const auto& single, auto&, const auto&, const auto&, const auto& at) {
        const Affine<long double> map = affine_cast<long double>(single.world_from_object);
        const Wide p = lanes<long double>(at.object_point);
        const Wide unit = normalize(transform_normal(map, lanes<long double>(at.surface.normal)));
        const auto gradient = [&](const Wide& q) {
            const long double h = 1e-7L;
            const auto slope = [&](const Wide& d) {
                return (signed_distance(single.shape, q + d, unit) -
                        signed_distance(single.shape, q - d, unit)) /
                       (2 * h);
            };
            return Wide{slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
        };
        const Wide here = gradient(p),
                   bound = transform_magnitude(inverse(map), lanes<long double>(at.surface.error));
        long double change = 0; // of the gradient, from the point to others within the bound
        for (const Wide& d : {Wide{bound.x, 0, 0}, Wide{0, bound.y, 0}, Wide{0, 0, bound.z}}) {
            change += length(gradient(p + d) - here);
        }
        // The differences lose digits where a plane is met far off.
        const long double lost = 1e-9L * (8 + length(p));
        EXPECT_LE(length(here - unit), lost + 32 * static_cast<long double>(this->eps) + change);
        EXPECT_NEAR(static_cast<double>(length(at.surface.normal)), 1, 4 * this->eps);
    });
}

TYPED_TEST(EveryShape, AnyHitExistsExactlyWhereAClosestHitDoes) {
    using R = typename RealOfShape<TypeParam>::type;
    int met = 0, missed = 0;
    this->for_scenes(200, [&](const auto& single, Random<R>& random) {
        for (int i = 0; i < 20; ++i) {
            Ray<R> ray = single.ray_towards(random);
            const Hit<R> hit = closest_hit(single.scene, ray);
            EXPECT_EQ(any_hit(single.scene, ray), is_hit(hit));
            (is_hit(hit) ? met : missed) += 1;
            if (is_hit(hit)) {
                ray.t_max = hit.shape.t;
                EXPECT_TRUE(any_hit(single.scene, ray));
                ray.t_max = std::nextafter(hit.shape.t, R(-1));
                EXPECT_FALSE(any_hit(single.scene, ray));
            }
        }
    });
    EXPECT_GT(met, 500);
    if (!std::is_same_v<TypeParam, Plane<R>>) {
        EXPECT_GT(missed, 50);
    }
}

/// A direction that leaves to the normal's side; `slope` is its sine above the surface.
template <class R>
Vec3<R> leaving(const Vec3<R>& normal, R slope, Random<R>& random) {
    const Vec3<R> tangent = normalize(cross(normal, random.direction()));
    return normalize(tangent + normal * slope) * random.number(0.2, 5);
}

TYPED_TEST(EveryShape, RayLeavingTheSurfaceDoesNotMeetItAgain) {
    using R = typename RealOfShape<TypeParam>::type;
    int checked = 0;
    this->for_hits(200, [&](const auto& single, Random<R>& random, const auto&, const auto&, const auto& at) {
        for (const double slope : {3.0, 0.1, 1e-3, 1e-5, 1e-7, 1e-10, 1e-14, 0.0}) {
            for (const int side : {1, -1}) {
                const Vec3<R> dir = leaving<R>(at.surface.normal * R(side), R(slope), random);
                // A plane has no end at which a ray along it, to within rounding, would have left it.
                const R flattest =
                    is_bounded<TypeParam> ? R(0) : 64 * std::numeric_limits<R>::epsilon() * length(dir);
                if (dot(dir, at.surface.normal) * R(side) > flattest &&
                    this->is_left_for_good(single, at, dir)) {
                    ++checked;
                    const Ray<R> ray{start_off(at.surface, dir), dir, spawned_t_min<R>(), infinity<R>()};
                    const Hit<R> again = closest_hit(single.scene, ray);
                    EXPECT_EQ(any_hit(single.scene, ray), is_hit(again));
                    EXPECT_TRUE(!is_hit(again) || this->all_but_touches(single, ray, again))
                        << "slope " << slope << ", t " << again.shape.t;
                }
            }
        }
    });
    if (!is_mesh<TypeParam>) {
        EXPECT_GT(checked, 3000);
    }
}

TYPED_TEST(EveryShape, RayGoingInsideMeetsTheFarSideOnly) {
    using R = typename RealOfShape<TypeParam>::type;
    this->for_hits(200, [&](const auto& single, Random<R>& random, const auto&, const auto&, const auto& at) {
        if constexpr (requires { single.shape.caps; }) {
            if (!single.shape.caps) {
                return;
            }
        }
        const Vec3<R> dir = leaving<R>(-at.surface.normal, R(0.5), random);
        if (this->is_left_for_good(single, at, dir)) {
            return; // has no inside
        }
        const Ray<R> ray{start_off(at.surface, dir), dir, spawned_t_min<R>(), infinity<R>()};
        if (this->is_beyond_a_thin_part(single, at, ray.org)) {
            return;
        }
        const Hit<R> hit = closest_hit(single.scene, ray);
        ASSERT_TRUE(is_hit(hit));
        const auto far = single.surface(ray, hit);
        EXPECT_GT(dot(far.surface.normal, dir), 0) << "leaves there";
        const Ray<R> outside{start_off(far.surface, dir), dir, spawned_t_min<R>(), infinity<R>()};
        if (this->is_left_for_good(single, far, dir)) {
            const Hit<R> again = closest_hit(single.scene, outside);
            EXPECT_TRUE(!is_hit(again) || this->all_but_touches(single, outside, again));
        }
    });
}

TYPED_TEST(EveryShape, MovingRayAndObjectTogetherKeepsTheDistance) {
    using R = typename RealOfShape<TypeParam>::type;
    int rays = 0, others = 0;
    this->for_scenes(200, [&](const auto& single, Random<R>& random) {
        const Affine<long double> map = affine_cast<long double>(random.map(3));
        const Affine<long double> old = affine_cast<long double>(single.world_from_object);
        DynamicScene<R> moved;
        moved.meshes = single.scene.meshes;
        moved.functions = single.scene.functions;
        moved.add(Placed<TypeParam, R>{
            single.shape, affine_cast<R>(compose(map, old)), affine_cast<R>(inverse(compose(map, old))), {}});
        for (int i = 0; i < 20; ++i) {
            const Ray<R> ray = single.ray_towards(random);
            const Hit<R> hit = closest_hit(single.scene, ray);
            const Hit<R> other = closest_hit(moved, transform_ray(affine_cast<R>(map), ray));
            ++rays;
            if (is_hit(hit) != is_hit(other)) {
                ++others;
            } else if (is_hit(hit)) {
                // Two maps and their inverses round, and stretch by up to some tens.
                const auto at = single.surface(ray, hit);
                const double slope = std::abs(static_cast<double>(dot(at.surface.normal, ray.dir)));
                const double far = static_cast<double>(length(ray.org) + length(at.surface.point));
                others += std::abs(static_cast<double>(hit.shape.t - other.shape.t)) * slope >
                          2000 * this->eps * far;
            }
        }
    });
    // Rays within rounding of an outline meet either what has it or what is behind: of 200 000 in float up to
    // 3 were seen, in double none.
    const int most = std::is_same_v<R, float> ? rays / 20000 : rays / 1000000;
    EXPECT_LE(others, most) << "of " << rays;
}

TEST(Sphere, RayFromInsideHitsFarSide) {
    const Sphere<double> sphere{{1, 0, 0}, 2};
    EXPECT_DOUBLE_EQ(sphere.intersect(Ray<double>{{1, 0, 0}, {0, 0, 0.5}}).t, 4);
}

TEST(Sphere, SmallAndFarIsHitWhereItIs) {
    const Sphere<float> sphere{{0, 0, -10000}, 0.5F};
    EXPECT_FLOAT_EQ(sphere.intersect(Ray<float>{{0, 0, 0}, {0, 0, -1}}).t, 9999.5F);
    EXPECT_EQ(sphere.intersect(Ray<float>{{0.501F, 0, 0}, {0, 0, -1}}).t, infinity<float>());
    EXPECT_LT(sphere.intersect(Ray<float>{{0.499F, 0, 0}, {0, 0, -1}}).t, infinity<float>());
}

TEST(Box, RayAlongAFaceIsInsideTheSlab) {
    const Box<double> box{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_DOUBLE_EQ(box.intersect(Ray<double>{{1, 0, 5}, {0, 0, -1}}).t, 4);
    EXPECT_DOUBLE_EQ(box.intersect(Ray<double>{{1, 0, 5}, {-0.0, 0, -1}}).t, 4);
    EXPECT_EQ(box.intersect(Ray<double>{{1.0000001, 0, 5}, {0, 0, -1}}).t, infinity<double>());
}

TEST(Box, PartsAreTheFaces) {
    const Box<double> box{{-1, -1, -1}, {1, 1, 1}};
    const Vec3<double> axes[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    for (std::uint32_t face = 0; face < 6; ++face) {
        EXPECT_EQ(box.intersect(Ray<double>{axes[face] * 3.0, -axes[face]}).part, face);
        EXPECT_EQ(box.intersect(Ray<double>{{0, 0, 0}, axes[face]}).part, face);
    }
}

TEST(Cylinder, CapsCloseItAndAnOpenOneShowsItsInside) {
    const Ray<double> down{{0.1, 5, 0.1}, {0, -1, 0}};
    EXPECT_DOUBLE_EQ((Cylinder<double>{{0, 0, 0}, {0, 2, 0}, 1, true}.intersect(down).t), 3);
    EXPECT_EQ((Cylinder<double>{{0, 0, 0}, {0, 2, 0}, 1, false}.intersect(down).t), infinity<double>());
    const Ray<double> slanted{{0, 3, 0}, {1, -1.5, 0}};
    EXPECT_DOUBLE_EQ((Cylinder<double>{{0, 0, 0}, {0, 2, 0}, 1, false}.intersect(slanted).t), 1);
}

TEST(Cylinder, NoRaySlipsThroughTheRim) {
    const Cylinder<float> cylinder{{0.1F, 0.2F, 0.3F}, {1.3F, 0.7F, -0.4F}, 0.35F, true};
    const Vec3<float> axis = normalize(cylinder.to - cylinder.from),
                      u = normalize(cross(axis, Vec3<float>{0, 1, 0}));
    const Vec3<float> v = cross(axis, u), inside = (cylinder.from + cylinder.to) * 0.5F;
    for (int i = 0; i < 5000; ++i) {
        const float a = 0.00125F * static_cast<float>(i);
        const Vec3<float> rim = cylinder.to + u * (std::cos(a) * 0.35F) + v * (std::sin(a) * 0.35F);
        EXPECT_LT(cylinder.intersect(Ray<float>{inside, rim - inside}).t, infinity<float>());
    }
}

TEST(Cone, IsHitOnItsSideItsCapsAndItsInside) {
    const Cone<double> cone{{0, 0, 0}, {0, 2, 0}, 2, 1, true};
    const auto t = [&](const Cone<double>& c, const Vec3<double>& org, const Vec3<double>& dir) {
        return c.intersect(Ray<double>{org, dir}).t;
    };
    EXPECT_DOUBLE_EQ(t(cone, {5, 1, 0}, {-1, 0, 0}), 3.5);
    EXPECT_DOUBLE_EQ(t(cone, {0.5, 5, 0.5}, {0, -1, 0}), 3);
    EXPECT_DOUBLE_EQ(t(cone, {1.5, 5, 0}, {0, -1, 0}), 4);
    EXPECT_DOUBLE_EQ(t(cone, {0.5, 1, 0}, {0, -1, 0}), 1);
    Cone<double> open = cone;
    open.caps = false;
    EXPECT_EQ(t(open, {0.5, 5, 0.5}, {0, -1, 0}), infinity<double>());
    EXPECT_DOUBLE_EQ(t(open, {1.5, 5, 0}, {0, -1, 0}), 4);
    EXPECT_DOUBLE_EQ(t(open, {0, 2.5, 0}, {1.5, -1, 0}), 0.75) << "in through the open end";
}

TEST(Cone, EndsAtItsTip) {
    for (const bool caps : {false, true}) {
        const Cone<double> cone{{0, 0, 0}, {0, 2, 0}, 1, 0, caps};
        const auto t = [&](const Vec3<double>& org, const Vec3<double>& dir) {
            return cone.intersect(Ray<double>{org, dir}).t;
        };
        EXPECT_DOUBLE_EQ(t({0, 5, 0}, {0, -1, 0}), 3) << "down the axis onto the tip";
        EXPECT_DOUBLE_EQ(t({0, -1, 0}, {0, 1, 0}), caps ? 1 : 3) << "up the axis";
        EXPECT_EQ(t({5, 3, 0}, {-1, 0, 0}), infinity<double>()) << "the other half of the double cone";
        EXPECT_EQ(t({5, 2.0000001, 0}, {-1, 0, 0}), infinity<double>());
        EXPECT_DOUBLE_EQ(t({5, 1, 0}, {-1, 0, 0}), 4.5);
        const Ray<double> down{{0, 5, 0}, {0, -1, 0}};
        EXPECT_EQ(cone.surface(down, cone.intersect(down)).normal, (Vec3<double>{0, 1, 0}));
    }
}

TEST(Cone, WithEqualRadiiIsTheCylinder) {
    Random<double> random(3);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3<double> from = random.vector(2);
        const Cylinder<double> cylinder{from, from + random.direction() * random.number(0.2, 3),
                                        random.number(0.2, 1.5), i % 2 == 0};
        const Cone<double> cone{cylinder.from, cylinder.to, cylinder.radius, cylinder.radius, cylinder.caps};
        const Vec3<double> org = random.vector(5);
        const Ray<double> ray{org, from + random.vector(1) - org};
        const ShapeHit<double> a = cylinder.intersect(ray), b = cone.intersect(ray);
        ASSERT_EQ(a.t < infinity<double>(), b.t < infinity<double>());
        if (a.t < infinity<double>()) {
            ++hits;
            ASSERT_NEAR(a.t, b.t, 1e-11);
            ASSERT_EQ(a.part, b.part);
            ASSERT_LT(length(cylinder.surface(ray, a).normal - cone.surface(ray, b).normal), 1e-11);
        }
    }
    EXPECT_GT(hits, 5000);
    const Cone<double> tube{{0, 0, 0}, {0, 0, 1}, 1, 1, true};
    EXPECT_DOUBLE_EQ((tube.intersect(Ray<double>{{0.5, 0, 4}, {0, 0, -2}}).t), 1.5);
    EXPECT_EQ((tube.intersect(Ray<double>{{1.5, 0, 4}, {0, 0, -2}}).t), infinity<double>());
}

TEST(Cone, NoRaySlipsThroughItsRimsAndItsTip) {
    for (const float narrow : {0.0F, 1e-6F, 0.2F, 0.35F}) {
        const Cone<float> cone{{0.1F, 0.2F, 0.3F}, {1.3F, 0.7F, -0.4F}, 0.35F, narrow, true};
        const Vec3<float> axis = normalize(cone.to - cone.from),
                          u = normalize(cross(axis, Vec3<float>{0, 1, 0}));
        const Vec3<float> v = cross(axis, u), inside = cone.from + (cone.to - cone.from) * 0.3F;
        for (int i = 0; i < 5000; ++i) {
            const float a = 0.00125F * static_cast<float>(i);
            for (const auto& [end, radius] : {std::pair{cone.from, 0.35F}, std::pair{cone.to, narrow}}) {
                const Vec3<float> rim = end + u * (std::cos(a) * radius) + v * (std::sin(a) * radius);
                EXPECT_LT(cone.intersect(Ray<float>{inside, rim - inside}).t, infinity<float>());
            }
        }
    }
}

TEST(Cone, RayAlongTheSideThatLeavesItDoesNotMeetItAtTheTip) {
    // The worst case of leaving: a ray close beside a line of the side, towards the tip or away from it.
    Random<float> random(5);
    for (int i = 0; i < 20000; ++i) {
        Cone<float> cone;
        randomize(cone, random, 2);
        cone.radius_to = i % 3 == 0 ? cone.radius_from * 0.001F : 0.0F;
        if (cone.radius_from == 0) {
            continue;
        }
        const Vec3<float> axis = normalize(cone.to - cone.from);
        const Vec3<float> radial = normalize(cross(axis, random.direction()));
        const Vec3<float> start = cone.from + radial * cone.radius_from, line = cone.to - start;
        const Vec3<float> on_side = start + line * random.number(0.1, 0.9);
        const Ray<float> ray{on_side + radial * 3.0F, -radial};
        const ShapeHit<float> hit = cone.intersect(ray);
        if (hit.part != 0 || !(hit.t < infinity<float>())) {
            continue;
        }
        const Surface<float> at = cone.surface(ray, hit);
        for (const float side : {1.0F, -1.0F}) {
            for (const float lift : {0.0F, 1e-7F, 1e-6F, 1e-4F}) {
                const Vec3<float> dir = line * side + at.normal * lift;
                if (dot(dir, at.normal) >= 0) {
                    const Ray<float> away{start_off(at, dir), dir, spawned_t_min<float>(), infinity<float>()};
                    EXPECT_EQ(cone.intersect(away).t, infinity<float>()) << i << ", lift " << lift;
                }
            }
        }
    }
}

TEST(Cone, BoundsAreTight) {
    const Bounds<double> b = Cone<double>{{0, 0, 0}, {0, 0, 5}, 2, 0.5, true}.bounds();
    EXPECT_NEAR(b.min.x, -2, 1e-13);
    EXPECT_NEAR(b.max.y, 2, 1e-13);
    EXPECT_NEAR(b.min.z, 0, 1e-13);
    EXPECT_NEAR(b.max.z, 5, 1e-13);
    const Bounds<double> tip = Cone<double>{{0, 0, 0}, {3, 3, 0}, 1, 0, true}.bounds();
    EXPECT_NEAR(tip.max.x, 3, 1e-13);
    EXPECT_NEAR(tip.min.x, -std::sqrt(0.5), 1e-13);
    EXPECT_NEAR(tip.max.z, 1, 1e-13);
}

TEST(Disc, HoleLetsRaysThrough) {
    const Disc<double> disc{{0, 0, 0}, {0, 0, 2}, 1, 0.5};
    EXPECT_DOUBLE_EQ(disc.intersect(Ray<double>{{0.6, 0, 3}, {0, 0, -1}}).t, 3);
    EXPECT_EQ(disc.intersect(Ray<double>{{0.4, 0, 3}, {0, 0, -1}}).t, infinity<double>());
    EXPECT_EQ(disc.intersect(Ray<double>{{1.1, 0, 3}, {0, 0, -1}}).t, infinity<double>());
    EXPECT_EQ(disc.intersect(Ray<double>{{-3, 0, 0}, {1, 0, 0}}).t, infinity<double>());
}

/// A ray through a point of the inside meets the tube before it, however thin that is and however far the
/// ray comes, and leaves it behind.
template <class R>
void check_torus(R ratio, R away, int count) {
    Random<R> random(3);
    const auto wide = [](R x) { return static_cast<long double>(x); };
    const long double eps = std::numeric_limits<R>::epsilon();
    for (int i = 0; i < count; ++i) {
        Torus<R> torus;
        torus.axis = random.direction();
        torus.minor = ratio;
        const Vec3<R> radial = normalize(cross(torus.axis, random.direction()));
        const Vec3<R> inside = radial + random.direction() * (torus.minor * random.number(0, 0.9));
        const Vec3<R> dir = random.direction();
        const Ray<R> ray{inside - dir * away, dir};
        const long double blur = 32 * eps * (1 + wide(away)) + 32 * eps;
        ASSERT_LT(blur, wide(ratio) / 20) << "the ray itself is not known that well";
        Crossing<R> crossing = torus.cross(ray);
        bool enters = true;
        int crossings = 0;
        for (; crossing.hit.t < infinity<R>() && crossings < 4; ++crossings, enters = !enters) {
            EXPECT_EQ(crossing.outwards, !enters);
            const Wide p = lanes<long double>(ray.org) + lanes<long double>(ray.dir) * wide(crossing.hit.t);
            EXPECT_LE(std::abs(signed_distance(torus, p, {})), blur) << ratio << ", " << away;
            const Surface<R> at = torus.surface(ray, crossing.hit);
            EXPECT_LE(std::abs(signed_distance(torus, lanes<long double>(at.point), {})),
                      dot(lanes<long double>(absolute(at.normal)), lanes<long double>(at.error)));
            Ray<R> rest = ray;
            rest.t_min = std::nextafter(crossing.hit.t, infinity<R>());
            if (crossings == 0) {
                EXPECT_LE(crossing.hit.t, away);
                EXPECT_EQ(torus.intersect(ray).t, crossing.hit.t);
            }
            crossing = torus.cross(rest);
        }
        EXPECT_TRUE(crossings == 2 || crossings == 4) << ratio << ", " << away << ": " << crossings;
    }
}

TEST(Torus, IsMetHoweverThinAndFar) {
    for (const double ratio : {1e-6, 1e-4, 0.01, 0.3, 0.9, 1.0}) {
        for (const double away : {5.0, 1e3, 1e6}) {
            if (ratio > 1e-13 * away) {
                check_torus<double>(ratio, away, 300);
            }
        }
    }
    for (const float ratio : {1e-3F, 0.01F, 0.3F, 1.0F}) {
        check_torus<float>(ratio, 5, 300);
    }
    check_torus<float>(0.3F, 100, 300);
}

TEST(Torus, RaysThroughTheHoleAndAlongTheAxisMiss) {
    const Torus<double> torus{};
    EXPECT_EQ(torus.intersect(Ray<double>{{0, 5, 0}, {0, -1, 0}}).t, infinity<double>());
    EXPECT_EQ(torus.intersect(Ray<double>{{0.74, 5, 0}, {0, -1, 0}}).t, infinity<double>());
    EXPECT_NEAR(torus.intersect(Ray<double>{{1, 5, 0}, {0, -2, 0}}).t, 4.75 / 2, 1e-15);
    EXPECT_NEAR(torus.intersect(Ray<double>{{-5, 0, 0}, {1, 0, 0}, 4.5}).t, 5.75, 1e-14);
}

TEST(Quadric, IsASphereAConeAPlane) {
    const Quadric<double> ball{};
    EXPECT_NEAR(ball.intersect(Ray<double>{{0, 0, 3}, {0, 0, -1}}).t, 2, 1e-15);
    EXPECT_EQ(ball.intersect(Ray<double>{{1.001, 0, 3}, {0, 0, -1}}).t, infinity<double>());
    const Quadric<double> cone{{1, -1, 1}, {0, 0, 0}, {0, 0, 0}, 0};
    EXPECT_NEAR(cone.intersect(Ray<double>{{3, 1, 0}, {-1, 0, 0}}).t, 2, 1e-15);
    EXPECT_NEAR(cone.intersect(Ray<double>{{0, 5, 0}, {0, -1, 0}}).t, 5, 1e-15) << "through the tip";
    const Quadric<double> plane{{0, 0, 0}, {0, 0, 0}, {0, 2, 0}, -1};
    EXPECT_NEAR(plane.intersect(Ray<double>{{7, 3, 0}, {0, -1, 0}}).t, 2.5, 1e-15);
    EXPECT_EQ(plane.intersect(Ray<double>{{7, 3, 0}, {0, 0, -1}}).t, infinity<double>());
    const Quadric<double> bowl{{1, 0, 1}, {0, 0, 0}, {0, -1, 0}, 0};
    EXPECT_NEAR(bowl.intersect(Ray<double>{{0.5, 9, 0}, {0, -1, 0}}).t, 8.75, 1e-15)
        << "parallel to the axis";
    EXPECT_EQ(bowl.intersect(Ray<double>{{0.5, 0.1, 0}, {0, -1, 0}}).t, infinity<double>());
}

TEST(Quadric, OneOfEllipsoidsHasBounds) {
    // |(p - c) / (1, 2, 3)|^2 = 1 with c = (1, -2, 4), rotated about z by 30 degrees in the second case.
    const Quadric<double> straight{{1, 0.25, 1.0 / 9}, {0, 0, 0}, {-2, 1, -8.0 / 9}, 1 + 1 + 16.0 / 9 - 1};
    const Bounds<double> b = straight.inside_bounds();
    EXPECT_NEAR(b.min.x, 0, 1e-4);
    EXPECT_NEAR(b.max.y, 0, 1e-4);
    EXPECT_NEAR(b.max.z, 7, 1e-4);
    EXPECT_LE(b.min.x, 0);
    const Quadric<double> slanted{{5, 5, 1}, {6, 0, 0}, {0, 0, 0}, -1};
    EXPECT_NEAR(slanted.inside_bounds().max.x, std::sqrt(5.0 / 16), 1e-5);
    EXPECT_FALSE(is_finite(Quadric<double>{{1, 0, 1}}.inside_bounds()));
    EXPECT_FALSE(is_finite(Quadric<double>{{1, -1, 1}}.inside_bounds()));
    EXPECT_FALSE(is_finite(Quadric<double>{{1, 1, 1}, {2, 0, 0}}.inside_bounds())) << "a cylinder";
}

TEST(Quadric, SmallAndFarIsHitWhereItIs) {
    const Quadric<float> ball{{1, 1, 1}, {0, 0, 0}, {0, 0, 0}, -0.25F};
    EXPECT_FLOAT_EQ(ball.intersect(Ray<float>{{0, 0, 10000}, {0, 0, -1}}).t, 9999.5F);
    EXPECT_EQ(ball.intersect(Ray<float>{{0.501F, 0, 10000}, {0, 0, -1}}).t, infinity<float>());
    EXPECT_LT(ball.intersect(Ray<float>{{0.499F, 0, 10000}, {0, 0, -1}}).t, infinity<float>());
}

TEST(Mesh, NormalsPointOutOfTheCounterClockwiseSide) {
    Random<double> random(9);
    const MeshStorage mesh = ball_mesh(2, 2, {1, 2, 3});
    for (int i = 0; i < 500; ++i) {
        const Vec3<double> outwards = random.direction();
        const Ray<double> ray{Vec3<double>{1, 2, 3} + outwards * 5.0, -outwards};
        ShapeHit<double> hit;
        Ray<double> search = ray;
        intersect_mesh<false, double>(mesh.data(), {&search, 1}, Apex::none, {&hit, 1});
        const Surface<double> flat = mesh_surface<false>(mesh.data(), ray, hit, true);
        const Surface<double> smooth = mesh_surface<true>(mesh.data(), ray, hit, true);
        EXPECT_GT(dot(flat.normal, outwards), 0.97);
        EXPECT_EQ(flat.shading_normal, flat.normal);
        EXPECT_GT(dot(smooth.shading_normal, outwards), 0.9995);
        EXPECT_NEAR(length(flat.point - (ray.org + ray.dir * hit.t)), 0, 1e-14);
    }
}

/// Its roundings would move the point by 1e-16 times the length squared over the height.
TEST(Triangle, NeedlesAreMetWhereTheRayIs) {
    const Triangle<double> needle{{{{-1e9, 0, 0}, {1, 0, 0}, {1, 0.015625, 0}}}};
    const Ray<double> ray{{0.25, 0.01, 4}, {0, 0, -1}};
    const ShapeHit<double> hit = needle.intersect(ray);
    ASSERT_EQ(hit.t, 4);
    const Vec3<double> point = needle.surface(ray, hit).point;
    EXPECT_EQ(point.x, 0.25);
    EXPECT_EQ(point.y, 0.01);
    EXPECT_EQ(point.z, 0);
}

TEST(Triangle, WeightsAreNumbersWhereRoundingLeavesNone) {
    const Corners<float> corners{{-1e20F, 0, 0}, {1e20F, 0, 0}, {1e20F, 1e-20F, 0}};
    const Vec3<float> weights = barycentric(corners, Ray<float>{{0, 0, 4}, {0, 0, -1}});
    EXPECT_NEAR(weights.x + weights.y + weights.z, 1, 1e-6F);
}

TEST(Triangle, NormalPointsToTheCounterClockwiseSide) {
    Triangle<double> triangle{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
    const Ray<double> ray{{0.2, 0.2, -1}, {0, 0, 1}};
    EXPECT_EQ(triangle.surface(ray, triangle.intersect(ray)).normal, (Vec3<double>{0, 0, 1}));
    triangle.smooth = true;
    triangle.normals = {{{0, 0, 3}, {1, 0, 0}, {0, 0.5, 0}}};
    const Vec3<double> expected = normalize(Vec3<double>{0.2, 0.2, 0.6});
    EXPECT_LT(length(triangle.surface(ray, triangle.intersect(ray)).shading_normal - expected), 1e-15);
}

} // namespace
