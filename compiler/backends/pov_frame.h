#pragma once

#include "compiler/backends/function_range.h"
#include "compiler/ir/scene.h"

#include <string>

/// Where the scene stands in the file. POV-Ray's tolerances are absolute lengths and its bounding boxes
/// floats, so a scene is written in a frame of its own where its size or its distance from the origin would
/// cost accuracy.
namespace scc::compiler {

/// A point p of the scene is written as scale * (p - origin).
struct PovFrame {
    double scale = 1; ///< a power of two: numbers keep their digits
    runtime::Vec3<double> origin{};

    runtime::Vec3<double> point(const runtime::Vec3<double>& p) const { return scale * (p - origin); }
    /// The transform of a texture whose x, y, z are world coordinates.
    std::string texture_transform() const;
};
PovFrame choose_frame(const ir::Scene& scene);

/// A shape's numbers are written times `shape_scale` (a power of two), then moved by `transform`.
struct Placement {
    double shape_scale = 1;
    runtime::Affine<double> transform;
};
Placement place(const ir::Object& object, const ir::Scene& scene, const PovFrame& frame);

/// By how much the vertices of a mesh are scaled where it is declared.
double mesh_scale(const ir::Mesh& mesh);

/// What a function can read on the object.
InputRanges input_ranges(const ir::Object& object, const ir::Scene& scene);

} // namespace scc::compiler
