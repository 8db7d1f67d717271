#pragma once

#include "compiler/ir/scene.h"
#include "lang/diagnostic.h"

namespace scc::compiler {

/// Warns of faces of a solid's operands that lie in one plane, facing the same way: what was meant there the
/// numbers do not tell.
void check_coincident_faces(const ir::Scene& scene, lang::Diagnostics& diagnostics);

} // namespace scc::compiler
