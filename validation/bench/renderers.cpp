#include "validation/bench/renderers.h"

#include "validation/renderer_output.h"
#include "validation/subprocess.h"

#include <fmt/format.h>

#include <fstream>

namespace scc::bench {

namespace {

using validation::Command;
using validation::ProcessResult;

constexpr double timeout_seconds = 120;

Command command_for(const std::string& program, const PictureJob& job) {
    Command command;
    command.program = program;
    command.directory = job.folder;
    command.timeout_seconds = timeout_seconds;
    return command;
}

/// The last line of what it said, which is where programs tell why they end.
std::string last_words(const ProcessResult& process) {
    const std::vector<std::string> lines = validation::lines_of(process.err);
    return lines.empty() ? std::string() : ": " + lines.back();
}

Drawing run_ours(const Command& command, const std::filesystem::path& stats) {
    std::filesystem::remove(stats);
    const ProcessResult process = run(command);
    Drawing drawing;
    drawing.wall = process.wall_seconds;
    if (!process.ok()) {
        drawing.failure = describe(process, command) + last_words(process);
        return drawing;
    }
    std::ifstream file(stats);
    drawing.stats = nlohmann::json::parse(file);
    const nlohmann::json& times = drawing.stats.at("times_ms");
    drawing.trace = times.at("render").get<double>() * 1e-3;
    for (const char* stage : {"parse", "check", "lower", "passes"}) {
        drawing.parse += times.value(stage, 0.0) * 1e-3;
    }
    return drawing;
}

Drawing run_ours(Command command, const PictureJob& job) {
    const std::filesystem::path stats = job.folder / "stats.json";
    command.arguments.insert(
        command.arguments.end(),
        {"-o", job.image, "--threads", std::to_string(job.threads), "--stats", stats.filename().string()});
    command.arguments.insert(command.arguments.end(), job.arguments.begin(), job.arguments.end());
    return run_ours(command, stats);
}

} // namespace

Drawing draw_with_scc(const std::filesystem::path& scc, const std::filesystem::path& scene, PictureJob job) {
    Command command = command_for(scc.string(), job);
    command.arguments = {"render", scene.string()};
    return run_ours(std::move(command), job);
}

Drawing draw_with_program(const std::filesystem::path& program, PictureJob job) {
    return run_ours(command_for(program.string(), job), job);
}

Drawing draw_with_povray(const std::filesystem::path& scene, const PictureJob& job) {
    Command command = command_for("povray", job);
    // -V: the progress line is not part of the work.
    command.arguments = {"+I" + scene.string(),
                         "+Opovray_" + job.image,
                         fmt::format("+W{}", job.width),
                         fmt::format("+H{}", job.height),
                         fmt::format("+WT{}", job.threads),
                         "+FN8",
                         "-A",
                         "-D",
                         "-V"};
    const ProcessResult process = run(command);
    Drawing drawing;
    drawing.wall = process.wall_seconds;
    const validation::PovrayOutput output = validation::read_povray_output(process.err);
    if (!process.ok() || !output.trace) {
        drawing.failure =
            describe(process, command) + (output.errors.empty() ? "" : ": " + output.errors.front());
        return drawing;
    }
    drawing.trace = *output.trace;
    drawing.parse = output.parse.value_or(0);
    drawing.version = output.version;
    return drawing;
}

Drawing draw_with_tachyon(const std::filesystem::path& scene, const PictureJob& job) {
    Command command = command_for("tachyon", job);
    // Shading normals on the viewer's side, as here.
    command.arguments = {scene.string(), "-numthreads", std::to_string(job.threads),
                         "-normalfixup", "flip",        "-format",
                         "PNG",          "-o",          "tachyon_" + job.image};
    const ProcessResult process = run(command);
    Drawing drawing;
    drawing.wall = process.wall_seconds;
    constexpr std::string_view mark = "Ray Tracing Time:";
    const std::size_t at = process.out.find(mark);
    if (!process.ok() || at == std::string::npos) {
        drawing.failure = describe(process, command) + last_words(process);
        return drawing;
    }
    drawing.trace = std::stod(process.out.substr(at + mark.size()));
    constexpr std::string_view version = "Version ";
    if (const std::size_t word = process.out.find(version); word != std::string::npos) {
        const std::size_t begin = word + version.size();
        drawing.version =
            "Tachyon " + process.out.substr(begin, process.out.find_first_of(" \n", begin) - begin);
    }
    return drawing;
}

} // namespace scc::bench
