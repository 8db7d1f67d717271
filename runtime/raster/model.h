#pragma once

#include "runtime/scene.h"
#include "runtime/tessellate/triangles.h"

#include <cstdint>
#include <vector>

/// What the raster pipeline draws: a scene's surfaces as triangles, made once per scene and camera.
namespace scc::runtime {

/// A triangle in the world. Triangle3::part is as ShapeHit::part has it.
using RasterTriangle = Triangle3;

/// The triangles of one primitive of the scene, or of one part of a solid's surface. Their numbers are
/// consecutive in the model, from `first` on.
template <class R>
struct RasterSurface {
    std::uint32_t kind = 0;  ///< of the primitive, as Hit::kind has it
    std::uint32_t index = 0; ///< in the table of its kind
    std::uint32_t id = 0;    ///< Tag::id of the object; of a solid, the whole
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    bool at_infinity = false; ///< of each triangle the first corner is a point, the others are directions
    bool is_mesh = false;     ///< of a mesh that is drawn as it lies in the scene
    std::uint32_t mesh = 0;   ///< its index
    Affine<R> world_from_object{}; ///< of a mesh
    Affine<R> object_from_world{}; ///< of a mesh
    std::uint32_t own = 0;         ///< if no mesh: where its triangles begin in RasterModel::triangles
};

/// A straight piece of a line, in the world.
template <class R>
struct RasterSegment {
    Vec3<R> from, to;
    Rgb<R> color{};
    R width = 1; ///< in pixels
    std::uint32_t id = 0;
};

template <class R>
struct RasterModel {
    std::vector<RasterSurface<R>> surfaces; ///< in the order of their ids
    std::vector<Vec3<R>> positions;
    std::vector<Vec3<R>> normals; ///< unit, exact
    std::vector<RasterTriangle> triangles;
    std::vector<std::vector<std::uint32_t>> mesh_parts; ///< of each mesh: ShapeHit::part of its triangles
    std::vector<RasterSegment<R>> edges; ///< of the surfaces' polygons; with wireframe and hidden line alone
    std::vector<RasterSegment<R>> lines; ///< of the polylines
    std::uint32_t triangle_count = 0;    ///< of all surfaces
    std::vector<std::uint32_t> left_out; ///< ids of unbounded quadrics, which are not drawn
};

/// The surfaces to within RasterSettings::tessellation; planes without end; meshes as they are, which must
/// outlive the model.
template <SceneModel S>
RasterModel<typename S::Real> raster_model(const S& scene, const RenderSettings& settings);

} // namespace scc::runtime
