#pragma once

#include "compiler/ir/scene.h"
#include "lang/check.h"
#include "lang/diagnostic.h"

namespace scc::compiler {

/// Warns of numbers that are legal but lose digits: a `near` that leaves far points too little depth
/// resolution (L4), and objects so far from the origin that float could not hold their detail.
void check_scene(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics);

} // namespace scc::compiler
