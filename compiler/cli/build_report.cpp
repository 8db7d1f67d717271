#include "compiler/cli/build_report.h"

#include "compiler/backends/render.h"
#include "compiler/cli/commands.h"
#include "compiler/cli/executable.h"
#include "compiler/cli/needs.h"
#include "validation/scratch.h"
#include "validation/subprocess.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <vector>

namespace scc::cli {

namespace fs = std::filesystem;

namespace {

constexpr int runs = 5, width = 320, height = 240;

struct Facts {
    std::vector<Feature> kept;
    std::vector<std::string> left_out;
    Executable program;
    Executable with_everything;
    double generic_ns = 0, program_ns = 0; ///< per sample, one thread
};

double nanoseconds_per_sample(double milliseconds) {
    return milliseconds * 1e6 / (static_cast<double>(width) * height);
}

double draw_generic(const host::Drawable& drawable) {
    runtime::RenderRequest request;
    request.settings = drawable.settings;
    request.settings.width = width;
    request.settings.height = height;
    request.settings.samples = 1;
    request.crop = {0, 0, width, height};
    runtime::Image image(width, height);
    const auto start = std::chrono::steady_clock::now();
    drawable.render(request, image);
    const std::chrono::duration<double, std::milli> gone = std::chrono::steady_clock::now() - start;
    return nanoseconds_per_sample(gone.count());
}

double draw_program(const fs::path& program, const fs::path& folder) {
    validation::Command command;
    command.program = program.string();
    command.directory = folder;
    command.arguments = {"-o",        "report.pfm", "--size",    fmt::format("{}x{}", width, height),
                         "--samples", "1",          "--threads", "1",
                         "--stats",   "-"};
    const validation::ProcessResult result = validation::run(command);
    if (result.end == validation::ProcessEnd::interrupted) {
        throw Interrupted{};
    }
    const nlohmann::json stats = nlohmann::json::parse(result.out, nullptr, false);
    if (!result.ok() || stats.is_discarded()) {
        throw EnvironmentError(fmt::format("the built program failed ({}):\n{}",
                                           validation::describe(result, command), result.err));
    }
    return nanoseconds_per_sample(stats["times_ms"]["render"].get<double>());
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// By turns, so that a machine whose speed drifts favours neither.
void measure_times(Facts& facts, const host::Drawable& drawable, const fs::path& program,
                   const fs::path& folder) {
    std::vector<double> generic, built;
    for (int i = 0; i < runs; ++i) {
        generic.push_back(draw_generic(drawable));
        built.push_back(draw_program(program, folder));
    }
    facts.generic_ns = median(generic);
    facts.program_ns = median(built);
}

/// A program whose code could draw any scene (but for functions, which are this scene's).
Executable everything_program(const Loaded& loaded, compiler::Precision precision,
                              const NativeOptions& options, const fs::path& folder) {
    compile_native(emit_cpp(loaded.scene, precision, compiler::Numbers::of_any_scene), options,
                   folder / "everything");
    return inspect_executable((folder / "everything").string());
}

std::string as_text(const Facts& facts, const std::string& program,
                    const compiler::PrecisionChoice& precision) {
    std::string text =
        fmt::format("{}: {} ({})\n\nkept\n", program, name_of(precision.precision), precision.reason);
    for (const Feature& feature : facts.kept) {
        text += fmt::format("  {:24} {}\n", feature.name, feature.place);
    }
    text += "left out\n ";
    for (const std::string& name : facts.left_out) {
        text += " " + name + (&name == &facts.left_out.back() ? "" : ",");
    }
    text += "\nlibraries\n ";
    for (const std::string& name : facts.program.libraries) {
        text += " " + name;
    }
    text += fmt::format("\ncode\n  {} bytes; with everything {} bytes\n", facts.program.code_bytes,
                        facts.with_everything.code_bytes);
    text += fmt::format("time per sample\n  {:.0f} ns; the generic renderer {:.0f} ns, {:.2f} times that\n"
                        "  ({} x {} pixels, one thread, medians of {} runs by turns)\n",
                        facts.program_ns, facts.generic_ns, facts.generic_ns / facts.program_ns, width,
                        height, runs);
    return text;
}

std::string as_json(const Facts& facts, const std::string& program,
                    const compiler::PrecisionChoice& precision) {
    nlohmann::ordered_json kept = nlohmann::ordered_json::array();
    for (const Feature& feature : facts.kept) {
        kept.push_back({{"feature", feature.name}, {"asked_for_at", feature.place}});
    }
    const nlohmann::ordered_json json{
        {"schema", 1},
        {"program", program},
        {"precision", name_of(precision.precision)},
        {"precision_reason", precision.reason},
        {"kept", kept},
        {"left_out", facts.left_out},
        {"libraries", facts.program.libraries},
        {"code_bytes", facts.program.code_bytes},
        {"code_bytes_with_everything", facts.with_everything.code_bytes},
        {"ns_per_sample", facts.program_ns},
        {"ns_per_sample_generic", facts.generic_ns},
        {"gain", facts.generic_ns / facts.program_ns},
        {"measured", {{"size", {width, height}}, {"samples", 1}, {"threads", 1}, {"runs", runs}}}};
    return json.dump(2) + "\n";
}

} // namespace

std::string build_report(const Loaded& loaded, const compiler::PrecisionChoice& precision,
                         const NativeOptions& options, const std::string& program, ReportKind kind) {
    const validation::ScratchFolder folder;
    Facts facts;
    facts.kept = needed_features(loaded);
    facts.left_out = features_left_out(loaded.scene);
    facts.program = inspect_executable(program);
    facts.with_everything = everything_program(loaded, precision.precision, options, folder.path());
    measure_times(facts, compiler::make_drawable(loaded.scene, precision.precision), fs::absolute(program),
                  folder.path());
    return kind == ReportKind::json ? as_json(facts, program, precision) : as_text(facts, program, precision);
}

} // namespace scc::cli
