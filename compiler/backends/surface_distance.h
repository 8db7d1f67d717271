#pragma once

#include "compiler/ir/scene.h"

namespace scc::compiler {

struct DistanceRange {
    double near = 0, far = 0; ///< far is infinite where a plane is among the objects
};

/// Bounds for the distances from a point to all points of the scene's surfaces.
DistanceRange surface_distances(const ir::Scene& scene, const runtime::Vec3<double>& point);

} // namespace scc::compiler
