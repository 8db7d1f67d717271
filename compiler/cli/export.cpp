#include "compiler/cli/export.h"

#include "compiler/backends/table.h"
#include "compiler/cli/commands.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace scc::cli {

namespace {

struct Options {
    SceneOptions scene;
    std::string target;
    std::string output;
    std::string ledger;
    bool allow_drop = false;
};

const char* name_of(compiler::Fidelity fidelity) {
    switch (fidelity) {
    case compiler::Fidelity::exact:
        return "exact";
    case compiler::Fidelity::approximated:
        return "approximated";
    case compiler::Fidelity::dropped:
        return "dropped";
    }
    return "";
}

std::string place(const lang::SourceSet& sources, lang::Span span) {
    if (!sources.contains(span.file)) { // made by scc: a default camera, a headlight
        return "";
    }
    const lang::SourceFile& file = sources.file(span.file);
    const lang::Position position = file.position(span.begin);
    return fmt::format("{}:{}:{}", file.path(), position.line, position.column);
}

std::string ledger_json(const std::vector<validation::LedgerRow>& rows) {
    nlohmann::ordered_json features = nlohmann::ordered_json::array();
    for (const validation::LedgerRow& row : rows) {
        nlohmann::ordered_json entry{{"fidelity", row.fidelity},
                                     {"feature", row.feature},
                                     {"subject", row.subject},
                                     {"place", row.place},
                                     {"how", row.how}};
        if (row.bound > 0) {
            entry["bound"] = row.bound;
        }
        features.push_back(std::move(entry));
    }
    const nlohmann::ordered_json json{{"schema", 1}, {"features", features}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

int export_scene(const Options& options) {
    Loaded loaded = load(options.scene, Stage::scene);
    if (loaded.diagnostics.has_errors()) {
        report(loaded);
        return host::exit_scene;
    }
    const compiler::Exporter& exporter = *compiler::find_exporter(options.target);
    compiler::Ledger ledger;
    compiler::ExportFiles beside{.stem = std::filesystem::path(options.output).stem().string()};
    const std::string text = exporter.emit(loaded.scene, ledger, beside);
    for (const compiler::LedgerEntry& entry : ledger) {
        if (entry.fidelity == compiler::Fidelity::dropped) {
            const lang::Diag kind = options.allow_drop ? lang::Diag::dropped : lang::Diag::not_exportable;
            loaded.diagnostics.report(kind, entry.span, entry.feature, exporter.renderer, entry.how);
        }
    }
    if (!report(loaded)) {
        return host::exit_scene;
    }
    if (!beside.files.empty() && options.output == "-") {
        throw host::UsageError(
            "the scene has images, which are written beside the export; `-o` takes a file's name");
    }
    if (!options.ledger.empty()) {
        write_result(options.ledger, ledger_json(ledger_rows(ledger, loaded.sources)));
    }
    write_beside(std::filesystem::path(options.output).parent_path(), beside);
    write_result(options.output, text);
    return host::exit_fine;
}

} // namespace

void write_beside(const std::filesystem::path& folder, const compiler::ExportFiles& beside) {
    for (const compiler::ExportFiles::File& file : beside.files) {
        host::replace_file((folder / file.name).string(), file.bytes);
    }
}

std::vector<validation::LedgerRow> ledger_rows(const compiler::Ledger& ledger,
                                               const lang::SourceSet& sources) {
    std::vector<validation::LedgerRow> rows;
    for (const compiler::LedgerEntry& entry : ledger) {
        rows.push_back({name_of(entry.fidelity), entry.feature, entry.subject, place(sources, entry.span),
                        entry.how, entry.bound});
    }
    return rows;
}

void add_export(CLI::App& app, Run& selected) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("export", "write the scene for another renderer");
    std::vector<std::string> names;
    for (const compiler::Exporter& exporter : compiler::exporters()) {
        names.emplace_back(exporter.name);
    }
    command->add_option("TARGET", options->target, "pov (POV-Ray 3.7) or blender (a script for Blender 3.4)")
        ->required()
        ->check(CLI::IsMember(names));
    add_scene_options(*command, options->scene);
    command
        ->add_option(
            "-o,--output", options->output,
            "the exported file; - for stdout. Images of an export to POV-Ray go beside it, named after it")
        ->required()
        ->type_name("OUT");
    command
        ->add_option("--ledger", options->ledger, "write which features are exact, approximated or dropped")
        ->type_name("OUT.json");
    command->add_flag("--allow-drop", options->allow_drop,
                      "leave out what the renderer cannot draw instead of failing");
    command->footer(
        "\nDraw the exported scene with\n"
        "  povray +IOUT.pov +Oimg.png +W640 +H480 +FN16 File_Gamma=1.0 -A -D\n"
        "  blender -b --factory-startup --python-exit-code 1 -P OUT.py -- --render img.exr --size 640x480");
    command->callback([&selected, options] { selected = [options] { return export_scene(*options); }; });
}

} // namespace scc::cli
