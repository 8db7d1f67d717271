#pragma once

#include "compiler/backends/blender_library.h"
#include "compiler/backends/blender_paths.h"
#include "compiler/backends/blender_solid.h"
#include "compiler/ir/objects.h"
#include "compiler/ir/scene.h"

#include <memory>
#include <vector>

namespace scc::compiler {

/// What the exported scene consists of: nothing else is written.
struct BlenderNeeds {
    BlenderFeatures features;
    std::vector<bool> materials; ///< of each of the scene's materials, whether an object uses it
    std::vector<bool> functions;
    std::vector<bool> fields; ///< of the functions, those that are a solid's formula
    std::vector<bool> meshes;
    BlenderSolids solids;
    std::vector<std::shared_ptr<const ir::Image>> images; ///< of those functions, each once
    BlenderPaths ways;                                    ///< if some material lets light through
    int bounces = 0;    ///< mirror bounces that can be seen, or the most surfaces on a way
    double cut_off = 0; ///< of the radiance that arrives at the last bounce, what share later ones could add
    runtime::Vec3<double> center; ///< of what is bounded, the lights and the camera
    double extent = 1;            ///< their distance from `center` at most

    /// Whether something is seen through surfaces.
    bool sees_through() const { return !ways.paths.empty(); }
};

BlenderNeeds blender_needs(const ir::Scene& scene);

/// Of a material: some channel is not 0, or varies.
bool is_present(const runtime::Varying<runtime::Rgb<double>>& color);

/// Fresnel's is left out where nothing is seen through it: its mirror image alone would make glass silver.
inline bool has_mirror(const runtime::Phong<double>& phong) {
    return is_present(phong.reflect) && !phong.fresnel;
}

/// Whether a hit of the shape is shaded with normals interpolated from its corners.
bool is_smooth(const ir::Shape& shape, const ir::Scene& scene);

/// Whether a pixel's ray is a linear function of its column and row.
bool is_window_flat(const runtime::Camera<double>& camera);

/// Whether a pattern of a plane needs its point more exactly than Cycles gives it, and a pixel has one ray by
/// which it can be found.
bool has_pattern(const ir::Object& object, const ir::Scene& scene);

} // namespace scc::compiler
