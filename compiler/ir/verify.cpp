#include "compiler/ir/verify.h"

#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

namespace scc::compiler::ir {

namespace {

void require(bool condition, std::string_view what, std::string_view where) {
    if (!condition) {
        throw std::logic_error(fmt::format("internal error in the scene IR: {} ({})", what, where));
    }
}

void verify_function(const Function& function) {
    for (std::size_t i = 0; i < function.nodes.size(); ++i) {
        const Node& node = function.nodes[i];
        for (std::size_t k = 0; k < arity(node); ++k) {
            require(node.operands[k] < i, "an operand comes after its use", function.name);
        }
        if (node.kind == Node::Kind::image) {
            require(node.image < function.images.size() && node.channel < 3, "no such image", function.name);
        }
    }
    require(function.results.size() == 1 || function.results.size() == 3,
            "a function has one result or three", function.name);
    for (const std::uint32_t result : function.results) {
        require(result < function.nodes.size(), "a result is no node", function.name);
    }
}

void verify_varying(std::int32_t index, std::size_t results, const Scene& scene, std::string_view where) {
    require(index < static_cast<std::int32_t>(scene.functions.size()), "no such function", where);
    require(index < 0 || scene.functions[static_cast<std::size_t>(index)].results.size() == results,
            "a function has the wrong number of results", where);
}

void verify_phong(const runtime::Phong<double>& p, const Material& material, const Scene& scene) {
    for (const auto* color : {&p.ambient, &p.diffuse, &p.specular, &p.emission, &p.reflect, &p.transmit}) {
        verify_varying(color->function, 3, scene, material.name);
        require(std::isfinite(color->value.r) && std::isfinite(color->value.g) &&
                    std::isfinite(color->value.b),
                "a colour is not finite", material.name);
    }
    verify_varying(p.shininess.function, 1, scene, material.name);
    verify_varying(p.bump, 1, scene, material.name);
    require(std::isfinite(p.ior) && p.ior > 0, "an index of refraction is no positive number", material.name);
}

void verify_material(const Material& material, const Scene& scene) {
    verify_phong(material.phong, material, scene);
    require(material.bands.size() == scene.bands.size(), "a material has not one colour per band",
            material.name);
    for (const runtime::Phong<double>& phong : material.bands) {
        verify_phong(phong, material, scene);
    }
}

void verify_solid(const Object& object, const runtime::Csg<double>& solid, const Scene& scene) {
    require(solid.root < scene.csg_nodes.size(), "no such tree", object.path);
    require(solid.root + scene.csg_nodes[solid.root].size <= scene.csg_nodes.size(), "a tree is cut off",
            object.path);
    for_each_csg_node(scene, solid, [&](const CsgNode& node) {
        if (node.op == runtime::CsgOp::member) {
            require(node.size == 1 && node.member < scene.members.size(), "no such member", object.path);
        }
    });
}

void verify_object(const Object& object, const Scene& scene) {
    require(object.sides.front < scene.materials.size() && object.sides.back < scene.materials.size(),
            "no such material", object.path);
    for (const auto& matrix_row : object.world_from_object.m) {
        for (const double entry : matrix_row) {
            require(std::isfinite(entry), "a transform is not finite", object.path);
        }
    }
    if (const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape)) {
        require(mesh->mesh < scene.meshes.size(), "no such mesh", object.path);
    }
    if (const auto* solid = std::get_if<runtime::Csg<double>>(&object.shape)) {
        verify_solid(object, *solid, scene);
    }
    if (const auto* implicit = std::get_if<runtime::Implicit<double>>(&object.shape)) {
        require(implicit->field >= 0, "an implicit surface has a field", object.path);
        verify_varying(implicit->field, 1, scene, object.path);
    }
}

void verify_array(const ObjectArray& array, const Scene& scene) {
    require(array.before <= scene.objects.size() && array.rounds > 0 && !array.columns.empty(),
            "an array is empty or out of place", scene.name);
    for (const ObjectColumn& column : array.columns) {
        const std::size_t shapes = std::visit([](const auto& s) { return s.size(); }, column.shapes);
        require(shapes == array.rounds && (column.sides.size() == 1 || column.sides.size() == array.rounds),
                "a column has not one row per round", column.path);
        std::uint32_t last = 0;
        for (const runtime::Sides& sides : column.sides) {
            last = std::max({last, sides.front, sides.back});
        }
        require(last < scene.materials.size(), "no such material", column.path);
        // What it has in common with an object of its own
        verify_object(object_of(column, 0), scene);
    }
}

bool all_below(std::span<const std::uint32_t> indices, std::size_t count) {
    std::uint32_t largest = 0;
    for (const std::uint32_t index : indices) {
        largest = std::max(largest, index);
    }
    return indices.empty() || largest < count;
}

void verify_mesh(const Mesh& mesh) {
    require(mesh.indices.size() % 3 == 0 && !mesh.indices.empty(), "a mesh has whole triangles", mesh.name);
    require(mesh.normal_indices.empty() || mesh.normal_indices.size() == mesh.indices.size(),
            "one normal per corner", mesh.name);
    require(mesh.uv_indices.empty() || mesh.uv_indices.size() == mesh.indices.size(), "one uv per corner",
            mesh.name);
    require(all_below(mesh.uv_indices, mesh.uvs.size() / 2), "no such uv", mesh.name);
    require(all_below(mesh.indices, mesh.positions.size() / 3), "no such vertex", mesh.name);
    require(all_below(mesh.normal_indices, mesh.normals.size() / 3), "no such normal", mesh.name);
}

template <class Entries, class Name>
void verify_unique(const Entries& entries, Name name, std::string_view what) {
    std::set<std::string_view> names;
    for (const auto& entry : entries) {
        require(names.insert(name(entry)).second, what, name(entry));
    }
}

} // namespace

void verify(const Scene& scene) {
    for (const Function& function : scene.functions) {
        verify_function(function);
    }
    for (const Material& material : scene.materials) {
        verify_material(material, scene);
    }
    for (const Light& light : scene.lights) {
        require(light.bands.size() == scene.bands.size(), "a light has not one colour per band", light.name);
    }
    for (const Object& object : scene.objects) {
        verify_object(object, scene);
    }
    for (const Object& member : scene.members) {
        verify_object(member, scene);
        require(!std::holds_alternative<runtime::Csg<double>>(member.shape), "a solid is a member",
                member.path);
    }
    for (const ObjectArray& array : scene.arrays) {
        verify_array(array, scene);
    }
    for (const Mesh& mesh : scene.meshes) {
        verify_mesh(mesh);
    }
    verify_unique(
        scene.materials, [](const Material& m) -> std::string_view { return m.name; },
        "two materials share a name");
    verify_unique(
        scene.objects, [](const Object& o) -> std::string_view { return o.path; },
        "two objects share a path");
    verify_unique(
        scene.members, [](const Object& o) -> std::string_view { return o.path; },
        "two members share a path");
    verify_unique(
        scene.lights, [](const Light& l) -> std::string_view { return l.name; }, "two lights share a name");
    verify_unique(
        scene.meshes, [](const Mesh& m) -> std::string_view { return m.name; }, "two meshes share a name");
}

} // namespace scc::compiler::ir
