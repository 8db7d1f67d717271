#pragma once

#include "runtime/aov.h"
#include "runtime/render_request.h"

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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
    std::optional<int> samples;
    std::optional<runtime::PixelFilter> filter;
    std::optional<runtime::Crop> crop;
    int threads = 0; ///< 0: one per core
    int bits = 8;
    ProgressMode progress = ProgressMode::automatic;
    runtime::AovSet aovs = 0;
    std::string stats; ///< file, `-` for standard output, or empty
};

/// One of the render options, as the command line has it: always a name and a value.
struct OptionRow {
    const char* name;       ///< with its dashes
    const char* short_name; ///< or null
    const char* value;      ///< what stands for the value in the help
    const char* help;
    bool picture; ///< says how a picture is drawn that is compared with others', and not where it goes
    bool required;
    bool aov; ///< of programs that draw AOVs only
    /// Throws UsageError for a bad value; the text says what a good one is.
    void (*set)(RenderOptions&, const std::string& value);
};
/// All of them: the one table that scc's commands and the programs' own command line are made from.
std::span<const OptionRow> render_option_rows();

struct ProgramOptions {
    RenderOptions render;
    std::vector<std::string> definitions; ///< -D NAME=VALUE
    std::vector<std::string> asset_paths;
};

/// A built program's command line. Nothing if it asked for `--help`, which then was printed with `purpose` at
/// its head. `parameters` lists those that `-D` can set, a line each; without any there is no such option,
/// nor is there `--aov` unless `draws_aovs`. Throws UsageError.
std::optional<ProgramOptions> parse_program_options(int argc, char** argv, const std::string& purpose,
                                                    const std::string& parameters, bool draws_aovs);

/// What can be told before any work: an unknown image type, `-o -`, AOVs for a type without layers
/// (UsageError), a folder that cannot be
/// written (FileError).
void check_output(const RenderOptions& options);

/// At least one.
int thread_count(const RenderOptions& options);

/// The scene's settings with the command line's on top. Throws UsageError for a crop outside the picture, and
/// for samples that make no grid where the scene's sampler is one.
runtime::RenderRequest make_request(const RenderOptions& options, const runtime::RenderSettings& scene);

} // namespace scc::host
