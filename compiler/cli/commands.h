#pragma once

#include "compiler/backends/precision.h"
#include "compiler/pipeline.h"
#include "runtime/host/options.h"

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

/// The commands of scc. Each `add_...` registers one with its options; what it runs returns the exit code and
/// may throw host::UsageError (2), host::FileError and EnvironmentError (3).
namespace scc::cli {

using compiler::load;
using compiler::Loaded;
using compiler::read_text_file;
using compiler::report;
using compiler::SceneOptions;
using compiler::Stage;

using Run = std::function<int()>;

/// Something that the machine lacks: a compiler, a renderer.
struct EnvironmentError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The user ended it.
struct Interrupted {};

/// Registers a command; `selected` becomes what to run if the command line names it.
void add_check(CLI::App& app, Run& selected);
void add_fmt(CLI::App& app, Run& selected);
void add_params(CLI::App& app, Run& selected);
void add_render(CLI::App& app, Run& selected);
void add_build(CLI::App& app, Run& selected);
void add_export(CLI::App& app, Run& selected);
void add_import(CLI::App& app, Run& selected);
void add_validate(CLI::App& app, Run& selected);
void add_stability(CLI::App& app, Run& selected);
void add_explain(CLI::App& app, Run& selected);
void add_compare(CLI::App& app, Run& selected);
void add_lsp(CLI::App& app, Run& selected);
void add_doctor(CLI::App& app, Run& selected);
void add_reference(CLI::App& app, Run& selected);

/// The options that name a scene: FILE, -D, --asset-path, --camera.
void add_scene_options(CLI::App& app, SceneOptions& options);
/// -D, --asset-path and --camera alone.
void add_scene_values(CLI::App& app, SceneOptions& options);

/// `--precision auto|float|double`; nothing is `auto`, which `help` explains.
void add_precision_option(CLI::App& app, std::optional<compiler::Precision>& precision, const char* help);

/// The render options, or those of them that say how the picture is drawn. Bad values are CLI's usage errors.
enum class RenderOptionSet { all, picture };
void add_render_options(CLI::App& app, host::RenderOptions& options,
                        RenderOptionSet set = RenderOptionSet::all);

/// Result text: `-` is standard output.
void write_result(const std::string& path, const std::string& text);

} // namespace scc::cli
