#pragma once

#include "validation/bench/rays.h"

#include <filesystem>

namespace scc::bench {

/// The triangles of a Wavefront OBJ file, moved and scaled to fill the cube from -1 to 1 along its longest
/// side. Holds one vertex more than it uses, since Embree reads 16 bytes per vertex.
TriangleMesh load_mesh(const std::filesystem::path& obj);

/// Each triangle split into four at its edges' midpoints, so many times, then bent by smooth waves, so that
/// the parts of a flat triangle are not in one plane.
TriangleMesh subdivide(TriangleMesh mesh, int times);

/// A perspective view of the mesh, seen slightly from above, as high or wide as the shorter side of its
/// outline, which so fills most of the picture.
View view_of(const TriangleMesh& mesh, int side);

/// From the hits of a view to a point light, for the packets of the view; pixels without a hit take no part.
Rays shadow_rays(const TriangleMesh& mesh, const View& view, const Hits& hits);

/// One ray from each hit of a view, its direction cosine-distributed around the normal on the viewer's side.
Rays bounce_rays(const TriangleMesh& mesh, const View& view, const Hits& hits);

} // namespace scc::bench
