#include "validation/sweep.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace scc::validation {
namespace {

/// A curve through points whose x grow and whose y fall.
using Curve = std::vector<std::pair<double, double>>;

/// (time, error) of what is worth its time.
Curve frontier(const SweepSeries& series, SweepTime time) {
    Curve curve;
    for (const SweepPoint& point : series.points)
        if (const std::optional<double>& seconds = point.times.*time;
            seconds && *seconds > 0 && point.error > 0 && std::isfinite(point.error))
            curve.emplace_back(*seconds, point.error);
    std::sort(curve.begin(), curve.end());
    Curve result;
    for (const auto& point : curve)
        if (result.empty() || (point.second < result.back().second && point.first > result.back().first))
            result.push_back(point);
    return result;
}

double between(double x, double x0, double y0, double x1, double y1) {
    const double part = (std::log(x) - std::log(x0)) / (std::log(x1) - std::log(x0));
    return std::exp(std::log(y0) + part * (std::log(y1) - std::log(y0)));
}

std::optional<double> time_to(const Curve& curve, double error) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (curve[i].second == error)
            return curve[i].first;
        if (i > 0 && curve[i - 1].second > error && error > curve[i].second)
            return between(error, curve[i - 1].second, curve[i - 1].first, curve[i].second, curve[i].first);
    }
    return std::nullopt;
}

std::optional<double> error_after(const Curve& curve, double time) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (curve[i].first == time)
            return curve[i].second;
        if (i > 0 && curve[i - 1].first < time && time < curve[i].first)
            return between(time, curve[i - 1].first, curve[i - 1].second, curve[i].first, curve[i].second);
    }
    return std::nullopt;
}

std::optional<SweepRatio> summary(std::vector<double> ratios) {
    if (ratios.empty())
        return std::nullopt;
    std::sort(ratios.begin(), ratios.end());
    const std::size_t n = ratios.size();
    const double median = n % 2 == 1 ? ratios[n / 2] : std::sqrt(ratios[n / 2 - 1] * ratios[n / 2]);
    return SweepRatio{median, ratios.front(), ratios.back(), n};
}

nlohmann::ordered_json ratio_json(const std::optional<SweepRatio>& ratio) {
    if (!ratio)
        return nullptr;
    return {
        {"median", ratio->median}, {"least", ratio->least}, {"most", ratio->most}, {"points", ratio->points}};
}

nlohmann::ordered_json series_json(const SweepSeries& series) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const SweepPoint& point : series.points)
        points.push_back({{"setting", point.setting},
                          {"quality", point.quality},
                          {"rmse", point.error},
                          {"max_error", point.max_error},
                          {"times_s", to_json(point.times)}});
    nlohmann::ordered_json json{{"renderer", series.renderer}, {"knob", series.knob}, {"points", points}};
    const std::optional<PowerLaw> fit = error_by_quality(series);
    json["order"] = fit ? nlohmann::ordered_json(fit->order) : nlohmann::ordered_json(nullptr);
    if (!series.failure.empty())
        json["failure"] = series.failure;
    return json;
}

} // namespace

bool is_own(const SweepSeries& series) {
    return series.renderer.starts_with("scc ");
}

std::optional<PowerLaw> fit_power_law(const std::vector<double>& x, const std::vector<double>& y) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(x[i] > 0) || !(y[i] > 0) || !std::isfinite(x[i]) || !std::isfinite(y[i]))
            continue;
        const double lx = std::log(x[i]);
        const double ly = std::log(y[i]);
        n += 1;
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    const double spread = n * sxx - sx * sx;
    if (n < 3 || !(spread > 1e-9 * n * n))
        return std::nullopt;
    const double order = (n * sxy - sx * sy) / spread;
    return PowerLaw{std::exp((sy - order * sx) / n), order, static_cast<std::size_t>(n)};
}

std::optional<PowerLaw> error_by_quality(const SweepSeries& series) {
    std::vector<double> x, y;
    for (const SweepPoint& point : series.points) {
        x.push_back(point.quality);
        y.push_back(point.error);
    }
    return fit_power_law(x, y);
}

std::optional<SweepRatio> equal_error_ratio(const SweepSeries& ours, const SweepSeries& other,
                                            SweepTime time) {
    const Curve curve = frontier(ours, time);
    std::vector<double> ratios;
    for (const auto& [seconds, error] : frontier(other, time))
        if (const std::optional<double> own = time_to(curve, error))
            ratios.push_back(seconds / *own);
    return summary(std::move(ratios));
}

std::optional<SweepRatio> equal_time_ratio(const SweepSeries& ours, const SweepSeries& other,
                                           SweepTime time) {
    const Curve curve = frontier(ours, time);
    std::vector<double> ratios;
    for (const auto& [seconds, error] : frontier(other, time))
        if (const std::optional<double> own = error_after(curve, seconds))
            ratios.push_back(error / *own);
    return summary(std::move(ratios));
}

nlohmann::ordered_json to_json(const SweepScene& scene) {
    nlohmann::ordered_json series = nlohmann::ordered_json::array();
    nlohmann::ordered_json ratios = nlohmann::ordered_json::array();
    for (const SweepSeries& one : scene.series)
        series.push_back(series_json(one));
    for (const SweepSeries& ours : scene.series)
        for (const SweepSeries& other : scene.series)
            if (is_own(ours) && !is_own(other))
                ratios.push_back(
                    {{"ours", ours.renderer},
                     {"other", other.renderer},
                     {"equal_error_process", ratio_json(equal_error_ratio(ours, other, &RenderTimes::total))},
                     {"equal_error_drawing", ratio_json(equal_error_ratio(ours, other, &RenderTimes::trace))},
                     {"equal_time_process", ratio_json(equal_time_ratio(ours, other, &RenderTimes::total))},
                     {"equal_time_drawing", ratio_json(equal_time_ratio(ours, other, &RenderTimes::trace))}});
    return {{"name", scene.name},
            {"reference", scene.reference_made_by},
            {"confirmation", scene.confirmation},
            {"confirmed", scene.confirmed},
            {"series", series},
            {"ratios", ratios},
            {"tessellation", series_json(scene.tessellation)}};
}

} // namespace scc::validation
