#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"

namespace scc::compiler {

/// What becomes of samplers, filters, adaptive sampling and raster mode in an export, which has one ray per
/// pixel: the same for every renderer.
void record_sampling(const ir::Scene& scene, Ledger& ledger);

} // namespace scc::compiler
