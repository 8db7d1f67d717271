#include "validation/doctor.h"

#include "validation/renderer_output.h"
#include "validation/renderers.h"
#include "validation/subprocess.h"

#include <array>
#include <optional>
#include <string>

namespace scc::validation {
namespace {

constexpr double version_timeout_seconds = 20;

/// The first line of `NAME --version`.
std::optional<std::string> first_line(const std::string& program) {
    Command command;
    command.program = program;
    command.arguments = {"--version"};
    command.timeout_seconds = version_timeout_seconds;
    const ProcessResult result = run(command);
    if (result.end == ProcessEnd::not_started)
        return std::nullopt;
    const std::vector<std::string> lines = lines_of(result.out);
    return result.ok() && !lines.empty() ? lines.front() : std::string();
}

/// Of the numpy that Blender's Python finds, which Debian's package of Blender does not ask for.
std::optional<std::string> numpy_of_blender() {
    Command command;
    command.program = "blender";
    command.arguments = {"-b", "--factory-startup", "--python-exit-code",
                         "1",  "--python-expr",     "import numpy; print('numpy', numpy.__version__)"};
    command.timeout_seconds = version_timeout_seconds;
    const ProcessResult result = run(command);
    for (const std::string& line : lines_of(result.ok() ? result.out : ""))
        if (line.starts_with("numpy "))
            return line;
    return std::nullopt;
}

struct Row {
    const char* name;
    const char* purpose;
    const char* how_to_get;
    std::optional<std::string> (*version)();
};

constexpr const char* compiles = "compiles scenes into programs (scc build)";

constexpr std::array rows{
    Row{"c++", compiles, "apt install g++", [] { return first_line("c++"); }},
    Row{"g++", compiles, "apt install g++", [] { return first_line("g++"); }},
    Row{"clang++", compiles, "apt install clang", [] { return first_line("clang++"); }},
    Row{"povray", "draws exported scenes (scc validate --against pov)", "apt install povray", povray_version},
    Row{"blender", "draws exported scenes (scc validate --against blender)", "apt install blender",
        blender_version},
    Row{"numpy", "makes the arrays of scenes exported to Blender", "apt install python3-numpy",
        numpy_of_blender},
    Row{"scc-opengl", "draws raster pictures by OpenGL (scc validate --against opengl)",
        "apt install libosmesa6-dev, then build scc again",
        [] {
            const std::optional<std::string> program = find_opengl_program();
            return program ? first_line(*program) : std::nullopt;
        }},
};

} // namespace

std::vector<Tool> find_tools() {
    std::vector<Tool> tools;
    for (const Row& row : rows) {
        const std::optional<std::string> version = row.version();
        tools.push_back({row.name, row.purpose, version.has_value(), version.value_or(""), row.how_to_get});
    }
    return tools;
}

nlohmann::ordered_json to_json(const std::vector<Tool>& tools) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Tool& tool : tools)
        json.push_back({{"name", tool.name},
                        {"purpose", tool.purpose},
                        {"found", tool.found},
                        {"version", tool.version},
                        {"how_to_get", tool.how_to_get}});
    return json;
}

} // namespace scc::validation
