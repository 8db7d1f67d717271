#include "compiler/cli/commands.h"
#include "compiler/import/nff.h"
#include "lang/utf8.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace scc::cli {

namespace {

namespace nff = compiler::nff;

// The rest is counted; the scene has a comment at the place of each.
constexpr std::size_t most_warnings = 20;

struct Options {
    std::string format;
    std::string file;
    std::string output;
};

void say(const std::string& file, nff::Place place, const char* kind, const std::string& text) {
    fmt::print(stderr, "{}:{}:{}: {}: {}\n", lang::printable(file), place.line, place.column, kind, text);
}

int import_scene(const Options& options) {
    const std::string text = read_text_file(options.file);
    std::string scene;
    std::vector<nff::Warning> warnings;
    try {
        const std::string name = std::filesystem::path(options.file).filename().string();
        scene = nff::scene_text(nff::parse(text), name, warnings);
    } catch (const nff::Error& error) {
        say(options.file, error.place, "error", error.what());
        return host::exit_scene;
    }
    for (std::size_t i = 0; i < std::min(warnings.size(), most_warnings); ++i) {
        say(options.file, warnings[i].place, "warning", warnings[i].text);
    }
    if (warnings.size() > most_warnings) {
        fmt::print(stderr, "and {} more; comments in the scene say which\n", warnings.size() - most_warnings);
    }
    write_result(options.output, scene);
    return host::exit_fine;
}

} // namespace

void add_import(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("import", "turn another format's scene into a .scn file");
    command->add_option("FORMAT", options->format, "nff (Eric Haines' Neutral File Format)")
        ->required()
        ->check(CLI::IsMember({"nff"}));
    command->add_option("FILE", options->file, "the scene in that format")->required();
    command->add_option("-o,--output", options->output, "the scene, a .scn file; - for stdout")
        ->required()
        ->type_name("OUT.scn");
    command->footer("\nWhat the format says and a scene cannot is a comment at its place and a warning.");
    command->callback([&selected, options] { selected = [options] { return import_scene(*options); }; });
}

} // namespace scc::cli
