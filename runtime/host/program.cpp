#include "runtime/host/program.h"

#include "runtime/host/draw.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>
#include <new>

namespace scc::host {

namespace {

Drawable drawable_of(const Program& program) {
    Drawable drawable{.scene = program.scene,
                      .precision = program.precision,
                      .isa = program.isa,
                      .features = {},
                      .settings = program.settings,
                      .times_ms = {},
                      .render = program.render};
    for (const char* const* feature = program.features; *feature != nullptr; ++feature) {
        drawable.features.emplace_back(*feature);
    }
    return drawable;
}

int fail(int code, const char* text) {
    fmt::print(stderr, "error: {}\n", text);
    return code;
}

} // namespace

int run_program(const Program& program, int argc, char** argv) {
    CLI::App app{fmt::format(
        "Draws the scene `{}`, for which this program was made. Default size {} x {}, {} samples per pixel.",
        program.scene, program.settings.width, program.settings.height,
        program.settings.samples_per_axis * program.settings.samples_per_axis)};
    RenderOptions options;
    add_render_options(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_fine : exit_usage;
    }
    try {
        return draw(drawable_of(program), options);
    } catch (const UsageError& error) {
        return fail(exit_usage, error.what());
    } catch (const FileError& error) {
        return fail(exit_environment, error.what());
    } catch (const std::bad_alloc&) {
        return fail(exit_environment, "there is not enough memory for this picture");
    }
}

} // namespace scc::host
