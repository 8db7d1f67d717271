#include "compiler/backends/table.h"

#include "compiler/backends/blender.h"
#include "compiler/backends/pov.h"

#include <algorithm>

namespace scc::compiler {

std::span<const Exporter> exporters() {
    static constexpr Exporter table[] = {
        {"pov", "POV-Ray 3.7", ".pov",
         [](const ir::Scene& scene, Ledger& ledger, ExportFiles& files) {
             return emit_pov(scene, ledger, files);
         }},
        {"blender", "Blender 3.4", ".py",
         [](const ir::Scene& scene, Ledger& ledger, ExportFiles&) { return emit_blender(scene, ledger); }},
    };
    return table;
}

const Exporter* find_exporter(std::string_view name) {
    const auto all = exporters();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Exporter& e) { return e.name == name; });
    return found == all.end() ? nullptr : &*found;
}

} // namespace scc::compiler
