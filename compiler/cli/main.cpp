#include "compiler/cli/commands.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <new>

namespace {

using namespace scc;

int fail(int code, const char* text) {
    fmt::print(stderr, "scc: error: {}\n", text);
    return code;
}

int run(const cli::Run& command) {
    try {
        return command();
    } catch (const host::UsageError& error) {
        return fail(host::exit_usage, error.what());
    } catch (const host::FileError& error) {
        return fail(host::exit_environment, error.what());
    } catch (const cli::EnvironmentError& error) {
        return fail(host::exit_environment, error.what());
    } catch (const cli::Interrupted&) {
        return fail(host::exit_interrupted, "interrupted");
    } catch (const std::bad_alloc&) {
        return fail(host::exit_environment, "there is not enough memory");
    } catch (const std::exception& error) {
        return fail(host::exit_environment,
                    fmt::format("internal error, please report it: {}", error.what()).c_str());
    }
}

constexpr const char* examples = R"(
Examples:
  scc check scene.scn                            say what is wrong with a scene
  scc fmt scene.scn                              lay it out in place
  scc render scene.scn -o scene.png              draw it
  scc build scene.scn -o scene && ./scene -o scene.png
                                                 make a program that draws it
  scc export pov scene.scn -o scene.pov          hand it to POV-Ray, or to Blender
  scc import nff balls.nff -o balls.scn          turn a Neutral File Format scene into one of ours
  scc validate scene.scn --against pov,blender,native --report out
                                                 compare our picture with theirs
  scc stability offset scale_up --report out     how far our pictures hold when scenes go to extremes
  scc explain scene.scn --pixel 320,240          tell how a pixel came about

Exit codes: 0 fine; 1 the scene is wrong or a comparison failed; 2 usage; 3 the environment (file, disk, missing
program); 130 interrupted.)";

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"scc compiles scene descriptions (.scn) into pictures, native programs, POV-Ray scenes and "
                 "Blender scripts."};
    app.require_subcommand(1);
    app.set_version_flag("--version", SCC_VERSION);
    app.footer(examples);
    cli::Run selected;
    for (auto* add :
         {cli::add_check, cli::add_fmt, cli::add_params, cli::add_render, cli::add_build, cli::add_export,
          cli::add_import, cli::add_validate, cli::add_stability, cli::add_explain, cli::add_compare,
          cli::add_lsp, cli::add_doctor, cli::add_reference}) {
        add(app, selected);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? host::exit_fine : host::exit_usage;
    }
    return run(selected);
}
