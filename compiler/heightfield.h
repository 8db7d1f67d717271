#pragma once

#include "compiler/ir/function.h"
#include "compiler/ir/mesh.h"

#include <cstddef>
#include <optional>
#include <string>

namespace scc::compiler {

/// The surface y = height f(u, v) over a rectangle in the plane y = 0 with its middle in the origin, where u
/// runs from 0 to 1 along x and v along z, cut into cells.
struct Heightfield {
    double size_x = 1, size_z = 1;
    double height = 1;
    std::size_t cells_x = 256, cells_z = 256;
};

/// Where its function has no finite value.
struct HeightlessPoint {
    double u, v, value;
};

struct HeightfieldMesh {
    ir::Mesh mesh;
    std::optional<HeightlessPoint> bad; ///< the first one, if any; the mesh is then of no use
};

/// Two triangles per cell, whose front is above; corners have normals from the slopes to their neighbours.
/// `f` takes u and v for p.x and p.y.
HeightfieldMesh heightfield_mesh(std::string name, const ir::Function& f, const Heightfield& shape);

} // namespace scc::compiler
