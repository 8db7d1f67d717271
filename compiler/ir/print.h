#pragma once

#include "compiler/ir/scene.h"

#include <string>

namespace scc::compiler::ir {

/// The scene as readable text, complete but for the contents of meshes (`--emit ir`).
std::string print(const Scene& scene);

} // namespace scc::compiler::ir
