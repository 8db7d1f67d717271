#pragma once

#include "compiler/ir/scene.h"
#include "runtime/bounds.h"

#include <cstddef>

/// The scene again, painted so that its picture is what an AOV layer holds: any renderer that a scene can be
/// exported to then tells what its rays meet. One ray per pixel, through the middle of the lens; pictures in
/// 0..1; black where a ray meets nothing.
namespace scc::cli {

/// The least and the largest position that is seen, stretched by a twentieth on each side, so that black is
/// none: the world position of colour c is low + c * (high - low).
struct PositionRange {
    runtime::Vec3<double> low, high;
};
compiler::ir::Scene position_scene(const compiler::ir::Scene& scene, const PositionRange& range);

/// max(0, sign * n) of the normal n, which is on the eye's side, smooth where a mesh's is, and without
/// bumps. With sign 1 and -1 the two pictures
/// are the parts of n above and below 0.
compiler::ir::Scene normal_scene(const compiler::ir::Scene& scene, int sign);

/// Colours are number / object_scale, the numbers being those of Aov::object.
compiler::ir::Scene object_scene(const compiler::ir::Scene& scene);
inline constexpr double object_scale = 65535;
/// Of more objects there is no such scene, since each takes a material of its own.
inline constexpr std::size_t most_objects = 4000;

} // namespace scc::cli
