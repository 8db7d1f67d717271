#include "compiler/cli/commands.h"
#include "runtime/host/file.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <map>

namespace scc::cli {

void add_scene_values(CLI::App& app, SceneOptions& options) {
    app.add_option("-D", options.definitions, "set a param of the scene; may be repeated")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--asset-path", options.asset_paths,
                   "a further folder that the scene may read files from; may be repeated")
        ->type_name("FOLDER")
        ->allow_extra_args(false)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--camera", options.camera, "which camera, where the scene has several")
        ->type_name("NAME");
    app.add_option_function<std::string>(
           "--mode",
           [&options](const std::string& mode) {
               options.method = runtime::choice_of<runtime::Method>(runtime::method_names, mode);
           },
           "by rays or by projecting triangles; as the scene's first render says, if it is left out")
        ->check(CLI::IsMember({"ray", "raster"}))
        ->type_name("ray|raster");
    app.add_option_function<std::int64_t>(
           "--frame", [&options](std::int64_t frame) { options.frame = frame; },
           "which frame of an animated scene; the first one, if it is left out")
        ->type_name("N");
}

void add_scene_options(CLI::App& app, SceneOptions& options) {
    app.add_option("FILE", options.file, "the scene, a .scn file")->required();
    add_scene_values(app, options);
}

void add_precision_option(CLI::App& app, std::optional<compiler::Precision>& precision, const char* help) {
    static const std::map<std::string, std::optional<compiler::Precision>> names{
        {"auto", std::nullopt},
        {"float", compiler::Precision::single},
        {"double", compiler::Precision::full}};
    app.add_option_function<std::string>(
           "--precision", [&](const std::string& name) { precision = names.at(name); }, help)
        ->check(CLI::IsMember({"auto", "float", "double"}))
        ->type_name("auto|float|double");
}

void add_render_options(CLI::App& app, host::RenderOptions& options, RenderOptionSet set) {
    for (const host::OptionRow& row : host::render_option_rows()) {
        if (set == RenderOptionSet::picture && !row.picture) {
            continue;
        }
        const std::string names =
            (row.short_name != nullptr ? std::string(row.short_name) + "," : "") + row.name;
        app.add_option_function<std::string>(
               names,
               [&options, &row](const std::string& value) {
                   try {
                       row.set(options, value);
                   } catch (const host::UsageError& error) {
                       throw CLI::ValidationError(row.name, error.what());
                   }
               },
               row.help)
            ->required(row.required)
            ->type_name(row.value);
    }
}

void write_result(const std::string& path, const std::string& text) {
    if (path != "-") {
        host::replace_file(path, text);
    } else if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw host::FileError("cannot write to standard output");
    }
}

} // namespace scc::cli
