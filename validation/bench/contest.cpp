#include "validation/bench/contest.h"

#include <fmt/format.h>

namespace scc::bench {

std::map<std::string, Runs> alternate(const std::vector<Contestant>& contestants, int repeat) {
    std::map<std::string, Runs> result;
    for (int i = 0; i <= repeat; ++i) {
        for (const auto& [name, draw] : contestants) {
            Runs& runs = result[name];
            if (!runs.failure.empty()) {
                continue;
            }
            Drawing drawing = draw();
            runs.failure = std::move(drawing.failure);
            runs.stats = std::move(drawing.stats);
            runs.version = std::move(drawing.version);
            if (i > 0) {
                runs.trace.add(drawing.trace);
                runs.parse.add(drawing.parse);
                runs.wall.add(drawing.wall);
            }
        }
    }
    return result;
}

Row compare(const std::map<std::string, Runs>& runs, const char* ours, const char* theirs,
            Series Runs::*series) {
    const Runs &a = runs.at(ours), &b = runs.at(theirs);
    Row row;
    row.skipped = a.failure.empty() ? b.failure : a.failure;
    if (!row.skipped.empty()) {
        return row;
    }
    const Series &our_times = a.*series, &their_times = b.*series;
    row.reached = ratio(their_times, our_times);
    row.detail =
        fmt::format("{:.4g} ms against {:.4g} ms", 1e3 * our_times.median(), 1e3 * their_times.median());
    row.facts = {{"ours_seconds", our_times.json()},
                 {"theirs_seconds", their_times.json()},
                 {"ratio_of_fastest", their_times.min() / our_times.min()},
                 {"precision", a.stats.value("precision", "")},
                 {"isa", a.stats.value("isa", "")},
                 {"rays", a.stats.value("rays", nlohmann::json::object())}};
    return row;
}

} // namespace scc::bench
