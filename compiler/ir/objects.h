#pragma once

#include "compiler/ir/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/// The one way to go through all objects of a scene, those on their own and those of arrays, in source order.
namespace scc::compiler::ir {

std::size_t object_count(const Scene& scene);

/// The indices of refraction that transparent surfaces give to what they enclose, those of an object or of
/// the solid whose tree begins at a node: each once, ascending. A body has one; without any it is that of
/// air, 1.
std::vector<double> iors_of(const Scene& scene, const Object& object);
std::vector<double> iors_of_solid(const Scene& scene, std::size_t root);

/// Whether a member of the solid is a mesh.
bool has_mesh(const Scene& scene, const runtime::Csg<double>& solid);

/// Those of the material's fields; runtime::no_function where one is constant.
std::array<std::int32_t, 8> functions_of(const runtime::Phong<double>& phong);

/// Whether a function of the material reads one of these inputs.
bool material_reads(const Scene& scene, std::uint32_t material, Input first, Input last);

/// The images of all functions, each once.
std::vector<const Image*> images_of(const Scene& scene);

/// The author's word: `union`, `intersection`, `difference`.
std::string_view csg_word(runtime::CsgOp op);

/// An object as it would stand on its own.
Object object_of(const ObjectColumn& column, std::size_t round);

/// Calls `single(object)` and `array(array)` in source order.
template <class SomeScene, class Single, class Array>
void for_each_piece(SomeScene& scene, Single single, Array array) {
    std::size_t done = 0;
    const auto singles_up_to = [&](std::size_t end) {
        for (; done < end; ++done) {
            single(scene.objects[done]);
        }
    };
    for (auto& one : scene.arrays) {
        singles_up_to(one.before);
        array(one);
    }
    singles_up_to(scene.objects.size());
}

/// Calls `visit(shape, world_from_object, sides)` with every object, the shape being of its own type.
template <class SomeScene, class Visit>
void for_each_shape(SomeScene& scene, Visit visit) {
    for_each_piece(
        scene,
        [&](auto& object) {
            std::visit([&](auto& shape) { visit(shape, object.world_from_object, object.sides); },
                       object.shape);
        },
        [&](auto& array) {
            for (std::size_t round = 0; round < array.rounds; ++round) {
                for (auto& column : array.columns) {
                    std::visit(
                        [&](auto& shapes) {
                            visit(shapes[round], column.world_from_object, column.sides_of(round));
                        },
                        column.shapes);
                }
            }
        });
}

/// Calls `visit(node)` with every node of a solid's tree, operators before their operands.
template <class Visit>
void for_each_csg_node(const Scene& scene, const runtime::Csg<double>& solid, Visit visit) {
    const std::size_t end = solid.root + scene.csg_nodes[solid.root].size;
    for (std::size_t i = solid.root; i < end; ++i) {
        visit(scene.csg_nodes[i]);
    }
}

/// Calls `visit(object)` with every object. Those of arrays are made for it, which takes a while; what goes
/// through millions of them looks at their columns.
template <class Visit>
void for_each_object(const Scene& scene, Visit visit) {
    for_each_piece(scene, visit, [&](const ObjectArray& array) {
        for (std::size_t round = 0; round < array.rounds; ++round) {
            for (const ObjectColumn& column : array.columns) {
                visit(object_of(column, round));
            }
        }
    });
}

/// Calls `visit(object)` with every object that has a surface of its own: members of solids instead of the
/// solids, after all others.
template <class Visit>
void for_each_surface(const Scene& scene, Visit visit) {
    for_each_object(scene, [&](const Object& object) {
        if (!std::holds_alternative<runtime::Csg<double>>(object.shape)) {
            visit(object);
        }
    });
    for (const Object& member : scene.members) {
        visit(member);
    }
}

} // namespace scc::compiler::ir
