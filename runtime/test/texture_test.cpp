#include "runtime/primitive.h"
#include "runtime/texture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace scc::runtime {
namespace {

constexpr double pi = std::numbers::pi;

// ---- images --------------------------------------------------------------------------------------------

/// 4 x 2 grey texels, from the bottom: 0 1 2 3 and 10 20 30 40.
struct Grey {
    std::vector<float> values{0, 1, 2, 3, 10, 20, 30, 40};
    ImageData data(Wrap wrap, Filter filter) const {
        ImageData image;
        image.values = values.data();
        image.width = 4;
        image.height = 2;
        image.channels = 1;
        image.wrap = wrap;
        image.filter = filter;
        image.min = {0, 0, 0};
        image.max = {40, 40, 40};
        return image;
    }
    double at(double u, double v, Wrap wrap = Wrap::repeat, Filter filter = Filter::bilinear) const {
        return image_channel(data(wrap, filter), 0, u, v);
    }
};

TEST(Texture, CentresOfTexelsHaveTheirValues) {
    const Grey grey;
    for (std::size_t j = 0; j < 2; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
            const double u = (static_cast<double>(i) + 0.5) / 4, v = (static_cast<double>(j) + 0.5) / 2;
            for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
                for (const Filter filter : {Filter::bilinear, Filter::nearest}) {
                    EXPECT_EQ(grey.at(u, v, wrap, filter), grey.values[4 * j + i]) << i << " " << j;
                }
            }
        }
    }
}

TEST(Texture, BetweenCentresValuesAreBlended) {
    const Grey grey;
    EXPECT_DOUBLE_EQ(grey.at(0.25, 0.25), 0.5); // between texels 0 and 1 of the lower row
    EXPECT_DOUBLE_EQ(grey.at(0.5, 0.5), (1 + 2 + 20 + 30) / 4.0);
    EXPECT_DOUBLE_EQ(grey.at((0.5 + 0.25) / 4, 0.75), 0.75 * 10 + 0.25 * 20);
    EXPECT_DOUBLE_EQ(grey.at(0.125, 0.25 + 0.1 * 0.5), 0.9 * 0 + 0.1 * 10); // v is upwards
}

TEST(Texture, TheEdgesWrapOrEndWithTheLastTexel) {
    const Grey grey;
    EXPECT_DOUBLE_EQ(grey.at(0, 0.25), (0 + 3) / 2.0);
    EXPECT_DOUBLE_EQ(grey.at(1, 0.25), (0 + 3) / 2.0);
    EXPECT_DOUBLE_EQ(grey.at(0.125, 0), (0 + 10) / 2.0);
    EXPECT_DOUBLE_EQ(grey.at(0, 0), (0 + 3 + 10 + 40) / 4.0);
    for (const double beyond : {0.0, -0.3, -7.0}) {
        EXPECT_DOUBLE_EQ(grey.at(beyond, beyond, Wrap::clamp), 0);
        EXPECT_DOUBLE_EQ(grey.at(1 - beyond, 1 - beyond, Wrap::clamp), 40);
    }
    EXPECT_DOUBLE_EQ(grey.at(0.25, 0, Wrap::clamp), 0.5);
    for (const double period : {-3.0, 2.0, 1024.0}) {
        EXPECT_DOUBLE_EQ(grey.at(0.25 + period, 0.25 + period), 0.5);
    }
}

TEST(Texture, TheNearestTexelChangesHalfwayBetweenCentres) {
    const Grey grey;
    const auto at = [&](double u, double v, Wrap wrap) { return grey.at(u, v, wrap, Filter::nearest); };
    EXPECT_EQ(at(0.2499, 0.1, Wrap::repeat), 0);
    EXPECT_EQ(at(0.2501, 0.1, Wrap::repeat), 1);
    EXPECT_EQ(at(0.1, 0.4999, Wrap::repeat), 0);
    EXPECT_EQ(at(0.1, 0.5, Wrap::repeat), 10);
    EXPECT_EQ(at(0, 0, Wrap::repeat), 0);
    EXPECT_EQ(at(1, 0, Wrap::repeat), 0) << "the first texel again";
    EXPECT_EQ(at(-0.01, 0, Wrap::repeat), 3);
    EXPECT_EQ(at(1, 0, Wrap::clamp), 3);
    EXPECT_EQ(at(-0.01, 0, Wrap::clamp), 0);
    EXPECT_EQ(at(-1e-30, 0, Wrap::repeat), 3) << "rounding does not leave the image";
}

TEST(Texture, WhatIsNoNumberStaysInTheImage) {
    const Grey grey;
    const double inf = infinity<double>();
    for (const double odd : {std::nan(""), inf, -inf, 1e300, -1e300}) {
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
            for (const Filter filter : {Filter::bilinear, Filter::nearest}) {
                const double value = grey.at(odd, odd, wrap, filter);
                EXPECT_TRUE(value >= 0 && value <= 40) << odd;
            }
        }
    }
}

TEST(Texture, CodesAreDecodedBeforeTheyAreBlended) {
    const std::vector<std::uint8_t> codes{0, 10, 20, 200, 100, 50}; // two texels
    std::vector<float> decoded(256);
    for (std::size_t i = 0; i < 256; ++i) {
        decoded[i] = static_cast<float>(i * i);
    }
    ImageData image;
    image.codes = codes.data();
    image.decoded = decoded.data();
    image.width = 2;
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
        const double a = codes[channel], b = codes[3 + channel];
        EXPECT_DOUBLE_EQ(image_channel(image, channel, 0.5, 0.5), (a * a + b * b) / 2);
    }
}

TEST(Texture, LanesGetWhatScalarsGet) {
    const Grey grey;
    using L = Pack<float, 8>;
    L u, v;
    for (int i = 0; i < 8; ++i) {
        set_lane(u, i, 0.37F * static_cast<float>(i) - 1.1F);
        set_lane(v, i, 0.21F * static_cast<float>(i) - 0.4F);
    }
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        const L value = image_channel(grey.data(wrap, Filter::bilinear), 0, u, v);
        for (int i = 0; i < 8; ++i) {
            EXPECT_EQ(lane(value, i),
                      image_channel(grey.data(wrap, Filter::bilinear), 0, lane(u, i), lane(v, i)));
        }
    }
}

TEST(Texture, DerivativesAreThoseOfThePatch) {
    const Grey grey;
    using D = Dual<double, 2>;
    const ImageData image = grey.data(Wrap::repeat, Filter::bilinear);
    const double u = 0.3, v = 0.4, h = 1e-6;
    const D value = image_channel(image, 0, D::variable(u, 0), D::variable(v, 1));
    EXPECT_DOUBLE_EQ(value.v, grey.at(u, v));
    EXPECT_NEAR(value.d[0], (grey.at(u + h, v) - grey.at(u - h, v)) / (2 * h), 1e-5);
    EXPECT_NEAR(value.d[1], (grey.at(u, v + h) - grey.at(u, v - h)) / (2 * h), 1e-5);
    using I = Interval<double>;
    const auto bounds = image_channel(image, 0, Dual<I, 1>::variable(I(0, 1), 0), Dual<I, 1>(I(0.5, 0.5)));
    EXPECT_TRUE(bounds.v.min <= 0 && bounds.v.max >= 40);
    EXPECT_TRUE(bounds.d[0].min <= -160 && bounds.d[0].max >= 160);
}

// ---- coordinates on surfaces ---------------------------------------------------------------------------

/// Those where a ray from `org` to `target` first meets the shape.
template <class Shape>
Vec2<double> uv_at(const Shape& shape, const Vec3<double>& org, const Vec3<double>& target) {
    const Ray<double> ray{org, target - org};
    const ShapeHit<double> hit = shape.intersect(ray);
    EXPECT_LT(hit.t, infinity<double>());
    return shape.uv(ray, hit, shape.surface(ray, hit).point);
}
/// At the point, seen from along the direction.
template <class Shape>
void expect_uv(const Shape& shape, const Vec3<double>& point, const Vec3<double>& from, double u, double v) {
    const Vec2<double> uv = uv_at(shape, point + from, point);
    EXPECT_NEAR(uv.x, u, 1e-12);
    EXPECT_NEAR(uv.y, v, 1e-12);
}

TEST(Uv, ASphereHasLongitudeAndLatitude) {
    const Sphere<double> sphere{{1, 2, 3}, 2};
    for (const double longitude : {-3.0, -1.5, 0.0, 0.4, 2.9}) {
        for (const double latitude : {-1.5, -0.3, 0.0, 1.1}) {
            // From the z axis towards x, which is to the right of who looks along -z.
            const Vec3<double> out{std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                                   std::cos(latitude) * std::cos(longitude)};
            expect_uv(sphere, sphere.center + 2.0 * out, out, 0.5 + longitude / (2 * pi),
                      0.5 + latitude / pi);
        }
    }
}

TEST(Uv, ABoxHasASquareOnEachFaceAsSeenFromOutside) {
    const Box<double> box{{-1, 0, 2}, {1, 4, 3}};
    expect_uv(box, {-0.5, 1, 3}, {0, 0, 5}, 0.25, 0.25);
    expect_uv(box, {-0.5, 1, 2}, {0, 0, -5}, 0.75, 0.25);
    expect_uv(box, {1, 3, 2.2}, {5, 0, 0}, 0.8, 0.75);
    expect_uv(box, {-1, 3, 2.2}, {-5, 0, 0}, 0.2, 0.75);
    expect_uv(box, {0.5, 4, 2.1}, {0, 5, 0}, 0.75, 0.9);
    expect_uv(box, {0.5, 0, 2.1}, {0, -5, 0}, 0.75, 0.1);
}

TEST(Uv, FlatShapesHaveLengthsOrASquare) {
    expect_uv(Plane<double>{{0, 1, 0}, 2}, {3, 2, -7}, {0, 1, 0}, 3, 7);
    expect_uv(Plane<double>{{0, -1, 0}, 2}, {3, -2, -7}, {0, -1, 0}, 3, -7);
    expect_uv(Plane<double>{{0, 0, 1}, 2}, {3, -4, 2}, {0, 0, 1}, 3, -4);
    expect_uv(Plane<double>{{0, 0, -1}, 2}, {3, -4, -2}, {0, 0, -1}, -3, -4);
    expect_uv(Plane<double>{{1, 0, 0}, 0}, {0, 5, 6}, {1, 0, 0}, -6, 5);
    const double h = std::sqrt(0.5); // tilted towards the viewer: up is up along it
    expect_uv(Plane<double>{{0, h - 1e-3, std::sqrt(1 - (h - 1e-3) * (h - 1e-3))}, 0}, {3, 0, 0}, {0, 1, 1},
              3, 0);
    expect_uv(Disc<double>{{1, 2, 3}, {0, 1, 0}, 2, 0}, {2, 2, 2}, {0, 1, 0}, 0.75, 0.75);
    expect_uv(Disc<double>{{1, 2, 3}, {0, 0, 1}, 2, 0}, {1, 1, 3}, {0, 0, 1}, 0.5, 0.25);
}

TEST(Uv, CylindersAndConesGoAroundTheirAxis) {
    const Cylinder<double> upright{{1, 1, 1}, {1, 5, 1}, 2, true};
    expect_uv(upright, {1, 2, 3}, {0, 0, 1}, 0.5, 0.25);
    expect_uv(upright, {3, 4, 1}, {1, 0, 0}, 0.75, 0.75);
    expect_uv(upright, {-1, 4, 1}, {-1, 0, 0}, 0.25, 0.75);
    expect_uv(upright, {2, 5, 0}, {0, 1, 0}, 0.75, 0.75);
    expect_uv(upright, {2, 1, 0}, {0, -1, 0}, 0.75, 0.25);
    // Lying along x, seen from the front of its end: up is up.
    const Cylinder<double> lying{{0, 0, 0}, {4, 0, 0}, 1, true};
    expect_uv(lying, {4, 0.5, 0}, {1, 0, 0}, 0.5, 0.75);
    const Cone<double> cone{{0, 0, 0}, {0, 2, 0}, 2, 1, true};
    expect_uv(cone, {0, 1, 1.5}, {0, 0, 1}, 0.5, 0.5);
    expect_uv(cone, {1.5 * std::sqrt(0.5), 1, 1.5 * std::sqrt(0.5)}, {1, 0, 1}, 0.625, 0.5);
    expect_uv(cone, {0.5, 2, 0}, {0, 1, 0}, 0.75, 0.5);
    expect_uv(cone, {0.5, 0, 0}, {0, -1, 0}, 0.625, 0.5);
}

TEST(Uv, ATorusGoesAroundItsAxisAndItsTube) {
    Torus<double> torus;
    torus.center = {1, 2, 3};
    torus.major = 2;
    torus.minor = 0.5;
    expect_uv(torus, {3.5, 2, 3}, {1, 0, 0}, 0.75, 0.5);
    expect_uv(torus, {1, 2.5, 5}, {0, 1, 0}, 0.5, 0.75);
    expect_uv(torus, {1, 1.5, 5}, {0, -1, 0}, 0.5, 0.25);
    const double s = std::sqrt(0.125);
    expect_uv(torus, {1, 2 + s, 5 + s}, {0, 1, 1}, 0.5, 0.625);
}

TEST(Uv, TrianglesAndMeshesInterpolate) {
    Triangle<double> triangle;
    triangle.points = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    expect_uv(triangle, {1, 2, 0}, {0.3, 0.1, 1}, 0.25, 0.5);
    triangle.uvs = {{{1, 1}, {3, 1}, {1, -7}}};
    expect_uv(triangle, {1, 2, 0}, {0.3, 0.1, 1}, 1.5, -3);
}

TEST(Uv, AnImplicitSurfaceHasItsPoint) {
    const Implicit<double> implicit;
    EXPECT_EQ(implicit.uv(Ray<double>{}, ShapeHit<double>{}, Vec3<double>{1, 2, 3}), (Vec2<double>{1, 2}));
}

} // namespace
} // namespace scc::runtime
