#pragma once

#include "compiler/ir/scene.h"

#include <optional>
#include <string>

namespace scc::compiler {

/// Scales the whole scene, camera and lights and their attenuation included, and then moves it: the picture
/// stays the same. Of a scene that the passes have not run over.
void place_scene(ir::Scene& scene, double scale, const runtime::Vec3<double>& offset);

/// Why a picture changes when the scene is placed elsewhere or in another size; nothing if it does not.
std::optional<std::string> tied_to_place(const ir::Scene& scene);

/// Moves what stands far from the origin to it, since coordinates would lose digits there, and notes where
/// that was (RenderSettings::origin). Of a scene that the passes have not run over.
void recenter(ir::Scene& scene);

} // namespace scc::compiler
