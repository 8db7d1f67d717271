#pragma once

#include "compiler/backends/precision.h"
#include "compiler/ir/scene.h"
#include "runtime/host/draw.h"

#include <string>
#include <vector>

namespace scc::compiler {

/// The scene in the generic renderer's tables, hierarchies built, ready to be drawn in this process.
host::Drawable make_drawable(const ir::Scene& scene, Precision precision);

/// What the scene needs of the runtime, in words: shapes, lights, shading terms.
std::vector<std::string> feature_names(const ir::Scene& scene);

} // namespace scc::compiler
