#pragma once

#include "compiler/ir/scene.h"
#include "runtime/bounds.h"

namespace scc::compiler {

/// The smallest box around all bounded objects, in world space; empty (min > max) if there are none.
runtime::Bounds<double> world_bounds(const ir::Scene& scene);

} // namespace scc::compiler
