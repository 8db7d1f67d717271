#include "runtime/host/program.h"

#include "runtime/host/draw.h"
#include "runtime/host/file.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <chrono>
#include <cstdio>
#include <new>
#include <optional>
#include <span>
#include <string>

namespace scc::host {

namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Fills the scene, the greater part of which may stay in the mapped file.
Drawable load(const Program& program, std::optional<MappedFile>& file) {
    const auto start = std::chrono::steady_clock::now();
    Drawable drawable{.scene = {},
                      .precision = program.precision,
                      .precision_reason = "the program was made for it",
                      .isa = program.isa,
                      .features = {},
                      .settings = program.settings,
                      .times_ms = {},
                      .render = program.draw};
    for (const char* const* feature = program.features; *feature != nullptr; ++feature) {
        drawable.features.emplace_back(*feature);
    }
    Values values;
    if (program.scene == nullptr) {
        file.emplace("/proc/self/exe");
        values = Values(file->bytes(), "this program");
        drawable.scene = values.read_text();
        values.read(drawable.settings);
    } else {
        drawable.scene = program.scene;
        if (program.values != nullptr) {
            values = Values(std::as_bytes(std::span(program.values, program.values_size)), program.scene);
        }
    }
    program.load(values);
    drawable.times_ms.emplace_back("accel", milliseconds_since(start));
    return drawable;
}

int fail(int code, const char* text) {
    std::fputs((std::string("error: ") + text + "\n").c_str(), stderr);
    return code;
}

} // namespace

int run_program(const Program& program, int argc, char** argv) {
    try {
        std::optional<MappedFile> file;
        const Drawable drawable = load(program, file);
        const runtime::RenderSettings& settings = drawable.settings;
        const std::optional<RenderOptions> options = parse_program_options(
            argc, argv,
            "Draws the scene `" + drawable.scene + "`, for which this program was made. Default size " +
                std::to_string(settings.width) + " x " + std::to_string(settings.height) + ", " +
                std::to_string(settings.samples_per_axis * settings.samples_per_axis) +
                " samples per pixel.");
        if (!options) {
            return exit_fine;
        }
        if (drawable.precision == "float" && !keeps_8_bits(options->output, options->bits)) {
            std::fputs(
                "note: this program calculates in float and this file could hold more digits; `scc build "
                "--precision double` makes a program that has them\n",
                stderr);
        }
        return draw(drawable, *options);
    } catch (const UsageError& error) {
        return fail(exit_usage, error.what());
    } catch (const FileError& error) {
        return fail(exit_environment, error.what());
    } catch (const std::bad_alloc&) {
        return fail(exit_environment, "there is not enough memory for this picture");
    }
}

} // namespace scc::host
