#pragma once

#include "compiler/ir/function.h"

#include <optional>

namespace scc::compiler {

/// The function, of one number, followed by its derivatives by p.x, p.y and p.z: four results. At kinks (min,
/// abs, ...) and texels' edges they are one side's, as runtime/math/dual.h has them; between steps they are
/// 0. Nothing where an operation has no formula for them: `noise` (but see lattices.h).
std::optional<ir::Function> with_gradient(const ir::Function& function);

/// Whether the function, of one number, varies somewhere other than in steps, whatever it reads.
bool has_slope(const ir::Function& function);

} // namespace scc::compiler
