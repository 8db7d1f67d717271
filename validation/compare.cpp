#include "validation/compare.h"

#include "validation/perceptual.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scc::validation {
namespace {

using runtime::Image;

constexpr double infinity = std::numeric_limits<double>::infinity();

void check_sizes(const Image& reference, const Image& other) {
    if (reference.width != other.width || reference.height != other.height)
        throw CompareError(fmt::format("the images have different sizes, {} x {} and {} x {}",
                                       reference.width, reference.height, other.width, other.height));
    if (reference.pixels.empty())
        throw CompareError("the images have no pixels");
}

double error_of(float reference, float other) {
    const double error = std::abs(static_cast<double>(other) - static_cast<double>(reference));
    return std::isfinite(error) ? error : infinity;
}

/// Gathers the statistics of one set of pixels.
class Accumulator {
public:
    void add(int x, int y, const float* reference, const float* other) {
        double pixel_error = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const double error = error_of(reference[channel], other[channel]);
            pixel_error = std::max(pixel_error, error);
            if (error > worst_error_) {
                worst_error_ = error;
                worst_ = {x, y, channel};
            }
            if (error < infinity) {
                sum_ += error;
                squares_ += error * error;
                ++finite_;
            }
        }
        errors_.push_back(pixel_error);
    }

    ErrorStatistics finish(const std::vector<double>& thresholds) {
        ErrorStatistics result;
        result.pixels = errors_.size();
        if (errors_.empty())
            return result;
        std::sort(errors_.begin(), errors_.end());
        result.max_error = errors_.back();
        result.worst = worst_;
        if (finite_ > 0) {
            result.mean = sum_ / static_cast<double>(finite_);
            result.rmse = std::sqrt(squares_ / static_cast<double>(finite_));
        }
        result.p50 = per_mille(500);
        result.p90 = per_mille(900);
        result.p99 = per_mille(990);
        result.p999 = per_mille(999);
        for (const double threshold : thresholds) {
            const auto above = std::upper_bound(errors_.begin(), errors_.end(), threshold);
            result.counts.push_back({threshold, static_cast<std::size_t>(errors_.end() - above)});
        }
        return result;
    }

private:
    /// Nearest rank, in whole numbers: 999 per mille of 1000 errors is the 999th.
    double per_mille(std::size_t share) const {
        const std::size_t rank = (share * errors_.size() + 999) / 1000;
        return errors_[std::max<std::size_t>(rank, 1) - 1];
    }

    std::vector<double> errors_;
    double worst_error_ = 0;
    Place worst_;
    double sum_ = 0;
    double squares_ = 0;
    std::size_t finite_ = 0;
};

bool shows_background(const float* rgb, const Background& background) {
    for (std::size_t channel = 0; channel < 3; ++channel)
        if (!(std::abs(static_cast<double>(rgb[channel]) - static_cast<double>(background.color[channel])) <=
              background.tolerance))
            return false;
    return true;
}

/// What needs both pictures as a whole rather than pixel by pixel errors.
void add_levels(Metrics& metrics, const Image& reference, const Image& other) {
    double squares = 0;
    double peak = 1;
    std::size_t finite = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const auto r = static_cast<double>(reference.pixels[i]);
        const auto o = static_cast<double>(other.pixels[i]);
        metrics.non_finite_reference += !std::isfinite(r);
        metrics.non_finite_other += !std::isfinite(o);
        if (!std::isfinite(r) || !std::isfinite(o))
            continue;
        squares += r * r;
        peak = std::max({peak, std::abs(r), std::abs(o)});
        ++finite;
    }
    const double rmse = metrics.all.rmse;
    metrics.psnr = rmse > 0 ? 20 * std::log10(peak / rmse) : infinity;
    const double root_mean_square = finite > 0 ? std::sqrt(squares / static_cast<double>(finite)) : 0;
    if (rmse > 0)
        metrics.relative_rmse = root_mean_square > 0 ? rmse / root_mean_square : infinity;
}

void add_delta_e(Metrics& metrics, const Image& reference, const Image& other) {
    double sum = 0;
    for (int y = 0; y < metrics.height; ++y)
        for (int x = 0; x < metrics.width; ++x) {
            const float* r = reference.at(x, y);
            const float* o = other.at(x, y);
            if (std::equal(r, r + 3, o))
                continue;
            const double difference = delta_e_2000(lab_from_linear(r), lab_from_linear(o));
            sum += difference;
            if (difference > metrics.delta_e_max) {
                metrics.delta_e_max = difference;
                metrics.delta_e_worst = {x, y, 0};
            }
        }
    metrics.delta_e_mean = sum / static_cast<double>(metrics.all.pixels);
}

void add_errors(Metrics& metrics, const Image& reference, const Image& other, const CompareOptions& options) {
    const std::vector<unsigned char> edges = edge_mask(reference, options.edge_contrast);
    Accumulator all;
    Accumulator inner;
    std::size_t pixel = 0;
    for (int y = 0; y < metrics.height; ++y)
        for (int x = 0; x < metrics.width; ++x, ++pixel) {
            const float* r = reference.at(x, y);
            const float* o = other.at(x, y);
            all.add(x, y, r, o);
            if (edges[pixel] == 0)
                inner.add(x, y, r, o);
            for (std::size_t channel = 0; channel < 3; ++channel)
                if (const double error = error_of(r[channel], o[channel]);
                    error > metrics.channel_max[channel]) {
                    metrics.channel_max[channel] = error;
                    metrics.channel_worst[channel] = {x, y, static_cast<int>(channel)};
                }
        }
    metrics.all = all.finish(options.thresholds);
    metrics.away_from_edges = inner.finish(options.thresholds);
    std::copy_n(reference.at(metrics.all.worst.x, metrics.all.worst.y), 3, metrics.worst_reference.begin());
    std::copy_n(other.at(metrics.all.worst.x, metrics.all.worst.y), 3, metrics.worst_other.begin());
}

void add_coverage(Metrics& metrics, const Image& reference, const Image& other,
                  const CompareOptions& options) {
    if (!options.reference_background || !options.other_background)
        return;
    std::size_t mismatch = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); i += 3)
        mismatch += shows_background(&reference.pixels[i], *options.reference_background) !=
                    shows_background(&other.pixels[i], *options.other_background);
    metrics.coverage_mismatch = mismatch;
}

nlohmann::ordered_json number_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const Place& place) {
    return {{"x", place.x}, {"y", place.y}, {"channel", place.channel}};
}

nlohmann::ordered_json to_json(const ErrorStatistics& statistics) {
    nlohmann::ordered_json counts = nlohmann::ordered_json::array();
    for (const ErrorStatistics::Count& count : statistics.counts)
        counts.push_back({{"threshold", number_or_null(count.threshold)}, {"pixels", count.pixels}});
    return {{"pixels", statistics.pixels},
            {"max_error", number_or_null(statistics.max_error)},
            {"worst", to_json(statistics.worst)},
            {"mean", statistics.mean},
            {"rmse", statistics.rmse},
            {"percentiles",
             {{"50", number_or_null(statistics.p50)},
              {"90", number_or_null(statistics.p90)},
              {"99", number_or_null(statistics.p99)},
              {"99.9", number_or_null(statistics.p999)}}},
            {"above", counts}};
}

nlohmann::ordered_json color_json(const std::array<float, 3>& color) {
    nlohmann::ordered_json result = nlohmann::ordered_json::array();
    for (const float value : color)
        result.push_back(number_or_null(static_cast<double>(value)));
    return result;
}

} // namespace

std::size_t ErrorStatistics::above(double threshold) const {
    for (const Count& count : counts)
        if (count.threshold == threshold)
            return count.pixels;
    throw std::invalid_argument(fmt::format("errors above {} were not counted", threshold));
}

Metrics compare(const Image& reference_image, const Image& other_image, const CompareOptions& options) {
    check_sizes(reference_image, other_image);
    const Image reference = in_color(reference_image);
    const Image other = in_color(other_image);
    Metrics metrics;
    metrics.width = reference.width;
    metrics.height = reference.height;
    add_errors(metrics, reference, other, options);
    add_levels(metrics, reference, other);
    add_coverage(metrics, reference, other, options);
    add_delta_e(metrics, reference, other);
    metrics.ssim = reference.pixels == other.pixels ? 1 : ssim(reference, other);
    return metrics;
}

double suggest_amplification(const Metrics& metrics) {
    const double visible = metrics.all.p999 > 0 ? metrics.all.p999 : metrics.all.max_error;
    if (!(visible > 0) || !std::isfinite(visible))
        return 1;
    return std::pow(10, std::clamp(std::floor(-std::log10(visible)), 0.0, 6.0));
}

nlohmann::ordered_json to_json(const Metrics& metrics) {
    nlohmann::ordered_json channels = nlohmann::ordered_json::array();
    for (std::size_t channel = 0; channel < 3; ++channel)
        channels.push_back({{"max_error", number_or_null(metrics.channel_max[channel])},
                            {"worst", to_json(metrics.channel_worst[channel])}});
    nlohmann::ordered_json json{{"width", metrics.width}, {"height", metrics.height}};
    json["all"] = to_json(metrics.all);
    json["away_from_edges"] = to_json(metrics.away_from_edges);
    json["channels"] = channels;
    json["worst_reference"] = color_json(metrics.worst_reference);
    json["worst_other"] = color_json(metrics.worst_other);
    json["psnr_db"] = number_or_null(metrics.psnr);
    json["relative_rmse"] = number_or_null(metrics.relative_rmse);
    json["ssim"] = metrics.ssim;
    json["delta_e_2000"] = {{"mean", metrics.delta_e_mean},
                            {"max", metrics.delta_e_max},
                            {"worst", {{"x", metrics.delta_e_worst.x}, {"y", metrics.delta_e_worst.y}}}};
    json["coverage_mismatch"] = metrics.coverage_mismatch ? nlohmann::ordered_json(*metrics.coverage_mismatch)
                                                          : nlohmann::ordered_json(nullptr);
    json["non_finite"] = {{"reference", metrics.non_finite_reference}, {"other", metrics.non_finite_other}};
    return json;
}

} // namespace scc::validation
