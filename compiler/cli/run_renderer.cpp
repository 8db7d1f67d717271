#include "compiler/cli/run_renderer.h"

#include "compiler/cli/commands.h"
#include "compiler/cli/export.h"
#include "runtime/host/file.h"
#include "runtime/sampling.h"

namespace scc::cli {

validation::RenderResult run_renderer(const compiler::Exporter& exporter, const compiler::ir::Scene& scene,
                                      const runtime::RenderRequest& request,
                                      const std::filesystem::path& folder, double brightest,
                                      double timeout_seconds, compiler::Ledger& ledger) {
    const std::filesystem::path file = folder / ("scene" + std::string(exporter.extension));
    compiler::ExportFiles beside{.stem = file.stem().string()};
    compiler::ir::Scene sized = scene;
    sized.settings = request.settings; // meshes are refined for the picture's size
    host::replace_file(file.string(), exporter.emit(sized, ledger, beside));
    write_beside(folder, beside);
    validation::RenderJob job;
    job.scene = file;
    job.folder = folder;
    job.width = request.settings.width;
    job.height = request.settings.height;
    job.samples_per_axis = samples_per_axis(request.settings);
    job.threads = request.threads;
    job.timeout_seconds = timeout_seconds;
    job.brightest = brightest;
    validation::RenderResult run =
        exporter.name == "pov" ? validation::render_with_povray(job) : validation::render_with_blender(job);
    if (run.status == validation::RenderStatus::interrupted) {
        throw Interrupted{};
    }
    return run;
}

} // namespace scc::cli
