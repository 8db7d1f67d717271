#pragma once

#include "compiler/ir/scene.h"
#include "runtime/bounds.h"

#include <optional>

namespace scc::compiler {

/// In object space; none for unbounded shapes.
std::optional<runtime::Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene);

/// The smallest box around all bounded objects, in world space; empty (min > max) if there are none.
runtime::Bounds<double> world_bounds(const ir::Scene& scene);

} // namespace scc::compiler
