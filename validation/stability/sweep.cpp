#include "validation/stability/sweep.h"

#include "runtime/host/file.h"
#include "validation/compare.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace scc::validation {

namespace {

using Json = nlohmann::ordered_json;

constexpr int schema_number = 1;
constexpr double most_digits = 16;

template <class Is>
std::vector<int> powers_where(const Sweep& sweep, Is is) {
    std::vector<int> powers;
    for (const Step& step : sweep.steps) {
        if (is(step)) {
            powers.push_back(step.power);
        }
    }
    return powers;
}

Json to_json(const std::optional<int>& power) {
    return power ? Json(*power) : Json(nullptr);
}

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json to_json(const Reading& reading) {
    if (!reading.drawn) {
        return {{"drawn", false}, {"reason", reading.reason}};
    }
    return {{"drawn", true},
            {"max_error", finite_or_null(reading.max_error)},
            {"digits", reading.digits()},
            {"wrong_pixels", reading.wrong},
            {"kept", reading.kept()}};
}

Json to_json(const Sweep& sweep) {
    Json json{{"name", sweep.name}, {"title", sweep.title}, {"reference", sweep.reference}};
    json["recorded_threshold"] = to_json(sweep.holds_to);
    json["bound"] = sweep.bound.empty() ? Json(nullptr) : Json(sweep.bound);
    json["is_worse_than_recorded"] = is_worse_than_recorded(sweep);
    json["thresholds"] = Json::object();
    for (std::size_t i = 0; i < sweep.engines.size(); ++i) {
        json["thresholds"][sweep.engines[i]] = to_json(threshold(sweep, i));
    }
    json["auto"] = {{"wrong_picks", wrong_picks(sweep)},
                    {"cautious_picks", cautious_picks(sweep)},
                    {"beyond_double", beyond_double(sweep)},
                    {"unwarned", unwarned(sweep)}};
    json["steps"] = Json::array();
    for (const Step& step : sweep.steps) {
        Json one{{"power", step.power}, {"chosen", step.chosen}, {"why", step.why}};
        for (std::size_t i = 0; i < step.readings.size(); ++i) {
            one["engines"][sweep.engines[i]] = to_json(step.readings[i]);
        }
        json["steps"].push_back(one);
    }
    return json;
}

/// "1e-3", or "never" if already the first step is off.
std::string power_text(const std::optional<int>& power) {
    return power ? fmt::format("1e{}", *power) : "never";
}

} // namespace

double Reading::digits() const {
    if (!drawn || !std::isfinite(max_error)) {
        return 0;
    }
    return max_error > 0 ? std::clamp(-std::log10(max_error), 0.0, most_digits) : most_digits;
}

Reading read(const runtime::Image& reference, const runtime::Image& other) {
    const Metrics metrics = compare(reference, other);
    return {.drawn = true,
            .reason = {},
            .max_error =
                (metrics.away_from_edges.pixels > 0 ? metrics.away_from_edges : metrics.all).max_error,
            .wrong =
                static_cast<double>(metrics.all.above(kept_error)) / static_cast<double>(metrics.all.pixels)};
}

std::optional<int> threshold(const Sweep& sweep, std::size_t engine) {
    std::optional<int> last;
    for (const Step& step : sweep.steps) {
        if (!step.readings[engine].kept()) {
            break;
        }
        last = step.power;
    }
    return last;
}

bool is_worse_than_recorded(const Sweep& sweep) {
    if (!sweep.holds_to) {
        return false;
    }
    return std::any_of(sweep.steps.begin(), sweep.steps.end(), [&](const Step& step) {
        const int first = sweep.steps.front().power;
        return std::abs(step.power - first) <= std::abs(*sweep.holds_to - first) &&
               !step.readings[in_auto].kept();
    });
}

std::vector<int> wrong_picks(const Sweep& sweep) {
    return powers_where(sweep, [](const Step& step) {
        return step.chosen == "float" && !step.readings[in_float].kept() && step.readings[in_double].kept();
    });
}

std::vector<int> cautious_picks(const Sweep& sweep) {
    return powers_where(
        sweep, [](const Step& step) { return step.chosen == "double" && step.readings[in_float].kept(); });
}

std::vector<int> beyond_double(const Sweep& sweep) {
    return powers_where(sweep, [](const Step& step) { return !step.readings[in_double].kept(); });
}

std::vector<int> unwarned(const Sweep& sweep) {
    return powers_where(sweep, [](const Step& step) {
        const Reading& full = step.readings[in_double];
        return full.drawn && !full.kept() && !step.warned;
    });
}

std::string to_text(const Sweep& sweep) {
    std::string text = fmt::format("{}: {}, 1e{} to 1e{}\n", sweep.name, sweep.title,
                                   sweep.steps.front().power, sweep.steps.back().power);
    for (std::size_t i = 0; i < sweep.engines.size(); ++i) {
        const Reading &first = sweep.steps.front().readings[i], &last = sweep.steps.back().readings[i];
        text +=
            fmt::format("  {:8} keeps 1e-4 to {:6} digits {:.1f} .. {:.1f}, wrong pixels {:.2g} .. {:.2g} %",
                        sweep.engines[i], power_text(threshold(sweep, i)), first.digits(), last.digits(),
                        100 * first.wrong, 100 * last.wrong);
        if (i == in_auto && sweep.holds_to) {
            text += fmt::format("; recorded 1e{}{}", *sweep.holds_to,
                                is_worse_than_recorded(sweep) ? ": WORSE" : "");
        }
        const std::string& reason = !first.drawn ? first.reason : last.reason;
        text += reason.empty() ? "\n" : " (" + reason + ")\n";
    }
    if (const std::vector<int> wrong = wrong_picks(sweep); !wrong.empty()) {
        text += fmt::format("  auto took float, which was not enough, at 1e{}\n", fmt::join(wrong, ", 1e"));
    }
    return text;
}

nlohmann::ordered_json to_json(const StabilityReport& report) {
    Json json{{"schema", schema_number}, {"title", "scc stability"}};
    json["versions"] = Json::object();
    for (const auto& [program, version] : report.versions) {
        json["versions"][program] = version;
    }
    json["size"] = {report.width, report.height};
    json["kept"] = {{"max_error", kept_error}, {"wrong_pixels", kept_wrong_pixels}};
    json["sweeps"] = Json::array();
    for (const Sweep& sweep : report.sweeps) {
        json["sweeps"].push_back(to_json(sweep));
    }
    return json;
}

void write_report(const StabilityReport& report, const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw host::FileError(fmt::format("cannot make the folder `{}`: {}", folder, error.message()));
    }
    // Renderers' texts may hold any bytes; what is not UTF-8 is replaced.
    const std::string text = to_json(report).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    host::replace_file(folder + "/report.json", text);
    host::replace_file(folder + "/index.html", to_html(report));
}

} // namespace scc::validation
