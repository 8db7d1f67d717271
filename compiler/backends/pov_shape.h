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
    bool placed = false;     ///< the numbers include the placement's transform
    bool reversed = false;   ///< POV-Ray takes our front for the inside
    std::string precision{}; ///< why the shape is not exact, else empty
    double bound = 0;        ///< for `precision`
};

/// Of an isosurface, relative to the container's size.
inline constexpr double pov_isosurface_accuracy = 1e-9;

/// What an implicit surface needs of its field.
struct PovField {
    std::string function; ///< its name in SDL
    double steepest_slope = 0;
    std::string precision;
    double bound = 0; ///< for `precision`
};

/// `mesh_names` holds the identifiers of the scene's meshes, which are declared at the scale of their
/// placements.
PovShape pov_shape(const ir::Shape& shape, const Placement& placement,
                   const std::vector<std::string>& mesh_names, const PovField& field);

/// In which POV-Ray looks at the field of an implicit surface.
runtime::Bounds<double> pov_field_box(const runtime::Container<double>& container);

/// `#declare NAME = mesh2 { ... }`; `is_solid`: with an inside.
void declare_mesh(const ir::Mesh& mesh, const std::string& name, bool with_uvs, bool is_solid, Writer& out);

} // namespace scc::compiler
