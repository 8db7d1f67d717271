#include "validation/budget.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace scc::validation {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double base_size = 640.0 * 480.0;
constexpr double above_1e3_threshold = 1e-3;

/// Pixel counts are per 640 x 480 pixels, or rays; negative: no such limit.
struct Row {
    const char* renderer;
    double max_error;
    int outliers;
    double max_away_from_edges;
    int above_1e3;
    bool follows_exposure; ///< the file has steps, which an exposure makes coarser
    bool counts_rays;      ///< n x n samples allow n * n times as many pixels
    const char* reason;
};

constexpr std::array rows{
    Row{"native", 0, 0, -1, -1, false, false,
        "the specialised program and the generic renderer do the same arithmetic: every value is identical"},
    Row{"pov", 2e-5, 5, -1, -1, true, false,
        "16-bit file: rounding of 0.5/65535 = 7.7e-6, doubled by what it adds to; edges agree too, since the "
        "sample "
        "positions are the same; outliers: chains of mirrors that end on an edge (0 to 4 per image)"},
    Row{"blender", infinity, 0, 1e-4, 20, false, true,
        "single precision: 2e-5 to 4e-5 measured away from edges; curved surfaces are meshes, so that a few "
        "rays on "
        "silhouettes, shadow edges and patterns fall on the other side (2 to 6 of 640 x 480)"},
    Row{"opengl", 5e-6, 20, 5e-6, 0, false, false,
        "single precision colours of the same formulas: 1e-6 measured; coverage agrees, since both snap "
        "corners to "
        "1/256 of a pixel; outliers: triangles seen almost edge-on, across which colours change so fast that "
        "Mesa's 32 bits show (6 pixels of a ball at 320 x 240, 1.1e-5)"},
};

std::size_t scaled(int count, double size) {
    return static_cast<std::size_t>(std::ceil(count * std::max(size / base_size, 1.0)));
}

std::string at(const Place& place) {
    return fmt::format("at pixel ({}, {})", place.x, place.y);
}

} // namespace

std::optional<Budget> budget_for(const std::string& renderer, int width, int height, int samples_per_axis,
                                 double exposure) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.renderer == renderer; });
    if (row == rows.end())
        return std::nullopt;
    const double pixels = static_cast<double>(width) * height;
    const double size = row->counts_rays ? pixels * samples_per_axis * samples_per_axis : pixels;
    Budget budget;
    budget.renderer = row->renderer;
    budget.max_error = row->follows_exposure ? row->max_error / exposure : row->max_error;
    budget.outliers = scaled(row->outliers, size);
    if (row->max_away_from_edges >= 0)
        budget.max_away_from_edges = row->max_away_from_edges;
    if (row->above_1e3 >= 0)
        budget.above_1e3 = scaled(row->above_1e3, size);
    budget.reason = row->reason;
    return budget;
}

std::size_t pixels_of_base(int count, int width, int height) {
    return scaled(count, static_cast<double>(width) * height);
}

Budget with_refined_meshes(Budget budget, int width, int height, int samples_per_axis) {
    // Of 640 x 480 pixels; measured are 84 to 216.
    constexpr double more_above_1e3 = 400, more_outliers = 600;
    constexpr double error_elsewhere = 1e-4;
    const double share =
        static_cast<double>(width) * height * samples_per_axis * samples_per_axis / base_size;
    const auto added = [&](std::size_t base, double more) {
        return base + static_cast<std::size_t>(std::ceil(more * share));
    };
    budget.above_1e3 = added(budget.above_1e3.value_or(0), more_above_1e3);
    budget.outliers = added(*budget.above_1e3, more_outliers - more_above_1e3);
    budget.max_error = budget.max_away_from_edges.value_or(error_elsewhere);
    budget.max_away_from_edges.reset(); // edges of shadows and of what mirrors show are found anywhere
    budget.reason +=
        "; implicit surfaces and solids are meshes a fraction of a pixel wide of the surface, so that "
        "rays along their outlines and shadows fall on the other side (84 to 216 of 640 x 480), while "
        "what is hit is calculated as exactly as elsewhere";
    return budget;
}

Budget with_differenced_bumps(Budget budget, int width, int height) {
    // Measured are 1.2 % and 9 of 320 x 240 pixels.
    constexpr double share_of_pixels = 0.02;
    constexpr int above_1e3 = 40;
    constexpr double error_elsewhere = 5e-4;
    const double pixels = static_cast<double>(width) * height;
    budget.outliers += static_cast<std::size_t>(std::ceil(share_of_pixels * pixels));
    budget.above_1e3 = scaled(above_1e3, pixels);
    budget.max_away_from_edges = error_elsewhere;
    budget.reason +=
        "; bumps: their slopes are differences over a short way, which are coarse where a height bends "
        "within it, as images and noise do (1.2 % of the pixels differ by more than 4e-5, 9 of 320 x 240 "
        "by more than 1e-3)";
    return budget;
}

nlohmann::ordered_json to_json(const Budget& budget) {
    nlohmann::ordered_json json{{"renderer", budget.renderer}};
    if (std::isfinite(budget.max_error)) {
        json["max_error"] = budget.max_error;
        json["outliers"] = budget.outliers;
    }
    if (budget.max_away_from_edges)
        json["max_away_from_edges"] = *budget.max_away_from_edges;
    if (budget.above_1e3)
        json["above_1e-3"] = *budget.above_1e3;
    json["reason"] = budget.reason;
    return json;
}

std::vector<double> thresholds_for(const Budget& budget) {
    std::vector<double> thresholds = CompareOptions{}.thresholds;
    if (std::isfinite(budget.max_error) &&
        std::find(thresholds.begin(), thresholds.end(), budget.max_error) == thresholds.end())
        thresholds.push_back(budget.max_error);
    std::sort(thresholds.begin(), thresholds.end());
    return thresholds;
}

Judgement judge(const Budget& budget, const Metrics& metrics) {
    std::vector<std::string> broken;
    if (metrics.non_finite_reference + metrics.non_finite_other > 0)
        broken.push_back(fmt::format("{} values of the reference and {} of the other image are not finite",
                                     metrics.non_finite_reference, metrics.non_finite_other));
    if (std::isfinite(budget.max_error)) {
        const std::size_t count = metrics.all.above(budget.max_error);
        if (count > budget.outliers)
            broken.push_back(fmt::format(
                "{} pixels differ by more than {:.3g}, {} may; the largest error is {:.3g} {}", count,
                budget.max_error, budget.outliers, metrics.all.max_error, at(metrics.all.worst)));
    }
    const ErrorStatistics& inner = metrics.away_from_edges;
    if (budget.max_away_from_edges && inner.pixels == 0)
        broken.push_back("every pixel counts as an edge, none is left to compare away from edges");
    if (budget.max_away_from_edges && !(inner.max_error <= *budget.max_away_from_edges))
        broken.push_back(fmt::format("away from edges the largest error is {:.3g} {}, {:.3g} may be",
                                     inner.max_error, at(inner.worst), *budget.max_away_from_edges));
    if (budget.above_1e3) {
        const std::size_t count = metrics.all.above(above_1e3_threshold);
        if (count > *budget.above_1e3)
            broken.push_back(
                fmt::format("{} pixels differ by more than 0.001, {} may; the largest error is {:.3g} {}",
                            count, *budget.above_1e3, metrics.all.max_error, at(metrics.all.worst)));
    }
    Judgement judgement{broken.empty() ? Verdict::passed : Verdict::failed, {}};
    for (const std::string& text : broken)
        judgement.reason += (judgement.reason.empty() ? "" : "; ") + text;
    return judgement;
}

const char* name_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::passed:
        return "passed";
    case Verdict::failed:
        return "failed";
    case Verdict::skipped:
        return "skipped";
    }
    return "";
}

} // namespace scc::validation
