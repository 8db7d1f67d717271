#include "validation/embed.h"
#include "validation/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace scc::validation {
namespace {

struct Range {
    double low = INFINITY, high = -INFINITY; ///< decimal logarithms, whole

    void take(double value) {
        if (value > 0 && std::isfinite(value)) {
            low = std::min(low, std::floor(std::log10(value)));
            high = std::max(high, std::ceil(std::log10(value)));
        }
    }
    double part(double value) const { return (std::log10(value) - low) / std::max(high - low, 1.0); }
};

using Select = std::function<double(const SweepPoint&)>;

/// Error over something, both by logarithms: one curve per series.
class Plot {
public:
    Plot(std::vector<SweepSeries> all, std::string title, Select x)
        : all_(std::move(all)), title_(std::move(title)), x_(std::move(x)) {
        for (const SweepSeries& series : all_)
            for (const SweepPoint& point : series.points)
                if (is_shown(point)) {
                    xs_.take(x_(point));
                    ys_.take(point.error);
                }
    }

    std::string svg() const {
        if (!(xs_.high >= xs_.low))
            return "";
        std::string body = grid();
        for (std::size_t i = 0; i < all_.size(); ++i)
            body += curve(all_[i], i);
        return fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n{}"
                           "<text class=\"axis\" x=\"{}\" y=\"{}\">{}</text>\n</svg>\n",
                           width, height, escape_html(title_), body, left, top - 10, escape_html(title_));
    }

private:
    static constexpr double width = 560, height = 340, left = 60, top = 30, right = 150, bottom = 40;
    static constexpr std::array<const char*, 8> colors{"#1f77b4", "#17a2a2", "#2ca02c", "#d62728",
                                                       "#ff7f0e", "#e377c2", "#9467bd", "#8c564b"};

    bool is_shown(const SweepPoint& point) const {
        return x_(point) > 0 && std::isfinite(x_(point)) && point.error > 0 && std::isfinite(point.error);
    }
    double px(double x) const { return left + xs_.part(x) * (width - left - right); }
    double py(double y) const { return height - bottom - ys_.part(y) * (height - top - bottom); }

    std::string grid() const {
        std::string lines;
        for (double e = xs_.low; e <= std::max(xs_.high, xs_.low + 1); ++e)
            lines += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
                                 "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\">1e{4:.0f}</text>\n",
                                 px(std::pow(10, e)), top, height - bottom, height - bottom + 16, e);
        for (double e = ys_.low; e <= std::max(ys_.high, ys_.low + 1); ++e)
            lines += fmt::format("<line class=\"grid\" y1=\"{0:.1f}\" y2=\"{0:.1f}\" x1=\"{1}\" x2=\"{2}\"/>"
                                 "<text class=\"tick\" x=\"{3}\" y=\"{0:.1f}\">1e{4:.0f}</text>\n",
                                 py(std::pow(10, e)), left, width - right, left - 24, e);
        return lines;
    }

    std::string curve(const SweepSeries& series, std::size_t index) const {
        const char* color = colors[index % colors.size()];
        std::string path;
        std::string dots;
        for (const SweepPoint& point : series.points) {
            if (!is_shown(point))
                continue;
            const double x = px(x_(point));
            const double y = py(point.error);
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x, y);
            dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"><title>{} {}: "
                                "RMSE {:.3g}</title></circle>",
                                x, y, color, escape_html(series.renderer), escape_html(point.setting),
                                point.error);
        }
        if (path.empty())
            return "";
        const double legend_y = top + 16 * static_cast<double>(index);
        return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>{}\n"
                           "<rect x=\"{}\" y=\"{}\" width=\"10\" height=\"10\" fill=\"{}\"/>"
                           "<text class=\"legend\" x=\"{}\" y=\"{}\">{}</text>\n",
                           path, color, dots, width - right + 10, legend_y, color, width - right + 25,
                           legend_y + 9, escape_html(series.renderer));
    }

    std::vector<SweepSeries> all_;
    std::string title_;
    Select x_;
    Range xs_, ys_;
};

std::string time_cell(const std::optional<double>& seconds) {
    return fmt::format("<td class=\"n\">{}</td>", seconds ? fmt::format("{:.3f}", *seconds) : "");
}

std::vector<SweepSeries> all_series(const SweepScene& scene) {
    std::vector<SweepSeries> all = scene.series;
    all.push_back(scene.tessellation);
    return all;
}

std::string points_table(const SweepScene& scene) {
    std::string rows =
        "<tr><th>renderer</th><th>setting</th><th>RMSE</th><th>largest error</th><th>start-up, s</th>"
        "<th>parse, s</th><th>build, s</th><th>draw, s</th><th>write, s</th><th>whole process, s</th></tr>\n";
    for (const SweepSeries& series : all_series(scene)) {
        for (const SweepPoint& point : series.points)
            rows +=
                fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{:.3g}</td><td class=\"n\">{:.3g}</td>"
                            "{}{}{}{}{}{}</tr>\n",
                            escape_html(series.renderer), escape_html(point.setting), point.error,
                            point.max_error, time_cell(point.times.start_up), time_cell(point.times.parse),
                            time_cell(point.times.bounding), time_cell(point.times.trace),
                            time_cell(point.times.saving), time_cell(point.times.total));
        if (!series.failure.empty())
            rows += fmt::format("<tr><td>{}</td><td class=\"failed\" colspan=\"9\">{}</td></tr>\n",
                                escape_html(series.renderer), escape_html(series.failure));
    }
    return "<div class=\"scroll\"><table class=\"sortable\">\n" + rows + "</table></div>\n";
}

std::string orders_table(const SweepScene& scene) {
    std::string rows = "<tr><th>renderer</th><th>knob</th><th>convergence order</th><th>points</th></tr>\n";
    for (const SweepSeries& series : all_series(scene))
        if (const std::optional<PowerLaw> fit = error_by_quality(series))
            rows += fmt::format(
                "<tr><td>{}</td><td>{}</td><td class=\"n\">{:.2f}</td><td class=\"n\">{}</td></tr>\n",
                escape_html(series.renderer), escape_html(series.knob), fit->order, fit->points);
    return "<div class=\"scroll\"><table class=\"sortable\">\n" + rows + "</table></div>\n";
}

std::string ratio_cell(const std::optional<SweepRatio>& ratio) {
    if (!ratio)
        return "<td class=\"n\">none in common</td>";
    return fmt::format("<td class=\"n\">{:.3g} ({:.3g} .. {:.3g}, {})</td>", ratio->median, ratio->least,
                       ratio->most, ratio->points);
}

std::string ratios_table(const SweepScene& scene) {
    std::string rows =
        "<tr><th>ours</th><th>other</th><th>equal error: process time</th><th>equal error: drawing "
        "time</th><th>equal process time: error</th><th>equal drawing time: error</th></tr>\n";
    for (const SweepSeries& ours : scene.series)
        for (const SweepSeries& other : scene.series)
            if (is_own(ours) && !is_own(other))
                rows += fmt::format("<tr><td>{}</td><td>{}</td>{}{}{}{}</tr>\n", escape_html(ours.renderer),
                                    escape_html(other.renderer),
                                    ratio_cell(equal_error_ratio(ours, other, &RenderTimes::total)),
                                    ratio_cell(equal_error_ratio(ours, other, &RenderTimes::trace)),
                                    ratio_cell(equal_time_ratio(ours, other, &RenderTimes::total)),
                                    ratio_cell(equal_time_ratio(ours, other, &RenderTimes::trace)));
    return "<p class=\"dim\">The other's over ours, so that above 1 ours is faster or better: the median "
           "(least .. "
           "most, and of how many points), interpolated between settings and never beyond them.</p>\n"
           "<div class=\"scroll\"><table class=\"sortable\">\n" +
           rows + "</table></div>\n";
}

} // namespace

std::string to_html(const SweepScene& scene) {
    std::string html = fmt::format("<p>Reference: {}. <span class=\"{}\">{}</span></p>\n",
                                   escape_html(scene.reference_made_by),
                                   scene.confirmed ? "passed" : "skipped", escape_html(scene.confirmation));
    html += "<div class=\"plots\">\n";
    html += Plot(scene.series, "RMSE over seconds of the whole process", [](const SweepPoint& p) {
                return p.times.total.value_or(0);
            }).svg();
    html += Plot(scene.series, "RMSE over seconds of drawing", [](const SweepPoint& p) {
                return p.times.trace.value_or(0);
            }).svg();
    html += Plot(scene.series, "RMSE over samples per pixel", [](const SweepPoint& p) {
                return p.quality;
            }).svg();
    html += Plot({scene.tessellation}, "RMSE of raster against rays, away from edges, over 1 / tessellation",
                 [](const SweepPoint& p) { return p.quality; })
                .svg();
    html += "</div>\n";
    return html + ratios_table(scene) + orders_table(scene) + "<details><summary>all settings</summary>\n" +
           points_table(scene) + "</details>\n";
}

} // namespace scc::validation
