#pragma once

#include "runtime/scene.h"
#include "runtime/tessellate/triangles.h"

#include <cstdint>
#include <vector>

/// What the raster pipeline draws: a scene's surfaces as triangles, and its lines. See make_model.h.
namespace scc::runtime {

/// A triangle in the world. Triangle3::part is as ShapeHit::part has it.
using RasterTriangle = Triangle3;

/// The triangles of one primitive of the scene, or of one member's share of a solid's surface. Their numbers
/// in the model are consecutive.
template <class R>
struct RasterSurface {
    std::uint32_t kind = 0;  ///< of the primitive, as Hit::kind has it
    std::uint32_t index = 0; ///< in the table of its kind
    std::uint32_t id = 0;    ///< Tag::id of the object; of a solid's part, the whole's
    Sides sides{};
    std::uint32_t first = 0; ///< number of its first triangle
    std::uint32_t count = 0;
    std::uint32_t own = 0;  ///< if no mesh: where its triangles begin in RasterModel::triangles
    std::uint32_t mesh = 0; ///< if a mesh, drawn as it lies in the scene: its index
    bool is_mesh = false;
    bool is_placed = false;   ///< of a mesh: has a map to the world
    bool is_mirrored = false; ///< by that map
    bool at_infinity = false; ///< of each triangle the first corner is a point, the others are directions
    bool is_faceted = false;  ///< its geometric normals are those of the triangles
    Affine<R> world_from_object{};
    Affine<R> object_from_world{};
};

/// A mesh's vertices by the numbers of its normals, where each of these belongs to one place; else empty.
struct MeshVertices {
    std::vector<float> positions;          ///< x y z of each, in the mesh's own space
    std::vector<std::uint32_t> of_corners; ///< 3 of each triangle, in the order in which these lie in memory
};

template <class R>
struct RasterModel {
    std::vector<RasterSurface<R>> surfaces; ///< in the order of their ids
    std::vector<Vec3<R>> positions;         ///< or directions, see RasterSurface::at_infinity
    std::vector<Vec3<R>> normals;           ///< unit, exact
    std::vector<RasterTriangle> triangles;
    /// Of each mesh: ShapeHit::part of its triangles, in the order in which they lie in memory.
    std::vector<std::vector<std::uint32_t>> mesh_parts;
    std::vector<MeshVertices> mesh_vertices; ///< of each mesh, if vertices are lit
    std::vector<LineSegment<R>> segments;    ///< edges of polygons, and polylines
    std::uint32_t triangle_count = 0;        ///< of all surfaces
    std::vector<std::uint32_t> left_out; ///< ids of what has no mesh: unbounded quadrics and solids of them
};

/// So many triangles a model can have; the rest of a number's bits has other uses.
inline constexpr std::uint32_t raster_most_triangles = 1U << 30;

} // namespace scc::runtime
