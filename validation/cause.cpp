#include "validation/cause.h"

#include "validation/perceptual.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace scc::validation {
namespace {

using runtime::Image;

/// What has to be explained for a hypothesis to stand.
constexpr double enough = 0.8;
/// A tone curve has two numbers and could come near to much else.
constexpr double enough_of_tone = 0.98;

double value_of(const Image& image, std::size_t i) {
    const float value = image.pixels[i];
    return std::isfinite(value) ? static_cast<double>(value) : 0;
}

double squared_difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        sum += std::pow(value_of(a, i) - value_of(b, i), 2);
    return sum;
}

/// How much smaller the difference becomes with `instead` in the reference's place; at least 0.
double explained_by(const CauseInput& input, const Image& instead) {
    const double before = squared_difference(input.reference, input.other);
    return before > 0 ? std::max(0.0, 1 - squared_difference(instead, input.other) / before) : 0;
}

// ---- encoding

Image mapped(const Image& image, const std::function<double(double)>& curve) {
    Image result = image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        result.pixels[i] = static_cast<float>(curve(value_of(image, i)));
    return result;
}

struct Power {
    double gain = 1;
    double exponent = 1;
};
/// other = gain * reference^exponent, fitted to the logarithms of values that are neither dark nor cut off;
/// nothing if they are too much alike to tell.
std::optional<Power> fit_power(const Image& reference, const Image& other) {
    constexpr double dark = 0.01;
    constexpr double cut = 0.999;
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const double r = value_of(reference, i);
        const double o = value_of(other, i);
        if (r < dark || o < dark || o > cut)
            continue;
        n += 1;
        x += std::log(r);
        y += std::log(o);
        xx += std::log(r) * std::log(r);
        xy += std::log(r) * std::log(o);
    }
    const double spread = n * xx - x * x;
    if (n < 16 || spread < 1e-3 * n * n)
        return std::nullopt;
    Power power;
    power.exponent = (n * xy - x * y) / spread;
    power.gain = std::exp((y - power.exponent * x) / n);
    return power;
}

double decode_srgb_value(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Evidence test_tone(const CauseInput& input) {
    const auto within = [](double v) { return std::clamp(v, 0.0, 1.0); };
    std::vector<std::pair<std::string, std::function<double(double)>>> curves{
        {"the reference encoded by the sRGB curve", [&](double v) { return encode_srgb(within(v)); }},
        {"the reference decoded by the sRGB curve", [&](double v) { return decode_srgb_value(within(v)); }}};
    if (const std::optional<Power> fit = fit_power(input.reference, input.other)) {
        const Power power = *fit;
        curves.emplace_back(
            fmt::format("{:.4g} times the reference to the power of {:.4g}", power.gain, power.exponent),
            [power](double v) { return power.gain * std::pow(std::max(v, 0.0), power.exponent); });
    }
    Evidence best{"tone curve", "no curve fits", 0};
    for (const auto& [words, curve] : curves) {
        const double explained = explained_by(input, mapped(input.reference, curve));
        if (explained > best.explained)
            best = {"tone curve", words, explained};
    }
    return best;
}

// ---- sampling

/// The movement of the picture by Lucas and Kanade's least squares, which holds for small ones: other(x) =
/// reference(x + d).
std::array<double, 2> estimate_shift(const Image& reference, const Image& other) {
    double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0;
    for (int y = 1; y + 1 < reference.height; ++y)
        for (int x = 1; x + 1 < reference.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const auto at = [&](const Image& image, int px, int py) {
                    return static_cast<double>(image.at(px, py)[c]);
                };
                const double gx = (at(reference, x + 1, y) - at(reference, x - 1, y)) / 2;
                const double gy = (at(reference, x, y + 1) - at(reference, x, y - 1)) / 2;
                const double t = at(other, x, y) - at(reference, x, y);
                if (!std::isfinite(gx) || !std::isfinite(gy) || !std::isfinite(t))
                    continue;
                xx += gx * gx;
                xy += gx * gy;
                yy += gy * gy;
                xt += gx * t;
                yt += gy * t;
            }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-9 * xx * yy))
        return {0, 0};
    return {(yy * xt - xy * yt) / determinant, (xx * yt - xy * xt) / determinant};
}

Evidence test_shift(const CauseInput& input) {
    constexpr double most = 2; // pixels
    constexpr std::array steps{0.5, 0.25, 0.125};
    const auto [ex, ey] = estimate_shift(input.reference, input.other);
    std::vector<std::array<double, 2>> candidates;
    for (const double step : steps)
        candidates.push_back({std::round(ex / step) * step, std::round(ey / step) * step});
    for (const double x : {-0.5, 0.0, 0.5}) // the usual mistakes, should the estimate be misled
        for (const double y : {-0.5, 0.0, 0.5})
            candidates.push_back({x, y});
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    Evidence best{"shift", "no shift of the samples explains it", 0};
    for (const auto& [x, y] : candidates) {
        if ((x == 0 && y == 0) || std::max(std::abs(x), std::abs(y)) > most)
            continue;
        const double explained = explained_by(input, input.redraw(x, y));
        if (explained > best.explained)
            best = {"shift",
                    fmt::format("samples {:.3g} pixels to the right and {:.3g} down of where they should be",
                                x + 0.0, y + 0.0), // no -0
                    explained};
    }
    return best;
}

// ---- geometry

Evidence test_layers(const std::vector<LayerDifference>& layers) {
    Evidence result{"layers", "", 0};
    for (const LayerDifference& layer : layers) {
        if (!differs(layer))
            continue;
        result.explained = 1;
        result.finding += fmt::format("{}{}: {} of {} pixels differ, the most at ({}, {})",
                                      result.finding.empty() ? "" : "; ", layer.layer, layer.pixels,
                                      layer.compared, layer.x, layer.y);
    }
    if (result.finding.empty())
        result.finding = "objects, depths, positions and normals agree";
    return result;
}

// ---- shading

/// Solves the normal equations of a least-squares problem (symmetric, at most a few dozen unknowns) by
/// elimination; unknowns that nothing tells apart become 0.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
    const std::size_t n = b.size();
    std::vector<double> scale(n);
    for (std::size_t i = 0; i < n; ++i)
        scale[i] = a[i][i];
    std::vector<bool> used(n);
    for (std::size_t i = 0; i < n; ++i) {
        used[i] = a[i][i] > 1e-9 * scale[i];
        for (std::size_t row = 0; used[i] && row < n; ++row) {
            if (row == i)
                continue;
            const double factor = a[row][i] / a[i][i];
            for (std::size_t column = 0; column < n; ++column)
                a[row][column] -= factor * a[i][column];
            b[row] -= factor * b[i];
        }
    }
    std::vector<double> result(n);
    for (std::size_t i = 0; i < n; ++i)
        result[i] = used[i] ? b[i] / a[i][i] : 0;
    return result;
}

/// The reference with the lights' parts scaled so that it comes nearest to the other picture.
struct LightFit {
    std::vector<double> changes; ///< per light: -1 is a lost one, 0 an unchanged one
    double explained = 0;
};
LightFit fit_lights(const CauseInput& input) {
    const std::size_t n = input.lights.size();
    std::vector<std::vector<double>> products(n, std::vector<double>(n));
    std::vector<double> targets(n);
    for (std::size_t i = 0; i < input.reference.pixels.size(); ++i) {
        const double residual = value_of(input.other, i) - value_of(input.reference, i);
        for (std::size_t k = 0; k < n; ++k) {
            const double part = value_of(input.lights[k].image, i);
            targets[k] += part * residual;
            for (std::size_t l = 0; part != 0 && l < n; ++l)
                products[k][l] += part * value_of(input.lights[l].image, i);
        }
    }
    LightFit fit;
    fit.changes = solve(products, targets);
    Image changed = input.reference;
    for (std::size_t i = 0; i < changed.pixels.size(); ++i)
        for (std::size_t k = 0; k < n; ++k)
            changed.pixels[i] += static_cast<float>(fit.changes[k] * value_of(input.lights[k].image, i));
    fit.explained = explained_by(input, changed);
    return fit;
}

/// How much a factor for this light alone explains that depends on the distance: a constant in each of many
/// ranges of it, with as many pixels in each.
double explained_by_distance(const CauseInput& input, const LightPart& light) {
    constexpr std::size_t ranges = 64;
    std::vector<std::size_t> pixels; // by distance
    for (std::size_t i = 0; i < light.distance.size(); ++i)
        if (std::isfinite(light.distance[i]))
            pixels.push_back(i);
    std::sort(pixels.begin(), pixels.end(),
              [&](std::size_t a, std::size_t b) { return light.distance[a] < light.distance[b]; });
    Image changed = input.reference;
    for (std::size_t range = 0; range < ranges; ++range) {
        const std::size_t begin = range * pixels.size() / ranges;
        const std::size_t end = (range + 1) * pixels.size() / ranges;
        double products = 0;
        double targets = 0;
        const auto for_each_value = [&](const auto& visit) {
            for (std::size_t k = begin; k < end; ++k)
                for (std::size_t i = 3 * pixels[k]; i < 3 * pixels[k] + 3; ++i)
                    visit(i, value_of(light.image, i));
        };
        for_each_value([&](std::size_t i, double part) {
            products += part * part;
            targets += part * (value_of(input.other, i) - value_of(input.reference, i));
        });
        for_each_value([&](std::size_t i, double part) {
            changed.pixels[i] += products > 0 ? static_cast<float>(targets / products * part) : 0.0F;
        });
    }
    return explained_by(input, changed);
}

std::string changes_in_words(const CauseInput& input, const std::vector<double>& changes) {
    constexpr double visible = 0.01;
    std::string words;
    for (std::size_t k = 0; k < changes.size(); ++k) {
        if (std::abs(changes[k]) < visible)
            continue;
        words += words.empty() ? "" : "; ";
        words +=
            std::abs(changes[k] + 1) < visible
                ? fmt::format("light `{}` is missing", input.lights[k].name)
                : fmt::format("light `{}` is {:.3g} times as strong", input.lights[k].name, 1 + changes[k]);
    }
    return words.empty() ? "all lights are as strong as they should be" : words;
}

std::vector<Evidence> test_lights(const CauseInput& input) {
    const LightFit fit = fit_lights(input);
    std::vector<Evidence> result{{"lights", changes_in_words(input, fit.changes), fit.explained}};
    Evidence best{"attenuation", "no factor of the distance from one light explains it", 0};
    for (const LightPart& light : input.lights) {
        const double explained = light.distance.empty() ? 0 : explained_by_distance(input, light);
        if (explained > best.explained)
            best = {"attenuation",
                    fmt::format("light `{}` falls off differently with the distance", light.name), explained};
    }
    result.push_back(best);
    return result;
}

const Evidence* find(const Cause& cause, const char* test) {
    const auto found = std::find_if(cause.evidence.begin(), cause.evidence.end(),
                                    [&](const Evidence& evidence) { return evidence.test == test; });
    return found == cause.evidence.end() ? nullptr : &*found;
}

double explained(const Evidence* evidence) {
    return evidence != nullptr ? evidence->explained : 0;
}

void conclude(Cause& cause) {
    // As many numbers as the lights': an exposure is both, and told as the light's that it is more likely.
    constexpr double better = 0.005;
    const Evidence* tone = find(cause, "tone curve");
    const Evidence* shift = find(cause, "shift");
    const Evidence* layers = find(cause, "layers");
    const Evidence* lights = find(cause, "lights");
    const Evidence* attenuation = find(cause, "attenuation");
    const auto take = [&](CauseClass kind, const Evidence& evidence) {
        cause.cause = kind;
        cause.summary = evidence.finding;
    };
    if (explained(tone) >= enough_of_tone && explained(tone) > explained(lights) + better)
        take(CauseClass::encoding, *tone);
    else if (explained(shift) >= enough && explained(shift) > explained(lights))
        take(CauseClass::sampling, *shift);
    else if (explained(lights) >= enough_of_tone)
        take(CauseClass::shading, *lights);
    else if (explained(layers) > 0)
        take(CauseClass::geometry, *layers);
    else if (explained(attenuation) >= enough)
        take(CauseClass::shading, *attenuation);
    else if (layers != nullptr) {
        cause.cause = CauseClass::shading;
        cause.summary = layers->finding + ", so that it is the light that differs";
    } else {
        cause.summary = "nothing that was tested explains it; `--layers always` tests more";
    }
}

} // namespace

const char* name_of(CauseClass cause) {
    switch (cause) {
    case CauseClass::geometry:
        return "geometry";
    case CauseClass::shading:
        return "shading";
    case CauseClass::sampling:
        return "sampling";
    case CauseClass::encoding:
        return "encoding";
    case CauseClass::unclear:
        return "unclear";
    }
    return "";
}

Cause find_cause(const CauseInput& input) {
    Cause cause;
    if (!input.layers.empty())
        cause.evidence.push_back(test_layers(input.layers));
    cause.evidence.push_back(test_tone(input));
    if (input.redraw)
        cause.evidence.push_back(test_shift(input));
    if (!input.lights.empty())
        for (Evidence& evidence : test_lights(input))
            cause.evidence.push_back(std::move(evidence));
    conclude(cause);
    return cause;
}

nlohmann::ordered_json to_json(const Cause& cause) {
    nlohmann::ordered_json evidence = nlohmann::ordered_json::array();
    for (const Evidence& e : cause.evidence)
        evidence.push_back({{"test", e.test}, {"finding", e.finding}, {"explained", e.explained}});
    return {{"class", name_of(cause.cause)}, {"summary", cause.summary}, {"evidence", evidence}};
}

} // namespace scc::validation
