#include "compiler/bounds.h"

#include "compiler/ir/objects.h"
#include "runtime/primitive.h"

namespace scc::compiler {

using runtime::Bounds;

std::optional<Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene) {
    return std::visit([&](const auto& s) { return object_bounds(s, scene); }, shape);
}

Bounds<double> solid_bounds(const ir::Scene& scene, std::size_t node) {
    return runtime::csg_bounds<double>(scene.csg_nodes, node, [&](const ir::CsgNode& leaf) {
        const ir::Object& member = scene.members[leaf.member];
        const bool is_bare = member.world_from_object == runtime::Affine<double>{};
        const Bounds<double> own = std::visit(
            [&](const auto& shape) {
                if constexpr (requires { shape.inside_bounds(); }) {
                    return shape.inside_bounds();
                } else {
                    return *object_bounds(shape, scene);
                }
            },
            member.shape);
        return is_bare ? own : runtime::transform_inside(member.world_from_object, own);
    });
}

Bounds<double> world_bounds(const ir::Scene& scene) {
    Bounds<double> box;
    ir::for_each_shape(scene,
                       [&](const auto& shape, const runtime::Affine<double>& place, const runtime::Sides&) {
                           if (const auto bounds = object_bounds(shape, scene)) {
                               box.add(transform_bounds(place, *bounds));
                           }
                       });
    return box;
}

} // namespace scc::compiler
