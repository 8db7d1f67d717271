#include "runtime/host/options.h"

#include "runtime/host/image_file.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <thread>
#include <unistd.h>

namespace scc::host {

namespace {

constexpr int max_side = 65536;

// The whole numbers of `text`, which has exactly one `separator` between each two; empty if it is anything
// else.
std::vector<int> whole_numbers(std::string_view text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        int value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{}) {
            return {};
        }
        numbers.push_back(value);
        if (next == end) {
            return numbers;
        }
        if (*next != separator) {
            return {};
        }
        at = next + 1;
    }
}

void set_size(RenderOptions& options, const std::string& text) {
    const std::vector<int> size = whole_numbers(text, 'x');
    if (size.size() != 2 || size[0] < 1 || size[1] < 1 || size[0] > max_side || size[1] > max_side) {
        throw CLI::ValidationError(
            "--size", fmt::format("`{}` is not WxH, two whole numbers from 1 to {}", text, max_side));
    }
    options.size = {size[0], size[1]};
}

void set_samples(RenderOptions& options, int samples) {
    const int root = samples > 0 ? static_cast<int>(std::lround(std::sqrt(samples))) : 0;
    if (root < 1 || root > 64 || root * root != samples) {
        throw CLI::ValidationError(
            "--samples", fmt::format("{} is not a square number from 1 to 4096 (1, 4, 9, 16, ...)", samples));
    }
    options.samples_per_axis = root;
}

void set_crop(RenderOptions& options, const std::string& text) {
    const std::vector<int> c = whole_numbers(text, ',');
    if (c.size() != 4 || c[0] < 0 || c[1] < 0 || c[0] >= c[2] || c[1] >= c[3]) {
        throw CLI::ValidationError(
            "--crop",
            fmt::format("`{}` is not X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, rows from the top", text));
    }
    options.crop = runtime::Crop{c[0], c[1], c[2], c[3]};
}

int core_count() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

} // namespace

void add_picture_options(CLI::App& app, RenderOptions& options) {
    app.add_option_function<std::string>(
           "--size", [&](const std::string& text) { set_size(options, text); }, "size in pixels")
        ->type_name("WxH");
    app.add_option_function<int>(
           "--samples", [&](const int& n) { set_samples(options, n); }, "samples per pixel, a square number")
        ->type_name("N");
    app.add_option("--threads", options.threads, "threads; default: one per core")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
}

void add_render_options(CLI::App& app, RenderOptions& options) {
    app.add_option("-o,--output", options.output,
                   "the picture: .png (8 or 16 bit, sRGB), .exr or .pfm (float, linear)")
        ->required()
        ->type_name("IMG");
    add_picture_options(app, options);
    app.add_option_function<std::string>(
           "--crop", [&](const std::string& text) { set_crop(options, text); },
           "draw only these pixels, rows from the top, ends excluded")
        ->type_name("X0,Y0,X1,Y1");
    app.add_option("--bits", options.bits, "of a PNG")->check(CLI::IsMember({8, 16}))->type_name("8|16");
    static const std::map<std::string, ProgressMode> modes{
        {"auto", ProgressMode::automatic}, {"always", ProgressMode::always}, {"never", ProgressMode::never}};
    app.add_option_function<std::string>(
           "--progress", [&](const std::string& mode) { options.progress = modes.at(mode); },
           "progress line on stderr; auto: on a terminal, after a second")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->type_name("auto|always|never");
    app.add_option("--stats", options.stats, "write times, ray counts and features as JSON; - for stdout")
        ->type_name("FILE.json");
}

void check_output(const RenderOptions& options) {
    namespace fs = std::filesystem;
    if (options.output == "-") {
        throw UsageError(
            "a picture cannot go to standard output: give `-o` a file name that ends in .png, .exr or .pfm");
    }
    if (!is_image_type_known(options.output)) {
        throw UsageError(
            fmt::format("`{}` has no known image type; it ends in .png, .exr or .pfm", options.output));
    }
    fs::path folder = fs::path(options.output).parent_path();
    if (folder.empty()) {
        folder = ".";
    }
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        throw FileError(
            fmt::format("cannot write `{}`: there is no folder `{}`", options.output, folder.string()));
    }
    if (access(folder.c_str(), W_OK) != 0) {
        throw FileError(fmt::format("cannot write `{}`: the folder `{}` is not writable", options.output,
                                    folder.string()));
    }
    if (fs::is_directory(options.output, error)) {
        throw FileError(fmt::format("cannot write `{}`: it is a folder", options.output));
    }
}

runtime::RenderRequest make_request(const RenderOptions& options, const runtime::RenderSettings& scene) {
    runtime::RenderRequest request;
    request.settings = scene;
    if (options.size) {
        request.settings.width = options.size->first;
        request.settings.height = options.size->second;
    }
    if (options.samples_per_axis) {
        request.settings.samples_per_axis = *options.samples_per_axis;
    }
    request.threads = options.threads > 0 ? options.threads : core_count();
    request.crop =
        options.crop.value_or(runtime::Crop{0, 0, request.settings.width, request.settings.height});
    if (request.crop.x1 > request.settings.width || request.crop.y1 > request.settings.height) {
        throw UsageError(fmt::format("the crop reaches to ({}, {}); the picture has {} x {} pixels",
                                     request.crop.x1, request.crop.y1, request.settings.width,
                                     request.settings.height));
    }
    return request;
}

} // namespace scc::host
