#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace scc::compiler {

/// What an export consists of besides its text: files that lie beside it, under names that begin with `stem`.
struct ExportFiles {
    struct File {
        std::string name;
        std::string bytes;
    };
    std::string stem;
    std::vector<File> files{};
};

/// A renderer that scenes can be exported to.
struct Exporter {
    std::string_view name;      ///< as the command line says it
    std::string_view renderer;  ///< for people
    std::string_view extension; ///< of its files
    std::string (*emit)(const ir::Scene&, Ledger&, ExportFiles&);
};

std::span<const Exporter> exporters();
/// Null if there is none of that name.
const Exporter* find_exporter(std::string_view name);

} // namespace scc::compiler
