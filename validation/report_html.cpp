#include "validation/embed.h"
#include "validation/report.h"
#include "validation/report_script.h"

#include <fmt/core.h>

#include <cmath>

namespace scc::validation {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --ink: #1b1e23; --paper: #ffffff; --line: #d4d8de; --soft: #f3f5f7; --dim: #5b6470;
  --passed: #11692f; --failed: #b3161b; --skipped: #7a5300; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --paper: #15181c; --line: #3a4048; --soft: #1f2329;
  --dim: #9aa3af; --passed: #6bd48c; --failed: #ff8a86; --skipped: #e6bb5c; } }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 2rem auto;
  max-width: 1500px; padding: 0 1.5rem; }
h2 { border-top: 1px solid var(--line); padding-top: 1.2rem; margin-top: 2.5rem; }
table { border-collapse: collapse; margin: .6rem 0 1.2rem; }
th, td { border: 1px solid var(--line); padding: .2rem .6rem; text-align: left; vertical-align: top; }
th { background: var(--soft); font-weight: 600; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.scroll { overflow-x: auto; }
.figures { display: grid; grid-template-columns: repeat(3, 1fr); gap: .8rem; }
@media (max-width: 800px) { .figures { grid-template-columns: 1fr; } }
figure { margin: 0; } figcaption { color: var(--dim); font-size: .9em; }
figure img { width: 100%; image-rendering: pixelated; border: 1px solid var(--line); display: block; }
pre { background: var(--soft); padding: .6rem; overflow-x: auto; max-height: 24rem; }
.passed { color: var(--passed); } .failed { color: var(--failed); } .skipped { color: var(--skipped); }
.sortable tr:first-child th { cursor: pointer; } th[data-sorted=up]::after { content: " \\2191"; }
th[data-sorted=down]::after { content: " \\2193"; }
.viewer { margin: .6rem 0; } .bar { display: flex; gap: .6rem; align-items: center; flex-wrap: wrap; }
.bar output { font-variant-numeric: tabular-nums; font-size: .9em; } .frame { overflow: auto; max-height: 45rem; }
.frame canvas { image-rendering: pixelated; cursor: crosshair; } .heat b { display: inline-block; padding: 0 .8rem; }
.values { display: none; } [hidden] { display: none !important; }
.plots { display: flex; flex-wrap: wrap; gap: 1rem; } .plot { width: 560px; max-width: 100%; }
.plot text { font-size: 11px; fill: var(--ink); } .plot .tick { text-anchor: middle; fill: var(--dim); }
.plot .grid { stroke: var(--line); }
.verdict { font-weight: 600; } .dim { color: var(--dim); }
)";

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.3g}", value) : "&infin;";
}

std::string seconds(const std::optional<double>& time) {
    return time ? fmt::format("{:.3f}", *time) : "";
}

std::string cell(const std::string& html) {
    return "<td>" + html + "</td>";
}
std::string number_cell(const std::string& html) {
    return "<td class=\"n\">" + html + "</td>";
}
std::string head_cell(const std::string& html) {
    return "<th>" + html + "</th>";
}
std::string row(const std::string& cells) {
    return "<tr>" + cells + "</tr>\n";
}
std::string table(const std::string& rows) {
    return "<div class=\"scroll\"><table>\n" + rows + "</table></div>\n";
}

/// By clicks on the heads of its columns.
std::string sortable(const std::string& rows) {
    return "<div class=\"scroll\"><table class=\"sortable\">\n" + rows + "</table></div>\n";
}

std::string paragraph(const std::string& text) {
    return text.empty() ? "" : "<p>" + escape_html(text) + "</p>\n";
}

std::string folded(const std::string& title, const std::string& html, bool open = false) {
    return fmt::format("<details{}><summary>{}</summary>\n{}</details>\n", open ? " open" : "", title, html);
}

std::string verdict_html(const Judgement& judgement) {
    const char* name = name_of(judgement.verdict);
    return fmt::format("<span class=\"verdict {}\">{}</span>", name, name);
}

std::string scene_anchor(std::size_t index) {
    return fmt::format("scene-{}", index + 1);
}

std::string overview(const Report& report) {
    std::string rows =
        row("<th>scene</th><th>renderer</th><th>verdict</th><th>largest error</th><th>RMSE</th>"
            "<th>total, s</th><th>reason</th>");
    for (std::size_t i = 0; i < report.scenes.size(); ++i)
        for (const RendererReport& renderer : report.scenes[i].renderers)
            rows += row(cell(fmt::format("<a href=\"#{}\">{}</a>", scene_anchor(i),
                                         escape_html(report.scenes[i].name))) +
                        cell(escape_html(renderer.renderer)) + cell(verdict_html(renderer.judgement)) +
                        number_cell(renderer.metrics ? number(renderer.metrics->all.max_error) : "") +
                        number_cell(renderer.metrics ? number(renderer.metrics->all.rmse) : "") +
                        number_cell(seconds(renderer.times.total)) +
                        cell(escape_html(renderer.judgement.reason)));
    return sortable(rows);
}

std::string versions_html(const Report& report) {
    std::string rows;
    for (const auto& [program, version] : report.versions)
        rows += row(head_cell(escape_html(program)) + cell(escape_html(version)));
    return rows.empty() ? "" : table(rows);
}

std::string figure(const runtime::Image& image, Shrink how, const std::string& caption) {
    return fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n",
                       escape_html(caption), data_uri(image, how));
}

std::string figures(const SceneReport& scene, const RendererReport& renderer) {
    const bool has_reference = !scene.reference.pixels.empty();
    const bool has_image = !renderer.image.pixels.empty();
    if (!has_image)
        return "";
    std::string html;
    if (has_reference)
        html += figure(scene.reference, Shrink::average, "reference: " + scene.reference_made_by);
    html += figure(renderer.image, Shrink::average, renderer.renderer + ": " + renderer.version);
    if (has_reference && renderer.metrics) {
        const double amplification = suggest_amplification(*renderer.metrics);
        html += figure(difference_image(in_color(scene.reference), in_color(renderer.image), amplification),
                       Shrink::maximum, fmt::format("difference, amplified {} times", amplification));
    }
    return "<div class=\"figures\">\n" + html + "</div>\n";
}

/// Pictures in a viewer are at most so wide; what is larger is shrunk by a whole factor.
constexpr int max_viewer_width = 320;

std::string values_id(std::size_t scene) {
    return fmt::format("values-{}", scene + 1);
}

/// The reference's numbers, once per scene.
std::string reference_values(const SceneReport& scene, std::size_t index) {
    if (scene.reference.pixels.empty())
        return "";
    return fmt::format("<div class=\"values\" id=\"{}\">{}</div>\n", values_id(index),
                       half_floats(shrunk(in_color(scene.reference), max_viewer_width, Shrink::average), 1));
}

/// Signed, the largest of each block that becomes a pixel.
runtime::Image signed_difference(const runtime::Image& reference, const runtime::Image& other, int block) {
    runtime::Image result((reference.width + block - 1) / block, (reference.height + block - 1) / block);
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float difference = other.at(x, y)[c] - reference.at(x, y)[c];
                float& kept = result.at(x / block, y / block)[c];
                kept = std::abs(difference) > std::abs(kept) || std::isnan(difference) ? difference : kept;
            }
    return result;
}

std::string viewer(const SceneReport& scene, std::size_t index, const RendererReport& renderer) {
    if (!renderer.metrics || renderer.image.pixels.empty() || scene.reference.pixels.empty())
        return "";
    const int block = (scene.reference.width + max_viewer_width - 1) / max_viewer_width;
    const runtime::Image difference =
        signed_difference(in_color(scene.reference), in_color(renderer.image), block);
    return fmt::format("<div class=\"viewer\" data-width=\"{}\" data-height=\"{}\" data-block=\"{}\" "
                       "data-reference=\"{}\" data-difference=\"{}\"></div>\n",
                       difference.width, difference.height, block, values_id(index),
                       half_floats(difference, viewer_difference_scale));
}

std::string place(const Place& where) {
    return fmt::format("({}, {})", where.x, where.y);
}

std::string color(const std::array<float, 3>& value) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", value[0], value[1], value[2]);
}

/// One row per measure, one column per renderer that has them.
class ErrorTable {
public:
    explicit ErrorTable(const SceneReport& scene) {
        for (const RendererReport& renderer : scene.renderers)
            if (renderer.metrics)
                renderers_.push_back(&renderer);
    }

    std::string html() {
        if (renderers_.empty())
            return "";
        std::string heads = head_cell("error, linear light");
        for (const RendererReport* renderer : renderers_)
            heads += head_cell(escape_html(renderer->renderer));
        rows_ = row(heads);
        add_statistics("", [](const Metrics& m) -> const ErrorStatistics& { return m.all; });
        add("red, green, blue", [](const Metrics& m) {
            return fmt::format("{} {} {}", number(m.channel_max[0]), number(m.channel_max[1]),
                               number(m.channel_max[2]));
        });
        add("worst: reference", [](const Metrics& m) { return color(m.worst_reference); });
        add("worst: other", [](const Metrics& m) { return color(m.worst_other); });
        add("relative RMSE", [](const Metrics& m) { return number(m.relative_rmse); });
        add("PSNR, dB", [](const Metrics& m) {
            return std::isfinite(m.psnr) ? fmt::format("{:.1f}", m.psnr) : "&infin;";
        });
        add("SSIM", [](const Metrics& m) { return fmt::format("{:.7f}", m.ssim); });
        add("CIEDE2000 mean, largest",
            [](const Metrics& m) { return number(m.delta_e_mean) + ", " + number(m.delta_e_max); });
        add("coverage mismatch",
            [](const Metrics& m) { return m.coverage_mismatch ? std::to_string(*m.coverage_mismatch) : ""; });
        add("not finite: reference, other", [](const Metrics& m) {
            return fmt::format("{}, {}", m.non_finite_reference, m.non_finite_other);
        });
        add_statistics("away from edges: ", [](const Metrics& m) -> const ErrorStatistics& {
            return m.away_from_edges;
        });
        return table(rows_);
    }

private:
    template <class Text>
    void add(const std::string& name, const Text& text) {
        std::string cells = head_cell(name);
        for (const RendererReport* renderer : renderers_)
            cells += number_cell(text(*renderer->metrics));
        rows_ += row(cells);
    }

    template <class Select>
    void add_statistics(const std::string& prefix, const Select& select) {
        add(prefix + "pixels", [&](const Metrics& m) { return std::to_string(select(m).pixels); });
        add(prefix + "largest, at",
            [&](const Metrics& m) { return number(select(m).max_error) + " " + place(select(m).worst); });
        add(prefix + "mean, RMSE",
            [&](const Metrics& m) { return number(select(m).mean) + ", " + number(select(m).rmse); });
        add(prefix + "50, 90, 99, 99.9 %", [&](const Metrics& m) {
            const ErrorStatistics& s = select(m);
            return fmt::format("{}, {}, {}, {}", number(s.p50), number(s.p90), number(s.p99), number(s.p999));
        });
        add(prefix + "pixels above", [&](const Metrics& m) {
            std::string text;
            for (const ErrorStatistics::Count& count : select(m).counts)
                text +=
                    fmt::format("{}{:.3g}: {}", text.empty() ? "" : "<br>", count.threshold, count.pixels);
            return text;
        });
    }

    std::vector<const RendererReport*> renderers_;
    std::string rows_;
};

std::string times_row(const std::string& name, const RenderTimes& times) {
    return row(head_cell(escape_html(name)) + number_cell(seconds(times.start_up)) +
               number_cell(seconds(times.parse)) + number_cell(seconds(times.bounding)) +
               number_cell(seconds(times.trace)) + number_cell(seconds(times.saving)) +
               number_cell(seconds(times.total)));
}

std::string times_table(const SceneReport& scene) {
    std::string rows = row("<th>time, s</th><th>start-up</th><th>parse</th><th>bounding</th><th>trace</th>"
                           "<th>saving</th><th>total</th>");
    rows += times_row("reference", scene.times);
    for (const RendererReport& renderer : scene.renderers)
        rows += times_row(renderer.renderer + (renderer.from_cache ? " (kept from an earlier run)" : ""),
                          renderer.times);
    return table(rows);
}

std::string ledger_html(const RendererReport& renderer) {
    if (renderer.ledger.empty())
        return "";
    std::string rows =
        row("<th>fidelity</th><th>feature</th><th>subject</th><th>place</th><th>how</th><th>bound</th>");
    std::size_t inexact = 0;
    for (const LedgerRow& entry : renderer.ledger) {
        inexact += entry.fidelity != "exact";
        rows += row(cell(escape_html(entry.fidelity)) + cell(escape_html(entry.feature)) +
                    cell(escape_html(entry.subject)) + cell(escape_html(entry.place)) +
                    cell(escape_html(entry.how)) + number_cell(entry.bound != 0 ? number(entry.bound) : ""));
    }
    const std::string title =
        fmt::format("ledger: {} features, {} of them not exact", renderer.ledger.size(), inexact);
    return folded(title, table(rows), inexact > 0);
}

std::string budget_text(const Budget& budget) {
    std::string text = "Budget:";
    const char* separator = " ";
    const auto add = [&](const std::string& limit) {
        text += separator + limit;
        separator = "; ";
    };
    if (std::isfinite(budget.max_error))
        add(fmt::format("{} pixels above {:.3g}", budget.outliers, budget.max_error));
    if (budget.max_away_from_edges)
        add(fmt::format("away from edges at most {:.3g}", *budget.max_away_from_edges));
    if (budget.above_1e3)
        add(fmt::format("{} pixels above 0.001", *budget.above_1e3));
    return text + ". " + budget.reason;
}

std::string layers_html(const RendererReport& renderer) {
    if (renderer.layers.empty())
        return "";
    std::string rows = row("<th>what rays meet</th><th>pixels that differ</th><th>of</th><th>largest</th>"
                           "<th>at</th><th>tolerance</th><th>unit</th>");
    for (const LayerDifference& layer : renderer.layers)
        rows += row(cell(fmt::format("<span class=\"{}\">{}</span>", differs(layer) ? "failed" : "passed",
                                     escape_html(layer.layer))) +
                    number_cell(std::to_string(layer.pixels)) + number_cell(std::to_string(layer.compared)) +
                    number_cell(number(layer.largest)) +
                    number_cell(layer.pixels > 0 ? fmt::format("({}, {})", layer.x, layer.y) : "") +
                    number_cell(number(layer.tolerance)) + cell(escape_html(layer.unit)));
    return table(rows);
}

std::string cause_html(const RendererReport& renderer) {
    if (!renderer.cause)
        return "";
    std::string rows = row("<th>test</th><th>finding</th><th>part of the squared difference explained</th>");
    for (const Evidence& evidence : renderer.cause->evidence)
        rows += row(cell(escape_html(evidence.test)) + cell(escape_html(evidence.finding)) +
                    number_cell(fmt::format("{:.4f}", evidence.explained)));
    return fmt::format("<p>Cause class: <strong>{}</strong>. {}</p>\n", name_of(renderer.cause->cause),
                       escape_html(renderer.cause->summary)) +
           folded("evidence", table(rows), true);
}

std::string renderer_html(const SceneReport& scene, std::size_t index, const RendererReport& renderer) {
    std::string html =
        fmt::format("<h3>{} {}</h3>\n", escape_html(renderer.renderer), verdict_html(renderer.judgement));
    html += paragraph(renderer.judgement.reason);
    if (renderer.budget)
        html += "<p class=\"dim\">" + escape_html(budget_text(*renderer.budget)) + "</p>\n";
    html += cause_html(renderer) + layers_html(renderer);
    html += figures(scene, renderer) + viewer(scene, index, renderer);
    if (!renderer.worst_pixel.empty())
        html += folded("the worst pixel", "<pre>" + escape_html(renderer.worst_pixel) + "</pre>\n",
                       renderer.judgement.verdict == Verdict::failed);
    html += ledger_html(renderer);
    for (const std::string& warning : renderer.warnings)
        html += "<p class=\"skipped\">" + escape_html(warning) + "</p>\n";
    if (!renderer.command.empty())
        html += "<p><code>" + escape_html(renderer.command) + "</code></p>\n";
    if (!renderer.log.empty())
        html += folded("log", "<pre>" + escape_html(renderer.log) + "</pre>\n");
    return html;
}

std::string scene_html(const SceneReport& scene, std::size_t index) {
    std::string html =
        fmt::format("<section>\n<h2 id=\"{}\">{}</h2>\n", scene_anchor(index), escape_html(scene.name));
    html += paragraph(scene.description);
    if (!scene.failure.empty())
        html += "<p class=\"failed\">" + escape_html(scene.failure) + "</p>\n";
    html += reference_values(scene, index) + ErrorTable(scene).html() + times_table(scene);
    for (const RendererReport& renderer : scene.renderers)
        html += renderer_html(scene, index, renderer);
    return html + "</section>\n";
}

} // namespace

std::string to_html(const Report& report) {
    const ReportSummary summary = summarize(report);
    std::string html =
        fmt::format("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n"
                    "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
                    escape_html(report.title), style);
    const bool compares = !report.scenes.empty() || report.sweeps.empty();
    if (compares)
        html += fmt::format(
            "<p>{} passed, {} failed, {} skipped. A skipped comparison was not made and does not count as "
            "passed.</p>\n",
            summary.passed, summary.failed, summary.skipped);
    html += (compares ? overview(report) : "") + versions_html(report);
    html += "<p class=\"dim\">Errors are absolute differences in linear light. Images are shown in sRGB, "
            "clamped to "
            "0..1 and at most 800 pixels wide; where a difference image is smaller than the image, each of "
            "its pixels "
            "is the largest of its block. SSIM is of the encoded luminance. In a viewer "
            "the reference's numbers and, by themselves, the differences have 11 bits.</p>\n";
    for (std::size_t i = 0; i < report.scenes.size(); ++i)
        html += scene_html(report.scenes[i], i);
    for (const SweepScene& sweep : report.sweeps)
        html += "<section>\n<h2>Error against run time: " + escape_html(sweep.name) + "</h2>\n" +
                to_html(sweep) + "</section>\n";
    html += std::string("<script>\n") + report_script + "</script>\n";
    return html + "</body>\n</html>\n";
}

} // namespace scc::validation
