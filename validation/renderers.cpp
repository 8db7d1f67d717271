#include "validation/renderers.h"

#include "runtime/host/read_image.h"
#include "validation/compare.h"
#include "validation/render_cache.h"
#include "validation/renderer_output.h"
#include "validation/subprocess.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <system_error>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;

constexpr double version_timeout_seconds = 60;

/// The scene's name in the job's folder, to which it is copied if it is elsewhere. Throws host::FileError.
std::string bring_scene(const RenderJob& job, const char* name) {
    std::error_code error;
    if (fs::equivalent(job.scene.has_parent_path() ? job.scene.parent_path() : fs::path("."), job.folder,
                       error))
        return job.scene.filename().string();
    fs::copy_file(job.scene, job.folder / name, fs::copy_options::overwrite_existing, error);
    if (error)
        throw host::FileError(fmt::format("cannot copy `{}`: {}", job.scene.string(), error.message()));
    return name;
}

std::string command_line(const Command& command) {
    std::string text = command.program;
    for (const std::string& argument : command.arguments)
        text += " " + argument;
    return text;
}

/// The renderer's talk without the name of the folder, which differs from run to run.
std::string without_folder(std::string text, const fs::path& folder) {
    std::error_code none;
    const std::string prefix = fs::absolute(folder, none).string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at))
        text.erase(at, prefix.size());
    return text;
}

RenderResult missing(const char* name) {
    RenderResult result;
    result.status = RenderStatus::missing;
    result.reason = fmt::format("{} is not installed", name);
    return result;
}

/// What the end of the process says about the picture; a reason found in the renderer's talk goes before the
/// status.
void judge_end(RenderResult& result, const ProcessResult& process, const Command& command,
               const std::string& said) {
    const std::string end = describe(process, command);
    if (process.ok()) {
        result.status = RenderStatus::done;
        return;
    }
    result.reason = end;
    if (process.end == ProcessEnd::timed_out) {
        result.status = RenderStatus::timed_out;
    } else if (process.end == ProcessEnd::interrupted) {
        result.status = RenderStatus::interrupted;
    } else {
        result.status = RenderStatus::failed;
        if (!said.empty())
            result.reason = fmt::format("{} ({})", said, end);
    }
}

/// Reads the picture and averages it to the job's size; without one the result is a failure.
void take_image(RenderResult& result, const RenderJob& job, const char* name, bool linear_integers) {
    try {
        const runtime::Image drawn = host::read_image((job.folder / name).string(), linear_integers);
        const int n = job.samples_per_axis;
        if (drawn.width != job.width * n || drawn.height != job.height * n)
            throw CompareError(fmt::format("it drew {} x {} pixels instead of {} x {}", drawn.width,
                                           drawn.height, job.width * n, job.height * n));
        result.image = n == 1 ? drawn : box_average(drawn, n);
    } catch (const std::runtime_error& error) {
        result.status = RenderStatus::failed;
        result.reason = without_folder(error.what(), job.folder);
    }
}

void forget_old_image(const RenderJob& job, const char* name) {
    std::error_code none;
    fs::remove(job.folder / name, none);
}

/// Values at the end of the file's range, where the reference has none, were cut off.
void warn_of_clipping(RenderResult& result, double brightest) {
    if (brightest * result.exposure >= 1)
        return;
    const auto clipped = std::count_if(result.image.pixels.begin(), result.image.pixels.end(),
                                       [](float value) { return value >= 1.0F; });
    if (clipped > 0)
        result.warnings.push_back(fmt::format(
            "{} values reach the end of the file's range, which the reference does not", clipped));
}

std::optional<double> remaining(const RenderTimes& times) {
    if (!times.total)
        return std::nullopt;
    const double rest = *times.total - times.parse.value_or(0) - times.bounding.value_or(0) -
                        times.trace.value_or(0) - times.saving.value_or(0);
    return std::max(rest, 0.0);
}

std::string joined(const std::vector<std::string>& texts) {
    std::string result;
    for (const std::string& text : texts)
        result += (result.empty() ? "" : "; ") + text;
    return result;
}

Command povray_command(const RenderJob& job, const std::string& scene, const char* image, double exposure) {
    Command command;
    command.program = "povray";
    command.directory = job.folder;
    command.timeout_seconds = job.timeout_seconds;
    command.arguments = {"+I" + scene,
                         fmt::format("+O{}", image),
                         fmt::format("+W{}", job.width * job.samples_per_axis),
                         fmt::format("+H{}", job.height * job.samples_per_axis),
                         "+FN16",
                         "File_Gamma=1.0"};
    if (const auto& a = job.antialiasing)
        command.arguments.insert(command.arguments.end(),
                                 {fmt::format("+A{}", a->threshold), fmt::format("+AM{}", a->method), "-J",
                                  fmt::format("+R{}", a->depth)});
    else
        command.arguments.emplace_back("-A");
    command.arguments.emplace_back("-D");
    if (job.threads > 0)
        command.arguments.push_back(fmt::format("+WT{}", job.threads));
    if (job.no_bounding)
        command.arguments.push_back("-MB");
    if (exposure != 1)
        command.arguments.push_back(fmt::format("Declare=scc_exposure={}", exposure));
    return command;
}

Command blender_command(const RenderJob& job, const std::string& scene, const char* image) {
    Command command;
    command.program = "blender";
    command.directory = job.folder;
    command.timeout_seconds = job.timeout_seconds;
    command.arguments = {"-b", "--factory-startup", "--python-exit-code", "1"};
    if (job.threads > 0)
        command.arguments.insert(command.arguments.end(), {"-t", std::to_string(job.threads)});
    command.arguments.insert(command.arguments.end(), {"-P", scene, "--", "--render", image, "--size"});
    command.arguments.push_back(
        fmt::format("{}x{}", job.width * job.samples_per_axis, job.height * job.samples_per_axis));
    return command;
}

std::optional<ProcessResult> ask_version(const char* program) {
    Command command;
    command.program = program;
    command.arguments = {"--version"};
    command.timeout_seconds = version_timeout_seconds;
    ProcessResult result = run(command);
    return result.end == ProcessEnd::not_started ? std::nullopt : std::optional(std::move(result));
}

/// The first line that begins with the name, or the name alone.
std::string version_line(const std::string& text, const std::string& name) {
    for (const std::string& line : lines_of(text))
        if (line.starts_with(name + " "))
            return line;
    return name;
}

/// A renderer's version is asked for once.
const std::string& known_version(const char* program) {
    static const std::string povray = povray_version().value_or("");
    static const std::string blender = blender_version().value_or("");
    return program == std::string_view("povray") ? povray : blender;
}

/// What the cache has for the command, else what `draw` makes of it, which is then kept.
template <class Draw>
RenderResult cached(const RenderJob& job, const Command& command, const Draw& draw) {
    if (job.cache == nullptr || !job.cache->keeps())
        return draw();
    const std::string key = render_key(job, command, known_version(command.program.c_str()));
    if (std::optional<RenderResult> kept = job.cache->find(key))
        return std::move(*kept);
    RenderResult result = draw();
    job.cache->store(key, result);
    return result;
}

RenderResult run_povray(const RenderJob& job, const Command& command, const char* image, double exposure) {
    RenderResult result;
    result.exposure = exposure;
    const ProcessResult process = run(command);
    const PovrayOutput output = read_povray_output(process.err);
    result.command = command_line(command);
    result.version = output.version;
    result.warnings = output.warnings;
    result.log = without_folder(output.log, job.folder);
    result.times.parse = output.parse;
    result.times.bounding = output.bounding;
    result.times.trace = output.trace;
    result.times.total = process.wall_seconds;
    result.times.start_up = remaining(result.times);
    judge_end(result, process, command, joined(output.errors));
    if (result.status != RenderStatus::done)
        return result;
    take_image(result, job, image, true);
    warn_of_clipping(result, job.brightest);
    for (float& value : result.image.pixels)
        value = static_cast<float>(static_cast<double>(value) / result.exposure);
    return result;
}

RenderResult run_blender(const RenderJob& job, const Command& command, const char* image) {
    RenderResult result;
    const ProcessResult process = run(command);
    const BlenderOutput output = read_blender_output(process.out, process.err);
    result.command = command_line(command);
    result.version = output.version;
    result.log = without_folder(output.log, job.folder);
    result.times.trace = output.render;
    result.times.saving = output.saving;
    result.times.total = process.wall_seconds;
    result.times.start_up = remaining(result.times);
    judge_end(result, process, command, output.error);
    if (result.status == RenderStatus::done)
        take_image(result, job, image, false);
    return result;
}

} // namespace

std::optional<std::string> find_opengl_program() {
    std::error_code error;
    const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "scc-opengl";
    return !error && fs::exists(beside, error) ? beside.string() : find_program("scc-opengl");
}

nlohmann::ordered_json to_json(const RenderTimes& times) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    const auto add = [&json](const char* name, const std::optional<double>& seconds) {
        if (seconds)
            json[name] = *seconds;
    };
    add("start_up", times.start_up);
    add("parse", times.parse);
    add("bounding", times.bounding);
    add("trace", times.trace);
    add("saving", times.saving);
    add("total", times.total);
    return json;
}

double exposure_for(double brightest) {
    return brightest > 1 && std::isfinite(brightest) ? std::exp2(-std::ceil(std::log2(brightest))) : 1;
}

double brightest_value(const runtime::Image& image) {
    float brightest = 0;
    for (const float value : image.pixels)
        if (std::isfinite(value))
            brightest = std::max(brightest, value);
    return static_cast<double>(brightest);
}

RenderResult render_with_povray(const RenderJob& job) {
    constexpr const char* image = "povray.png";
    if (!find_program("povray"))
        return missing("POV-Ray");
    forget_old_image(job, image);
    const double exposure = exposure_for(job.brightest);
    const Command command = povray_command(job, bring_scene(job, "scene.pov"), image, exposure);
    return cached(job, command, [&] { return run_povray(job, command, image, exposure); });
}

RenderResult render_with_blender(const RenderJob& job) {
    constexpr const char* image = "blender.exr";
    if (!find_program("blender"))
        return missing("Blender");
    forget_old_image(job, image);
    const Command command = blender_command(job, bring_scene(job, "scene.py"), image);
    return cached(job, command, [&] { return run_blender(job, command, image); });
}

std::optional<std::string> povray_version() {
    const std::optional<ProcessResult> result = ask_version("povray");
    return result ? std::optional(version_line(result->err, "POV-Ray")) : std::nullopt;
}

std::optional<std::string> blender_version() {
    const std::optional<ProcessResult> result = ask_version("blender");
    return result ? std::optional(version_line(result->out, "Blender")) : std::nullopt;
}

} // namespace scc::validation
