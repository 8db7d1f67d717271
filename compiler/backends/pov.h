#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"
#include "lang/source.h"

#include <string>

namespace scc::compiler {

/// The scene as POV-Ray 3.7 SDL that draws exactly our image (one sample at each pixel's centre):
///   povray +IOUT.pov +Oimg.png +W640 +H480 +FN16 File_Gamma=1.0 -A -D
/// `Declare=scc_exposure=k` on the command line multiplies all radiance by k, for pictures brighter than 1.
std::string emit_pov(const ir::Scene& scene, Ledger& ledger);

/// The same, with the source line of each object in the comment above it.
std::string emit_pov(const ir::Scene& scene, Ledger& ledger, const lang::SourceSet& sources);

} // namespace scc::compiler
