#pragma once

#include "validation/bench/nff.h"

/// Scenes of the kinds that are hardest, always the same.
namespace scc::bench {

/// Thousands of small cones, each under a mirror sphere, on one huge ground polygon: boxes of very different
/// size, and shapes that no mesh kernel helps.
NffScene cones_and_spheres();

/// A town of thousands of polygons under 5 lights: most rays are shadow rays.
NffScene many_lights();

} // namespace scc::bench
