#include "runtime/host/image_file.h"
#include "validation/compare.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scc::validation {
namespace {

using runtime::Image;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Image noise(int width, int height, unsigned seed) {
    Image image(width, height);
    for (float& value : image.pixels) {
        seed = seed * 1664525U + 1013904223U;
        value = static_cast<float>(seed >> 8) / static_cast<float>(1U << 24);
    }
    return image;
}

TEST(Compare, IdenticalImagesDifferByNothing) {
    const Image image = noise(20, 10, 1);
    const Metrics metrics = compare(image, image);
    EXPECT_EQ(metrics.all.pixels, 200U);
    EXPECT_EQ(metrics.all.max_error, 0);
    EXPECT_EQ(metrics.all.rmse, 0);
    EXPECT_EQ(metrics.all.above(1e-6), 0U);
    EXPECT_EQ(metrics.relative_rmse, 0);
    EXPECT_TRUE(std::isinf(metrics.psnr));
    EXPECT_EQ(metrics.ssim, 1);
    EXPECT_EQ(metrics.delta_e_max, 0);
    EXPECT_TRUE(to_json(metrics)["psnr_db"].is_null());
}

TEST(Compare, HandComputedCase) {
    Image reference(2, 2);
    reference.pixels = {0, 0, 0, 1, 1, 1, 0.5, 0.5, 0.5, 0, 0, 1};
    Image other = reference;
    other.at(1, 0)[1] = 0.75F; // 0.25 off
    other.at(0, 1)[2] = 1.0F;  // 0.5 off
    const Metrics metrics = compare(reference, other);
    EXPECT_EQ(metrics.all.max_error, 0.5);
    EXPECT_EQ(metrics.all.worst.x, 0);
    EXPECT_EQ(metrics.all.worst.y, 1);
    EXPECT_EQ(metrics.all.worst.channel, 2);
    EXPECT_EQ(metrics.worst_reference, (std::array<float, 3>{0.5, 0.5, 0.5}));
    EXPECT_EQ(metrics.worst_other, (std::array<float, 3>{0.5, 0.5, 1}));
    EXPECT_EQ(metrics.channel_max, (std::array<double, 3>{0, 0.25, 0.5}));
    EXPECT_EQ(metrics.channel_worst[1].x, 1);
    EXPECT_EQ(metrics.channel_worst[1].y, 0);
    EXPECT_DOUBLE_EQ(metrics.all.mean, 0.75 / 12);
    EXPECT_DOUBLE_EQ(metrics.all.rmse, std::sqrt((0.0625 + 0.25) / 12));
    EXPECT_DOUBLE_EQ(metrics.relative_rmse, std::sqrt((0.0625 + 0.25) / 4.75));
    EXPECT_DOUBLE_EQ(metrics.psnr, 20 * std::log10(1 / metrics.all.rmse));
    EXPECT_EQ(metrics.all.p50, 0);
    EXPECT_EQ(metrics.all.p90, 0.5);
    EXPECT_EQ(metrics.all.above(1e-6), 2U);
    EXPECT_LT(metrics.ssim, 0.999);
    EXPECT_GT(metrics.delta_e_max, 10);
}

TEST(Compare, PercentilesAreNearestRanks) {
    const Image reference(1000, 1, 1);
    Image other(1000, 1, 1);
    for (std::size_t i = 0; i < 1000; ++i)
        other.pixels[i] = static_cast<float>(i + 1);
    const Metrics metrics = compare(reference, other);
    EXPECT_EQ(metrics.all.p50, 500);
    EXPECT_EQ(metrics.all.p90, 900);
    EXPECT_EQ(metrics.all.p99, 990);
    EXPECT_EQ(metrics.all.p999, 999);
    EXPECT_EQ(metrics.all.max_error, 1000);
}

TEST(Compare, ThresholdsAreExclusiveAndCountPixelsOnce) {
    const Image reference(3, 1);
    Image other(3, 1);
    other.pixels = {0.5, 0.5, 0.5, 0.25, 0, 0, 0.125, 0, 0};
    const Metrics metrics = compare(reference, other, {.thresholds = {0.125, 0.25, 0.5}});
    EXPECT_EQ(metrics.all.above(0.125), 2U);
    EXPECT_EQ(metrics.all.above(0.25), 1U);
    EXPECT_EQ(metrics.all.above(0.5), 0U);
    EXPECT_THROW(metrics.all.above(0.3), std::invalid_argument);
}

TEST(Compare, DifferentSizesAreNamed) {
    try {
        compare(Image(3, 2), Image(2, 3));
        FAIL();
    } catch (const CompareError& error) {
        EXPECT_STREQ(error.what(), "the images have different sizes, 3 x 2 and 2 x 3");
    }
    EXPECT_THROW(compare(Image(), Image()), CompareError);
}

TEST(Compare, GreyEqualsColorOfThreeEqualChannels) {
    const Image grey(2, 2, 1);
    EXPECT_EQ(compare(grey, Image(2, 2, 3)).all.max_error, 0);
}

TEST(Compare, NotANumberIsAnInfiniteErrorAndIsCounted) {
    const Image reference = noise(8, 8, 3);
    Image other = reference;
    other.at(3, 5)[1] = not_a_number;
    other.at(4, 5)[0] = infinity;
    const Metrics metrics = compare(reference, other);
    EXPECT_TRUE(std::isinf(metrics.all.max_error));
    EXPECT_EQ(metrics.all.worst.x, 3);
    EXPECT_EQ(metrics.all.worst.y, 5);
    EXPECT_EQ(metrics.all.above(1e-2), 2U);
    EXPECT_EQ(metrics.all.rmse, 0);
    EXPECT_EQ(metrics.non_finite_reference, 0U);
    EXPECT_EQ(metrics.non_finite_other, 2U);
    EXPECT_TRUE(to_json(metrics)["all"]["max_error"].is_null());
}

TEST(Compare, NotANumberInBothImagesIsNoAgreement) {
    Image image = noise(8, 8, 3);
    image.at(0, 0)[0] = not_a_number;
    const Metrics metrics = compare(image, image);
    EXPECT_TRUE(std::isinf(metrics.all.max_error));
    EXPECT_EQ(metrics.non_finite_reference, 1U);
    EXPECT_EQ(metrics.non_finite_other, 1U);
}

TEST(Compare, CoverageCountsPixelsWhereOneImageShowsItsBackground) {
    Image reference(4, 1);
    Image other(4, 1);
    reference.pixels = {1, 1, 1, 0.1F, 0.2F, 0.3F, 0.1F, 0.2F, 0.3F, 1, 1, 1};
    other.pixels = {0.1F, 0.2F, 0.30001F, 0.1F, 0.2F, 0.30001F, 1, 1, 1, 1, 1, 1};
    EXPECT_FALSE(compare(reference, other).coverage_mismatch);
    CompareOptions options;
    options.reference_background = Background{{0.1F, 0.2F, 0.3F}};
    options.other_background = Background{{0.1F, 0.2F, 0.3F}, 1e-4};
    EXPECT_EQ(compare(reference, other, options).coverage_mismatch, 2U); // pixels 0 and 2
    options.other_background->tolerance = 1e-6;
    EXPECT_EQ(compare(reference, other, options).coverage_mismatch, 2U); // pixels 1 and 2
    options.reference_background->color = {1, 1, 1};
    EXPECT_EQ(compare(reference, other, options).coverage_mismatch, 2U); // pixels 0 and 3
}

TEST(Compare, ErrorsOnEdgesAreLeftOutOfTheInnerStatistics) {
    Image reference(20, 10);
    for (int y = 0; y < 10; ++y)
        for (int x = 10; x < 20; ++x)
            reference.at(x, y)[0] = 1;
    Image other = reference;
    other.at(10, 4)[0] = 0;      // the edge moved by a pixel
    other.at(3, 4)[0] = 0.0625F; // inside
    const Metrics metrics = compare(reference, other);
    EXPECT_EQ(metrics.all.max_error, 1);
    EXPECT_EQ(metrics.away_from_edges.pixels, 160U);
    EXPECT_EQ(metrics.away_from_edges.max_error, 0.0625);
    EXPECT_EQ(metrics.away_from_edges.worst.x, 3);
    EXPECT_EQ(metrics.away_from_edges.above(1e-2), 1U);
}

TEST(Compare, PeakFollowsBrightImages) {
    Image reference(1, 1);
    reference.pixels = {8, 0, 0};
    Image other(1, 1);
    other.pixels = {4, 0, 0};
    EXPECT_DOUBLE_EQ(compare(reference, other).psnr, 20 * std::log10(8 / std::sqrt(16.0 / 3)));
}

TEST(Amplification, IsAPowerOfTenThatKeepsTheBulkVisible) {
    Metrics metrics;
    EXPECT_EQ(suggest_amplification(metrics), 1);
    metrics.all.max_error = 0.5;
    EXPECT_EQ(suggest_amplification(metrics), 1);
    metrics.all.p999 = 0.004;
    EXPECT_EQ(suggest_amplification(metrics), 100);
    metrics.all.p999 = 1e-12;
    EXPECT_EQ(suggest_amplification(metrics), 1e6);
}

/// The number after a label in idiff's talk.
double number_after(const std::string& text, const std::string& label) {
    const std::size_t at = text.find(label);
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + label.size()));
}

TEST(Compare, AgreesWithIdiff) {
    if (!find_program("idiff"))
        GTEST_SKIP() << "idiff (openimageio-tools) is not installed";
    const Image reference = noise(64, 48, 7);
    Image other = noise(64, 48, 8);
    for (std::size_t i = 0; i < other.pixels.size(); ++i)
        other.pixels[i] = reference.pixels[i] + 0.1F * (other.pixels[i] - 0.5F);
    other.at(17, 31)[2] = 2.5F;
    const ScratchFolder folder;
    host::write_image((folder.path() / "a.exr").string(), reference);
    host::write_image((folder.path() / "b.exr").string(), other);
    Command command;
    command.program = "idiff";
    command.arguments = {"-fail", "0.01", "a.exr", "b.exr"};
    command.directory = folder.path();
    const std::string text = run(command).out;
    const Metrics metrics = compare(reference, other, {.thresholds = {0.01}});
    EXPECT_NEAR(metrics.all.mean, number_after(text, "Mean error = "), 1e-6) << text;
    EXPECT_NEAR(metrics.all.rmse, number_after(text, "RMS error = "), 1e-6);
    EXPECT_NEAR(metrics.psnr, number_after(text, "Peak SNR = "), 1e-3);
    EXPECT_NEAR(metrics.all.max_error, number_after(text, "Max error  = "), 1e-4);
    EXPECT_NE(text.find("(17, 31, B)"), std::string::npos);
    EXPECT_EQ(metrics.all.worst.x, 17);
    EXPECT_EQ(metrics.all.worst.y, 31);
    EXPECT_NE(text.find("  " + std::to_string(metrics.all.above(0.01)) + " pixels"), std::string::npos)
        << text;
}

} // namespace
} // namespace scc::validation
