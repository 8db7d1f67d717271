#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/backends/pov_frame.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

namespace scc::compiler {

/// The identifier of the union of all objects, which lights with Is other than Id need.
inline constexpr const char* pov_objects_name = "scc_objects";

/// Some light needs the union: its highlight has a colour of its own, and there are highlights and shadows.
bool needs_object_union(const ir::Scene& scene);

void emit_lights(const ir::Scene& scene, const PovFrame& frame, Writer& out, Ledger& ledger);

} // namespace scc::compiler
