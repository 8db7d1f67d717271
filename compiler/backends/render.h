#pragma once

#include "compiler/backends/precision.h"
#include "compiler/ir/scene.h"
#include "runtime/accel/build.h"
#include "runtime/host/draw.h"

namespace scc::compiler {

/// The scene in the generic renderer's tables, hierarchies built, ready to be drawn in this process.
host::Drawable make_drawable(const ir::Scene& scene, Precision precision,
                             const runtime::BuildOptions& build = {});

} // namespace scc::compiler
