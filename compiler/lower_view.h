#pragma once

#include "compiler/ir/scene.h"
#include "compiler/lower.h"
#include "compiler/rendition.h"
#include "lang/check.h"
#include "lang/diagnostic.h"

namespace scc::compiler {

/// Ambient light and background from the last `world`; the rest from the first `render` of the method that is
/// asked for, if there is one, else from the first of all.
void lower_settings(const lang::Module& module, const LowerOptions& options, const Rendition& rec709,
                    ir::Scene& scene, lang::Diagnostics& diagnostics);

/// The camera that the command line or the render names, else the first; a scene without one gets a camera
/// that frames all bounded shapes. Needs the objects.
void lower_camera(const lang::Module& module, const LowerOptions& options, ir::Scene& scene,
                  lang::Diagnostics& diagnostics);

/// The enabled lights; a scene without any gets a headlight. Needs the camera.
void lower_lights(const lang::Module& module, const Rendition& rec709, ir::Scene& scene,
                  lang::Diagnostics& diagnostics);

/// The world's, by which plain colours shine.
const lang::Spectrum& illuminant_of(const lang::Module& module);
/// Whether a light or the world has a spectrum, or the illuminant is another than Rec.709's white.
bool view_has_spectra(const lang::Module& module);
/// Makes Scene::bands and gives the lights, which are lowered, their colours in them.
void add_view_bands(const lang::Module& module, const std::vector<Rendition>& bands, ir::Scene& scene);

} // namespace scc::compiler
