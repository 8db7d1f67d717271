#include "validation/perceptual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace scc::validation {
namespace {

using runtime::Image;

TEST(DeltaE2000, AgreesWithThePublishedTestData) {
    struct Row {
        Lab a;
        Lab b;
        double difference;
    };
    // From table 1 of Sharma, Wu, Dalal (2005), chosen for its branches: hue means across 0, the blue
    // rotation, greys.
    const Row rows[] = {
        {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
        {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
        {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
        {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
        {{50, 0, 0}, {50, -1, 2}, 2.3669},
        {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
        {{50, 2.49, -0.001}, {50, -2.49, 0.0011}, 7.2195},
        {{50, -0.001, 2.49}, {50, 0.0009, -2.49}, 4.8045},
        {{50, -0.001, 2.49}, {50, 0.0011, -2.49}, 4.7461},
        {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
        {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
        {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
        {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
        {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (const Row& row : rows) {
        EXPECT_NEAR(delta_e_2000(row.a, row.b), row.difference, 5e-5);
        EXPECT_NEAR(delta_e_2000(row.b, row.a), row.difference, 5e-5);
    }
}

TEST(Lab, WhiteGreyAndRedLieWhereTheyShould) {
    const float white[] = {1, 1, 1};
    const float grey[] = {0.18F, 0.18F, 0.18F};
    const float red[] = {1, 0, 0};
    const Lab w = lab_from_linear(white);
    EXPECT_NEAR(w[0], 100, 1e-4);
    EXPECT_NEAR(w[1], 0, 1e-4);
    EXPECT_NEAR(w[2], 0, 1e-4);
    EXPECT_NEAR(lab_from_linear(grey)[0], 49.4961, 1e-3);
    const Lab r = lab_from_linear(red);
    EXPECT_NEAR(r[0], 53.24, 0.01);
    EXPECT_NEAR(r[1], 80.09, 0.01);
    EXPECT_NEAR(r[2], 67.20, 0.01);
}

TEST(Lab, ValuesBeyondTheRangeAreClamped) {
    const float wild[] = {5, -1, std::numeric_limits<float>::quiet_NaN()};
    const float red[] = {1, 0, 0};
    EXPECT_EQ(lab_from_linear(wild), lab_from_linear(red));
}

TEST(EncodeSrgb, FollowsTheCurve) {
    EXPECT_EQ(encode_srgb(0), 0);
    EXPECT_NEAR(encode_srgb(1), 1, 1e-15);
    EXPECT_NEAR(encode_srgb(0.0031308), 0.0404499, 1e-6);
    EXPECT_NEAR(encode_srgb(0.214041), 0.5, 1e-6);
}

Image filled(int width, int height, float value) {
    Image image(width, height);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

TEST(Ssim, OfConstantImagesIsTheLuminanceTermAlone) {
    const double a = encode_srgb(0.25F);
    const double b = encode_srgb(0.5F);
    const double expected = (2 * a * b + 1e-4) / (a * a + b * b + 1e-4);
    EXPECT_NEAR(ssim(filled(30, 20, 0.25F), filled(30, 20, 0.5F)), expected, 1e-9);
    EXPECT_NEAR(ssim(filled(3, 2, 0.25F), filled(3, 2, 0.25F)), 1, 1e-9);
}

/// The definition written out: one two-dimensional window per pixel.
double ssim_by_definition(const Image& a, const Image& b) {
    double total = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            double w = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = std::max(y - 5, 0); j <= std::min(y + 5, a.height - 1); ++j)
                for (int i = std::max(x - 5, 0); i <= std::min(x + 5, a.width - 1); ++i) {
                    const double g = std::exp(-((i - x) * (i - x) + (j - y) * (j - y)) / 4.5);
                    const double va = encode_srgb(static_cast<double>(*a.at(i, j)));
                    const double vb = encode_srgb(static_cast<double>(*b.at(i, j)));
                    w += g;
                    ma += g * va;
                    mb += g * vb;
                    aa += g * va * va;
                    bb += g * vb * vb;
                    ab += g * va * vb;
                }
            ma /= w;
            mb /= w;
            total += (2 * ma * mb + 1e-4) * (2 * (ab / w - ma * mb) + 9e-4) /
                     ((ma * ma + mb * mb + 1e-4) * (aa / w - ma * ma + bb / w - mb * mb + 9e-4));
        }
    return total / (a.width * a.height);
}

TEST(Ssim, AgreesWithItsDefinition) {
    Image a(23, 17);
    Image b(23, 17);
    unsigned state = 1;
    for (std::size_t i = 0; i < a.pixels.size(); i += 3) {
        state = state * 1664525U + 1013904223U;
        const float noise = static_cast<float>(state >> 8) / static_cast<float>(1U << 24);
        std::fill_n(a.pixels.begin() + static_cast<std::ptrdiff_t>(i), 3, noise);
        std::fill_n(b.pixels.begin() + static_cast<std::ptrdiff_t>(i), 3, 0.5F * noise + 0.2F);
    }
    const double expected = ssim_by_definition(a, b);
    EXPECT_GT(expected, 0.1);
    EXPECT_LT(expected, 0.95);
    EXPECT_NEAR(ssim(a, b), expected, 1e-6);
}

} // namespace
} // namespace scc::validation
