#pragma once

#include "compiler/ir/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace scc::compiler {

/// A part of a solid's mesh: which material it has, and the formula by which the material finds the true
/// surface behind the mesh.
struct BlenderFace {
    enum class Formula : std::uint8_t {
        none,  ///< the mesh itself: what is flat, and what Math nodes cannot calculate
        ball,  ///< |q| = radius
        round, ///< about the z axis with a radius of radius + slope z
        field  ///< an author's, where Math nodes can calculate it and its gradient
    };
    Formula formula = Formula::none;
    runtime::Sides sides;
    bool inverted = false;                ///< the formula grows into the solid
    runtime::Affine<double> q_from_world; ///< the formula's coordinates
    double radius = 0, slope = 0;
    std::int32_t field = 0;                    ///< index into the scene's functions
    runtime::Affine<double> member_from_world; ///< those that the member was written in
};

/// The mesh of an implicit surface, in object space, or of a solid made of others, in the world.
struct BlenderSolid {
    ir::Mesh mesh;
    std::vector<std::uint32_t> slots; ///< of each triangle: index into `faces`
    std::vector<BlenderFace> faces;
    double deviation = 0;      ///< of the mesh from the surface, in world units
    std::size_t uncertain = 0; ///< SolidMesh::uncertain
};

/// The field with its gradient, if Math nodes can calculate both.
std::optional<ir::Function> field_for_nodes(const ir::Function& field);

/// By the objects' paths.
using BlenderSolids = std::map<std::string, BlenderSolid>;

/// Of all implicit surfaces, and solids made of others than meshes, to a fraction of the camera's pixels.
BlenderSolids blender_solids(const ir::Scene& scene);

} // namespace scc::compiler
