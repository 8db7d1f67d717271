#include "compiler/cli/commands.h"
#include "lang/format.h"
#include "lang/parser.h"
#include "runtime/host/file.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>

namespace scc::cli {

namespace {

struct FmtOptions {
    std::vector<std::string> files;
    bool check = false;
};

std::string read_standard_input() {
    std::string text;
    char buffer[1 << 16];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, stdin)) {
        text.append(buffer, count);
    }
    if (std::ferror(stdin) != 0) {
        throw host::FileError("cannot read standard input");
    }
    return text;
}

/// The text in the layout of the language; nothing if it has mistakes of syntax, which are printed.
std::optional<std::string> formatted(const std::string& name, const std::string& text) {
    Loaded loaded;
    const lang::FileId file = loaded.sources.add(name, text);
    loaded.tokens = lang::lex(loaded.sources, file, loaded.diagnostics);
    const lang::ast::File tree = lang::parse(loaded.sources, file, loaded.tokens, loaded.diagnostics);
    if (!report(loaded)) {
        return std::nullopt;
    }
    return lang::checked_format(loaded.sources, loaded.tokens, tree);
}

int format_files(const FmtOptions& options) {
    bool fine = true;
    for (const std::string& file : options.files) {
        const bool is_input = file == "-";
        const std::string text = is_input ? read_standard_input() : read_text_file(file);
        const std::optional<std::string> result = formatted(is_input ? "<stdin>" : file, text);
        const bool is_as_it_should_be = result && *result == text;
        fine &= result && (is_as_it_should_be || !options.check);
        if (options.check && result && !is_as_it_should_be) {
            write_result("-", (is_input ? "<stdin>" : file) + "\n");
        } else if (!options.check && result && is_input) {
            write_result("-", *result);
        } else if (!options.check && result && !is_as_it_should_be) {
            host::replace_file(file, *result);
        }
    }
    return fine ? host::exit_fine : host::exit_scene;
}

} // namespace

void add_fmt(CLI::App& app, Run& selected) {
    auto options = std::make_shared<FmtOptions>();
    CLI::App* command =
        app.add_subcommand("fmt", "lay out scenes in the one way of the language, in place; comments stay");
    command
        ->add_option("FILE", options->files,
                     "scenes, .scn files; `-` is standard input, whose layout is printed")
        ->required();
    command->add_flag("--check", options->check,
                      "only name the files that are laid out otherwise, with exit code 1");
    command->callback([&selected, options] { selected = [options] { return format_files(*options); }; });
}

} // namespace scc::cli
