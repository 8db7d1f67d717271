#pragma once

#include "compiler/ir/scene.h"

namespace scc::compiler {

/// The scene with `noise`, and `random` of whole numbers, in its materials looked up in images of what they
/// are at whole numbers, for renderers that cannot calculate their hash; noise is blended by formulas, whose
/// derivatives are the noise's. Where the arguments' bounds are not known, or too wide for an image, they
/// stay.
ir::Scene with_lattices(const ir::Scene& scene);
/// The same of the field of implicit surfaces, for all of the scene's.
ir::Function field_with_lattices(const ir::Scene& scene, std::int32_t field);

/// Whether it has `noise` or `random`.
bool has_lattice(const ir::Function& function);

} // namespace scc::compiler
