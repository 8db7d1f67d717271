#pragma once

#include "compiler/ir/scene.h"
#include "compiler/lower.h"
#include "lang/check.h"
#include "lang/diagnostic.h"

namespace scc::compiler {

/// Ambient light and background from the last `world`; size, depth, samples and shadows from the first
/// `render` that ray mode can draw.
void lower_settings(const lang::Module& module, ir::Scene& scene, lang::Diagnostics& diagnostics);

/// The camera that the command line or the render names, else the first; a scene without one gets a camera
/// that frames all bounded shapes. Needs the objects.
void lower_camera(const lang::Module& module, const LowerOptions& options, ir::Scene& scene,
                  lang::Diagnostics& diagnostics);

/// The enabled lights; a scene without any gets a headlight. Needs the camera.
void lower_lights(const lang::Module& module, ir::Scene& scene, lang::Diagnostics& diagnostics);

} // namespace scc::compiler
