#include "compiler/backends/render.h"

#include "compiler/cli/commands.h"
#include "runtime/host/draw.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace scc::cli {

namespace {

struct Options {
    SceneOptions scene;
    host::RenderOptions render;
    std::optional<compiler::Precision> precision;                ///< nothing: auto
    std::optional<std::pair<std::int64_t, std::int64_t>> frames; ///< the last one excluded
    runtime::BuildQuality quality = runtime::BuildQuality::high;
};

host::Drawable make_drawable(const compiler::ir::Scene& scene, const Options& options) {
    const runtime::BuildOptions build{host::thread_count(options.render), options.quality};
    if (options.precision) {
        host::Drawable drawable = compiler::make_drawable(scene, *options.precision, build);
        drawable.precision_reason = "asked for";
        return drawable;
    }
    if (!host::keeps_8_bits(options.render.output, options.render.bits)) {
        host::Drawable drawable = compiler::make_drawable(scene, compiler::Precision::full, build);
        drawable.precision_reason = "the file keeps more than 8 bits of each value";
        return drawable;
    }
    const runtime::RenderRequest request = make_request(options.render, scene.settings);
    return compiler::make_drawable_for_8_bits(scene, request.settings, build);
}

std::pair<std::int64_t, std::int64_t> parse_frames(const std::string& text) {
    std::pair<std::int64_t, std::int64_t> frames;
    const std::string_view view = text;
    const std::size_t dots = view.find("..");
    const auto number = [](std::string_view part, std::int64_t& value) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        return error == std::errc() && end == part.data() + part.size();
    };
    if (dots == std::string_view::npos || !number(view.substr(0, dots), frames.first) ||
        !number(view.substr(dots + 2), frames.second) || frames.first >= frames.second) {
        throw CLI::ValidationError("--frames",
                                   fmt::format("`{}` is not A..B, two whole numbers of which B, which is "
                                               "excluded, is the greater",
                                               text));
    }
    return frames;
}

/// `####` is the number with at least as many digits; without it `_0001` goes before the extension.
std::string name_of_frame(const std::string& output, std::int64_t frame) {
    const std::size_t last = output.find_last_of('#');
    const std::size_t folder = output.find_last_of('/');
    if (last == std::string::npos || (folder != std::string::npos && last < folder)) {
        std::filesystem::path path(output);
        path.replace_filename(
            fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()));
        return path.string();
    }
    const std::size_t before = output.find_last_not_of('#', last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    return fmt::format("{}{:0{}}{}", output.substr(0, first), frame, last - first + 1,
                       output.substr(last + 1));
}

int render_one(const Options& options) {
    check_output(options.render);
    const Loaded loaded = load(options.scene, Stage::scene);
    if (!report(loaded)) {
        return host::exit_scene;
    }
    host::Drawable drawable = make_drawable(loaded.scene, options);
    drawable.times_ms.insert(drawable.times_ms.begin(), loaded.times_ms.begin(), loaded.times_ms.end());
    return draw(drawable, options.render);
}

int render(Options options) {
    if (!options.frames) {
        return render_one(options);
    }
    const std::string output = options.render.output;
    for (std::int64_t frame = options.frames->first; frame < options.frames->second; ++frame) {
        options.scene.frame = frame;
        options.render.output = name_of_frame(output, frame);
        if (const int code = render_one(options); code != host::exit_fine) {
            return code;
        }
    }
    return host::exit_fine;
}

} // namespace

void add_render(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("render", "draw a scene in this process");
    add_scene_options(*command, options->scene);
    add_render_options(*command, options->render);
    add_precision_option(
        *command, options->precision,
        "of the arithmetic; auto (default): float where an 8-bit picture does not show it, else "
        "double");
    command
        ->add_option_function<std::string>(
            "--frames", [options](const std::string& text) { options->frames = parse_frames(text); },
            "frames of an animated scene, B excluded, each into a file of its own: `####` in the name is the "
            "number, else `_0001` is added to it")
        ->excludes("--frame")
        ->type_name("A..B");
    static const std::map<std::string, runtime::BuildQuality> qualities{
        {"sah", runtime::BuildQuality::high}, {"quick", runtime::BuildQuality::quick}};
    command
        ->add_option_function<std::string>(
            "--accel", [options](const std::string& name) { options->quality = qualities.at(name); },
            "hierarchies over meshes and shapes: by the surface area heuristic (default), or built "
            "somewhat faster for a preview, whose rays are slower; the same picture")
        ->check(CLI::IsMember({"sah", "quick"}))
        ->type_name("sah|quick");
    command->callback([&selected, options] { selected = [options] { return render(*options); }; });
}

} // namespace scc::cli
