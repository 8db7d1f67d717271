#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>

namespace scc::compiler::ir {

lang::Span ObjectColumn::span_of(std::size_t round) const {
    lang::Span place = span;
    if (places) {
        std::tie(place.begin, place.end) = (*places)[first_place + round];
    }
    return place;
}

std::string ObjectColumn::path_of(std::size_t round) const {
    return fmt::format("{}[{}]", path, first_number + round * number_step);
}

std::size_t object_count(const Scene& scene) {
    std::size_t count = scene.objects.size();
    for (const ObjectArray& array : scene.arrays) {
        count += array.rounds * array.columns.size();
    }
    return count;
}

namespace {

void add_iors(const Scene& scene, const runtime::Sides& sides, std::vector<double>& iors) {
    for (const std::uint32_t side : {sides.front, sides.back}) {
        const runtime::Phong<double>& phong = scene.materials[side].phong;
        const auto place = std::lower_bound(iors.begin(), iors.end(), phong.ior);
        if (lets_through(phong) && (place == iors.end() || *place != phong.ior)) {
            iors.insert(place, phong.ior);
        }
    }
}

} // namespace

std::vector<double> iors_of_solid(const Scene& scene, std::size_t root) {
    std::vector<double> iors;
    for_each_csg_node(scene, runtime::Csg<double>{static_cast<std::uint32_t>(root)},
                      [&](const CsgNode& node) {
                          if (node.op == runtime::CsgOp::member) {
                              add_iors(scene, scene.members[node.member].sides, iors);
                          }
                      });
    return iors;
}

bool has_mesh(const Scene& scene, const runtime::Csg<double>& solid) {
    bool result = false;
    for_each_csg_node(scene, solid, [&](const CsgNode& node) {
        result = result || (node.op == runtime::CsgOp::member &&
                            std::holds_alternative<runtime::Mesh<double>>(scene.members[node.member].shape));
    });
    return result;
}

std::vector<double> iors_of(const Scene& scene, const Object& object) {
    if (const auto* solid = std::get_if<runtime::Csg<double>>(&object.shape)) {
        return iors_of_solid(scene, solid->root);
    }
    std::vector<double> iors;
    add_iors(scene, object.sides, iors);
    return iors;
}

std::array<std::int32_t, 8> functions_of(const runtime::Phong<double>& p) {
    return {p.ambient.function, p.diffuse.function,  p.specular.function,  p.emission.function,
            p.reflect.function, p.transmit.function, p.shininess.function, p.bump};
}

bool material_reads(const Scene& scene, std::uint32_t material, Input first, Input last) {
    for (const std::int32_t index : functions_of(scene.materials[material].phong)) {
        if (index != runtime::no_function &&
            scene.functions[static_cast<std::size_t>(index)].reads(first, last)) {
            return true;
        }
    }
    return false;
}

std::vector<const Image*> images_of(const Scene& scene) {
    std::vector<const Image*> images;
    for (const Function& function : scene.functions) {
        for (const std::shared_ptr<const Image>& image : function.images) {
            if (std::find(images.begin(), images.end(), image.get()) == images.end()) {
                images.push_back(image.get());
            }
        }
    }
    return images;
}

std::string_view csg_word(runtime::CsgOp op) {
    switch (op) {
    case runtime::CsgOp::member:
        return "member";
    case runtime::CsgOp::unite:
        return "union";
    case runtime::CsgOp::intersect:
        return "intersection";
    case runtime::CsgOp::subtract:
        return "difference";
    }
    return "";
}

Object object_of(const ObjectColumn& column, std::size_t round) {
    return {std::visit([&](const auto& shapes) { return Shape{shapes[round]}; }, column.shapes),
            column.world_from_object, column.sides_of(round), column.path_of(round), column.span_of(round)};
}

} // namespace scc::compiler::ir
