#pragma once

#include "compiler/backends/blender_needs.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

#include <string>
#include <string_view>

namespace scc::compiler {

/// Whether some mesh that is needed is too large for lists of numbers.
bool needs_packing(const ir::Scene& scene, const BlenderNeeds& needs);

/// The Python function that reads packed arrays.
void write_unpacking(Writer& out);

/// An entry of the table of meshes.
void write_mesh(Writer& out, const ir::Mesh& mesh);

/// An entry of the table of solids.
void write_solid(Writer& out, const BlenderSolid& solid);

/// RFC 4648.
std::string base64(std::string_view bytes);

} // namespace scc::compiler
