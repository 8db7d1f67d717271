#include "compiler/cli/commands.h"
#include "compiler/cli/comparison.h"
#include "compiler/cli/subject.h"
#include "compiler/cli/sweep.h"
#include "runtime/host/file.h"
#include "validation/jobs.h"
#include "validation/junit.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>

namespace scc::cli {

namespace {

using validation::RendererReport;
using Subjects = std::vector<std::unique_ptr<Subject>>;

std::vector<std::string> renderers_of(const std::string& list) {
    std::vector<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');) {
        if (!is_renderer(name)) {
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
    line += "\n";
    if (result.cause) {
        line += fmt::format("           cause class {}: {}\n", validation::name_of(result.cause->cause),
                            result.cause->summary);
    }
    return line;
}

/// Prints each scene's lines once all its comparisons are done, in the scenes' order.
class ScenePrinter {
public:
    explicit ScenePrinter(const Subjects& subjects, std::size_t renderers) : subjects_(subjects) {
        for (const auto& subject : subjects) {
            missing_.push_back(subject->report.failure.empty() ? renderers : 0);
        }
    }
    /// One more comparison of the scene is done.
    void done(std::size_t scene) {
        const std::lock_guard lock(guard_);
        --missing_[scene];
        print_finished();
    }

private:
    void print_finished() {
        for (; next_ < missing_.size() && missing_[next_] == 0; ++next_) {
            std::string text = subjects_[next_]->options.file + "\n";
            for (const RendererReport& result : subjects_[next_]->report.renderers) {
                text += summary_line(result);
            }
            write_result("-", subjects_[next_]->report.failure.empty() ? text : "");
        }
    }

    const Subjects& subjects_;
    std::vector<std::size_t> missing_;
    std::size_t next_ = 0;
    std::mutex guard_;
};

/// All scenes with all renderers, `options.jobs` at a time.
void compare_all(const ValidateOptions& options, const std::vector<std::string>& names, Subjects& subjects) {
    const int threads = std::max(1, thread_count(options.render) / options.jobs);
    ScenePrinter printer(subjects, names.size());
    std::vector<validation::Job> jobs;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        Subject& subject = *subjects[i];
        if (!subject.report.failure.empty()) {
            continue;
        }
        subject.request.threads = threads;
        subject.report.renderers.resize(names.size());
        for (std::size_t k = 0; k < names.size(); ++k) {
            jobs.push_back([&, i, k] {
                subjects[i]->report.renderers[k] = compare_with(*subjects[i], names[k], threads);
                printer.done(i);
            });
        }
    }
    validation::run_jobs(jobs, options.jobs);
}

void add_versions(validation::Report& report) {
    report.versions.emplace_back("scc", SCC_VERSION);
    for (const validation::SceneReport& scene : report.scenes) {
        for (const RendererReport& result : scene.renderers) {
            const std::pair<std::string, std::string> version{result.renderer, result.version};
            if (!result.version.empty() &&
                std::find(report.versions.begin(), report.versions.end(), version) == report.versions.end()) {
                report.versions.push_back(version);
            }
        }
    }
}

int exit_code(const validation::ReportSummary& summary) {
    if (summary.broken > 0 || summary.failed > 0) {
        return host::exit_scene;
    }
    return summary.skipped > 0 ? host::exit_environment : host::exit_fine;
}

std::string words(const std::optional<validation::SweepRatio>& ratio) {
    return ratio ? fmt::format("{:.3g} ({:.3g} .. {:.3g})", ratio->median, ratio->least, ratio->most)
                 : "none in common";
}

/// Each scene's reference, and how much longer others take to the same error.
std::string sweep_lines(const validation::SweepScene& scene) {
    std::string text = fmt::format("{}: {}\n", scene.name, scene.confirmation);
    for (const validation::SweepSeries& ours : scene.series) {
        for (const validation::SweepSeries& other : scene.series) {
            if (!is_own(ours) || is_own(other)) {
                continue;
            }
            text += fmt::format("  {:10} over {:18} to equal error: process {}, drawing {}\n", other.renderer,
                                ours.renderer,
                                words(equal_error_ratio(ours, other, &validation::RenderTimes::total)),
                                words(equal_error_ratio(ours, other, &validation::RenderTimes::trace)));
        }
    }
    return text;
}

int sweep(const ValidateOptions& options, const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), "opengl") != names.end()) {
        throw host::UsageError("--sweep draws by rays, which OpenGL does not");
    }
    validation::Report all;
    all.title = "scc validate --sweep";
    all.versions.emplace_back("scc", SCC_VERSION);
    bool complete = true;
    all.sweeps = sweep_scenes(options, names, complete);
    validation::write_report(all, options.report);
    for (const validation::SweepScene& scene : all.sweeps) {
        write_result("-", sweep_lines(scene));
    }
    write_result("-", fmt::format("report: {}/index.html\n", options.report));
    return complete ? host::exit_fine : host::exit_scene;
}

int validate(const ValidateOptions& options) {
    const std::vector<std::string> names = renderers_of(options.against);
    if (options.sweep) {
        return sweep(options, names);
    }
    const auto cache = validation::RenderCache::from_option(options.cache);
    Subjects subjects;
    for (const std::string& file : options.files) {
        subjects.push_back(prepare_subject(options, file));
        subjects.back()->cache = cache;
    }
    compare_all(options, names, subjects);
    validation::Report all;
    for (const std::unique_ptr<Subject>& subject : subjects) {
        all.scenes.push_back(std::move(subject->report));
    }
    add_versions(all);
    validation::write_report(all, options.report);
    if (!options.junit.empty()) {
        write_result(options.junit, validation::to_junit(all));
    }
    const validation::ReportSummary summary = validation::summarize(all);
    write_result("-", fmt::format("{} passed, {} failed, {} skipped; report: {}/index.html\n", summary.passed,
                                  summary.failed, summary.skipped, options.report));
    return exit_code(summary);
}

void add_options(CLI::App& command, ValidateOptions& options) {
    command.add_option("FILE", options.files, "scenes, .scn files")->required();
    add_scene_values(command, options.scene);
    command
        .add_option("--against", options.against,
                    "pov, blender, opengl (of raster pictures), native (the built program); separated by "
                    "commas")
        ->capture_default_str()
        ->type_name("LIST");
    command.add_option("--report", options.report, "folder for report.json, index.html and the pictures")
        ->required()
        ->type_name("DIR");
    CLI::Option* sweeps = command.add_flag(
        "--sweep", options.sweep,
        "error against run time instead: 1, 4, 16, ... samples per pixel up to --samples (256) "
        "against 4096 of ours in double, which POV-Ray confirms; --size is 96x72 if it is left "
        "out");
    command.add_option("--junit", options.junit, "the verdicts as JUnit XML, for continuous integration")
        ->excludes(sweeps)
        ->type_name("FILE.xml");
    add_render_options(command, options.render, RenderOptionSet::picture);
    command
        .add_option("--jobs", options.jobs,
                    "how many comparisons, each with processes of its own, are under way at once; they share "
                    "the threads, and disturb each other's times")
        ->check(CLI::Range(1, 256))
        ->excludes(sweeps)
        ->capture_default_str();
    static const std::map<std::string, LayerUse> uses{
        {"auto", LayerUse::automatic}, {"always", LayerUse::always}, {"never", LayerUse::never}};
    command
        .add_option_function<std::string>(
            "--layers", [&options](const std::string& use) { options.layers = uses.at(use); },
            "whether POV-Ray and Blender are asked what rays meet (object, depth, position, normal), too; "
            "auto "
            "(default): where a picture is over its budget, to tell the cause")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->excludes(sweeps)
        ->type_name("auto|always|never");
    command
        .add_option("--cache", options.cache,
                    "folder that keeps other renderers' pictures, or off; default: $XDG_CACHE_HOME/scc")
        ->type_name("DIR|off");
    command
        .add_option("--timeout", options.timeout_seconds,
                    "seconds that one renderer, ourselves among them, may take for a picture")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
}

} // namespace

void add_validate(CLI::App& app, Run& selected) {
    auto options = std::make_shared<ValidateOptions>();
    CLI::App* command = app.add_subcommand(
        "validate", "compare our picture with other renderers' pictures of the same scene");
    add_options(*command, *options);
    command->footer(
        "\nA scene states limits of its own, where it has a reason, in a comment:\n"
        "  //@ budget blender: above_1e-3 = 60, away_from_edges = 2e-4 because the lens is sampled at "
        "random\n"
        "Counts are per 640 x 480 pixels; max_error and outliers are the other two.\n\n"
        "Exits with 1 if a comparison is over its budget, with 3 if all that ran passed but a renderer is "
        "missing.");
    command->callback([&selected, options] { selected = [options] { return validate(*options); }; });
}

} // namespace scc::cli
