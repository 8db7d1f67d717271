#include "compiler/cli/explain.h"

#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <charconv>
#include <memory>
#include <string_view>
#include <vector>

namespace scc::cli {

namespace {

/// The numbers of `A,B` or `A,B,C`. Throws CLI::ValidationError, which says what `option` wants.
template <class Number>
std::vector<Number> numbers(const std::string& text, std::size_t count, const char* option,
                            const char* wanted) {
    std::vector<Number> result;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        Number value{};
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{} || (next != end && *next != ',')) {
            break;
        }
        result.push_back(value);
        if (next == end) {
            if (result.size() == count) {
                return result;
            }
            break;
        }
        at = next + 1;
    }
    throw CLI::ValidationError(option, fmt::format("`{}` is not {}", text, wanted));
}

std::pair<int, int> place(const std::string& text, const char* option, const char* wanted) {
    const std::vector<int> two = numbers<int>(text, 2, option, wanted);
    if (two[0] < 0 || two[1] < 0) {
        throw CLI::ValidationError(option, fmt::format("`{}` is not {}", text, wanted));
    }
    return {two[0], two[1]};
}

int explain(const ExplainOptions& options) {
    const int chapters = (options.needs ? 1 : 0) + (options.matrices ? 1 : 0) + (options.pixel ? 1 : 0);
    if (chapters == 0) {
        throw host::UsageError("there is nothing to explain: give `--pixel X,Y`, `--matrices` or `--needs`");
    }
    if (options.json && chapters > 1) {
        throw host::UsageError("`--json` is of `--pixel`, `--matrices` or `--needs`, one at a time");
    }
    std::string text;
    if (options.matrices) {
        // Passes work transforms into shapes; the author's matrices are asked for.
        const Loaded loaded = load(options.scene, Stage::lowered);
        if (!report(loaded)) {
            return host::exit_scene;
        }
        text += explain_matrices(loaded, options);
    }
    if (options.needs || options.pixel) {
        const Loaded loaded = load(options.scene, Stage::scene);
        if (options.matrices ? loaded.diagnostics.has_errors() : !report(loaded)) {
            return host::exit_scene;
        }
        if (options.needs) {
            text += (text.empty() ? "" : "\n") + explain_needs(loaded, options);
        }
        if (options.pixel) {
            const bool is_raster = loaded.scene.settings.method == runtime::Method::raster;
            text += (text.empty() ? "" : "\n") +
                    (is_raster ? explain_raster(loaded, options) : explain_rays(loaded, options));
        }
    }
    write_result("-", text);
    return host::exit_fine;
}

} // namespace

void add_explain(CLI::App& app, Run& selected) {
    auto options = std::make_shared<ExplainOptions>();
    CLI::App* command = app.add_subcommand("explain", "tell how a picture comes about");
    add_scene_options(*command, options->scene);
    command
        ->add_option_function<std::string>(
            "--pixel",
            [options](const std::string& text) {
                options->pixel = place(text, "--pixel", "X,Y, two whole numbers from the top left corner");
            },
            "how this pixel came about: its ray, all that the ray passes, the light, mirrored and refracted "
            "rays, and the sum; in raster mode the triangles and lines on it, their depths and their light")
        ->type_name("X,Y");
    command
        ->add_option_function<std::string>(
            "--sample",
            [options](const std::string& text) {
                options->sample = place(text, "--sample", "I,J, two whole numbers from the top left corner");
            },
            "for --pixel: which of its n x n samples; else the one at its centre, or next to it")
        ->type_name("I,J");
    add_precision_option(
        *command, options->precision,
        "for --pixel: of the arithmetic; auto (default): as for the file that the scene names");
    command->add_flag(
        "--matrices", options->matrices,
        "the model, view, projection and viewport matrices in both conventions, and one point on "
        "its way through them");
    command->add_flag("--needs", options->needs,
                      "what the scene needs, which line asks for it, and in which arithmetic it is drawn");
    command
        ->add_option_function<std::string>(
            "--point",
            [options](const std::string& text) {
                const auto p = numbers<double>(text, 3, "--point", "X,Y,Z, world coordinates");
                options->point = {p[0], p[1], p[2]};
            },
            "for --matrices: this point; else the camera's target")
        ->type_name("X,Y,Z");
    add_render_options(*command, options->render, RenderOptionSet::picture);
    command->add_flag("--json", options->json, "as JSON");
    command->callback([&selected, options] { selected = [options] { return explain(*options); }; });
}

} // namespace scc::cli
