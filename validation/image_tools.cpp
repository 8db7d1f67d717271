#include "validation/image_tools.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scc::validation {
namespace {

using runtime::Image;

/// Largest minus smallest residual of the plane fitted to a channel's 3x3 neighbourhood; the picture is
/// continued by its border pixels.
double departure_from_plane(const Image& image, int x, int y, int channel) {
    std::array<double, 9> values;
    double mean = 0;
    double slope_x = 0;
    double slope_y = 0;
    std::size_t k = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx, ++k) {
            const float* pixel =
                image.at(std::clamp(x + dx, 0, image.width - 1), std::clamp(y + dy, 0, image.height - 1));
            values[k] = static_cast<double>(pixel[channel]);
            mean += values[k] / 9;
            slope_x += values[k] * dx / 6;
            slope_y += values[k] * dy / 6;
        }
    k = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx, ++k)
            values[k] -= mean + slope_x * dx + slope_y * dy;
    const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
    return *largest - *smallest;
}

bool is_edge(const Image& image, int x, int y, double contrast) {
    for (int channel = 0; channel < image.channels; ++channel)
        if (!(departure_from_plane(image, x, y, channel) <= contrast)) // true for NaN too
            return true;
    return false;
}

} // namespace

std::vector<unsigned char> edge_mask(const Image& image, double contrast) {
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<unsigned char> mask(width * static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (!is_edge(image, x, y, contrast))
                continue;
            for (int row = std::max(y - 1, 0); row <= std::min(y + 1, image.height - 1); ++row)
                for (int column = std::max(x - 1, 0); column <= std::min(x + 1, image.width - 1); ++column)
                    mask[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] = 1;
        }
    return mask;
}

Image in_color(const Image& image) {
    if (image.channels == 3)
        return image;
    if (image.channels != 1)
        throw CompareError(
            fmt::format("an image with {} channels cannot be compared; 1 or 3 can", image.channels));
    Image color(image.width, image.height, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        std::fill_n(color.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, image.pixels[i]);
    return color;
}

Image difference_image(const Image& reference, const Image& other, double amplification) {
    if (reference.width != other.width || reference.height != other.height ||
        reference.channels != other.channels)
        throw CompareError("the images have different sizes or channels");
    Image difference(reference.width, reference.height, reference.channels);
    for (std::size_t i = 0; i < difference.pixels.size(); ++i)
        difference.pixels[i] = static_cast<float>(
            std::abs(static_cast<double>(other.pixels[i]) - static_cast<double>(reference.pixels[i])) *
            amplification);
    return difference;
}

Image box_average(const Image& image, int n) {
    if (n < 1 || image.width % n != 0 || image.height % n != 0)
        throw CompareError(fmt::format("an image of {} x {} pixels has no blocks of {} x {}", image.width,
                                       image.height, n, n));
    Image average(image.width / n, image.height / n, image.channels);
    std::vector<double> sums(static_cast<std::size_t>(image.channels));
    for (int y = 0; y < average.height; ++y)
        for (int x = 0; x < average.width; ++x) {
            std::fill(sums.begin(), sums.end(), 0);
            for (int sample = 0; sample < n * n; ++sample) {
                const float* pixel = image.at(x * n + sample % n, y * n + sample / n);
                for (std::size_t channel = 0; channel < sums.size(); ++channel)
                    sums[channel] += static_cast<double>(pixel[channel]);
            }
            std::transform(sums.begin(), sums.end(), average.at(x, y),
                           [n](double sum) { return static_cast<float>(sum / (n * n)); });
        }
    return average;
}

} // namespace scc::validation
