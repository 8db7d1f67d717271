#include "compiler/cli/commands.h"
#include "compiler/import/nff.h"
#include "compiler/import/obj.h"
#include "compiler/mesh_file.h"
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

/// How a scene at `scene` names a file in its folder or below; empty: it is elsewhere.
std::string name_from(const std::filesystem::path& scene, const std::filesystem::path& file) {
    const std::filesystem::path folder =
        scene == "-" ? std::filesystem::current_path() : std::filesystem::absolute(scene).parent_path();
    std::error_code error;
    const std::filesystem::path name = std::filesystem::relative(file, folder, error);
    return error || *name.begin() == ".." ? "" : name.generic_string();
}

int import_mesh(const Options& options) {
    const std::filesystem::path file = options.file;
    const std::string text = read_text_file(options.file);
    std::string name = name_from(options.output, file);
    const bool is_elsewhere = name.empty();
    if (is_elsewhere) {
        name = file.filename().string();
    }
    std::vector<std::string> warnings;
    std::string scene;
    try {
        scene = compiler::obj::scene_text(text, file.parent_path(), name, warnings);
    } catch (const compiler::MeshError& error) {
        fmt::print(stderr, "{}: error: {}\n", lang::printable(options.file), lang::printable(error.what()));
        return host::exit_scene;
    }
    if (is_elsewhere) {
        warnings.push_back(fmt::format("the scene's folder is another one: it needs `--asset-path {}`",
                                       file.parent_path().string()));
    }
    for (const std::string& warning : warnings) {
        fmt::print(stderr, "{}: warning: {}\n", lang::printable(options.file), lang::printable(warning));
    }
    write_result(options.output, scene);
    return host::exit_fine;
}

int import_nff(const Options& options) {
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
    command
        ->add_option(
            "FORMAT", options->format,
            "nff (Eric Haines' Neutral File Format) or obj (a Wavefront mesh, its parts and materials)")
        ->required()
        ->check(CLI::IsMember({"nff", "obj"}));
    command->add_option("FILE", options->file, "the scene in that format")->required();
    command->add_option("-o,--output", options->output, "the scene, a .scn file; - for stdout")
        ->required()
        ->type_name("OUT.scn");
    command->footer("\nWhat the format says and a scene cannot is a comment at its place and a warning.");
    command->callback([&selected, options] {
        selected = [options] {
            return options->format == "obj" ? import_mesh(*options) : import_nff(*options);
        };
    });
}

} // namespace scc::cli
