#include "compiler/backends/table.h"

#include "compiler/backends/blender.h"
#include "compiler/backends/pov.h"

#include <algorithm>

namespace scc::compiler {

std::span<const Exporter> exporters() {
    static constexpr Exporter table[] = {
        {"pov", "POV-Ray 3.7", ".pov", emit_pov},
        {"blender", "Blender 3.4", ".py", emit_blender},
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
