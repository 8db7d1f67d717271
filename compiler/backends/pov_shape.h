#pragma once

#include "compiler/backends/pov_frame.h"
#include "compiler/ir/scene.h"
#include "compiler/writer.h"

#include <string>
#include <vector>

namespace scc::compiler {

/// A shape as SDL: `keyword { lines... modifiers }`.
struct PovShape {
    std::string keyword;
    std::vector<std::string> lines;
    std::string precision{}; ///< why the shape is not exact, else empty
    double bound = 0;        ///< for `precision`: relative to the shape's size
    bool reversed = false;   ///< POV-Ray takes our front for the inside
};

/// `mesh_names` holds the identifiers of the scene's meshes. Meshes are declared with their own scale.
PovShape pov_shape(const ir::Shape& shape, double scale, const std::vector<std::string>& mesh_names);

/// `#declare NAME = mesh2 { ... }`
void declare_mesh(const ir::Mesh& mesh, const std::string& name, Writer& out);

} // namespace scc::compiler
