#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/backends/table.h"
#include "compiler/ir/scene.h"
#include "lang/source.h"

#include <string>

namespace scc::compiler {

/// The scene as POV-Ray 3.7 SDL that draws exactly our image (one sample at each pixel's centre):
///   povray +IOUT.pov +Oimg.png +W640 +H480 +FN16 File_Gamma=1.0 -A -D
/// `Declare=scc_exposure=k` on the command line multiplies all radiance by k, for pictures brighter than 1.
/// Images go beside it, as PNG files. With `sources`, the comment above each object has its source line.
std::string emit_pov(const ir::Scene& scene, Ledger& ledger, ExportFiles& files,
                     const lang::SourceSet* sources = nullptr);

} // namespace scc::compiler
