#include "runtime/math/affine.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

using namespace scc::runtime;

namespace {

TEST(Affine, ComposeAppliesTheSecondArgumentFirst) {
    constexpr Affine<double> move{{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}}};
    constexpr Affine<double> scale{{{2, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 4, 0}}};
    static_assert(transform_point(compose(move, scale), Vec3<double>{1, 1, 1}) == Vec3<double>{3, 5, 7});
    static_assert(transform_point(compose(scale, move), Vec3<double>{1, 1, 1}) == Vec3<double>{4, 9, 16});
}

TEST(Affine, InverseIsRightToTheLastBitsAlsoWhereIllConditioned) {
    // Rows nearly equal: condition 1e9. The entries of the true inverse are whole numbers.
    const Affine<double> a{{{1, 1, 0, 5}, {1, 1 + 0x1p-30, 0, -7}, {0, 0, 1, 2}}};
    const Affine<double> expected{{{0x1p30 + 1, -0x1p30, 0, -5 * (0x1p30 + 1) - 7 * 0x1p30},
                                   {-0x1p30, 0x1p30, 0, 12 * 0x1p30},
                                   {0, 0, 1, -2}}};
    const Affine<double> got = inverse(a);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            EXPECT_DOUBLE_EQ(got.m[row][column], expected.m[row][column]) << row << ", " << column;
        }
    }
}

TEST(Affine, NormalsStayPerpendicularToTransformedTangents) {
    test::Random<double> random(1);
    for (int i = 0; i < 100; ++i) {
        const Affine<double> m = random.map(3);
        const Vec3<double> tangent = random.direction(), normal = cross(tangent, random.direction());
        const Vec3<double> moved = transform_normal(inverse(m), normal);
        EXPECT_NEAR(dot(moved, transform_vector(m, tangent)), 0, 1e-13);
        EXPECT_GT(dot(moved, transform_vector(m, normal)), 0);
    }
}

TEST(Bounds, TransformedBoxContainsItsCorners) {
    test::Random<float> random(2);
    for (int i = 0; i < 1000; ++i) {
        const Affine<float> m = affine_cast<float>(random.map(100));
        const Vec3<float> low = random.vector(5);
        const Bounds<float> b{low, low + Vec3<float>{1, 2, 3}};
        const Bounds<float> moved = transform_bounds(m, b);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3<float> p{corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y,
                                corner & 4 ? b.max.z : b.min.z};
            const Vec3<long double> q = transform_point(affine_cast<long double>(m), lanes<long double>(p));
            EXPECT_TRUE(moved.min.x <= q.x && q.x <= moved.max.x && moved.min.y <= q.y &&
                        q.y <= moved.max.y && moved.min.z <= q.z && q.z <= moved.max.z);
        }
    }
}

} // namespace
