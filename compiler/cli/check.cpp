#include "compiler/cli/commands.h"
#include "lang/fixes.h"
#include "lang/type.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <map>
#include <memory>
#include <string>

namespace scc::cli {

namespace {

using Json = nlohmann::ordered_json;

struct CheckOptions {
    SceneOptions scene;
    std::vector<std::string> files;
    bool strict = false;
    bool json = false;
    bool fix = false;
};

const char* name_of(lang::Severity severity) {
    switch (severity) {
    case lang::Severity::note:
        return "note";
    case lang::Severity::warning:
        return "warning";
    case lang::Severity::error:
        return "error";
    }
    return "";
}

Json place(const lang::SourceSet& sources, lang::Span span) {
    if (!sources.contains(span.file)) {
        return nullptr;
    }
    const lang::SourceFile& file = sources.file(span.file);
    const lang::Position begin = file.position(span.begin);
    const lang::Position end = file.position(span.end);
    return {{"file", file.path()},
            {"line", begin.line},
            {"column", begin.column},
            {"end_line", end.line},
            {"end_column", end.column}};
}

Json to_json(const lang::SourceSet& sources, const lang::Diagnostic& diagnostic) {
    Json json{{"severity", name_of(diagnostic.severity)},
              {"name", lang::row(diagnostic.kind).name},
              {"message", diagnostic.message},
              {"place", place(sources, diagnostic.span)}};
    Json notes = Json::array();
    for (const lang::Note& note : diagnostic.notes) {
        notes.push_back({{"message", note.text}, {"place", place(sources, note.span)}});
    }
    json["notes"] = std::move(notes);
    if (diagnostic.fix) {
        json["fix"] = {{"replacement", diagnostic.fix->replacement},
                       {"place", place(sources, diagnostic.fix->span)}};
    }
    return json;
}

using FixCounts = std::map<std::string, std::size_t>; ///< by file

/// Writes the fixes of one file into it, which leaves it whole. True if there were any.
bool mend_file(const Loaded& loaded, lang::FileId id, FixCounts& fixed) {
    const lang::SourceFile& file = loaded.sources.file(id);
    const std::vector<lang::Fix> fixes = lang::fixes_for(id, loaded.diagnostics.sorted());
    if (fixes.empty()) {
        return false;
    }
    host::replace_file(file.path(), lang::with_fixes(file.text(), fixes));
    fixed[file.path()] += fixes.size();
    return true;
}

/// Checks a scene and writes the fixes of its mistakes into its file and those that it imports, until what is
/// left has none: a mistake can hide others.
Loaded mend(const SceneOptions& scene, FixCounts& fixed) {
    constexpr int most_rounds = 20; // a fix that leads to another one can go on for ever
    constexpr lang::FileId scene_file = 0;
    for (int round = 0;; ++round) {
        Loaded loaded = load(scene, Stage::scene);
        if (round == most_rounds) {
            return loaded;
        }
        bool any = mend_file(loaded, scene_file, fixed);
        for (const lang::FileId import : loaded.module.imports) {
            any = mend_file(loaded, import, fixed) || any;
        }
        if (!any) {
            return loaded;
        }
    }
}

int check(const CheckOptions& options) {
    bool fine = true;
    std::size_t fixed = 0;
    Json all = Json::array();
    for (const std::string& file : options.files) {
        SceneOptions scene = options.scene;
        scene.file = file;
        FixCounts counts;
        Loaded loaded = options.fix ? mend(scene, counts) : load(scene, Stage::scene);
        for (const auto& [path, count] : counts) {
            fmt::print(stderr, "{}: {} fix{} made\n", path, count, count == 1 ? "" : "es");
            fixed += count;
        }
        if (options.strict) {
            loaded.diagnostics.promote_warnings();
        }
        if (options.json) {
            for (const lang::Diagnostic& diagnostic : loaded.diagnostics.sorted()) {
                all.push_back(to_json(loaded.sources, diagnostic));
            }
            fine &= !loaded.diagnostics.has_errors();
        } else {
            fine &= report(loaded);
        }
    }
    if (options.json) {
        Json json{{"schema", 1}, {"diagnostics", all}};
        if (options.fix) {
            json["fixed"] = fixed;
        }
        write_result("-", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    }
    return fine ? host::exit_fine : host::exit_scene;
}

struct ParamsOptions {
    SceneOptions scene;
    bool json = false;
};

Json to_json(const lang::Param& param) {
    Json json{{"name", param.name},
              {"type", lang::to_string(param.type)},
              {"default", lang::to_string(param.default_value)},
              {"value", lang::to_string(param.value)},
              {"text", param.text}};
    json["range"] = param.range ? Json{param.range->first, param.range->second} : Json(nullptr);
    return json;
}

int list_params(const ParamsOptions& options) {
    const Loaded loaded = load(options.scene, Stage::module);
    if (!report(loaded)) {
        return host::exit_scene;
    }
    std::string text;
    Json json = Json::array();
    for (const lang::Param& param : loaded.module.params) {
        text += compiler::described(param) + "\n";
        json.push_back(to_json(param));
    }
    write_result("-", options.json ? Json{{"schema", 1}, {"params", json}}.dump(2) + "\n" : text);
    return host::exit_fine;
}

} // namespace

void add_check(CLI::App& app, Run& selected) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command = app.add_subcommand("check", "say what is wrong with scenes, all of it");
    command->add_option("FILE", options->files, "scenes, .scn files")->required();
    add_scene_values(*command, options->scene);
    command->add_flag("--strict", options->strict, "warnings are errors");
    command->add_flag(
        "--fix", options->fix,
        "write the replacements that are shown into the files and those that they import, then say what is "
        "left");
    command->add_flag("--json", options->json, "diagnostics as JSON on standard output");
    command->callback([&selected, options] { selected = [options] { return check(*options); }; });
}

void add_params(CLI::App& app, Run& selected) {
    auto options = std::make_shared<ParamsOptions>();
    CLI::App* command = app.add_subcommand("params", "list what `-D` can set in a scene");
    add_scene_options(*command, options->scene);
    command->add_flag("--json", options->json, "as JSON");
    command->callback([&selected, options] { selected = [options] { return list_params(*options); }; });
}

} // namespace scc::cli
