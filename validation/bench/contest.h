#pragma once

#include "validation/bench/renderers.h"
#include "validation/bench/report.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

/// Renderers taking turns at one picture.
namespace scc::bench {

struct Contestant {
    std::string name;
    std::function<Drawing()> draw;
};

/// What a contestant's runs have shown; with a failure nothing.
struct Runs {
    Series trace, parse, wall;
    nlohmann::json stats; ///< of the last run
    std::string version;
    std::string failure;
};

/// In turns, after a first round that does not count. Who fails drops out.
std::map<std::string, Runs> alternate(const std::vector<Contestant>& contestants, int repeat);

/// Theirs over ours, by the times that `series` selects. The row lacks its line, threads and target.
Row compare(const std::map<std::string, Runs>& runs, const char* ours, const char* theirs,
            Series Runs::*series);

} // namespace scc::bench
