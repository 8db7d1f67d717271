#include "compiler/ir/mesh.h"

namespace scc::compiler::ir {

Mesh make_mesh(std::string name, MeshArrays arrays) {
    const auto owner = std::make_shared<const MeshArrays>(std::move(arrays));
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.positions = owner->positions;
    mesh.normals = owner->normals;
    mesh.indices = owner->indices;
    mesh.normal_indices = owner->normal_indices;
    mesh.uvs = owner->uvs;
    mesh.uv_indices = owner->uv_indices;
    runtime::Bounds<float> box;
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        box.add(runtime::Vec3<float>{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
    }
    mesh.box = {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
    mesh.owner = owner;
    return mesh;
}

} // namespace scc::compiler::ir
