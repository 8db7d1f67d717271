#include "validation/junit.h"

#include "validation/embed.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace scc::validation {
namespace {

constexpr const char* replacement = "\xEF\xBF\xBD"; ///< U+FFFD

/// Text for attributes and content of XML 1.0, which has no control characters but tab and line ends.
std::string escape_xml(const std::string& text) {
    // The JSON library knows what UTF-8 is and replaces what is not.
    const nlohmann::json valid = nlohmann::json::parse(
        nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    std::string result;
    for (const char c : escape_html(valid.get<std::string>())) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '\n')
            result += "&#10;";
        else if (code < 0x20 && c != '\t')
            result += replacement;
        else
            result += c;
    }
    return result;
}

double seconds_of(const RenderTimes& times) {
    return times.total.value_or(times.trace.value_or(0));
}

std::string test_case(const SceneReport& scene, const RendererReport& renderer) {
    const std::string head =
        fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", escape_xml(scene.name),
                    escape_xml(renderer.renderer), seconds_of(renderer.times));
    const std::string reason = escape_xml(renderer.judgement.reason);
    switch (renderer.judgement.verdict) {
    case Verdict::passed:
        return head + "/>\n";
    case Verdict::failed:
        return fmt::format("{}>\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n", head, reason,
                           escape_xml(renderer.log));
    case Verdict::skipped:
        return fmt::format("{}>\n      <skipped message=\"{}\"/>\n    </testcase>\n", head, reason);
    }
    return "";
}

std::string test_suite(const SceneReport& scene) {
    std::string cases;
    std::size_t failures = 0;
    std::size_t skipped = 0;
    double seconds = seconds_of(scene.times);
    for (const RendererReport& renderer : scene.renderers) {
        cases += test_case(scene, renderer);
        failures += renderer.judgement.verdict == Verdict::failed;
        skipped += renderer.judgement.verdict == Verdict::skipped;
        seconds += seconds_of(renderer.times);
    }
    const bool broken = !scene.failure.empty();
    if (broken)
        cases += fmt::format("    <testcase classname=\"{}\" name=\"scc\">\n      <error message=\"{}\"/>\n"
                             "    </testcase>\n",
                             escape_xml(scene.name), escape_xml(scene.failure));
    return fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" "
                       "time=\"{:.3f}\">\n{}  </testsuite>\n",
                       escape_xml(scene.name), scene.renderers.size() + (broken ? 1U : 0U), failures,
                       broken ? 1 : 0, skipped, seconds, cases);
}

} // namespace

std::string to_junit(const Report& report) {
    const ReportSummary summary = summarize(report);
    std::string suites;
    for (const SceneReport& scene : report.scenes)
        suites += test_suite(scene);
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" tests=\"{}\" "
                       "failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n{}</testsuites>\n",
                       escape_xml(report.title),
                       summary.passed + summary.failed + summary.skipped + summary.broken, summary.failed,
                       summary.broken, summary.skipped, suites);
}

} // namespace scc::validation
