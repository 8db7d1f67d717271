#include "runtime/host/program.h"

#include "runtime/host/draw.h"
#include "runtime/host/file.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scc::host {

namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Aligned as the values in a mapped file are.
class AlignedBytes {
public:
    explicit AlignedBytes(std::string_view bytes)
        : blocks_((bytes.size() + sizeof(Block) - 1) / sizeof(Block)), size_(bytes.size()) {
        std::memcpy(blocks_.data(), bytes.data(), size_);
    }
    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(blocks_)).first(size_); }

private:
    struct alignas(64) Block {
        std::byte bytes[64];
    };
    std::vector<Block> blocks_;
    std::size_t size_;
};

/// A program's scene: what is said of it before its numbers, and these.
struct Opened {
    std::string name;
    runtime::RenderSettings settings;
    std::string source;     ///< of a scene with parameters, as the compiler packed it
    std::string parameters; ///< for people, a line each
    SceneNames names;       ///< with AOVs
    Values values;          ///< the rest of them
};

/// Of values as they are at the end of a program's file.
Opened open_values(const Program& program, std::span<const std::byte> bytes) {
    Opened opened;
    opened.values = Values(bytes, "this program");
    opened.name = opened.values.read_text();
    opened.values.read(opened.settings);
    if (program.redefine != nullptr) {
        opened.source = opened.values.read_text();
        opened.parameters = opened.values.read_text();
    }
    if (program.draw_aovs != nullptr) {
        opened.names.read(opened.values);
    }
    return opened;
}

/// `file` keeps what is read from it in memory.
Opened open(const Program& program, std::optional<MappedFile>& file) {
    if (program.scene == nullptr) {
        file.emplace("/proc/self/exe");
        return open_values(program, file->bytes());
    }
    Opened opened{.name = program.scene,
                  .settings = program.settings,
                  .source = {},
                  .parameters = {},
                  .names = {},
                  .values = {}};
    if (program.values != nullptr) {
        opened.values = Values(std::as_bytes(std::span(program.values, program.values_size)), program.scene);
    }
    if (program.draw_aovs != nullptr) {
        opened.names.read(opened.values);
    }
    return opened;
}

/// Fills the scene, the greater part of which may stay where the values are.
Drawable load(const Program& program, Opened& opened) {
    const auto start = std::chrono::steady_clock::now();
    program.load(opened.values);
    Drawable drawable{.scene = opened.name,
                      .precision = program.precision,
                      .precision_reason = "the program was made for it",
                      .isa = program.isa,
                      .features = {},
                      .settings = opened.settings,
                      .times_ms = {{"accel", milliseconds_since(start)}},
                      .render = program.draw,
                      .draw_aovs = program.draw_aovs,
                      .names = [&names = opened.names] { return names; }};
    for (const char* const* feature = program.features; *feature != nullptr; ++feature) {
        drawable.features.emplace_back(*feature);
    }
    return drawable;
}

std::string purpose_of(const Opened& opened) {
    const runtime::RenderSettings& settings = opened.settings;
    return "Draws the scene `" + opened.name + "`, for which this program was made. Default size " +
           std::to_string(settings.width) + " x " + std::to_string(settings.height) + ", " +
           std::to_string(settings.samples) + " samples per pixel.";
}

void check_filter(const Program& program, const RenderOptions& options) {
    if (!program.has_filters &&
        options.filter.value_or(runtime::PixelFilter::box) != runtime::PixelFilter::box) {
        throw UsageError(
            "--filter: this program has the box alone, since its scene takes the mean of a grid; "
            "`filter` in the scene's `ray { }` brings the others");
    }
}

int fail(int code, const char* text) {
    std::fputs((std::string("error: ") + text + "\n").c_str(), stderr);
    return code;
}

} // namespace

int run_program(const Program& program, int argc, char** argv) {
    try {
        std::optional<MappedFile> file;
        Opened opened = open(program, file);
        const std::optional<ProgramOptions> options = parse_program_options(
            argc, argv, purpose_of(opened), opened.parameters, program.draw_aovs != nullptr);
        if (!options) {
            return exit_fine;
        }
        check_filter(program, options->render);
        std::optional<AlignedBytes> redefined;
        if (!options->definitions.empty()) {
            redefined.emplace(
                program.redefine({opened.source, program.structure, program.precision, options->definitions,
                                  options->asset_paths, program.draw_aovs != nullptr}));
            opened = open_values(program, redefined->bytes());
        }
        const Drawable drawable = load(program, opened);
        if (drawable.precision == "float" && !keeps_8_bits(options->render.output, options->render.bits)) {
            std::fputs(
                "note: this program calculates in float and this file could hold more digits; `scc build "
                "--precision double` makes a program that has them\n",
                stderr);
        }
        return draw(drawable, options->render);
    } catch (const SceneError&) {
        return exit_scene;
    } catch (const UsageError& error) {
        return fail(exit_usage, error.what());
    } catch (const FileError& error) {
        return fail(exit_environment, error.what());
    } catch (const std::bad_alloc&) {
        return fail(exit_environment, "there is not enough memory for this picture");
    }
}

} // namespace scc::host
