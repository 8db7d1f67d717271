#include "compiler/bounds.h"

#include <type_traits>

namespace scc::compiler {

using runtime::Bounds;

std::optional<Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene) {
    return std::visit(
        [&]<class S>(const S& s) -> std::optional<Bounds<double>> {
            if constexpr (std::is_same_v<S, runtime::Plane<double>>) {
                return std::nullopt;
            } else if constexpr (std::is_same_v<S, runtime::Mesh<double>>) {
                return scene.meshes[s.mesh].box;
            } else {
                return s.bounds();
            }
        },
        shape);
}

Bounds<double> world_bounds(const ir::Scene& scene) {
    Bounds<double> box;
    for (const ir::Object& object : scene.objects) {
        if (const auto bounds = object_bounds(object.shape, scene)) {
            box.add(transform_bounds(object.world_from_object, *bounds));
        }
    }
    return box;
}

} // namespace scc::compiler
