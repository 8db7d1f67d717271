#include "compiler/bounds.h"

#include "compiler/ir/objects.h"
#include "runtime/primitive.h"

#include <cmath>

namespace scc::compiler {

using runtime::Bounds;
using runtime::Vec3;

std::optional<Bounds<double>> object_bounds(const ir::Shape& shape, const ir::Scene& scene) {
    return std::visit([&](const auto& s) { return object_bounds(s, scene); }, shape);
}

Bounds<double> solid_bounds(const ir::Scene& scene, std::size_t node) {
    return runtime::csg_bounds<double>(scene.csg_nodes, node, [&](const ir::CsgNode& leaf) {
        const ir::Object& member = scene.members[leaf.member];
        const bool is_bare = member.world_from_object == runtime::Affine<double>{};
        if (const auto* plane = std::get_if<runtime::Plane<double>>(&member.shape)) {
            const Vec3<double> all{INFINITY, INFINITY, INFINITY};
            return is_bare ? plane->half_space_bounds() : Bounds<double>{-all, all};
        }
        const Bounds<double> own = *object_bounds(member.shape, scene);
        return is_bare ? own : transform_bounds(member.world_from_object, own);
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
