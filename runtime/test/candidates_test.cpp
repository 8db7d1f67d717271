#include "runtime/accel/occluders.h"
#include "runtime/accel/view.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

#include <array>

using namespace scc::runtime;
using namespace scc::runtime::test;

/// What is left out for a part of a picture or for shadow rays must be what no such ray meets.
namespace {

template <class T>
struct RealOfShape;
template <template <class> class Shape, class R>
struct RealOfShape<Shape<R>> {
    using type = R;
};

template <class ShapeType>
class Candidate : public testing::Test {
protected:
    using Shape = ShapeType;
    using Real = typename RealOfShape<Shape>::type;
    static constexpr int scenes = 400, rays = 60;

    Random<Real> random_{7};

    template <class F>
    void for_scenes(F&& f) {
        for (int i = 0; i < scenes; ++i) {
            const SingleShape<Shape, Real> single(random_, i % 2 != 0, i % 4 < 2 ? 3 : 300);
            f(single);
        }
    }
    /// Near the shape or, at times, far away.
    Vec3<Real> point_near(const SingleShape<Shape, Real>& single) {
        const Bounds<Real> b = single.bounds();
        const Real distance =
            length(b.max - b.min) * random_.number(0.1, random_.number(0, 1) < 0.2 ? 1000 : 4);
        return b.center() + random_.direction() * distance;
    }
};
using BoundedShapes =
    testing::Types<Torus<double>, Sphere<float>, Sphere<double>, Box<float>, Cylinder<double>, Cone<double>,
                   Disc<double>, Triangle<double>, Mesh<float>, Mesh<double>>;
TYPED_TEST_SUITE(Candidate, BoundedShapes);

TYPED_TEST(Candidate, PartsOfThePictureLeaveOutWhatNoRayMeets) {
    using R = typename TestFixture::Real;
    int left_out = 0, met = 0;
    this->for_scenes([&](const auto& single) {
        Random<R>& random = this->random_;
        Camera<R> camera;
        camera.eye = this->point_near(single);
        camera.n = normalize(camera.eye - single.bounds().center() + random.direction() * R(0.5));
        camera.u = normalize(cross(camera.n, random.direction()));
        camera.v = cross(camera.n, camera.u);
        camera.half_height = random.number(0.001, 2);
        const Projection projection =
            random.number(0, 1) < 0.5 ? Projection::perspective : Projection::orthographic;
        const R x = random.number(-1, 1), y = random.number(-1, 1), size = random.number(0.001, 1);
        const auto ray = [&](R across, R down) {
            return camera_ray(camera, projection, x + across * size, y + down * size);
        };
        const Candidates candidates = candidates_in(
            primitive_boxes(single.scene), ViewPart<R>({ray(0, 0), ray(1, 0), ray(1, 1), ray(0, 1)}));
        left_out += candidates == 0 ? 1 : 0;
        for (int i = 0; i < this->rays; ++i) {
            if (is_hit(closest_hit(single.scene, ray(random.number(0, 1), random.number(0, 1))))) {
                ++met;
                EXPECT_EQ(candidates, 1);
            }
        }
    });
    EXPECT_GT(left_out, this->scenes / 20);
    EXPECT_GT(met, this->scenes);
}

TYPED_TEST(Candidate, LightsLeaveOutWhatStandsBeforeNoPoint) {
    using R = typename TestFixture::Real;
    int left_out = 0, met = 0;
    const auto check = [&](const auto& single, const auto& occluders, const Ray<R>& ray) {
        const Candidates candidates = occluders.before(ray, true);
        const bool blocked = any_hit(single.scene, ray);
        left_out += candidates == 0 ? 1 : 0;
        met += blocked ? 1 : 0;
        if (blocked) {
            EXPECT_NE(candidates & 1, 0);
        }
    };
    this->for_scenes([&](const auto& single) {
        Random<R>& random = this->random_;
        const auto balls = primitive_balls(single.scene);
        PointLight<R> lamp;
        lamp.position = this->point_near(single);
        DirectionalLight<R> sun;
        sun.to_light = random.direction();
        const Occluders<PointLight<R>> before_lamp(balls, lamp);
        const Occluders<DirectionalLight<R>> before_sun(balls, sun);
        for (int i = 0; i < this->rays; ++i) {
            const Vec3<R> to =
                single.bounds().center() + random.direction() * (balls[0].radius * random.number(0, 2));
            const Vec3<R> behind =
                to + (to - lamp.position) * random.number(0, random.number(0, 1) < 0.1 ? 1e4 : 2);
            check(single, before_lamp, {behind, lamp.position - behind, spawned_t_min<R>(), R(0.999)});
            const Vec3<R> below = to - sun.to_light * (balls[0].radius * random.number(-3, 1000));
            check(single, before_sun, {below, sun.to_light, spawned_t_min<R>(), infinity<R>()});
        }
    });
    EXPECT_GT(left_out, this->scenes * this->rays / 20);
    EXPECT_GT(met, this->scenes * this->rays / 20);
}

TEST(Candidates, AreTakenInOrderAndTheLastBitStandsForAllBeyond) {
    Candidates left = candidate(1) | candidate(40);
    EXPECT_FALSE(next_is_candidate(left));
    EXPECT_TRUE(next_is_candidate(left));
    for (int i = 2; i < 31; ++i) {
        EXPECT_FALSE(next_is_candidate(left)) << i;
    }
    for (int i = 31; i < 100; ++i) {
        EXPECT_TRUE(next_is_candidate(left)) << i;
    }
}

} // namespace
