#include "compiler/cli/comparison.h"

#include "compiler/backends/render.h"
#include "compiler/cli/diagnosis.h"
#include "compiler/cli/explain.h"
#include "compiler/cli/export.h"
#include "compiler/cli/native.h"
#include "compiler/ir/bands.h"
#include "runtime/bands.h"
#include "runtime/host/file.h"
#include "runtime/host/read_image.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <fmt/core.h>

#include <algorithm>

namespace scc::cli {

namespace {

namespace ir = compiler::ir;
using validation::RendererReport;
using validation::RenderStatus;
using validation::ScratchFolder;
using validation::Verdict;

void judge(RendererReport& result, const Subject& subject, double exposure,
           const compiler::Ledger& ledger = {}) {
    const runtime::RenderSettings& s = subject.request.settings;
    validation::Budget budget =
        *validation::budget_for(result.renderer, s.width, s.height, samples_per_axis(s), exposure);
    if (std::any_of(ledger.begin(), ledger.end(), [](const auto& entry) { return entry.is_refined_mesh; })) {
        budget = validation::with_refined_meshes(budget, s.width, s.height, samples_per_axis(s));
    }
    if (std::any_of(ledger.begin(), ledger.end(), [](const auto& entry) { return entry.is_differenced; })) {
        budget = validation::with_differenced_bumps(budget, s.width, s.height);
    }
    for (const validation::SceneBudget& stated : subject.budgets) {
        if (stated.renderer == result.renderer) {
            budget = validation::with_scene_budget(budget, stated, s.width, s.height);
        }
    }
    result.budget = budget;
    validation::CompareOptions options;
    options.thresholds = validation::thresholds_for(budget);
    result.metrics = validation::compare(subject.report.reference, result.image, options);
    result.judgement = validation::judge(budget, *result.metrics);
}

/// How we explain the pixel that differs most.
void explain_worst(RendererReport& result, const Subject& subject) {
    ExplainOptions options;
    options.scene = subject.options;
    options.precision = compiler::Precision::full;
    const runtime::RenderSettings& s = subject.request.settings;
    options.render.size = {s.width, s.height};
    options.render.samples = s.samples;
    const validation::Place& worst = result.metrics->all.worst;
    options.pixel = {worst.x, worst.y};
    result.worst_pixel = s.method == runtime::Method::ray ? explain_rays(subject.loaded, options)
                                                          : explain_raster(subject.loaded, options);
}

validation::ProcessResult run_to_end(const validation::Command& command) {
    validation::ProcessResult run = validation::run(command);
    if (run.end == validation::ProcessEnd::interrupted) {
        throw Interrupted{};
    }
    return run;
}

RendererReport run_native(const Subject& subject, int threads) {
    RendererReport result;
    result.renderer = "native";
    const ScratchFolder folder;
    const std::string program = (folder.path() / "native").string();
    try {
        ir::Scene scene = subject.loaded.scene;
        scene.settings = subject.request.settings;
        compile_native(emit_cpp(scene, compiler::Precision::full, compiler::Numbers::as_values), {}, program);
    } catch (const EnvironmentError& error) {
        result.judgement = {Verdict::skipped, error.what()};
        return result;
    }
    const runtime::RenderSettings& s = subject.request.settings;
    validation::Command command;
    command.program = program;
    command.directory = folder.path();
    command.timeout_seconds = subject.timeout_seconds;
    command.arguments = {"-o",        "native.exr",
                         "--size",    fmt::format("{}x{}", s.width, s.height),
                         "--samples", std::to_string(s.samples),
                         "--threads", std::to_string(threads)};
    const validation::ProcessResult run = run_to_end(command);
    result.command = "./native";
    for (const std::string& argument : command.arguments) {
        result.command += " " + argument;
    }
    result.times.total = run.wall_seconds;
    if (!run.ok()) {
        result.judgement = {Verdict::failed, validation::describe(run, command) + "\n" + run.err};
        return result;
    }
    result.image = host::read_image((folder.path() / "native.exr").string());
    judge(result, subject, 1);
    return result;
}

/// A renderer that knows no spectra draws three wavelengths at a time too.
validation::RenderResult run_in_bands(const Subject& subject, const ExportedRun& run,
                                      compiler::Ledger& ledger) {
    const ir::Scene& scene = subject.loaded.scene;
    validation::RenderResult last;
    double seconds = 0;
    bool all_from_cache = true;
    runtime::Image sum(subject.report.reference.width, subject.report.reference.height);
    const auto draw_band = [&](std::size_t band, const runtime::RenderRequest& request,
                               runtime::Image& image) {
        const ir::Scene one = ir::band_scene(scene, band);
        compiler::make_drawable(one, compiler::Precision::full).render(request, image);
        compiler::Ledger of_band;
        last = run_exported_scene(run, one, request.settings, validation::brightest_value(image), of_band);
        ledger = band == 0 ? of_band : ledger;
        seconds += last.times.total.value_or(0);
        all_from_cache = all_from_cache && last.from_cache;
        runtime::RenderResult result;
        result.complete = last.status == RenderStatus::done;
        image = result.complete ? last.image : image;
        return result;
    };
    render_bands(std::span<const runtime::BandGroup<double>>(scene.bands), subject.request, sum, draw_band);
    last.image = std::move(sum);
    last.exposure = 1;
    last.from_cache = all_from_cache;
    last.times = {.start_up = {}, .parse = {}, .bounding = {}, .trace = {}, .saving = {}, .total = seconds};
    ledger.push_back({compiler::Fidelity::exact,
                      "spectrum",
                      "scene",
                      {},
                      fmt::format("{} pictures of three wavelengths each, added up", scene.bands.size())});
    return last;
}

RendererReport run_exported(const Subject& subject, const std::string& name, int threads) {
    RendererReport result;
    result.renderer = name;
    const ScratchFolder folder;
    const ExportedRun how{.exporter = *compiler::find_exporter(name),
                          .folder = folder.path(),
                          .threads = threads,
                          .timeout_seconds = subject.timeout_seconds,
                          .cache = &subject.cache};
    compiler::Ledger ledger;
    const ir::Scene& scene = subject.loaded.scene;
    validation::RenderResult run =
        scene.bands.empty()
            ? run_exported_scene(how, scene, subject.request.settings, subject.brightest, ledger)
            : run_in_bands(subject, how, ledger);
    result.ledger = ledger_rows(ledger, subject.loaded.sources);
    result.version = run.version;
    result.command = run.command;
    result.times = run.times;
    result.from_cache = run.from_cache;
    result.warnings = std::move(run.warnings);
    result.log = std::move(run.log);
    if (run.status != RenderStatus::done) {
        result.judgement = {run.status == RenderStatus::missing ? Verdict::skipped : Verdict::failed,
                            run.reason};
        return result;
    }
    result.image = std::move(run.image);
    judge(result, subject, run.exposure, ledger);
    return result;
}

/// What scc-opengl is told of the scene beside its file.
std::vector<std::string> opengl_scene_arguments(const SceneOptions& scene) {
    std::vector<std::string> arguments;
    const auto repeat = [&](const char* option, const std::vector<std::string>& values) {
        for (const std::string& value : values) {
            arguments.insert(arguments.end(), {option, value});
        }
    };
    repeat("-D", scene.definitions);
    repeat("--asset-path", scene.asset_paths);
    if (!scene.camera.empty()) {
        repeat("--camera", {scene.camera});
    }
    return arguments;
}

RendererReport run_opengl(const Subject& subject) {
    RendererReport result;
    result.renderer = "opengl";
    if (subject.request.settings.method != runtime::Method::raster) {
        result.judgement = {Verdict::skipped,
                            "OpenGL casts no rays; `--mode raster` compares raster pictures"};
        return result;
    }
    const std::optional<std::string> program = validation::find_opengl_program();
    if (!program) {
        result.judgement = {Verdict::skipped,
                            "scc-opengl is not installed; on Debian, before building scc: apt "
                            "install libosmesa6-dev"};
        return result;
    }
    const runtime::RenderSettings& s = subject.request.settings;
    const ScratchFolder folder;
    const std::string picture = (folder.path() / "opengl.exr").string();
    const std::string& file = subject.options.file;
    validation::Command command;
    command.program = *program;
    command.timeout_seconds = subject.timeout_seconds;
    command.arguments = {file,
                         "-o",
                         picture,
                         "--size",
                         fmt::format("{}x{}", s.width, s.height),
                         "--samples",
                         std::to_string(s.samples)};
    const std::vector<std::string> more = opengl_scene_arguments(subject.options);
    command.arguments.insert(command.arguments.end(), more.begin(), more.end());
    const validation::ProcessResult run = run_to_end(command);
    result.command = "scc-opengl " + file;
    result.times.total = run.wall_seconds;
    if (!run.ok()) {
        const bool unsupported = run.end == validation::ProcessEnd::exited && run.code == host::exit_scene;
        result.judgement = {unsupported ? Verdict::skipped : Verdict::failed,
                            unsupported ? run.err : validation::describe(run, command) + "\n" + run.err};
        return result;
    }
    result.image = host::read_image(picture);
    judge(result, subject, 1);
    return result;
}

} // namespace

bool is_renderer(const std::string& name) {
    return name == "native" || name == "opengl" || compiler::find_exporter(name) != nullptr;
}

validation::RenderResult run_exported_scene(const ExportedRun& run, const ir::Scene& scene,
                                            const runtime::RenderSettings& settings, double brightest,
                                            compiler::Ledger& ledger) {
    const std::filesystem::path file = run.folder / ("scene" + std::string(run.exporter.extension));
    compiler::ExportFiles beside{.stem = file.stem().string()};
    ir::Scene sized = scene;
    sized.settings = settings; // meshes are refined for the picture's size
    host::replace_file(file.string(), run.exporter.emit(sized, ledger, beside));
    write_beside(run.folder, beside);
    validation::RenderJob job;
    for (const compiler::ExportFiles::File& one : beside.files) {
        job.beside.push_back(one.name);
    }
    job.cache = run.cache;
    job.antialiasing = run.antialiasing;
    job.scene = file;
    job.folder = run.folder;
    job.width = settings.width;
    job.height = settings.height;
    job.samples_per_axis = samples_per_axis(settings);
    job.threads = run.threads;
    job.timeout_seconds = run.timeout_seconds;
    job.brightest = brightest;
    validation::RenderResult result = run.exporter.name == "pov" ? validation::render_with_povray(job)
                                                                 : validation::render_with_blender(job);
    if (result.status == RenderStatus::interrupted) {
        throw Interrupted{};
    }
    return result;
}

RendererReport compare_with(const Subject& subject, const std::string& renderer, int threads) {
    RendererReport result = renderer == "native"   ? run_native(subject, threads)
                            : renderer == "opengl" ? run_opengl(subject)
                                                   : run_exported(subject, renderer, threads);
    if (result.metrics && result.judgement.verdict == Verdict::failed) {
        explain_worst(result, subject);
    }
    diagnose(result, subject, threads);
    return result;
}

} // namespace scc::cli
