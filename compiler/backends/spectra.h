#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"

namespace scc::compiler {

/// For renderers that know three numbers per colour: where the scene has spectra, that it is written in
/// Rec.709, and how far a reflection may then be off.
void record_spectra(const ir::Scene& scene, Ledger& ledger);

} // namespace scc::compiler
