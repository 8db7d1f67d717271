#include "validation/image_tools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace scc::validation {
namespace {

using runtime::Image;

Image filled(int width, int height, float value) {
    Image image(width, height);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

std::size_t edge_pixels(const std::vector<unsigned char>& mask) {
    return std::accumulate(mask.begin(), mask.end(), std::size_t{0});
}

TEST(BoxAverage, IsTheMeanOfEachBlock) {
    Image image(4, 2, 1);
    image.pixels = {1, 2, 10, 20, 3, 8, 30, 80};
    const Image average = box_average(image, 2);
    EXPECT_EQ(average.width, 2);
    EXPECT_EQ(average.height, 1);
    EXPECT_EQ(average.pixels, (runtime::Pixels{3.5, 35}));
}

TEST(BoxAverage, KeepsChannelsApart) {
    Image image(3, 3);
    for (std::size_t i = 0; i < 9; ++i) {
        image.pixels[3 * i] = 1;
        image.pixels[3 * i + 2] = static_cast<float>(i);
    }
    EXPECT_EQ(box_average(image, 3).pixels, (runtime::Pixels{1, 0, 4}));
    EXPECT_EQ(box_average(image, 1).pixels, image.pixels);
}

TEST(BoxAverage, RefusesSizesThatAreNoMultiple) {
    EXPECT_THROW(box_average(Image(4, 3), 2), CompareError);
    EXPECT_THROW(box_average(Image(4, 4), 0), CompareError);
}

TEST(EdgeMask, StepMarksTwoPixelsOnEachSide) {
    Image image = filled(20, 9, 0.25F);
    for (int y = 0; y < 9; ++y)
        for (int x = 10; x < 20; ++x)
            image.at(x, y)[1] = 0.75F;
    const std::vector<unsigned char> mask = edge_mask(image, 0.005);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 20; ++x)
            EXPECT_EQ(mask[static_cast<std::size_t>(20 * y + x)], x >= 8 && x < 12) << x << " " << y;
}

TEST(EdgeMask, ContrastIsHalfTheStep) {
    Image image = filled(10, 10, 0);
    for (int y = 0; y < 10; ++y)
        image.at(5, y)[0] = image.at(6, y)[0] = image.at(7, y)[0] = image.at(8, y)[0] = image.at(9, y)[0] =
            0.5F;
    EXPECT_EQ(edge_pixels(edge_mask(image, 0.2501)), 0U);
    EXPECT_EQ(edge_pixels(edge_mask(image, 0.2499)), 40U);
}

TEST(EdgeMask, EvenSlopeIsNoEdge) {
    Image image(30, 30);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 30; ++x)
            image.at(x, y)[2] = static_cast<float>(x + 2 * y) * 0.25F;
    const std::vector<unsigned char> mask = edge_mask(image, 0.005);
    EXPECT_EQ(mask[30 * 15 + 15], 0);
    EXPECT_EQ(edge_pixels(mask), 30U * 30 - 26 * 26)
        << "the border, where the slope ends, and its neighbours";
}

TEST(EdgeMask, PixelThatIsNotFiniteIsAnEdge) {
    Image image = filled(9, 9, 1);
    image.at(4, 4)[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(edge_pixels(edge_mask(image, 0.005)), 25U);
}

TEST(DifferenceImage, IsAbsoluteAndAmplified) {
    Image a(1, 1);
    Image b(1, 1);
    a.pixels = {1, 2, 3};
    b.pixels = {1.5, 1, 3};
    EXPECT_EQ(difference_image(a, b, 10).pixels, (runtime::Pixels{5, 10, 0}));
    EXPECT_THROW(difference_image(a, Image(1, 2), 1), CompareError);
}

TEST(InColor, RepeatsGreyThreeTimes) {
    Image grey(2, 1, 1);
    grey.pixels = {1, 2};
    EXPECT_EQ(in_color(grey).pixels, (runtime::Pixels{1, 1, 1, 2, 2, 2}));
    EXPECT_THROW(in_color(Image(1, 1, 4)), CompareError);
}

} // namespace
} // namespace scc::validation
