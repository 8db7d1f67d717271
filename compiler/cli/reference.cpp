#include "compiler/reference.h"

#include "compiler/cli/commands.h"
#include "runtime/host/options.h"

#include <CLI/CLI.hpp>

namespace scc::cli {

void add_reference(CLI::App& app, Run& selected) {
    CLI::App* command =
        app.add_subcommand("reference", "print the reference of the scene language, as Markdown");
    command->callback([&selected] {
        selected = [] {
            write_result("-", compiler::reference_text());
            return host::exit_fine;
        };
    });
}

} // namespace scc::cli
