#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace scc::compiler {

/// A renderer that scenes can be exported to.
struct Exporter {
    std::string_view name;      ///< as the command line says it
    std::string_view renderer;  ///< for people
    std::string_view extension; ///< of its files
    std::string (*emit)(const ir::Scene&, Ledger&);
};

std::span<const Exporter> exporters();
/// Null if there is none of that name.
const Exporter* find_exporter(std::string_view name);

} // namespace scc::compiler
