#include "compiler/backends/render.h"

#include "compiler/cli/commands.h"
#include "runtime/host/draw.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace scc::cli {

namespace {

struct Options {
    SceneOptions scene;
    host::RenderOptions render;
    std::optional<compiler::Precision> precision; ///< nothing: auto
    std::string mode = "ray";
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
