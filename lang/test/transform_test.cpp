#include "lang/test/toy_schema.h"
#include "lang/transforms.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scc::lang {
namespace {

using test::value_of;

void expect_near(const TransformValue& actual, const TransformValue& wanted, double tolerance) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            EXPECT_NEAR(actual.m[i][j], wanted.m[i][j], tolerance) << i << ' ' << j;
        }
    }
}

TEST(Transforms, AreWrittenRowByRow) {
    EXPECT_EQ(value_of("translate(1, 2, 3)"), "matrix([1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1])");
    EXPECT_EQ(value_of("translate((1, 2, 3))"), value_of("translate(1, 2, 3)"));
    EXPECT_EQ(value_of("scale(2)"), value_of("scale(2, 2, 2)"));
    EXPECT_EQ(value_of("matrix([1, 2, 3, 4, 0, 6, 7, 8, 0, 0, 2, 9, 0, 0, 0, 1])"),
              "matrix([1, 2, 3, 4, 0, 6, 7, 8, 0, 0, 2, 9, 0, 0, 0, 1])");
}

TEST(Transforms, JoinFirstToLast) {
    EXPECT_EQ(value_of("scale(2) then translate(1, 0, 0)"),
              "matrix([2, 0, 0, 1, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1])");
    EXPECT_EQ(value_of("translate(1, 0, 0) then scale(2)"),
              "matrix([2, 0, 0, 2, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1])");
}

TEST(Transforms, TurnRightHandedAndExactlyByQuarters) {
    EXPECT_EQ(value_of("rotate_x(90deg)"),
              "matrix([1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1])"); // y to z
    EXPECT_EQ(value_of("rotate_y(90deg)"),
              "matrix([0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1])"); // z to x
    EXPECT_EQ(value_of("rotate_z(90deg)"),
              "matrix([0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])"); // x to y
    EXPECT_EQ(value_of("rotate((0, 5, 0), 270deg)"), value_of("rotate_y(-90deg)"));
}

TEST(Transforms, TurnAboutAnyAxis) {
    const double third = 1.0 / std::sqrt(3.0);
    // a third of a turn about the diagonal takes x to y, y to z, z to x
    expect_near(rotation({third, third, third}, 2 * std::acos(-1.0) / 3),
                {{{{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}}}}, 1e-15);
}

TEST(Transforms, LookAtTakesTheEyeToTheOrigin) {
    EXPECT_EQ(value_of("look_at((0, 0, 5), (0, 0, 0), (0, 1, 0))"), value_of("translate(0, 0, -5)"));
    // from +x towards the origin: world -z is to the right, the eye's distance is along z
    EXPECT_EQ(value_of("look_at((4, 0, 0), (0, 0, 0), (0, 1, 0))"),
              "matrix([0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, -4, 0, 0, 0, 1])");
    EXPECT_FALSE(look_at({0, 0, 0}, {0, 0, 0}, {0, 1, 0}));
    EXPECT_FALSE(look_at({0, 5, 0}, {0, 0, 0}, {0, 1, 0}));
    EXPECT_FALSE(look_at({0, 5, 0}, {1, 0, 0}, {0, 0, 0}));
}

TEST(Transforms, AreUndoneByTheirInverse) {
    const TransformValue t =
        then(then(scaling({2, 3, 0.5}), rotation({0, 0.6, 0.8}, 1.1)), translation({4, -5, 6}));
    ASSERT_TRUE(inverse(t));
    expect_near(then(t, *inverse(t)), {}, 1e-14);
    expect_near(then(*inverse(t), t), {}, 1e-14);
    EXPECT_EQ(value_of("inverse(translate(1, 2, 3))"), value_of("translate(-1, -2, -3)"));
}

TEST(Transforms, WithATinyScaleAreNotSingular) {
    const auto undone = inverse(scaling({1e-150, 1e-150, 1e-150}));
    ASSERT_TRUE(undone);
    EXPECT_NEAR(undone->m[1][1] / 1e150, 1, 1e-12);
}

TEST(Transforms, ThatFlattenAreSingular) {
    EXPECT_FALSE(inverse(scaling({1, 0, 1})));
    EXPECT_FALSE(inverse(scaling({1, 1e-17, 1})));
    EXPECT_FALSE(inverse({{{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}}}));
    EXPECT_TRUE(inverse(scaling({1, 1e-12, 1})));
    EXPECT_TRUE(std::isinf(condition(scaling({0, 0, 0}))));
    EXPECT_NEAR(condition(scaling({7, 7, 7})), 3, 1e-12);
}

} // namespace
} // namespace scc::lang
