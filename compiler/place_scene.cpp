#include "compiler/place_scene.h"

#include "compiler/extent.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <variant>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Vec3;

/// In sizes of the scene: nearer to the origin, coordinates lose so few digits that they are left as the
/// author wrote them.
constexpr double far_from_origin = 64;

class Placing {
public:
    Placing(double scale, const Vec3<double>& offset) : scale_(scale), offset_(offset) {}

    void apply(Affine<double>& world_from_object) const {
        const Affine<double> place{
            {{scale_, 0, 0, offset_.x}, {0, scale_, 0, offset_.y}, {0, 0, scale_, offset_.z}}};
        world_from_object = compose(place, world_from_object);
    }
    void apply(Vec3<double>& p) const { p = p * scale_ + offset_; }
    void apply(runtime::DirectionalLight<double>&) const {}
    void apply(runtime::PointLight<double>& light) const {
        apply(light.position);
        light.kl /= scale_;
        light.kq /= scale_ * scale_;
    }
    void apply(runtime::RectangleLight<double>& light) const {
        apply(static_cast<runtime::PointLight<double>&>(light));
        light.edge_u = light.edge_u * scale_;
        light.edge_v = light.edge_v * scale_;
    }
    void apply(runtime::Camera<double>& camera) const {
        apply(camera.eye);
        for (double* length : {&camera.lens_radius, &camera.focus, &camera.near, &camera.far}) {
            *length *= scale_;
        }
        if (camera.projection == runtime::Projection::orthographic) {
            camera.half_height *= scale_;
        }
    }

private:
    double scale_;
    Vec3<double> offset_;
};

} // namespace

void place_scene(ir::Scene& scene, double scale, const Vec3<double>& offset) {
    const Placing placing(scale, offset);
    for (ir::Object& object : scene.objects) {
        if (!std::holds_alternative<runtime::Csg<double>>(object.shape)) { // whose members are in the world
            placing.apply(object.world_from_object);
        }
    }
    for (ir::Object& member : scene.members) {
        placing.apply(member.world_from_object);
    }
    for (ir::ObjectArray& array : scene.arrays) {
        for (ir::ObjectColumn& column : array.columns) {
            placing.apply(column.world_from_object);
        }
    }
    for (ir::Light& light : scene.lights) {
        std::visit([&](auto& one) { placing.apply(one); }, light.light);
    }
    for (ir::Polyline& line : scene.polylines) {
        for (Vec3<double>& p : line.points) {
            placing.apply(p);
        }
    }
    placing.apply(scene.camera);
}

std::optional<std::string> tied_to_place(const ir::Scene& scene) {
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
        const ir::Material& material = scene.materials[i];
        if (ir::material_reads(scene, i, ir::Input::world_x, ir::Input::world_z)) {
            return fmt::format("`{}` depends on places in the world", material.name);
        }
        if (material.phong.bump != runtime::no_function) {
            return fmt::format("the bumps of `{}` have their height in the world", material.name);
        }
    }
    return std::nullopt;
}

void recenter(ir::Scene& scene) {
    const Extent extent = extent_of(scene);
    if (!extent.is_usable() || extent.has_planes_alone ||
        !(length(extent.center) > far_from_origin * extent.size) || tied_to_place(scene)) {
        return;
    }
    const Vec3<double> origin = extent.round_center();
    place_scene(scene, 1, -origin);
    scene.settings.origin = {origin.x, origin.y, origin.z};
}

} // namespace scc::compiler
