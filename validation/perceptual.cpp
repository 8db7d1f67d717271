#include "validation/perceptual.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <vector>

namespace scc::validation {
namespace {

double unit(float value) {
    return value > 0 ? std::min(static_cast<double>(value), 1.0) : 0.0;
} // NaN too is 0

double cube_root_or_line(double t) {
    constexpr double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29.0;
}

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

/// Hue angle in degrees, 0..360; 0 for grey.
double hue(double a, double b) {
    if (a == 0 && b == 0)
        return 0;
    const double angle = std::atan2(b, a) * 180 / std::numbers::pi;
    return angle < 0 ? angle + 360 : angle;
}

double pow7(double x) {
    return std::pow(x, 7);
}

constexpr double pow7_of_25 = 6103515625.0;

/// A picture of one channel.
struct Plane {
    int width;
    int height;
    std::vector<double> values;

    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    double& at(int x, int y) { return values[index(x, y)]; }
    double at(int x, int y) const { return values[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

Plane encoded_luminance(const runtime::Image& image) {
    Plane plane(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* rgb = image.at(x, y);
            plane.at(x, y) =
                encode_srgb(0.2126 * unit(rgb[0]) + 0.7152 * unit(rgb[1]) + 0.0722 * unit(rgb[2]));
        }
    return plane;
}

Plane product(const Plane& a, const Plane& b) {
    Plane result(a.width, a.height);
    std::transform(a.values.begin(), a.values.end(), b.values.begin(), result.values.begin(),
                   std::multiplies<>());
    return result;
}

constexpr int window_radius = 5;
constexpr double window_sigma = 1.5;

/// Unnormalised, from the centre outwards.
std::array<double, window_radius + 1> window_weights() {
    std::array<double, window_radius + 1> weights;
    for (int i = 0; i <= window_radius; ++i)
        weights[static_cast<std::size_t>(i)] = std::exp(-i * i / (2 * window_sigma * window_sigma));
    return weights;
}

/// Weighted mean along one axis; the window's part outside the picture is left out.
template <class At>
double windowed(int position, int size, const At& at) {
    static const std::array<double, window_radius + 1> weight_at = window_weights();
    double sum = 0;
    double weights = 0;
    for (int i = std::max(position - window_radius, 0); i <= std::min(position + window_radius, size - 1);
         ++i) {
        const double weight = weight_at[static_cast<std::size_t>(std::abs(i - position))];
        sum += weight * at(i);
        weights += weight;
    }
    return sum / weights;
}

Plane blurred(const Plane& plane) {
    Plane rows(plane.width, plane.height);
    Plane result(plane.width, plane.height);
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x)
            rows.at(x, y) = windowed(x, plane.width, [&](int i) { return plane.at(i, y); });
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x)
            result.at(x, y) = windowed(y, plane.height, [&](int i) { return rows.at(x, i); });
    return result;
}

} // namespace

double encode_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Lab lab_from_linear(const float* rgb) {
    const double r = unit(rgb[0]);
    const double g = unit(rgb[1]);
    const double b = unit(rgb[2]);
    // Rows of the Rec.709 to XYZ matrix, each divided by its sum: the white point (1, 1, 1) has no colour.
    const double x = cube_root_or_line((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.9504700);
    const double y = cube_root_or_line(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
    const double z = cube_root_or_line((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.0888300);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double delta_e_2000(const Lab& first, const Lab& second) {
    const double mean_chroma = (std::hypot(first[1], first[2]) + std::hypot(second[1], second[2])) / 2;
    const double g = 0.5 * (1 - std::sqrt(pow7(mean_chroma) / (pow7(mean_chroma) + pow7_of_25)));
    const double a1 = (1 + g) * first[1];
    const double a2 = (1 + g) * second[1];
    const double c1 = std::hypot(a1, first[2]);
    const double c2 = std::hypot(a2, second[2]);
    const double h1 = hue(a1, first[2]);
    const double h2 = hue(a2, second[2]);

    double hue_step = c1 * c2 == 0 ? 0 : h2 - h1;
    if (std::abs(hue_step) > 180)
        hue_step += hue_step > 0 ? -360 : 360;
    double mean_hue = c1 * c2 == 0 ? h1 + h2 : (h1 + h2) / 2;
    if (c1 * c2 != 0 && std::abs(h1 - h2) > 180)
        mean_hue += mean_hue < 180 ? 180 : -180;

    const double lightness_step = second[0] - first[0];
    const double chroma_step = c2 - c1;
    const double hue_distance = 2 * std::sqrt(c1 * c2) * std::sin(radians(hue_step / 2));
    const double c = (c1 + c2) / 2;
    const double l50 = std::pow((first[0] + second[0]) / 2 - 50, 2);
    const double t = 1 - 0.17 * std::cos(radians(mean_hue - 30)) + 0.24 * std::cos(radians(2 * mean_hue)) +
                     0.32 * std::cos(radians(3 * mean_hue + 6)) - 0.20 * std::cos(radians(4 * mean_hue - 63));
    const double lightness = lightness_step / (1 + 0.015 * l50 / std::sqrt(20 + l50));
    const double chroma = chroma_step / (1 + 0.045 * c);
    const double hue_term = hue_distance / (1 + 0.015 * c * t);
    const double rotation = -2 * std::sqrt(pow7(c) / (pow7(c) + pow7_of_25)) *
                            std::sin(radians(60 * std::exp(-std::pow((mean_hue - 275) / 25, 2))));
    return std::sqrt(lightness * lightness + chroma * chroma + hue_term * hue_term +
                     rotation * chroma * hue_term);
}

double ssim(const runtime::Image& a, const runtime::Image& b) {
    constexpr double c1 = 0.01 * 0.01;
    constexpr double c2 = 0.03 * 0.03;
    const Plane la = encoded_luminance(a);
    const Plane lb = encoded_luminance(b);
    const Plane mean_a = blurred(la);
    const Plane mean_b = blurred(lb);
    const Plane square_a = blurred(product(la, la));
    const Plane square_b = blurred(product(lb, lb));
    const Plane mixed = blurred(product(la, lb));
    double sum = 0;
    for (std::size_t i = 0; i < la.values.size(); ++i) {
        const double ma = mean_a.values[i];
        const double mb = mean_b.values[i];
        const double variance_a = square_a.values[i] - ma * ma;
        const double variance_b = square_b.values[i] - mb * mb;
        const double covariance = mixed.values[i] - ma * mb;
        sum += (2 * ma * mb + c1) * (2 * covariance + c2) /
               ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2));
    }
    return sum / static_cast<double>(la.values.size());
}

} // namespace scc::validation
