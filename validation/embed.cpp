#include "validation/embed.h"

#include "runtime/host/png.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scc::validation {
namespace {

constexpr int max_embedded_width = 800;

/// One pixel of the smaller image; blocks at the right and lower border may be smaller.
void shrink_block(const runtime::Image& image, int x0, int y0, int n, Shrink how, float* target) {
    std::vector<double> sums(static_cast<std::size_t>(image.channels));
    int pixels = 0;
    for (int y = y0; y < std::min(y0 + n, image.height); ++y)
        for (int x = x0; x < std::min(x0 + n, image.width); ++x, ++pixels)
            for (std::size_t channel = 0; channel < sums.size(); ++channel) {
                const float value = image.at(x, y)[channel];
                const double finite = std::isfinite(value) ? static_cast<double>(value) : 1.0;
                sums[channel] =
                    how == Shrink::maximum ? std::max(sums[channel], finite) : sums[channel] + finite;
            }
    const double scale = how == Shrink::maximum ? 1 : 1.0 / pixels;
    std::transform(sums.begin(), sums.end(), target,
                   [scale](double sum) { return static_cast<float>(sum * scale); });
}

/// Rounded to nearest; IEEE 754 binary16.
std::uint16_t half_of(double value) {
    constexpr double largest = 65504;
    constexpr double least_normal = 0x1p-14;
    const unsigned sign = std::signbit(value) ? 0x8000U : 0U;
    const double size = std::abs(value);
    if (!(size <= largest))
        return static_cast<std::uint16_t>(sign | 0x7c00U);
    if (size < least_normal)
        return static_cast<std::uint16_t>(sign | static_cast<unsigned>(std::lround(size * 0x1p24)));
    int exponent = 0;
    const double mantissa = std::frexp(size, &exponent); // 0.5 .. 1
    // A mantissa that is rounded up to 2048 carries into the exponent.
    const auto bits = static_cast<unsigned>(std::lround(mantissa * 2048)) - 1024U;
    return static_cast<std::uint16_t>(sign | ((static_cast<unsigned>(exponent + 14) << 10) + bits));
}

} // namespace

std::string escape_html(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&#39;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(bytes.size() - i, 3);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            result += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return result;
}

runtime::Image shrunk(const runtime::Image& image, int max_width, Shrink how) {
    const int n = (image.width + max_width - 1) / max_width;
    runtime::Image small((image.width + n - 1) / n, (image.height + n - 1) / n, image.channels);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            shrink_block(image, x * n, y * n, n, how, small.at(x, y));
    return small;
}

std::string data_uri(const runtime::Image& image, Shrink how) {
    return "data:image/png;base64," + base64(host::encode_png(shrunk(image, max_embedded_width, how)));
}

std::string half_floats(const runtime::Image& image, double scale) {
    std::string bytes;
    bytes.reserve(2 * image.pixels.size());
    for (const float value : image.pixels) {
        const std::uint16_t half = half_of(static_cast<double>(value) * scale);
        bytes += static_cast<char>(half & 0xff);
        bytes += static_cast<char>(half >> 8);
    }
    return base64(bytes);
}

} // namespace scc::validation
