#include "compiler/backends/render.h"

#include "compiler/cli/commands.h"
#include "runtime/host/draw.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>

namespace scc::cli {

namespace {

struct Options {
    SceneOptions scene;
    host::RenderOptions render;
    std::optional<compiler::Precision> precision; ///< nothing: auto
    std::string mode = "ray";
};

host::Drawable make_drawable(const compiler::ir::Scene& scene, const Options& options) {
    if (options.precision) {
        host::Drawable drawable = compiler::make_drawable(scene, *options.precision);
        drawable.precision_reason = "asked for";
        return drawable;
    }
    if (!host::keeps_8_bits(options.render.output, options.render.bits)) {
        host::Drawable drawable = compiler::make_drawable(scene, compiler::Precision::full);
        drawable.precision_reason = "the file keeps more than 8 bits of each value";
        return drawable;
    }
    const runtime::RenderRequest request = make_request(options.render, scene.settings);
    return compiler::make_drawable_for_8_bits(scene, request.settings, request.threads);
}

int render(const Options& options) {
    if (options.mode == "raster") {
        throw host::UsageError("raster mode is not supported yet; leave out `--mode raster`");
    }
    check_output(options.render);
    const Loaded loaded = load(options.scene, Stage::scene);
    if (!report(loaded)) {
        return host::exit_scene;
    }
    host::Drawable drawable = make_drawable(loaded.scene, options);
    drawable.times_ms.insert(drawable.times_ms.begin(), loaded.times_ms.begin(), loaded.times_ms.end());
    return draw(drawable, options.render);
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
    command->add_option("--mode", options->mode, "ray casting (raster is not supported yet)")
        ->check(CLI::IsMember({"ray", "raster"}))
        ->type_name("ray|raster");
    command->callback([&selected, options] { selected = [options] { return render(*options); }; });
}

} // namespace scc::cli
