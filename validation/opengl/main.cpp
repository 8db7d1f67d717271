#include "compiler/backends/raster_scene.h"
#include "compiler/backends/render.h"
#include "compiler/pipeline.h"
#include "runtime/host/file.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"
#include "validation/opengl/fixed_function.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>
#include <stdexcept>

/// Draws a scene by OpenGL's fixed functions: a program of its own, so that scc does not carry Mesa along.
namespace scc::validation {
namespace {

struct Options {
    compiler::SceneOptions scene;
    host::RenderOptions render;
};

/// OpenGL cannot draw it.
struct Unsupported : std::runtime_error {
    using std::runtime_error::runtime_error;
};

runtime::Image draw(const compiler::ir::Scene& scene, const runtime::RenderSettings& settings) {
    runtime::Image image;
    compiler::with_tables(scene, [&](const runtime::DynamicScene<double>& tables) {
        const runtime::RasterModel<double> model = compiler::raster_model_of(tables, settings);
        if (const std::string why = unsupported_by_opengl(tables, model, settings); !why.empty()) {
            throw Unsupported(why);
        }
        OpenGlPicture picture = draw_by_opengl(tables, model, settings);
        if (!picture.error.empty()) {
            throw std::runtime_error(picture.error);
        }
        image = std::move(picture.image);
    });
    return image;
}

int run(const Options& options) {
    const compiler::Loaded loaded = compiler::load(options.scene, compiler::Stage::scene);
    if (!compiler::report(loaded)) {
        return host::exit_scene;
    }
    const runtime::RenderRequest request = host::make_request(options.render, loaded.scene.settings);
    host::write_image(options.render.output, draw(loaded.scene, request.settings));
    return host::exit_fine;
}

int fail(int code, const char* text) {
    std::fputs(fmt::format("error: {}\n", text).c_str(), stderr);
    return code;
}

} // namespace
} // namespace scc::validation

int main(int argc, char** argv) {
    using namespace scc;
    validation::Options options;
    options.scene.method = runtime::Method::raster;
    CLI::App app(
        "Draws the raster picture of a scene by OpenGL's fixed functions (Mesa, without a display).");
    app.add_option("FILE", options.scene.file, "the scene, a .scn file")->required();
    app.add_option("-D", options.scene.definitions, "set a param of the scene")->type_name("NAME=VALUE");
    app.add_option("--asset-path", options.scene.asset_paths, "a further folder for files")
        ->type_name("FOLDER");
    app.add_option("--camera", options.scene.camera, "which camera");
    for (const host::OptionRow& row : host::render_option_rows()) {
        if (row.picture || row.required) {
            app.add_option_function<std::string>(
                   row.short_name != nullptr ? std::string(row.short_name) + "," + row.name : row.name,
                   [&](const std::string& value) { row.set(options.render, value); }, row.help)
                ->required(row.required)
                ->type_name(row.value);
        }
    }
    app.set_version_flag("--version", "scc-opengl " SCC_VERSION);
    CLI11_PARSE(app, argc, argv);
    try {
        return validation::run(options);
    } catch (const validation::Unsupported& error) {
        return validation::fail(host::exit_scene, error.what());
    } catch (const host::UsageError& error) {
        return validation::fail(host::exit_usage, error.what());
    } catch (const std::exception& error) {
        return validation::fail(host::exit_environment, error.what());
    }
}
