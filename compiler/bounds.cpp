#include "compiler/bounds.h"

#include <type_traits>

namespace scc::compiler {

using runtime::Bounds;

Bounds<double> mesh_bounds(const ir::Mesh& mesh) {
    Bounds<double> box;
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        box.add(runtime::Vec3<double>{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
    }
    return box;
}

std::optional<Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene) {
    return std::visit(
        [&]<class S>(const S& s) -> std::optional<Bounds<double>> {
            if constexpr (std::is_same_v<S, runtime::Plane<double>>) {
                return std::nullopt;
            } else if constexpr (std::is_same_v<S, runtime::Mesh<double>>) {
                return mesh_bounds(scene.meshes[s.mesh]);
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
