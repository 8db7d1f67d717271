#pragma once

#include "compiler/ir/scene.h"

#include <string>
#include <string_view>

namespace scc::compiler {

/// What is wrong with a shape whose fields are each in range: it encloses or covers nothing. Empty if it is
/// fine.
std::string_view problem(const ir::Shape& shape);

/// Why a shape, no mesh, cannot be a part of a solid. Empty if it can.
std::string_view open_part(const ir::Shape& shape);

/// Why a mesh cannot be a part of a solid. Empty if it can: where each edge has as many triangles on one side
/// as on the other, the corners being told apart by where they are, and the triangles face outwards.
std::string open_part(const ir::Mesh& mesh);

} // namespace scc::compiler
