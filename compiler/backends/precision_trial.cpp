#include "compiler/backends/precision_trial.h"

#include "runtime/host/srgb.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace scc::compiler {

namespace {

using Render = decltype(host::Drawable::render);
using runtime::Image;
using runtime::RenderRequest;
using runtime::RenderSettings;

/// Where both precisions see the same surface, float is about 1e-4 steps off.
constexpr double most_steps = 1.0 / 32; // an eighth of what may be lost
/// What may be lost where the picture itself changes as much beside the sample, in so large a part of it.
constexpr double most_excused_steps = 1.0 / 4, most_excused = 1.0 / 20;
/// Around a sample that float draws otherwise double draws a square of as many, so close to each other.
constexpr int surroundings = 5;
constexpr double surroundings_per_pixel = 256;
/// First a rough trial, which is enough to see that many scenes need double: one sample of so many.
constexpr int trial_parts[] = {1000, 200};
constexpr double fewest_samples = 250, most_samples = 5000;

double samples_of(const RenderSettings& settings, int part) {
    const double all = static_cast<double>(settings.width) * settings.height * settings.samples;
    return std::clamp(all / part, fewest_samples, most_samples);
}

/// A part of a picture of another size, a sample per pixel.
RenderRequest request_of(const RenderSettings& settings, int width, int height, const runtime::Crop& crop,
                         int threads) {
    RenderRequest request{
        .settings = with_plain_grid(settings), .crop = crop, .threads = threads, .progress = {}};
    request.settings.width = width;
    request.settings.height = height;
    request.settings.samples = 1;
    return request;
}

/// The whole view with few samples.
std::vector<RenderRequest> sparse_requests(const RenderSettings& settings, int part, int threads) {
    const double samples = samples_of(settings, part);
    const double scale = std::sqrt(samples / (static_cast<double>(settings.width) * settings.height));
    const auto scaled = [&](int side) {
        return static_cast<int>(std::lround(std::clamp(scale * side, 1.0, samples)));
    };
    const int width = scaled(settings.width), height = scaled(settings.height);
    return {request_of(settings, width, height, {0, 0, width, height}, threads)};
}

/// As many in blocks of neighbours, in rows and columns over the whole picture. They see less of it, but rays
/// far apart take ten times as long in a mesh, of which they share no part.
std::vector<RenderRequest> block_requests(const RenderSettings& settings, int part, int threads) {
    constexpr int side = 4;
    const double distance =
        side * std::sqrt(static_cast<double>(settings.width) * settings.height / samples_of(settings, part));
    const int columns = std::max(1, static_cast<int>(settings.width / distance));
    const int rows = std::max(1, static_cast<int>(settings.height / distance));
    const auto start = [](int i, int count, int size) {
        return std::max(0, static_cast<int>((i + 0.5) / count * size) - side / 2);
    };
    std::vector<RenderRequest> requests;
    for (int i = 0; i < rows * columns; ++i) {
        const int x = start(i % columns, columns, settings.width),
                  y = start(i / columns, rows, settings.height);
        requests.push_back(request_of(
            settings, settings.width, settings.height,
            {x, y, std::min(x + side, settings.width), std::min(y + side, settings.height)}, threads));
    }
    return requests;
}

Image draw(const Render& render, const RenderRequest& request) {
    Image image(request.crop.x1 - request.crop.x0, request.crop.y1 - request.crop.y0);
    render(request, image);
    return image;
}

/// In steps of an 8-bit file; infinite for what is no number in both.
double steps_between(float a, float b) {
    constexpr double steps = 255, steepest = 12.92; // of the sRGB encoding, at 0
    const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
    if (difference * steepest * steps < 1e-3) {
        return difference * steepest * steps; // most are, and need no power
    }
    if (!std::isfinite(a) || !std::isfinite(b)) {
        return std::numeric_limits<double>::infinity();
    }
    return steps * std::abs(host::encode_srgb(a) - host::encode_srgb(b));
}

/// How far a value lies outside a range of values.
double steps_outside(float v, float low, float high) {
    return v >= low && v <= high ? 0 : steps_between(v, v > high ? high : low);
}

using Pixel = std::array<float, 3>;

double steps_between(const Pixel& a, const Pixel& b) {
    return std::max({steps_between(a[0], b[0]), steps_between(a[1], b[1]), steps_between(a[2], b[2])});
}

class Trial {
public:
    Trial(const Render& single, const Render& full, const RenderSettings& settings)
        : single_(single), full_(full), settings_(settings) {}

    void compare(const RenderRequest& request) {
        const Image a = draw(single_, request), b = draw(full_, request);
        for (int y = request.crop.y0; y < request.crop.y1; ++y) {
            for (int x = request.crop.x0; x < request.crop.x1; ++x) {
                const Pixel one = pixel(a, x - request.crop.x0, y - request.crop.y0),
                            other = pixel(b, x - request.crop.x0, y - request.crop.y0);
                ++samples_;
                const double steps = steps_between(one, other);
                if (steps <= most_steps) {
                    worst_ = std::max(worst_, steps);
                    continue;
                }
                ++excused_;
                worst_excused_ =
                    std::max(worst_excused_, std::min(steps, steps_outside_surroundings(one, request, x, y)));
                if (is_too_far_off()) {
                    return;
                }
            }
        }
    }

    bool is_too_far_off() const { return worst_excused_ > most_excused_steps; }
    bool is_passed() const { return !is_too_far_off() && part_excused() <= most_excused; }
    PrecisionTrial result() const {
        std::string text =
            fmt::format("float was {:.2g} 8-bit steps off in a trial ({} are allowed)", worst_, most_steps);
        if (excused_ > 0) {
            text +=
                fmt::format(", and {:.2g} where the picture changes within 1/128 pixel ({} are allowed), for "
                            "{:.2g} % of the samples ({} % are allowed)",
                            worst_excused_, most_excused_steps, 100 * part_excused(), 100 * most_excused);
        }
        return {is_passed(), text};
    }

private:
    static Pixel pixel(const Image& image, int x, int y) {
        const float* channels = image.at(x, y);
        return {channels[0], channels[1], channels[2]};
    }

    double part_excused() const { return static_cast<double>(excused_) / static_cast<double>(samples_); }

    /// Of a value outside what double sees around the centre of the request's pixel (x, y).
    double steps_outside_surroundings(const Pixel& value, const RenderRequest& request, int x, int y) const {
        // A picture of which so many pixels are one of the request's, the middle one with the same centre.
        const int width = request.settings.width, height = request.settings.height;
        const int parts = static_cast<int>(surroundings_per_pixel * settings_.width / width / 2) * 2 + 1;
        const int left = x * parts + (parts - surroundings) / 2, top = y * parts + (parts - surroundings) / 2;
        const Image around = draw(full_, request_of(settings_, width * parts, height * parts,
                                                    {left, top, left + surroundings, top + surroundings}, 1));
        double steps = 0;
        for (std::size_t channel = 0; channel < value.size(); ++channel) {
            float low = std::numeric_limits<float>::infinity(), high = -low;
            for (int i = 0; i < surroundings * surroundings; ++i) {
                const float v = pixel(around, i % surroundings, i / surroundings)[channel];
                low = std::min(low, v);
                high = std::max(high, v);
            }
            steps = std::max(steps, steps_outside(value[channel], low, high));
        }
        return steps;
    }

    const Render& single_;
    const Render& full_;
    const RenderSettings& settings_;
    double worst_ = 0, worst_excused_ = 0; ///< in steps
    long samples_ = 0, excused_ = 0;
};

} // namespace

PrecisionTrial try_float(const Render& single, const Render& full, const RenderSettings& settings,
                         const TrialOptions& options) {
    Trial trial(single, full, settings);
    for (const int part : trial_parts) {
        const auto requests = options.coherent ? block_requests(settings, part, options.threads)
                                               : sparse_requests(settings, part, options.threads);
        for (const RenderRequest& request : requests) {
            trial.compare(request);
            if (trial.is_too_far_off()) {
                return trial.result();
            }
        }
        if (!trial.is_passed()) {
            break;
        }
    }
    return trial.result();
}

} // namespace scc::compiler
