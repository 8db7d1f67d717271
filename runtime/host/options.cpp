#include "runtime/host/options.h"

#include "runtime/host/image_file.h"
#include "runtime/host/layers.h"
#include "runtime/host/parallel.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <unistd.h>
#include <vector>

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

[[noreturn]] void refuse(const std::string& value, const char* wanted) {
    throw UsageError("`" + value + "` is not " + wanted);
}

void set_size(RenderOptions& options, const std::string& text) {
    const std::vector<int> size = whole_numbers(text, 'x');
    if (size.size() != 2 || size[0] < 1 || size[1] < 1 || size[0] > max_side || size[1] > max_side) {
        refuse(text, "WxH, two whole numbers from 1 to 65536");
    }
    options.size = {size[0], size[1]};
}

void set_samples(RenderOptions& options, const std::string& text) {
    const std::vector<int> samples = whole_numbers(text, ',');
    if (samples.size() != 1 || samples[0] < 1 || samples[0] > runtime::most_samples) {
        refuse(text, "a whole number from 1 to 4096");
    }
    options.samples = samples[0];
}

void set_filter(RenderOptions& options, const std::string& text) {
    const auto& names = runtime::filter_names;
    if (std::find(names.begin(), names.end(), text) == names.end()) {
        refuse(text, "box, mitchell, gaussian or blackman_harris");
    }
    options.filter = runtime::choice_of<runtime::PixelFilter>(names, text);
}

void set_crop(RenderOptions& options, const std::string& text) {
    const std::vector<int> c = whole_numbers(text, ',');
    if (c.size() != 4 || c[0] < 0 || c[1] < 0 || c[0] >= c[2] || c[1] >= c[3]) {
        refuse(text, "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, rows from the top");
    }
    options.crop = runtime::Crop{c[0], c[1], c[2], c[3]};
}

void set_threads(RenderOptions& options, const std::string& text) {
    const std::vector<int> threads = whole_numbers(text, ',');
    if (threads.size() != 1 || threads[0] < 1 || threads[0] > 1024) {
        refuse(text, "a whole number from 1 to 1024");
    }
    options.threads = threads[0];
}

void set_bits(RenderOptions& options, const std::string& text) {
    if (text != "8" && text != "16") {
        refuse(text, "8 or 16");
    }
    options.bits = text == "8" ? 8 : 16;
}

void set_progress(RenderOptions& options, const std::string& text) {
    if (text != "auto" && text != "always" && text != "never") {
        refuse(text, "auto, always or never");
    }
    options.progress = text == "auto"     ? ProgressMode::automatic
                       : text == "always" ? ProgressMode::always
                                          : ProgressMode::never;
}

constexpr auto rows = std::to_array<OptionRow>({
    {"--output", "-o", "IMG", "the picture: .png (8 or 16 bit, sRGB), .exr or .pfm (float, linear)", false,
     true, false, [](RenderOptions& options, const std::string& text) { options.output = text; }},
    {"--size", nullptr, "WxH", "size in pixels", true, false, false, set_size},
    {"--samples", nullptr, "N", "samples per pixel; of a grid a square number", true, false, false,
     set_samples},
    {"--filter", nullptr, "NAME", "weights of samples: box, mitchell, gaussian or blackman_harris", false,
     false, false, set_filter},
    {"--threads", nullptr, "N", "threads; default: one per core", true, false, false, set_threads},
    {"--crop", nullptr, "X0,Y0,X1,Y1", "draw only these pixels, rows from the top, ends excluded", false,
     false, false, set_crop},
    {"--bits", nullptr, "8|16", "of a PNG", false, false, false, set_bits},
    {"--progress", nullptr, "auto|always|never",
     "progress line on stderr; auto: on a terminal, after a second", false, false, false, set_progress},
    {"--stats", nullptr, "FILE.json", "write times, ray counts and features as JSON; - for stdout", false,
     false, false, [](RenderOptions& options, const std::string& text) { options.stats = text; }},
    {"--aov", nullptr, "LIST",
     "further layers of the .exr: depth, planar, position, normal, uv, object, material", false, false, true,
     [](RenderOptions& options, const std::string& text) { options.aovs = parse_aovs(text); }},
});

/// An option of programs whose scene has parameters, which may be repeated.
struct ListRow {
    const char* name;
    const char* value;
    const char* help;
    std::vector<std::string> ProgramOptions::*list;
};
constexpr ListRow list_rows[] = {
    {"-D", "NAME=VALUE", "set one of the parameters; may be repeated", &ProgramOptions::definitions},
    {"--asset-path", "FOLDER", "where the scene's files are, if not in the current folder; may be repeated",
     &ProgramOptions::asset_paths},
};

void print_help(const std::string& program, const std::string& purpose, const std::string& parameters,
                bool draws_aovs) {
    std::string text = purpose + "\n\nUsage: " + program;
    for (const OptionRow& row : rows) {
        if (row.required) {
            text +=
                std::string(" ") + (row.short_name != nullptr ? row.short_name : row.name) + " " + row.value;
        }
    }
    text += " [OPTIONS]\n\nOptions:\n";
    constexpr std::size_t column = 32;
    const auto add = [&](std::string line, const char* help) {
        line.resize(std::max(line.size() + 1, column), ' ');
        text += line + help + "\n";
    };
    add("  -h,--help", "print this");
    for (const OptionRow& row : rows) {
        if (row.aov && !draws_aovs) {
            continue;
        }
        const std::string short_name = row.short_name != nullptr ? std::string(row.short_name) + "," : "";
        add("  " + short_name + row.name + " " + row.value, row.help);
    }
    if (!parameters.empty()) {
        for (const ListRow& row : list_rows) {
            add(std::string("  ") + row.name + " " + row.value, row.help);
        }
        text += "\nParameters:\n" + parameters;
    }
    std::fputs(text.c_str(), stdout);
}

/// The value if it is in the same word as the option: `--size=8x8`, `-oa.png`.
std::optional<std::string> value_in_word(const std::string& argument, const std::string& name) {
    const bool is_long = name.starts_with("--");
    const std::string head = is_long ? name + "=" : name;
    if (argument.size() > head.size() && argument.starts_with(head)) {
        return argument.substr(head.size());
    }
    return is_long && argument == head ? std::optional<std::string>("") : std::nullopt;
}

/// The arguments one by one, and the words after options that need a value.
class Arguments {
public:
    Arguments(int argc, char** argv) : words_(argv + 1, argv + argc) {}

    /// Whether there is one more, which then is current().
    bool next() { return ++at_ < words_.size(); }
    const std::string& current() const { return words_[at_]; }
    /// The current option's value, if this is its name.
    std::optional<std::string> value_of(const std::string& name, const char* wanted) {
        if (current() != name) {
            return value_in_word(current(), name);
        }
        if (!next()) {
            throw UsageError(name + " needs a value, " + wanted);
        }
        return current();
    }

private:
    std::vector<std::string> words_;
    std::size_t at_ = static_cast<std::size_t>(-1);
};

/// Whether the current argument was one of the render options, which then is set.
bool take_render_option(Arguments& arguments, RenderOptions& options, bool draws_aovs,
                        std::array<bool, rows.size()>& given) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const OptionRow& row = rows[i];
        std::optional<std::string> value = arguments.value_of(row.name, row.value);
        if (!value && row.short_name != nullptr) {
            value = arguments.value_of(row.short_name, row.value);
        }
        if (!value) {
            continue;
        }
        if (row.aov && !draws_aovs) {
            throw UsageError(
                std::string(row.name) +
                ": this program was made without AOVs; `scc build --aov` makes one that has them");
        }
        if (std::exchange(given[i], true)) {
            throw UsageError(std::string(row.name) + " is given twice");
        }
        try {
            row.set(options, *value);
        } catch (const UsageError& error) {
            throw UsageError(std::string(row.name) + ": " + error.what());
        }
        return true;
    }
    return false;
}

bool take_list_option(Arguments& arguments, ProgramOptions& options) {
    for (const ListRow& row : list_rows) {
        if (std::optional<std::string> value = arguments.value_of(row.name, row.value)) {
            (options.*row.list).push_back(std::move(*value));
            return true;
        }
    }
    return false;
}

} // namespace

std::span<const OptionRow> render_option_rows() {
    return rows;
}

std::optional<ProgramOptions> parse_program_options(int argc, char** argv, const std::string& purpose,
                                                    const std::string& parameters, bool draws_aovs) {
    ProgramOptions options;
    std::array<bool, rows.size()> given{};
    for (Arguments arguments(argc, argv); arguments.next();) {
        const std::string argument = arguments.current();
        if (argument == "-h" || argument == "--help") {
            print_help(argv[0], purpose, parameters, draws_aovs);
            return std::nullopt;
        }
        if (take_render_option(arguments, options.render, draws_aovs, given) ||
            (!parameters.empty() && take_list_option(arguments, options))) {
            continue;
        }
        throw UsageError(parameters.empty() && argument.starts_with("-D")
                             ? "the scene has no `param` that -D could set"
                             : "there is no option `" + argument + "`; --help lists them");
    }
    for (const OptionRow& row : rows) {
        if (row.required && !given[static_cast<std::size_t>(&row - rows.data())]) {
            throw UsageError(std::string(row.name) + " is required; --help lists all options");
        }
    }
    return options;
}

void check_output(const RenderOptions& options) {
    namespace fs = std::filesystem;
    if (options.output == "-") {
        throw UsageError(
            "a picture cannot go to standard output: give `-o` a file name that ends in .png, .exr or .pfm");
    }
    if (!is_image_type_known(options.output)) {
        throw UsageError("`" + options.output + "` has no known image type; it ends in .png, .exr or .pfm");
    }
    if (options.aovs != 0 && !has_layers(options.output)) {
        throw UsageError("`--aov` adds layers to an OpenEXR file: give `-o` a name that ends in .exr");
    }
    fs::path folder = fs::path(options.output).parent_path();
    if (folder.empty()) {
        folder = ".";
    }
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        throw FileError("cannot write `" + options.output + "`: there is no folder `" + folder.string() +
                        "`");
    }
    if (access(folder.c_str(), W_OK) != 0) {
        throw FileError("cannot write `" + options.output + "`: the folder `" + folder.string() +
                        "` is not writable");
    }
    if (fs::is_directory(options.output, error)) {
        throw FileError("cannot write `" + options.output + "`: it is a folder");
    }
}

int thread_count(const RenderOptions& options) {
    return options.threads > 0 ? options.threads : core_count();
}

runtime::RenderRequest make_request(const RenderOptions& options, const runtime::RenderSettings& scene) {
    runtime::RenderRequest request;
    request.settings = scene;
    if (options.size) {
        request.settings.width = options.size->first;
        request.settings.height = options.size->second;
    }
    request.settings.samples = options.samples.value_or(scene.samples);
    request.settings.filter = options.filter.value_or(scene.filter);
    if (scene.method == runtime::Method::raster && request.settings.filter != runtime::PixelFilter::box) {
        throw UsageError("--filter: a raster picture takes the mean of a pixel's samples");
    }
    if (!runtime::fits_sampler(request.settings)) {
        throw UsageError(
            "--samples: " + std::to_string(request.settings.samples) +
            " samples make no grid; their number is a square (1, 4, 9, 16, ...) unless the scene "
            "has `sampler = \"low_discrepancy\"`");
    }
    request.threads = thread_count(options);
    request.crop =
        options.crop.value_or(runtime::Crop{0, 0, request.settings.width, request.settings.height});
    if (request.crop.x1 > request.settings.width || request.crop.y1 > request.settings.height) {
        throw UsageError("the crop reaches to (" + std::to_string(request.crop.x1) + ", " +
                         std::to_string(request.crop.y1) + "); the picture has " +
                         std::to_string(request.settings.width) + " x " +
                         std::to_string(request.settings.height) + " pixels");
    }
    return request;
}

} // namespace scc::host
