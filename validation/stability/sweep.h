#pragma once

#include "runtime/image.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

/// Pictures of a scene over decades of a parameter, and where they leave what is expected.
namespace scc::validation {

/// What a picture may be off where nothing has an edge, in linear light.
inline constexpr double kept_error = 1e-4;
/// The part of a picture's pixels that may be further off, all of them at edges: there what is seen may lie a
/// little beside, which auto's trial excuses for up to 5 %. Kept pictures have up to 0.95 %.
inline constexpr double kept_wrong_pixels = 0.01;

/// How one picture compares with what is expected.
struct Reading {
    bool drawn = false;
    std::string reason;   ///< why there is none
    double max_error = 0; ///< away from edges; of a picture of nothing but edges, anywhere
    double wrong = 0;     ///< part of all pixels that are off by more than `kept_error`

    bool kept() const { return drawn && max_error <= kept_error && wrong <= kept_wrong_pixels; }
    /// -log10 of the largest error away from edges, at most 16; 0 if there is no picture.
    double digits() const;
};
/// Throws CompareError.
Reading read(const runtime::Image& reference, const runtime::Image& other);

struct Step {
    int power = 0;                 ///< the parameter is 10^power
    std::vector<Reading> readings; ///< one per engine of the sweep
    std::string chosen;            ///< by `--precision auto`: float or double
    std::string why;
    bool warned = false; ///< the scene's author is told that double may not be enough
};

/// Engines that every sweep has, before others.
enum OwnEngine : std::size_t { in_float, in_double, in_auto };

struct Sweep {
    std::string name;
    std::string title;
    std::string reference; ///< in words
    std::vector<std::string> engines{"float", "double", "auto"};
    std::vector<Step> steps;     ///< from the harmless end
    std::optional<int> holds_to; ///< the recorded threshold of auto; users' scenes have none
    std::string bound;           ///< what bounds us there
};

/// The last power up to which every step is kept; nothing if already the first is not.
std::optional<int> threshold(const Sweep& sweep, std::size_t engine);
/// Auto keeps less than what is recorded.
bool is_worse_than_recorded(const Sweep& sweep);
/// The powers at which auto took float and that was not enough.
std::vector<int> wrong_picks(const Sweep& sweep);
/// Those at which it took double and float would have done.
std::vector<int> cautious_picks(const Sweep& sweep);
/// Those at which double failed, too.
std::vector<int> beyond_double(const Sweep& sweep);
/// Those of them that are drawn and that `beyond-double` does not warn of.
std::vector<int> unwarned(const Sweep& sweep);

struct StabilityReport {
    std::vector<std::pair<std::string, std::string>> versions; ///< program, version
    int width = 0, height = 0;
    std::vector<Sweep> sweeps;
};
/// A line per sweep and engine, for people.
std::string to_text(const Sweep& sweep);
nlohmann::ordered_json to_json(const StabilityReport& report);
/// A page of its own, with a plot per sweep.
std::string to_html(const StabilityReport& report);
/// report.json and index.html. Throws host::FileError.
void write_report(const StabilityReport& report, const std::string& folder);

} // namespace scc::validation
