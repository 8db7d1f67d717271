#pragma once

#include "compiler/ir/scene.h"

#include <string_view>

namespace scc::compiler {

/// What is wrong with a shape whose fields are each in range: it encloses or covers nothing. Empty if it is
/// fine.
std::string_view problem(const ir::Shape& shape);

/// Why a shape cannot be a part of a solid. Empty if it can.
std::string_view open_part(const ir::Shape& shape);

} // namespace scc::compiler
