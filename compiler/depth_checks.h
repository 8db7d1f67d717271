#pragma once

#include "compiler/ir/scene.h"
#include "lang/check.h"
#include "lang/diagnostic.h"

namespace scc::compiler {

/// Warns where `near` and `far` leave too little resolution of depth (L4): less than a pixel's width, and in
/// raster mode less than what is between faces of two objects.
void check_depth(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics);

} // namespace scc::compiler
