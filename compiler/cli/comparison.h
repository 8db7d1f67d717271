#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/backends/table.h"
#include "compiler/cli/subject.h"
#include "validation/renderers.h"

#include <filesystem>
#include <string>

/// Other pictures of a subject, drawn and compared. Several may be under way at once. They throw Interrupted.
namespace scc::cli {

/// The names that --against knows: "pov", "blender", "opengl", "native".
bool is_renderer(const std::string& name);

validation::RendererReport compare_with(const Subject& subject, const std::string& renderer, int threads);

/// Where and how an exported scene is drawn.
struct ExportedRun {
    const compiler::Exporter& exporter;
    const std::filesystem::path& folder;
    int threads = 0;
    double timeout_seconds = 0;
    std::optional<validation::PovrayAntialiasing> antialiasing{}; ///< instead of the settings' samples
    const validation::RenderCache* cache = nullptr;               ///< null: it is drawn in any case
};

/// Exports the scene and has the other renderer draw it at these settings. `brightest`: of the picture.
validation::RenderResult run_exported_scene(const ExportedRun& run, const compiler::ir::Scene& scene,
                                            const runtime::RenderSettings& settings, double brightest,
                                            compiler::Ledger& ledger);

} // namespace scc::cli
