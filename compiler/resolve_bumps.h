#pragma once

#include "compiler/ir/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace scc::compiler {

/// A height over an object's surface as a function of p near the surface that does not change along the
/// normal in the world: its whole gradient is the one along the surface. It is the height at the place that a
/// Newton step towards the surface arrives at, p - F A grad F / (grad F . A grad F) with A = M^-1 M^-T, where
/// F is zero on the surface and M takes the object into the world. Nothing for meshes, and where F has no
/// gradient.
std::optional<ir::Function> height_along_surface(const ir::Function& height, const ir::Object& object,
                                                 const ir::Scene& scene);

/// The height's gradient by the point in the world as a function of p, three numbers, its part along the
/// normal included. Nothing where an operation has no derivative (see derivative.h).
std::optional<ir::Function> world_slope(const ir::Function& height, const runtime::Affine<double>& place);

/// What becomes of a bump.
enum class BumpForm { height_along_surface, world_slope };

/// A scene with a material of its own for each bumped surface, whose bump is of this form.
struct ResolvedBumps {
    ir::Scene scene;
    std::vector<std::uint32_t> flat; ///< the materials that lost their bumps
};
/// Of a scene without functions of uv but on meshes (see resolve_uv.h).
ResolvedBumps resolve_bumps(const ir::Scene& scene, BumpForm form);

} // namespace scc::compiler
