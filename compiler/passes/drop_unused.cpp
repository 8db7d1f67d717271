#include "compiler/ir/objects.h"
#include "compiler/passes/passes.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace scc::compiler {

namespace {

using runtime::Rgb;

// Keeps the marked entries in their order; returns the new index of every old one.
template <class T>
std::vector<std::uint32_t> keep(std::vector<T>& entries, const std::vector<bool>& used) {
    std::vector<std::uint32_t> renumbered(entries.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (used[i]) {
            renumbered[i] = static_cast<std::uint32_t>(count);
            if (count != i) {
                entries[count] = std::move(entries[i]);
            }
            ++count;
        }
    }
    entries.resize(count);
    return renumbered;
}

bool is_black(const Rgb<double>& c) {
    return c == Rgb<double>{};
}

bool gives_nothing(const ir::Light& light) {
    return std::visit([](const auto& l) { return is_black(l.diffuse) && is_black(l.specular); }, light.light);
}

template <class Visit>
void for_each_function_index(runtime::Phong<double>& phong, Visit visit) {
    visit(phong.ambient.function);
    visit(phong.diffuse.function);
    visit(phong.specular.function);
    visit(phong.emission.function);
    visit(phong.reflect.function);
    visit(phong.transmit.function);
    visit(phong.shininess.function);
    visit(phong.bump);
}

template <class Visit>
void for_each_sides(ir::Scene& scene, Visit visit) {
    for (ir::Object& object : scene.objects) {
        visit(object.sides);
    }
    for (ir::Object& member : scene.members) {
        visit(member.sides);
    }
    for (ir::ObjectArray& array : scene.arrays) {
        for (ir::ObjectColumn& column : array.columns) {
            std::for_each(column.sides.begin(), column.sides.end(), visit);
        }
    }
}

void drop_materials(ir::Scene& scene) {
    std::vector<std::uint8_t> is_used(scene.materials.size()); // bytes: millions of objects write here
    for_each_sides(scene,
                   [&](const runtime::Sides& sides) { is_used[sides.front] = is_used[sides.back] = 1; });
    const std::vector<bool> used(is_used.begin(), is_used.end());
    if (std::find(used.begin(), used.end(), false) == used.end()) {
        return;
    }
    const auto renumbered = keep(scene.materials, used);
    for_each_sides(scene, [&](runtime::Sides& sides) {
        sides = {renumbered[sides.front], renumbered[sides.back]};
    });
}

/// Those of a kind that no array holds.
template <class Shape, class Visit>
void for_each_of(ir::Scene& scene, Visit visit) {
    for (auto* objects : {&scene.objects, &scene.members}) {
        for (ir::Object& object : *objects) {
            if (auto* shape = std::get_if<Shape>(&object.shape)) {
                visit(*shape);
            }
        }
    }
}

template <class Visit>
void for_each_function_index(ir::Scene& scene, Visit visit) {
    for (ir::Material& material : scene.materials) {
        for_each_function_index(material.phong, visit);
        for (runtime::Phong<double>& phong : material.bands) {
            for_each_function_index(phong, visit);
        }
    }
}

void drop_functions(ir::Scene& scene) {
    std::vector<bool> used(scene.functions.size());
    for_each_of<runtime::Implicit<double>>(
        scene, [&](auto& shape) { used[static_cast<std::size_t>(shape.field)] = true; });
    for_each_function_index(scene, [&](std::int32_t index) {
        if (index >= 0) {
            used[static_cast<std::size_t>(index)] = true;
        }
    });
    const auto renumbered = keep(scene.functions, used);
    for_each_of<runtime::Implicit<double>>(scene, [&](auto& shape) {
        shape.field = static_cast<std::int32_t>(renumbered[static_cast<std::size_t>(shape.field)]);
    });
    for_each_function_index(scene, [&](std::int32_t& index) {
        if (index >= 0) {
            index = static_cast<std::int32_t>(renumbered[static_cast<std::size_t>(index)]);
        }
    });
}

void drop_meshes(ir::Scene& scene) {
    std::vector<bool> used(scene.meshes.size());
    for_each_of<runtime::Mesh<double>>(scene, [&](auto& mesh) { used[mesh.mesh] = true; });
    const auto renumbered = keep(scene.meshes, used);
    for_each_of<runtime::Mesh<double>>(scene, [&](auto& mesh) { mesh.mesh = renumbered[mesh.mesh]; });
}

} // namespace

void drop_unused(ir::Scene& scene) {
    std::erase_if(scene.lights, gives_nothing);
    drop_materials(scene);
    drop_functions(scene);
    drop_meshes(scene);
}

} // namespace scc::compiler
