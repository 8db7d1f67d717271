#include "compiler/backends/cpp.h"
#include "compiler/cli/build_report.h"
#include "compiler/cli/commands.h"
#include "compiler/cli/native.h"
#include "compiler/cli/needs.h"
#include "compiler/ir/print.h"
#include "compiler/program_scene.h"
#include "compiler/writer.h"
#include "lang/dump.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>

namespace scc::cli {

namespace fs = std::filesystem;

namespace {

enum class Emit { tokens, ast, ir, cpp, exe };

struct Options {
    SceneOptions scene;
    std::string output;
    Emit emit = Emit::exe;
    std::optional<compiler::Precision> chosen_precision; ///< nothing: auto

    NativeOptions native;
    bool draws_aovs = false;
    std::string depfile; ///< empty: none
    std::string report;  ///< "text", "json" or empty
};

Stage stage_for(Emit emit) {
    switch (emit) {
    case Emit::tokens:
        return Stage::tokens;
    case Emit::ast:
        return Stage::tree;
    case Emit::ir:
    case Emit::cpp:
    case Emit::exe:
        break;
    }
    return Stage::scene;
}

compiler::PrecisionChoice choose_precision(const compiler::ir::Scene& scene, const Options& options) {
    return options.chosen_precision ? compiler::PrecisionChoice{*options.chosen_precision, "asked for"}
                                    : program_precision(scene);
}

void emit_source(const Loaded& loaded, const Options& options) {
    const std::string values_name =
        compiler::Identifiers("scene_").make(fs::path(options.output).stem().string()) + ".values";
    const compiler::CppProgram program =
        emit_cpp(loaded.scene, choose_precision(loaded.scene, options).precision, compiler::Numbers::in_code,
                 values_name, nullptr, options.draws_aovs);
    if (!program.values.empty()) {
        if (options.output == "-") {
            throw host::UsageError(
                "this scene's program has a second file with its large tables: give `-o` a file name");
        }
        host::replace_file((fs::path(options.output).parent_path() / values_name).string(), program.values);
    }
    write_result(options.output, program.source);
}

void emit_program(const Loaded& loaded, const Options& options) {
    if (options.output == "-") {
        throw host::UsageError("a program cannot go to standard output: give `-o` a file name");
    }
    const compiler::PrecisionChoice precision = choose_precision(loaded.scene, options);
    std::optional<compiler::ProgramParameters> parameters;
    if (!loaded.module.params.empty()) {
        parameters = parameters_of(loaded, options.scene);
    }
    compile_native(emit_cpp(loaded.scene, precision.precision, compiler::Numbers::as_values, "",
                            parameters ? &*parameters : nullptr, options.draws_aovs),
                   options.native, options.output);
    if (!options.report.empty()) {
        const ReportKind kind = options.report == "json" ? ReportKind::json : ReportKind::text;
        write_result("-", build_report(loaded, precision, options.native, options.output, kind));
    }
}

/// A file name in a rule of Make.
std::string make_name(const std::string& name) {
    std::string escaped;
    for (const char c : name) {
        if (c == ' ' || c == '\t' || c == '#' || c == '\\') {
            escaped += '\\';
        }
        escaped += c == '$' ? "$$" : std::string(1, c);
    }
    return escaped;
}

/// What the output is made from, for Make; as of GCC's -MP, each file is a target of its own, so that one
/// that has gone is no error.
void write_depfile(const Loaded& loaded, const Options& options) {
    std::string rule = make_name(options.output) + ": " + make_name(options.scene.file), targets;
    for (const fs::path& file : *loaded.assets) {
        rule += " \\\n  " + make_name(file.string());
        targets += "\n" + make_name(file.string()) + ":\n";
    }
    host::replace_file(options.depfile, rule + "\n" + targets);
}

int build(const Options& options) {
    if (!options.report.empty() && options.emit != Emit::exe) {
        throw host::UsageError("`--report` is about the program: leave out `--emit`");
    }
    if (!options.depfile.empty() && options.output == "-") {
        throw host::UsageError("`-d` is about a file: give `-o` a file name");
    }
    const Loaded loaded = load(options.scene, stage_for(options.emit));
    if (!report(loaded)) {
        return host::exit_scene;
    }
    switch (options.emit) {
    case Emit::tokens:
        write_result(options.output, lang::dump_tokens(loaded.sources, loaded.tokens));
        break;
    case Emit::ast:
        write_result(options.output, lang::dump_ast(*loaded.tree));
        break;
    case Emit::ir:
        write_result(options.output, print(loaded.scene));
        break;
    case Emit::cpp:
        emit_source(loaded, options);
        break;
    case Emit::exe:
        emit_program(loaded, options);
        break;
    }
    if (!options.depfile.empty()) {
        write_depfile(loaded, options);
    }
    return host::exit_fine;
}

} // namespace

void add_build(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "build", "make a native program that draws the scene and holds only what it needs");
    add_scene_options(*command, options->scene);
    command->add_option("-o,--output", options->output, "the program, or what --emit asks for; - for stdout")
        ->required()
        ->type_name("PROG");
    add_precision_option(
        *command, options->chosen_precision,
        "of the arithmetic; auto (default): float where the scene names an 8-bit `file` that does not show "
        "it, else double");
    static const std::map<std::string, Emit> kinds{{"exe", Emit::exe},
                                                   {"cpp", Emit::cpp},
                                                   {"ir", Emit::ir},
                                                   {"ast", Emit::ast},
                                                   {"tokens", Emit::tokens}};
    command
        ->add_option_function<std::string>(
            "--emit", [options](const std::string& kind) { options->emit = kinds.at(kind); },
            "stop at this stage (default: exe)")
        ->check(CLI::IsMember({"exe", "cpp", "ir", "ast", "tokens"}))
        ->type_name("exe|cpp|ir|ast|tokens");
    static const std::map<std::string, Target> targets{{"host", Target::host},
                                                       {"baseline", Target::baseline}};
    command
        ->add_option_function<std::string>(
            "--target", [options](const std::string& name) { options->native.target = targets.at(name); },
            "whose instructions the program may use: this machine's (default), or any's of its architecture")
        ->check(CLI::IsMember({"host", "baseline"}))
        ->type_name("host|baseline");
    command
        ->add_flag("--report{text}", options->report,
                   "say what the program holds and leaves out, and what that saves; --report=json: as JSON")
        ->check(CLI::IsMember({"text", "json"}));
    command
        ->add_option("-d,--depfile", options->depfile,
                     "write what PROG depends on here, for Make: the scene, its imports, meshes and images")
        ->type_name("DEPFILE");
    command->add_flag("--aov", options->draws_aovs,
                      "the program can draw AOVs: it takes `--aov`, as `scc render` does");
    command->add_flag_callback(
        "--no-cache",
        [options] {
            options->native.use_cache = false;
            options->scene.keep_meshes = false;
        },
        "compile, even if the same code was compiled before");
    command->callback([&selected, options] { selected = [options] { return build(*options); }; });
}

} // namespace scc::cli
