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

std::array<std::int32_t, 6> functions_of(const runtime::Phong<double>& p) {
    return {p.ambient.function,  p.diffuse.function, p.specular.function,
            p.emission.function, p.reflect.function, p.shininess.function};
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
