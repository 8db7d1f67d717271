#pragma once

#include "compiler/ir/scene.h"
#include "runtime/host/scene_names.h"

namespace scc::compiler {

/// The objects' paths by their Tag::id, which for_each_primitive gives them, and the materials' names.
host::SceneNames names_of(const ir::Scene& scene);

} // namespace scc::compiler
