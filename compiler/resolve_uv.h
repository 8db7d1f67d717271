#pragma once

#include "compiler/ir/scene.h"

namespace scc::compiler {

/// The function with what it reads of uv computed from p, for the surface of one shape other than a mesh: the
/// formulas of the shapes' own uv (runtime/shapes), told from p alone. Where a point is on two parts of a
/// surface at once, as on a box's edge, it may be that of either.
ir::Function with_uv_of(const ir::Shape& shape, const ir::Function& function);

/// The scene with a material of its own for each shape, other than a mesh, whose functions read uv; for
/// renderers that have other coordinates on their surfaces, or none.
ir::Scene resolve_uv(const ir::Scene& scene);

} // namespace scc::compiler
