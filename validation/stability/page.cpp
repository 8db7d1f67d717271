#include "validation/embed.h"
#include "validation/stability/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace scc::validation {

namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --ink: #1b1e23; --paper: #ffffff; --line: #d4d8de; --soft: #f3f5f7; --dim: #5b6470;
  --e0: #c77700; --e1: #1f6fd1; --e2: #11692f; --e3: #b3161b; --e4: #7b3fb5; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --paper: #15181c; --line: #3a4048; --soft: #1f2329;
  --dim: #9aa3af; --e0: #f0b050; --e1: #74b0ff; --e2: #6bd48c; --e3: #ff8a86; --e4: #c79bf2; } }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 2rem auto;
  max-width: 1200px; padding: 0 1.5rem; }
h2 { border-top: 1px solid var(--line); padding-top: 1rem; margin-top: 2rem; }
table { border-collapse: collapse; margin: .6rem 0 1.2rem; }
th, td { border: 1px solid var(--line); padding: .2rem .6rem; text-align: left; }
th { background: var(--soft); }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
.plots { display: flex; flex-wrap: wrap; gap: 1rem; }
svg { background: var(--soft); } svg text { fill: var(--dim); font-size: 12px; }
.dim { color: var(--dim); } .worse { color: var(--e3); font-weight: 600; }
)";

constexpr double width = 540, height = 260, left = 40, right = 12, top = 14, bottom = 34;
constexpr std::size_t colors = 5;
/// Tells apart lines that lie on each other.
constexpr std::array<const char*, colors> dashes{"", "", "7 5", "2 3", "9 3 2 3"};

std::string power_text(const std::optional<int>& power) {
    return power ? fmt::format("10<sup>{}</sup>", *power) : "never";
}

/// One measure of all engines over the powers of a sweep; the harmless end is on the left.
class Plot {
public:
    Plot(const Sweep& sweep, std::string caption, double highest, int ticks, double limit)
        : sweep_(sweep), highest_(highest) {
        svg_ = fmt::format("<svg width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"{}\">\n", width, height,
                           caption);
        for (int i = 0; i <= ticks; ++i) {
            const double value = highest * i / ticks;
            svg_ += line(left, y(value), width - right, y(value), "var(--line)", "");
            svg_ += text(left - 6, y(value) + 4, "end", fmt::format("{:g}", value));
        }
        const std::size_t every = sweep.steps.size() > 9 ? 2 : 1;
        for (std::size_t i = 0; i < sweep.steps.size(); i += every) {
            svg_ += text(x(i), height - 18, "middle", fmt::format("1e{}", sweep.steps[i].power));
        }
        svg_ += text((left + width) / 2, height - 3, "middle", caption);
        svg_ += line(left, y(limit), width - right, y(limit), "var(--ink)", "3 3");
    }

    template <class Measure>
    std::string html(const Measure& measure) {
        for (std::size_t engine = 0; engine < sweep_.engines.size(); ++engine) {
            std::string points;
            for (std::size_t i = 0; i < sweep_.steps.size(); ++i) {
                const Reading& reading = sweep_.steps[i].readings[engine];
                if (reading.drawn) {
                    points += fmt::format("{:.1f},{:.1f} ", x(i), y(std::min(measure(reading), highest_)));
                }
            }
            svg_ +=
                fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"var(--e{})\" "
                            "stroke-width=\"{}\" stroke-dasharray=\"{}\"/>\n",
                            points, engine % colors, engine == in_double ? 4 : 2, dashes[engine % colors]);
        }
        return svg_ + "</svg>\n";
    }

private:
    double x(std::size_t step) const {
        const double last = std::max<double>(1, static_cast<double>(sweep_.steps.size()) - 1);
        return left + (width - left - right - 10) * static_cast<double>(step) / last + 5;
    }
    double y(double value) const { return height - bottom - (height - bottom - top) * value / highest_; }

    static std::string line(double x0, double y0, double x1, double y1, const char* color, const char* dash) {
        return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
                           "stroke-dasharray=\"{}\"/>\n",
                           x0, y0, x1, y1, color, dash);
    }
    static std::string text(double at_x, double at_y, const char* anchor, const std::string& words) {
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", at_x, at_y,
                           anchor, escape_html(words));
    }

    const Sweep& sweep_;
    double highest_;
    std::string svg_;
};

std::string powers_text(const char* what, const std::vector<int>& powers) {
    std::string text;
    for (const int power : powers) {
        text += fmt::format("{}1e{}", text.empty() ? "" : ", ", power);
    }
    return text.empty() ? "" : fmt::format("<p>{}: {}.</p>\n", what, text);
}

std::string thresholds_table(const StabilityReport& report) {
    std::string html = "<table>\n<tr><th>sweep</th><th>what</th><th>from</th><th>to</th><th>engine</th>"
                       "<th>keeps 1e-4 to</th><th>recorded</th></tr>\n";
    for (const Sweep& sweep : report.sweeps) {
        for (std::size_t i = 0; i < sweep.engines.size(); ++i) {
            const bool is_first = i == 0;
            html +=
                fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
                            is_first ? fmt::format("<a href=\"#{0}\">{0}</a>", escape_html(sweep.name)) : "",
                            is_first ? escape_html(sweep.title) : "",
                            is_first ? power_text(sweep.steps.front().power) : "",
                            is_first ? power_text(sweep.steps.back().power) : "");
            const bool judged = i == in_auto && sweep.holds_to;
            html += fmt::format("<td>{}</td><td class=\"n\">{}</td><td class=\"{}\">{}</td></tr>\n",
                                sweep.engines[i], power_text(threshold(sweep, i)),
                                judged && is_worse_than_recorded(sweep) ? "worse" : "n",
                                judged ? power_text(sweep.holds_to) : "");
        }
    }
    return html + "</table>\n";
}

std::string sweep_html(const Sweep& sweep) {
    std::string html =
        fmt::format("<section>\n<h2 id=\"{0}\">{0}</h2>\n<p>{1}. Compared with {2}.{3}</p>\n",
                    escape_html(sweep.name), escape_html(sweep.title), escape_html(sweep.reference),
                    sweep.bound.empty() ? "" : " Bound: " + escape_html(sweep.bound) + ".");
    html += "<p>";
    for (std::size_t i = 0; i < sweep.engines.size(); ++i) {
        html +=
            fmt::format("<span style=\"color: var(--e{})\">&#9632; {}</span> ", i % colors, sweep.engines[i]);
    }
    html += "</p>\n<div class=\"plots\">\n";
    html +=
        Plot(sweep, "digits kept away from edges", 8, 4, 4).html([](const Reading& r) { return r.digits(); });
    html += Plot(sweep, "wrong pixels, %", 100, 4, 100 * kept_wrong_pixels).html([](const Reading& r) {
        return 100 * r.wrong;
    });
    html += "</div>\n";
    html += powers_text("Auto took float, which was not enough, at", wrong_picks(sweep));
    html += powers_text("Auto took double where float would have done, at", cautious_picks(sweep));
    html += powers_text("Double does not keep 1e-4 either at", beyond_double(sweep));
    html += powers_text("Of these, no warning tells at", unwarned(sweep));
    return html + "</section>\n";
}

} // namespace

std::string to_html(const StabilityReport& report) {
    std::string html =
        fmt::format("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>scc stability</title>\n"
                    "<style>{}</style>\n</head>\n<body>\n<h1>scc stability</h1>\n",
                    style);
    html += fmt::format("<p>Pictures of {} x {} pixels. A step is kept if no pixel away from edges is off by "
                        "more than {:g}, in linear light, and at most {:g} % of all are.</p>\n",
                        report.width, report.height, kept_error, 100 * kept_wrong_pixels);
    for (const auto& [program, version] : report.versions) {
        html += fmt::format("<p class=\"dim\">{} {}</p>\n", escape_html(program), escape_html(version));
    }
    html += thresholds_table(report);
    for (const Sweep& sweep : report.sweeps) {
        html += sweep_html(sweep);
    }
    return html + "</body>\n</html>\n";
}

} // namespace scc::validation
