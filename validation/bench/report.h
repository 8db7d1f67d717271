#pragma once

#include "validation/bench/series.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What the comparisons have shown.
namespace scc::bench {

/// What is asked of a figure.
struct Target {
    double bar = 0; ///< 0: none
    double goal = 0;
    bool at_most = false; ///< the figure must not exceed them; else it must reach them
    const char* unit = "x";
};

/// One figure. `line` is the same for the figures that are judged together.
struct Row {
    std::string line;
    std::string detail; ///< which mesh, scene or peer
    int threads = 1;
    std::optional<Target> target; ///< none: for information
    Series reached;               ///< empty: skipped
    std::string skipped;          ///< why, in words
    nlohmann::json facts = nlohmann::json::object();
};

class Report {
public:
    void add(Row row);
    void describe(const std::string& what, const std::string& value);
    /// Writes bench.json and bench.md.
    void write(const std::filesystem::path& folder) const;

private:
    nlohmann::json json() const;
    std::string markdown() const;

    std::vector<std::pair<std::string, std::string>> setting_;
    std::vector<Row> rows_;
};

} // namespace scc::bench
