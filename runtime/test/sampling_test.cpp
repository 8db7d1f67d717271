#include "runtime/camera.h"
#include "runtime/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

using namespace scc::runtime;

namespace {

constexpr double pi = std::numbers::pi;

TEST(SobolPoints, FillEveryRectangleOfANetOnce) {
    for (const Pixel pixel : {Pixel{0, 0}, {17, 4}, {-2, 65535}}) {
        for (const PointUse use : {PointUse::pixel, PointUse::lens}) {
            const SobolPoints points(pixel, use);
            for (int m = 1; m <= 8; ++m) {
                for (int columns = 0; columns <= m; ++columns) {
                    std::set<std::pair<std::uint64_t, std::uint64_t>> cells;
                    for (int i = 0; i < 1 << m; ++i) {
                        const SquarePoint p = points[i];
                        cells.emplace(std::uint64_t{p.x} >> (32 - columns),
                                      std::uint64_t{p.y} >> (32 - (m - columns)));
                    }
                    ASSERT_EQ(cells.size(), std::size_t{1} << m) << m << ", " << columns;
                }
            }
        }
    }
}

TEST(SobolPoints, OfPixelsAndUsesAreIndependent) {
    // The correlation of n independent numbers is about 1 / sqrt(n).
    constexpr int n = 10000;
    double across = 0, uses = 0, numbers = 0;
    const auto x = [](const Pixel& pixel, PointUse use, int i) {
        return part_of_unit<double>(SobolPoints(pixel, use)[i].x) - 0.5;
    };
    for (int i = 0; i < n; ++i) {
        const Pixel pixel{i % 100, i / 100}, right{i % 100 + 1, i / 100};
        across += 12 * x(pixel, PointUse::pixel, 3) * x(right, PointUse::pixel, 3) / n;
        uses += 12 * x(pixel, PointUse::pixel, 3) * x(pixel, PointUse::lens, 3) / n;
        numbers += 12 * x(pixel, PointUse::pixel, 3) * x(pixel, PointUse::pixel, 6) / n;
    }
    EXPECT_LT(std::abs(across), 0.03);
    EXPECT_LT(std::abs(uses), 0.03);
    EXPECT_LT(std::abs(numbers), 0.05); // within a pixel they avoid each other a little
}

TEST(InDisc, KeepsAreas) {
    constexpr int n = 200;
    int inner = 0, right = 0, sector = 0;
    for (int i = 0; i < n * n; ++i) {
        const Vec2<double> p = in_disc((i % n + 0.5) / n, (i / n + 0.5) / n);
        const double r = std::hypot(p.x, p.y);
        ASSERT_LE(r, 1);
        inner += r < 0.5 ? 1 : 0;
        right += p.x > 0.2 ? 1 : 0;
        sector += p.y > 0 && p.y < p.x ? 1 : 0;
    }
    EXPECT_NEAR(inner, 0.25 * n * n, 1e-3 * n * n);
    EXPECT_NEAR(right, (std::acos(0.2) - 0.2 * std::sqrt(0.96)) / pi * n * n, 2e-3 * n * n);
    EXPECT_NEAR(sector, 0.125 * n * n, 2e-3 * n * n);
    EXPECT_EQ(in_disc(0.5, 0.5), (Vec2<double>{0, 0}));
}

TEST(PixelFilter, IsContinuousAndVanishesAtItsRadius) {
    for (const PixelFilter filter :
         {PixelFilter::mitchell, PixelFilter::gaussian, PixelFilter::blackman_harris}) {
        const double radius = radius_of(filter);
        EXPECT_NEAR(filter_weight(filter, radius - 1e-9), 0, 1e-4);
        EXPECT_EQ(filter_weight(filter, radius), 0);
        EXPECT_EQ(filter_weight(filter, -0.7), filter_weight(filter, 0.7));
        for (double x = 0; x < radius; x += 0.01) {
            EXPECT_NEAR(filter_weight(filter, x), filter_weight(filter, x + 1e-7), 1e-5) << x;
        }
    }
    // Mitchell and Netravali (1988), formula 8 with B = C = 1/3, up to the factor 1/6; its shifted copies add
    // up to a constant.
    EXPECT_NEAR(filter_weight(PixelFilter::mitchell, 0.0) / 6, 8.0 / 9, 1e-15);
    EXPECT_NEAR(filter_weight(PixelFilter::mitchell, 1.0) / 6, 1.0 / 18, 1e-15);
    for (double x = 0; x < 1; x += 0.05) {
        double sum = 0;
        for (int i = -2; i <= 2; ++i) {
            sum += filter_weight(PixelFilter::mitchell, x + i) / 6;
        }
        EXPECT_NEAR(sum, 1, 1e-14);
    }
    EXPECT_NEAR(filter_weight(PixelFilter::gaussian, 0.5), std::exp(-0.5) - std::exp(-4.5), 1e-15);
    EXPECT_NEAR(filter_weight(PixelFilter::blackman_harris, 0.0), 1, 1e-15);
    EXPECT_EQ(reach_of(PixelFilter::box), 0);
    EXPECT_EQ(reach_of(PixelFilter::mitchell), 2);
    EXPECT_EQ(reach_of(PixelFilter::gaussian), 1);
}

TEST(Camera, SphericalRaysAreLongitudesAndLatitudes) {
    Camera<double> camera;
    camera.eye = {1, 2, 3};
    camera.half_width = pi;
    camera.half_height = pi / 2;
    const auto dir = [&](double column, double row) {
        constexpr Projection spherical = Projection::spherical;
        const Ray<double> ray = camera_ray(camera, spherical, window_x(camera, spherical, column, 400, 100),
                                           window_y(camera, row, 100));
        EXPECT_EQ(ray.org, camera.eye);
        return ray.dir;
    };
    const auto expect_near = [](const Vec3<double>& a, const Vec3<double>& b) {
        EXPECT_LT(length(a - b), 1e-15);
    };
    expect_near(dir(200, 50), {0, 0, -1});
    expect_near(dir(300, 50), {1, 0, 0});
    expect_near(dir(400, 50), {0, 0, 1});
    expect_near(dir(0, 50), {0, 0, 1});
    expect_near(dir(123, 0), {0, 1, 0});
    expect_near(dir(250, 25), {0.5, std::sqrt(0.5), -0.5});
}

TEST(Camera, LensRaysMeetInThePlaneInFocus) {
    Camera<double> camera;
    camera.lens_radius = 0.25;
    camera.focus = 3;
    const Ray<double> middle = camera_ray(camera, Projection::perspective, 0.3, -0.2);
    const Vec3<double> sharp = middle.org + 3.0 * middle.dir;
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {-0.5, 0.7}, {0.0, 0.0}}) {
        const Ray<double> ray = lens_ray(camera, middle, x, y);
        EXPECT_LT(length(ray.org - (camera.eye + Vec3<double>{0.25 * x, 0.25 * y, 0})), 1e-15);
        EXPECT_LT(length(ray.org + 3.0 * ray.dir - sharp), 1e-15);
    }
}

} // namespace
