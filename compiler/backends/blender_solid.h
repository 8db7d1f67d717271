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
        none,    ///< the mesh itself: what is flat, and what Math nodes cannot calculate
        ball,    ///< |q| = radius
        round,   ///< about the z axis with a radius of radius + slope z
        ring,    ///< a tube of radius `slope` around the circle of `radius` about the z axis
        quadric, ///< as runtime::Quadric has it
        field    ///< an author's, where Math nodes can calculate it and its gradient
    };
    Formula formula = Formula::none;
    runtime::Sides sides;
    bool inverted = false;                ///< the formula grows into the solid
    runtime::Affine<double> q_from_world; ///< the formula's coordinates
    double radius = 0, slope = 0;
    runtime::Quadric<double> quadric;
    std::int32_t field = 0;                    ///< index into the scene's functions
    runtime::Affine<double> member_from_world; ///< those that the member was written in
};

struct BlenderCut;

/// The mesh of an implicit surface or a quadric, in object space, or of a solid made of others, in the world.
struct BlenderSolid {
    ir::Mesh mesh;
    std::vector<std::uint32_t> slots; ///< of each triangle: index into `faces`
    std::vector<BlenderFace> faces;
    double deviation = 0;         ///< of the mesh from the surface, in world units
    std::size_t uncertain = 0;    ///< SolidMesh::uncertain
    bool is_part = false;         ///< of a solid that Blender makes from meshes, one after the other:
    std::vector<BlenderCut> cuts; ///< what it combines this one with
};
struct BlenderCut {
    runtime::CsgOp op;
    BlenderSolid solid;
};

/// f(solid) for a solid and all the parts that it is made from.
template <class F>
void for_each_part(const BlenderSolid& solid, const F& f) {
    f(solid);
    for (const BlenderCut& cut : solid.cuts) {
        for_each_part(cut.solid, f);
    }
}

/// The field of implicit surfaces with its gradient, if Math nodes can calculate both.
std::optional<ir::Function> field_for_nodes(const ir::Scene& scene, std::int32_t field);

/// By the objects' paths.
using BlenderSolids = std::map<std::string, BlenderSolid>;

/// Of all implicit surfaces, quadrics that have an end, and solids, to a fraction of the camera's pixels.
BlenderSolids blender_solids(const ir::Scene& scene);

} // namespace scc::compiler
