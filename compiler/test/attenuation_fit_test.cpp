#include "compiler/backends/attenuation_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

namespace scc::compiler {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

struct Case {
    Attenuation attenuation;
    double near, far;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.attenuation.kc << ", " << c.attenuation.kl << ", " << c.attenuation.kq << " from " << c.near
         << " to " << c.far;
}

/// On other points than the fit looks at.
double largest_error(const FadeSum& sum, const Case& c) {
    double largest = 0;
    for (double d = c.near; d <= std::min(c.far, 1e6); d += 1e-3 + 7e-4 * d) {
        largest = std::max(largest, std::abs(sum.at(d) - c.attenuation.at(d)) / c.attenuation.at(c.near));
    }
    return largest;
}

TEST(AttenuationFit, ALightWithoutAttenuationDoesNotFade) {
    const FadeSum sum = fade_lights({2, 0, 0}, 1, endless);
    ASSERT_EQ(sum.lights.size(), 1U);
    EXPECT_EQ(sum.lights[0].power, 0);
    EXPECT_EQ(sum.lights[0].gain, 0.5);
}

class ExactAttenuation : public testing::TestWithParam<Case> {};

TEST_P(ExactAttenuation, IsASumOfAtMostTwoFadedLights) {
    const FadeSum sum = fade_lights(GetParam().attenuation, GetParam().near, GetParam().far);
    EXPECT_TRUE(sum.exact);
    EXPECT_LE(sum.lights.size(), 2U);
    EXPECT_LT(largest_error(sum, GetParam()), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ExactAttenuation,
                         testing::Values(Case{{1, 0, 0.05}, 0.1, endless}, Case{{1, 0.5, 0}, 0.1, endless},
                                         Case{{0, 0, 0.1}, 0.5, endless}, Case{{0, 0.4, 0}, 0.5, endless},
                                         Case{{0, 0.3, 0.1}, 0.5, endless}, Case{{1, 1, 0.1}, 0.1, endless},
                                         Case{{1, 2, 0.98}, 0.1, endless}));

class FittedAttenuation : public testing::TestWithParam<Case> {};

TEST_P(FittedAttenuation, KeepsItsBoundWithFewLightsThatDoNotCancel) {
    const FadeSum sum = fade_lights(GetParam().attenuation, GetParam().near, GetParam().far);
    EXPECT_FALSE(sum.exact);
    EXPECT_LE(sum.lights.size(), 5U);
    EXPECT_LT(sum.bound, 3e-6);
    EXPECT_GT(sum.bound, 0);
    EXPECT_LT(largest_error(sum, GetParam()), 1.05 * sum.bound);
    double magnitude = 0;
    for (const Fade& light : sum.lights) {
        magnitude += std::abs(light.at(GetParam().near)) / GetParam().attenuation.at(GetParam().near);
    }
    EXPECT_LT(magnitude, 30);
}

INSTANTIATE_TEST_SUITE_P(DoubleAndComplexRoots, FittedAttenuation,
                         testing::Values(Case{{1, 0.05, 0.01}, 1, endless}, Case{{1, 0.3, 0.08}, 1, endless},
                                         Case{{1, 0.3, 0.08}, 6, 186}, Case{{1, 2, 1}, 0.5, endless},
                                         Case{{1, 2, 0.999}, 1, 1000}, Case{{0.01, 0.1, 1}, 0.1, endless},
                                         Case{{1, 1e-6, 1}, 0, endless}, Case{{1, 1, 1}, 0, endless}));

TEST(AttenuationFit, GivesTheSameLightsInEveryRun) {
    const FadeSum a = fade_lights({1, 0.3, 0.08}, 1, 50), b = fade_lights({1, 0.3, 0.08}, 1, 50);
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) {
        EXPECT_EQ(a.lights[i].gain, b.lights[i].gain);
        EXPECT_EQ(a.lights[i].distance, b.lights[i].distance);
        EXPECT_EQ(a.lights[i].power, b.lights[i].power);
    }
}

} // namespace
} // namespace scc::compiler
