#include "compiler/backends/render.h"
#include "compiler/backends/table.h"
#include "compiler/cli/commands.h"
#include "compiler/cli/export.h"
#include "compiler/cli/native.h"
#include "compiler/cli/run_renderer.h"
#include "compiler/ir/bands.h"
#include "runtime/bands.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"
#include "runtime/host/read_image.h"
#include "validation/renderers.h"
#include "validation/report.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <sstream>

namespace scc::cli {

namespace {

namespace ir = compiler::ir;
using validation::RendererReport;
using validation::RenderStatus;
using validation::SceneReport;
using validation::Verdict;

struct Options {
    SceneOptions scene;
    std::vector<std::string> files;
    std::string against = "pov,blender,native";
    std::string report;
    host::RenderOptions render; ///< size, samples, threads
    double timeout_seconds = 1800;
};

/// A scene with our picture of it.
struct Subject {
    Loaded loaded;
    runtime::RenderRequest request;
    SceneReport report;
    validation::ScratchFolder folder;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

runtime::Image draw_with(const Subject& subject, compiler::Precision precision) {
    runtime::Image image(subject.request.settings.width, subject.request.settings.height);
    compiler::make_drawable(subject.loaded.scene, precision).render(subject.request, image);
    return image;
}

void draw_reference(Subject& subject) {
    const auto start = std::chrono::steady_clock::now();
    subject.report.reference = draw_with(subject, compiler::Precision::full);
    subject.report.times.trace = seconds_since(start);
    const runtime::RenderSettings& s = subject.request.settings;
    const int samples = s.samples;
    subject.report.reference_made_by =
        fmt::format("scc render --precision double --size {}x{} --samples {}", s.width, s.height, samples);

    const validation::Metrics metrics =
        validation::compare(subject.report.reference, draw_with(subject, compiler::Precision::single));
    subject.report.description = fmt::format("{} x {}, {} samples per pixel. The same in float: max error "
                                             "{:.2g}, away from edges {:.2g}, {} pixels above 1e-3.",
                                             s.width, s.height, samples, metrics.all.max_error,
                                             metrics.away_from_edges.max_error, metrics.all.above(1e-3));
}

// ---- the other pictures --------------------------------------------------------------------------------

void judge(RendererReport& result, const Subject& subject, double exposure,
           const compiler::Ledger& ledger = {}) {
    const runtime::RenderSettings& s = subject.request.settings;
    result.budget = validation::budget_for(result.renderer, s.width, s.height, samples_per_axis(s), exposure);
    if (std::any_of(ledger.begin(), ledger.end(), [](const auto& entry) { return entry.is_refined_mesh; })) {
        result.budget =
            validation::with_refined_meshes(*result.budget, s.width, s.height, samples_per_axis(s));
    }
    if (std::any_of(ledger.begin(), ledger.end(), [](const auto& entry) { return entry.is_differenced; })) {
        result.budget = validation::with_differenced_bumps(*result.budget, s.width, s.height);
    }
    validation::CompareOptions options;
    options.thresholds = validation::thresholds_for(*result.budget);
    result.metrics = validation::compare(subject.report.reference, result.image, options);
    result.judgement = validation::judge(*result.budget, *result.metrics);
}

RendererReport run_native(const Subject& subject) {
    RendererReport result;
    result.renderer = "native";
    const std::string program = (subject.folder.path() / "native").string();
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
    command.directory = subject.folder.path();
    command.arguments = {"-o",        "native.exr",
                         "--size",    fmt::format("{}x{}", s.width, s.height),
                         "--samples", std::to_string(s.samples),
                         "--threads", std::to_string(subject.request.threads)};
    const validation::ProcessResult run = validation::run(command);
    if (run.end == validation::ProcessEnd::interrupted) {
        throw Interrupted{};
    }
    result.command = "./native";
    for (const std::string& argument : command.arguments) {
        result.command += " " + argument;
    }
    result.times.total = run.wall_seconds;
    if (!run.ok()) {
        result.judgement = {Verdict::failed, validation::describe(run, command) + "\n" + run.err};
        return result;
    }
    result.image = host::read_image((subject.folder.path() / "native.exr").string());
    judge(result, subject, 1);
    return result;
}

/// A renderer that knows no spectra draws three wavelengths at a time too.
validation::RenderResult run_renderer_in_bands(const compiler::Exporter& exporter, const Subject& subject,
                                               double timeout_seconds, compiler::Ledger& ledger) {
    const ir::Scene& scene = subject.loaded.scene;
    validation::RenderResult last;
    double seconds = 0;
    runtime::Image sum(subject.report.reference.width, subject.report.reference.height);
    const auto draw_band = [&](std::size_t band, const runtime::RenderRequest& request,
                               runtime::Image& image) {
        const ir::Scene one = ir::band_scene(scene, band);
        compiler::make_drawable(one, compiler::Precision::full).render(request, image);
        compiler::Ledger of_band;
        last = run_renderer(exporter, one, subject.request, subject.folder.path(),
                            validation::brightest_value(image), timeout_seconds, of_band);
        ledger = band == 0 ? of_band : ledger;
        seconds += last.times.total.value_or(0);
        runtime::RenderResult result;
        result.complete = last.status == RenderStatus::done;
        image = result.complete ? last.image : image;
        return result;
    };
    render_bands(std::span<const runtime::BandGroup<double>>(scene.bands), subject.request, sum, draw_band);
    last.image = std::move(sum);
    last.exposure = 1;
    last.times = {.start_up = {}, .parse = {}, .bounding = {}, .trace = {}, .saving = {}, .total = seconds};
    ledger.push_back({compiler::Fidelity::exact,
                      "spectrum",
                      "scene",
                      {},
                      fmt::format("{} pictures of three wavelengths each, added up", scene.bands.size())});
    return last;
}

RendererReport run_exported(const Subject& subject, const std::string& name, double timeout_seconds) {
    RendererReport result;
    result.renderer = name;
    const compiler::Exporter& exporter = *compiler::find_exporter(name);
    compiler::Ledger ledger;
    const ir::Scene& scene = subject.loaded.scene;
    validation::RenderResult run =
        scene.bands.empty()
            ? run_renderer(exporter, scene, subject.request, subject.folder.path(),
                           validation::brightest_value(subject.report.reference), timeout_seconds, ledger)
            : run_renderer_in_bands(exporter, subject, timeout_seconds, ledger);
    result.ledger = ledger_rows(ledger, subject.loaded.sources);
    result.version = run.version;
    result.command = run.command;
    result.times = run.times;
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

RendererReport run_opengl(const Subject& subject, const Options& options, const std::string& file) {
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
    const std::string picture = (subject.folder.path() / "opengl.exr").string();
    validation::Command command;
    command.program = *program;
    command.timeout_seconds = options.timeout_seconds;
    command.arguments = {file,
                         "-o",
                         picture,
                         "--size",
                         fmt::format("{}x{}", s.width, s.height),
                         "--samples",
                         std::to_string(s.samples)};
    const auto repeat = [&](const char* option, const std::vector<std::string>& values) {
        for (const std::string& value : values) {
            command.arguments.insert(command.arguments.end(), {option, value});
        }
    };
    repeat("-D", options.scene.definitions);
    repeat("--asset-path", options.scene.asset_paths);
    if (!options.scene.camera.empty()) {
        repeat("--camera", {options.scene.camera});
    }
    const validation::ProcessResult run = validation::run(command);
    if (run.end == validation::ProcessEnd::interrupted) {
        throw Interrupted{};
    }
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

// ---- the command ---------------------------------------------------------------------------------------

std::vector<std::string> renderers_of(const std::string& list) {
    std::vector<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');) {
        if (name != "native" && name != "opengl" && compiler::find_exporter(name) == nullptr) {
            throw host::UsageError(fmt::format(
                "`{}` is no renderer to compare with; there are pov, blender, opengl and native", name));
        }
        names.push_back(name);
    }
    return names;
}

std::string summary_line(const RendererReport& result) {
    std::string line =
        fmt::format("  {:8} {:8}", result.renderer, validation::name_of(result.judgement.verdict));
    if (result.metrics) {
        const validation::Metrics& m = *result.metrics;
        line += fmt::format(" max {:.2g}, away from edges {:.2g}, rmse {:.2g}, {} px > 2e-5, {} px > 1e-3",
                            m.all.max_error, m.away_from_edges.max_error, m.all.rmse, m.all.above(2e-5),
                            m.all.above(1e-3));
    }
    if (!result.judgement.reason.empty()) {
        line += " (" + result.judgement.reason + ")";
    }
    return line + "\n";
}

// Nothing if the scene is wrong.
std::unique_ptr<Subject> prepare_subject(const Options& options, const std::string& file) {
    auto subject = std::make_unique<Subject>();
    SceneOptions scene = options.scene;
    scene.file = file;
    subject->loaded = load(scene, Stage::scene);
    if (!report(subject->loaded)) {
        return nullptr;
    }
    subject->request = make_request(options.render, subject->loaded.scene.settings);
    subject->request.settings = with_plain_grid(subject->request.settings); // which all renderers can have
    subject->report.name = subject->loaded.scene.name;
    draw_reference(*subject);
    return subject;
}

int validate(const Options& options) {
    const std::vector<std::string> names = renderers_of(options.against);
    validation::Report all;
    all.versions.emplace_back("scc", SCC_VERSION);
    bool fine = true;
    for (const std::string& file : options.files) {
        const std::unique_ptr<Subject> subject = prepare_subject(options, file);
        if (subject == nullptr) {
            fine = false;
            continue;
        }
        write_result("-", fmt::format("{}\n", file));
        for (const std::string& name : names) {
            RendererReport result = name == "native" ? run_native(*subject)
                                    : name == "opengl"
                                        ? run_opengl(*subject, options, file)
                                        : run_exported(*subject, name, options.timeout_seconds);
            write_result("-", summary_line(result));
            const std::pair<std::string, std::string> version{result.renderer, result.version};
            if (!result.version.empty() &&
                std::find(all.versions.begin(), all.versions.end(), version) == all.versions.end()) {
                all.versions.push_back(version);
            }
            subject->report.renderers.push_back(std::move(result));
        }
        all.scenes.push_back(std::move(subject->report));
    }
    validation::write_report(all, options.report);
    const validation::ReportSummary summary = validation::summarize(all);
    write_result("-", fmt::format("{} passed, {} failed, {} skipped; report: {}/index.html\n", summary.passed,
                                  summary.failed, summary.skipped, options.report));
    if (!fine || summary.failed > 0) {
        return host::exit_scene;
    }
    return summary.skipped > 0 ? host::exit_environment : host::exit_fine;
}

} // namespace

void add_validate(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "validate", "compare our picture with other renderers' pictures of the same scene");
    command->add_option("FILE", options->files, "scenes, .scn files")->required();
    add_scene_values(*command, options->scene);
    command
        ->add_option("--against", options->against,
                     "pov, blender, opengl (of raster pictures), native (the built program); separated by "
                     "commas")
        ->capture_default_str()
        ->type_name("LIST");
    command->add_option("--report", options->report, "folder for report.json, index.html and the pictures")
        ->required()
        ->type_name("DIR");
    add_render_options(*command, options->render, RenderOptionSet::picture);
    command->add_option("--timeout", options->timeout_seconds, "seconds that one renderer may take")
        ->capture_default_str();
    command->footer("\nExits with 1 if a comparison is over its budget, with 3 if all that ran passed but a "
                    "renderer is missing.");
    command->callback([&selected, options] { selected = [options] { return validate(*options); }; });
}

} // namespace scc::cli
