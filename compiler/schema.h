#pragma once

#include "lang/schema.h"

namespace scc::compiler {

/// Everything that a scene can construct: the shapes as their headers describe them, then lights, materials,
/// cameras and settings. Constructors of the language that are not built yet are rows with `supported =
/// false`.
const lang::Schema& scene_schema();

} // namespace scc::compiler
