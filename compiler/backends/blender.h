#pragma once

#include "compiler/backends/ledger.h"
#include "compiler/ir/scene.h"

#include <string>

namespace scc::compiler {

/// The scene as a Python script for Blender 3.4 whose Cycles render is exactly our image:
///   blender -b --factory-startup --python-exit-code 1 -P OUT.py -- --render img.exr --size 640x480
/// Without `--render` it only builds the scene (Text editor, F12). `--look exact|artist`.
std::string emit_blender(const ir::Scene& scene, Ledger& ledger);

} // namespace scc::compiler
