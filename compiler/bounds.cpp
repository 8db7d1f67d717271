#include "compiler/bounds.h"

#include "compiler/ir/objects.h"

namespace scc::compiler {

using runtime::Bounds;

std::optional<Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene) {
    return std::visit([&](const auto& s) { return object_bounds(s, scene); }, shape);
}

Bounds<double> world_bounds(const ir::Scene& scene) {
    Bounds<double> box;
    ir::for_each_shape(scene,
                       [&](const auto& shape, const runtime::Affine<double>& place, const runtime::Sides&) {
                           if (const auto bounds = object_bounds(shape, scene)) {
                               box.add(transform_bounds(place, *bounds));
                           }
                       });
    return box;
}

} // namespace scc::compiler
