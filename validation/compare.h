#pragma once

#include "runtime/image.h"
#include "validation/image_tools.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

/// How far two pictures are apart, in linear light.
namespace scc::validation {

struct Place {
    int x = 0;
    int y = 0; ///< row, from the top
    int channel = 0;
};

/// The colour of an image where it shows no object.
struct Background {
    std::array<float, 3> color{};
    double tolerance = 1e-6; ///< of an image from a 16-bit file: 1e-5
};

struct CompareOptions {
    std::optional<Background> reference_background = std::nullopt; ///< coverage is compared if both are given
    std::optional<Background> other_background = std::nullopt;
    double edge_contrast = 0.005; ///< see `edge_mask`
    std::vector<double> thresholds{1e-6, 1e-5, 2e-5, 1e-4, 1e-3, 1e-2};
};

/// Over a set of pixels. An error is the absolute difference of a channel; a pixel's error that of its worst
/// channel. A difference that is not a number or not finite counts as an infinite error and is left out of
/// the averages.
struct ErrorStatistics {
    struct Count {
        double threshold = 0;
        std::size_t pixels = 0; ///< with an error above it
    };

    std::size_t pixels = 0;
    double max_error = 0;
    Place worst;     ///< the first such place in reading order
    double mean = 0; ///< over all channels
    double rmse = 0; ///< over all channels
    double p50 = 0;  ///< percentiles of the pixels' errors, nearest rank
    double p90 = 0;
    double p99 = 0;
    double p999 = 0;
    std::vector<Count> counts;

    /// Pixels above one of the thresholds that the comparison was asked for.
    std::size_t above(double threshold) const;
};

struct Metrics {
    int width = 0;
    int height = 0;
    ErrorStatistics all;
    ErrorStatistics away_from_edges; ///< the pixels outside `edge_mask`
    std::array<double, 3> channel_max{};
    std::array<Place, 3> channel_worst;
    std::array<float, 3> worst_reference{}; ///< the colours at all.worst
    std::array<float, 3> worst_other{};
    double psnr = 0; ///< dB, against a peak of 1 or the largest value in either image; infinite if identical
    double relative_rmse = 0; ///< rmse over the root of the reference's mean square
    double ssim = 0;          ///< see `ssim`
    double delta_e_mean = 0;  ///< see `delta_e_2000`
    double delta_e_max = 0;
    Place delta_e_worst;
    std::optional<std::size_t> coverage_mismatch; ///< pixels where exactly one image shows its background
    std::size_t non_finite_reference = 0;         ///< values that are NaN or infinite
    std::size_t non_finite_other = 0;
};

/// Grey images count as three equal channels. Throws CompareError.
Metrics compare(const runtime::Image& reference, const runtime::Image& other,
                const CompareOptions& options = {});

/// Numbers that are not finite are null.
nlohmann::ordered_json to_json(const Metrics& metrics);

/// A power of ten (1 .. 1e6) that makes the difference image's 99.9th percentile or, if that is nothing, its
/// maximum visible without pushing it beyond 1.
double suggest_amplification(const Metrics& metrics);

} // namespace scc::validation
