#pragma once

#include "runtime/render_request.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
}

/// The render options, shared by `scc render` and the programs that `scc build` makes.
namespace scc::host {

/// Exit codes of the command line; they are a contract.
enum ExitCode : int {
    exit_fine = 0,
    exit_scene = 1,
    exit_usage = 2,
    exit_environment = 3,
    exit_interrupted = 130
};

/// The command line's fault.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class ProgressMode { automatic, always, never };

struct RenderOptions {
    std::string output;
    std::optional<std::pair<int, int>> size;
    std::optional<int> samples_per_axis;
    std::optional<runtime::Crop> crop;
    int threads = 0; ///< 0: one per core
    int bits = 8;
    ProgressMode progress = ProgressMode::automatic;
    std::string stats; ///< file, `-` for standard output, or empty
};

/// Adds the options to a command; the texts are parsed as the command line is read, bad ones are CLI's usage
/// errors.
void add_render_options(CLI::App& app, RenderOptions& options);
/// Those of them that say how the picture is drawn: --size, --samples, --threads.
void add_picture_options(CLI::App& app, RenderOptions& options);

/// What can be told before any work: an unknown image type, `-o -` (UsageError), a folder that cannot be
/// written (FileError).
void check_output(const RenderOptions& options);

/// The scene's settings with the command line's on top. Throws UsageError for a crop outside the picture.
runtime::RenderRequest make_request(const RenderOptions& options, const runtime::RenderSettings& scene);

} // namespace scc::host
