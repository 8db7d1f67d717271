#pragma once

#include "runtime/image.h"
#include "validation/budget.h"
#include "validation/cause.h"
#include "validation/compare.h"
#include "validation/renderers.h"
#include "validation/sweep.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scc::validation {

/// One feature of a scene in an export.
struct LedgerRow {
    std::string fidelity; ///< exact, approximated, dropped
    std::string feature;
    std::string subject;
    std::string place; ///< file:line:column
    std::string how;
    double bound = 0;
};

/// One other image of a scene. Without a judgement other than skipped it never counts as passed.
struct RendererReport {
    std::string renderer; ///< "pov"
    std::string version;
    std::string command;
    Judgement judgement{Verdict::skipped, "not run"};
    std::optional<Budget> budget;
    std::optional<Metrics> metrics;
    RenderTimes times;
    bool from_cache = false; ///< drawn and timed at some earlier time
    runtime::Image image;    ///< empty if there is none
    std::vector<LedgerRow> ledger;
    std::vector<std::string> warnings;
    std::vector<LayerDifference> layers; ///< empty: not compared
    std::optional<Cause> cause;          ///< of a failure
    std::string worst_pixel;             ///< how our renderer explains the worst pixel, as text
    std::string log;
};

struct SceneReport {
    std::string name;
    std::string description;
    runtime::Image reference;
    std::string reference_made_by; ///< "scc render --precision double"
    RenderTimes times;             ///< of the reference
    std::vector<RendererReport> renderers;
    std::string failure; ///< why it could not be drawn by ourselves; empty if it was
};

struct Report {
    std::string title = "scc validate";
    std::vector<std::pair<std::string, std::string>> versions; ///< program, version
    std::vector<SceneReport> scenes;
    std::vector<SweepScene> sweeps;
};

struct ReportSummary {
    std::size_t passed = 0;
    std::size_t failed = 0;
    std::size_t skipped = 0;
    std::size_t broken = 0; ///< scenes that we could not draw ourselves
};

ReportSummary summarize(const Report& report);

/// The images of scene i are listed as `images/<scene>-reference.exr`, `images/<scene>-<renderer>.exr`.
nlohmann::ordered_json to_json(const Report& report);

/// One page without outside resources: the images are embedded, at most 800 pixels wide.
std::string to_html(const Report& report);

/// Writes `report.json`, `index.html` and `images/*.exr` into the folder, which is made if need be; each file
/// is replaced as a whole. Throws host::FileError.
void write_report(const Report& report, const std::filesystem::path& folder);

} // namespace scc::validation
