#include "compiler/bounds.h"

namespace scc::compiler {

namespace {

runtime::Bounds<double> mesh_bounds(const ir::Mesh& mesh) {
    runtime::Bounds<double> box;
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        box.add(runtime::Vec3<double>{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
    }
    return box;
}

} // namespace

runtime::Bounds<double> world_bounds(const ir::Scene& scene) {
    std::vector<runtime::Bounds<double>> meshes;
    for (const ir::Mesh& mesh : scene.meshes) {
        meshes.push_back(mesh_bounds(mesh));
    }
    runtime::Bounds<double> box;
    for (const ir::Object& object : scene.objects) {
        std::visit(
            [&]<class Shape>(const Shape& shape) {
                if constexpr (std::is_same_v<Shape, runtime::Mesh<double>>) {
                    box.add(transform_bounds(object.world_from_object, meshes[shape.mesh]));
                } else if constexpr (!std::is_same_v<Shape, runtime::Plane<double>>) {
                    box.add(transform_bounds(object.world_from_object, shape.bounds()));
                }
            },
            object.shape);
    }
    return box;
}

} // namespace scc::compiler
