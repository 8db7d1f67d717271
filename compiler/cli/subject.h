#pragma once

#include "compiler/backends/precision.h"
#include "compiler/cli/commands.h"
#include "runtime/render_request.h"
#include "validation/render_cache.h"
#include "validation/report.h"
#include "validation/scene_budget.h"

#include <memory>
#include <string>
#include <vector>

/// What `scc validate` compares other pictures with: a scene and our own picture of it.
namespace scc::cli {

/// Whether other renderers are asked for the layers (position, normal, object), too.
enum class LayerUse { automatic, always, never };

struct ValidateOptions {
    SceneOptions scene;
    std::vector<std::string> files;
    std::string against = "pov,blender,native";
    std::string report;
    std::string junit;
    std::string cache;          ///< as RenderCache::from_option
    host::RenderOptions render; ///< size, samples, threads
    LayerUse layers = LayerUse::automatic;
    bool sweep = false;
    int jobs = 1;
    double timeout_seconds = 1800;
};

struct Subject {
    SceneOptions options; ///< of this file
    Loaded loaded;
    runtime::RenderRequest request;
    std::vector<validation::SceneBudget> budgets;
    double timeout_seconds = 0;
    LayerUse layers = LayerUse::automatic;
    validation::RenderCache cache;
    validation::SceneReport report;
    double brightest = 0; ///< of our picture
};

/// Loads. Where that fails, `report.failure` says why, and errors of the scene are printed.
std::unique_ptr<Subject> load_subject(const ValidateOptions& options, const std::string& file);
/// Loads and draws. Where that fails, `report.failure` says why, and errors of the scene are printed.
std::unique_ptr<Subject> prepare_subject(const ValidateOptions& options, const std::string& file);

/// Our picture, by the generic renderer. Throws RenderTimedOut.
runtime::Image draw_subject(const Subject& subject, const compiler::ir::Scene& scene,
                            compiler::Precision precision);

struct RenderTimedOut : std::runtime_error {
    using std::runtime_error::runtime_error;
};
/// The same request, which ends with RenderTimedOut's text from `timed_out` on.
runtime::RenderRequest with_deadline(const runtime::RenderRequest& request, double seconds);

} // namespace scc::cli
