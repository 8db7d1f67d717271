#include "compiler/cli/commands.h"
#include "compiler/schema.h"
#include "lang/lsp/grammar.h"
#include "lang/lsp/server.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <map>
#include <memory>
#include <unistd.h>

namespace scc::cli {

namespace {

struct LspOptions {
    compiler::SceneOptions scene;
    bool print_grammar = false;
};

/// Where the objects of a scene were made in its own file. Of a long column of them the first ones say
/// enough.
std::vector<lang::lsp::ObjectPlace> object_places(const compiler::ir::Scene& scene, lang::FileId file) {
    constexpr std::size_t most_of_a_column = 10'000;
    std::vector<lang::lsp::ObjectPlace> places;
    for (const compiler::ir::Object& object : scene.objects) {
        if (object.span.file != file) {
            continue;
        }
        const bool is_same = !places.empty() && places.back().begin == object.span.begin;
        if (is_same) {
            ++places.back().count;
        } else {
            places.push_back({object.span.begin, object.path, 1});
        }
    }
    for (const compiler::ir::ObjectArray& array : scene.arrays) {
        for (const compiler::ir::ObjectColumn& column : array.columns) {
            const lang::Span first = column.places ? column.span_of(0) : column.span;
            if (first.file != file) {
                continue;
            }
            if (!column.places) {
                places.push_back({column.span.begin, column.path_of(0), array.rounds});
            }
            for (std::size_t i = 0; column.places && i < std::min(array.rounds, most_of_a_column); ++i) {
                places.push_back({column.span_of(i).begin, column.path_of(i), 1});
            }
        }
    }
    return places;
}

int serve(const LspOptions& options) {
    if (options.print_grammar) {
        write_result("-", lang::lsp::textmate_grammar(compiler::scene_schema()));
        return host::exit_fine;
    }
    std::signal(SIGPIPE, SIG_IGN); // a client that is gone is seen when it is written to
    const auto check = [&options](const std::string& path, const std::string& text) {
        const std::map<std::string, std::string> texts{{path, text}};
        compiler::SceneOptions scene = options.scene;
        scene.file = path;
        scene.texts = &texts;
        compiler::Loaded loaded = compiler::load(scene, compiler::Stage::scene);
        std::vector<lang::Diagnostic> diagnostics = loaded.diagnostics.sorted();
        std::vector<lang::lsp::ObjectPlace> objects = object_places(loaded.scene, loaded.tree->file);
        return lang::lsp::Checked{std::move(loaded.sources), std::move(diagnostics), std::move(objects)};
    };
    const auto importer_for = [&options](const std::string& path) {
        compiler::SceneOptions scene = options.scene;
        scene.file = path;
        return compiler::make_importer(scene);
    };
    lang::lsp::DescriptorChannel channel(STDIN_FILENO, STDOUT_FILENO);
    const bool ended_well =
        lang::lsp::Server(compiler::scene_schema(), check, importer_for, channel, SCC_VERSION).run();
    return ended_well ? host::exit_fine : host::exit_scene;
}

} // namespace

void add_lsp(CLI::App& app, Run& selected) {
    auto options = std::make_shared<LspOptions>();
    CLI::App* command = app.add_subcommand(
        "lsp", "serve editors: the Language Server Protocol over standard input and output");
    add_scene_values(*command, options->scene);
    command->add_flag("--print-grammar", options->print_grammar,
                      "only print the TextMate grammar of the language");
    command->callback([&selected, options] { selected = [options] { return serve(*options); }; });
}

} // namespace scc::cli
