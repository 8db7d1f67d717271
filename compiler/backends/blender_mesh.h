#pragma once

#include "compiler/backends/blender_needs.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

#include <string>
#include <string_view>

namespace scc::compiler {

/// Whether there are images, or some mesh that is needed is too large for lists of numbers.
bool needs_packing(const ir::Scene& scene, const BlenderNeeds& needs);

/// The Python function that reads packed arrays.
void write_unpacking(Writer& out);

/// An entry of the table of meshes.
void write_mesh(Writer& out, const ir::Mesh& mesh, bool with_uvs);

/// An entry of the table of images, which hold linear light as floats, or codes with the light of each.
void write_image(Writer& out, const ir::Image& image, const std::string& key);

/// An entry of the table of solids.
void write_solid(Writer& out, const BlenderSolid& solid);

/// RFC 4648.
std::string base64(std::string_view bytes);

} // namespace scc::compiler
