#pragma once

#include "compiler/ir/scene.h"
#include "runtime/bounds.h"

#include <optional>
#include <type_traits>

namespace scc::compiler {

/// Of a solid's tree from a node on, in world space: not finite where its members do not bound it, inside out
/// where there is nothing in it.
runtime::Bounds<double> solid_bounds(const ir::Scene& scene, std::size_t node);

/// In object space; none for unbounded shapes.
template <class Shape>
std::optional<runtime::Bounds<double>> object_bounds(const Shape& shape, const ir::Scene& scene) {
    if constexpr (std::is_same_v<Shape, runtime::Plane<double>>) {
        return std::nullopt;
    } else if constexpr (std::is_same_v<Shape, runtime::Quadric<double>>) {
        const runtime::Bounds<double> box = shape.inside_bounds();
        return is_finite(box) ? std::optional(box) : std::nullopt;
    } else if constexpr (std::is_same_v<Shape, runtime::Mesh<double>>) {
        return scene.meshes[shape.mesh].box;
    } else if constexpr (std::is_same_v<Shape, runtime::Csg<double>>) {
        return solid_bounds(scene, shape.root);
    } else {
        return shape.bounds();
    }
}
std::optional<runtime::Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene);

/// The smallest box around all bounded objects, in world space; empty (min > max) if there are none.
runtime::Bounds<double> world_bounds(const ir::Scene& scene);

} // namespace scc::compiler
