#pragma once

#include "compiler/backends/blender_needs.h"
#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"

namespace scc::compiler {

/// How each feature of the scene goes into the script.
void record_blender(const ir::Scene& scene, const BlenderNeeds& needs, Ledger& ledger);

} // namespace scc::compiler
