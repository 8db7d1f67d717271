#pragma once

#include "compiler/backends/blender_needs.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

namespace scc::compiler {

/// The part of the script that is the scene's own: constants, functions and tables.
void write_blender_scene(Writer& out, const ir::Scene& scene, const BlenderNeeds& needs);

} // namespace scc::compiler
