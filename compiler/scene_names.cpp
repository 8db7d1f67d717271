#include "compiler/scene_names.h"

#include "compiler/ir/objects.h"

#include <cstddef>
#include <cstdint>
#include <variant>

namespace scc::compiler {

namespace {

/// The ids that an object takes: its own, and one for each member of a solid.
std::uint32_t ids_of(const ir::Scene& scene, const ir::Object& object) {
    std::uint32_t count = 1;
    if (const auto* solid = std::get_if<runtime::Csg<double>>(&object.shape)) {
        ir::for_each_csg_node(scene, *solid, [&](const ir::CsgNode& node) {
            count += node.op == runtime::CsgOp::member ? 1 : 0;
        });
    }
    return count;
}

} // namespace

host::SceneNames names_of(const ir::Scene& scene) {
    host::SceneNames names;
    std::uint32_t id = 0;
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            names.add_objects({.first = id}, object.path);
            id += ids_of(scene, object);
        },
        [&](const ir::ObjectArray& array) {
            const auto columns = static_cast<std::uint32_t>(array.columns.size());
            const auto rounds = static_cast<std::uint32_t>(array.rounds);
            std::uint32_t first = id;
            for (const ir::ObjectColumn& column : array.columns) {
                names.add_objects({.first = first++,
                                   .step = columns,
                                   .count = rounds,
                                   .is_numbered = 1,
                                   .first_number = column.first_number,
                                   .number_step = column.number_step},
                                  column.path);
            }
            id += columns * rounds;
        });
    for (const ir::Material& material : scene.materials) {
        names.add_material(material.name);
    }
    return names;
}

std::map<std::uint32_t, std::string> member_names_of(const ir::Scene& scene) {
    std::map<std::uint32_t, std::string> names;
    std::uint32_t id = 0;
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            const std::uint32_t after = id + ids_of(scene, object);
            if (const auto* solid = std::get_if<runtime::Csg<double>>(&object.shape)) {
                ir::for_each_csg_node(scene, *solid, [&](const ir::CsgNode& node) {
                    if (node.op == runtime::CsgOp::member) {
                        names[++id] = scene.members[node.member].path;
                    }
                });
            }
            id = after;
        },
        [&](const ir::ObjectArray& array) {
            id += static_cast<std::uint32_t>(array.columns.size() * array.rounds);
        });
    return names;
}

} // namespace scc::compiler
