#pragma once

#include "runtime/image.h"
#include "validation/renderers.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

/// Error against run time: what renderers reach with more samples against one reference.
namespace scc::validation {

/// One picture of a sweep.
struct SweepPoint {
    std::string setting; ///< "4 x 4", "+AM2 +R3"
    double quality = 0;  ///< samples per pixel; 0: not to be told
    double error = 0;    ///< root mean square, linear light
    double max_error = 0;
    RenderTimes times{}; ///< the least of a few runs
};

struct SweepSeries {
    std::string renderer; ///< "scc double", "pov"
    std::string knob{};   ///< "samples per pixel", "depth"
    std::vector<SweepPoint> points{};
    std::string failure{}; ///< why it ends early, or is empty
};

struct SweepScene {
    std::string name;
    std::string reference_made_by;
    std::string confirmation; ///< by which other renderer, and how near it came; or why by none
    bool confirmed = false;
    std::vector<SweepSeries> series{};
    /// Raster pictures over the reciprocal of `tessellation`, against rays without shadows and mirrors
    /// through the same samples; `failure` says why there are none.
    SweepSeries tessellation{};
};

/// error = factor * x^order, a straight line through the logarithms by least squares.
struct PowerLaw {
    double factor = 0;
    double order = 0;
    std::size_t points = 0;
};
/// Of positive finite pairs; nothing with less than three, or where all x are the same.
std::optional<PowerLaw> fit_power_law(const std::vector<double>& x, const std::vector<double>& y);
std::optional<PowerLaw> error_by_quality(const SweepSeries& series);

/// Ours, by its name: "scc ...".
bool is_own(const SweepSeries& series);

/// Which time counts: that of the whole process, or of drawing alone.
using SweepTime = std::optional<double> RenderTimes::*;

/// The other's over ours, where both have it: interpolated between a series' points in logarithms, never
/// beyond them. Above 1: ours is faster, or better.
struct SweepRatio {
    double median = 0;
    double least = 0;
    double most = 0;
    std::size_t points = 0; ///< of the other series, each of which gives one ratio
};
/// Of the times to come to the same error. A series' points count only as far as each further one is better
/// and dearer than all before.
std::optional<SweepRatio> equal_error_ratio(const SweepSeries& ours, const SweepSeries& other,
                                            SweepTime time);
/// Of the errors after the same time.
std::optional<SweepRatio> equal_time_ratio(const SweepSeries& ours, const SweepSeries& other, SweepTime time);

nlohmann::ordered_json to_json(const SweepScene& scene);
/// Plots and tables, without a heading.
std::string to_html(const SweepScene& scene);

} // namespace scc::validation
