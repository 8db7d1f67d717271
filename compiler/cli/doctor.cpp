#include "validation/doctor.h"

#include "compiler/cli/commands.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <memory>

namespace scc::cli {

namespace {

int doctor(bool json) {
    const std::vector<validation::Tool> tools = validation::find_tools();
    std::string text;
    for (const validation::Tool& tool : tools) {
        text += tool.found ? fmt::format("found    {:10} {} ({})\n", tool.name, tool.version, tool.purpose)
                           : fmt::format("missing  {:10} {}; to get it: {}\n", tool.name, tool.purpose,
                                         tool.how_to_get);
    }
    write_result("-", json ? to_json(tools).dump(2) + "\n" : text);
    const bool complete =
        std::all_of(tools.begin(), tools.end(), [](const validation::Tool& tool) { return tool.found; });
    return complete ? host::exit_fine : host::exit_environment;
}

} // namespace

void add_doctor(CLI::App& app, Run& selected) {
    auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand(
        "doctor", "say which compilers and renderers are there, and how to get the missing ones");
    command->add_flag("--json", *json, "as JSON");
    command->callback([&selected, json] { selected = [json] { return doctor(*json); }; });
}

} // namespace scc::cli
