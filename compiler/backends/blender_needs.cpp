#include "compiler/backends/blender_needs.h"

#include "compiler/backends/enclosed.h"
#include "compiler/bounds.h"
#include "compiler/ir/objects.h"
#include "runtime/illumination.h"

#include <algorithm>
#include <cmath>

namespace scc::compiler {

namespace {

using ir::Input;
using runtime::Phong;
using runtime::Vec3;

// Cycles follows a path no further.
constexpr int most_bounces = 1024;
// A bounce that can add no more than this share is left out.
constexpr double least_share = 1e-8;

template <class Wanted>
bool some_function(const ir::Scene& scene, std::uint32_t material, Wanted wanted) {
    const auto functions = ir::functions_of(scene.materials[material].phong);
    return std::any_of(functions.begin(), functions.end(), [&](std::int32_t index) {
        return index != runtime::no_function && wanted(scene.functions[static_cast<std::size_t>(index)]);
    });
}

template <class Wanted>
bool some_function(const ir::Scene& scene, const ir::Object& object, Wanted wanted) {
    return some_function(scene, object.sides.front, wanted) ||
           some_function(scene, object.sides.back, wanted);
}

bool reads_p(const ir::Function& function) {
    return function.reads(Input::p_x, Input::p_z);
}
bool reads_point(const ir::Function& function) {
    return reads_p(function) || function.reads(Input::world_x, Input::world_z);
}

// From which sides a mirror ray that leaves a shape can meet the same shape again.
struct MirrorView {
    bool front = false, back = false;
};
template <class Shape>
MirrorView sees_itself(const Shape& shape, const Vec3<double>& eye) {
    using namespace runtime;
    if constexpr (std::is_same_v<Shape, Mesh<double>> || std::is_same_v<Shape, Csg<double>> ||
                  std::is_same_v<Shape, Implicit<double>> || std::is_same_v<Shape, Torus<double>> ||
                  std::is_same_v<Shape, Quadric<double>>) {
        return {true, true};
    } else if constexpr (std::is_same_v<Shape, Triangle<double>>) {
        return {shape.smooth, shape.smooth};
    } else if constexpr (std::is_same_v<Shape, Plane<double>> || std::is_same_v<Shape, Disc<double>>) {
        return {false, false};
    } else if constexpr (std::is_same_v<Shape, Cylinder<double>> || std::is_same_v<Shape, Cone<double>>) {
        return {false, !shape.caps || encloses(shape, eye)};
    } else {
        return {false, encloses(shape, eye)};
    }
}

class Mirrors {
public:
    explicit Mirrors(const ir::Scene& scene) : scene_(scene) {
        ir::for_each_object(scene, [&](const ir::Object& object) {
            if (!std::holds_alternative<runtime::Csg<double>>(object.shape)) {
                add(object);
            }
        });
        for (const ir::Object& member : scene.members) {
            add(member);
            sees_itself_ |= reflects(member.sides.front) || reflects(member.sides.back); // or other members
        }
    }

    int bounces() const {
        if (scene_.settings.depth <= 0 || count_ == 0) {
            return 0;
        }
        int limit = std::min(scene_.settings.depth, most_bounces);
        if (count_ == 1 && !sees_itself_) {
            return 1;
        }
        if (strongest_ < 1) {
            limit = std::min(limit, 1 + static_cast<int>(std::log(least_share) / std::log(strongest_)));
        }
        return limit;
    }

    double cut_off(int bounces) const {
        const bool complete =
            bounces == scene_.settings.depth || (count_ == 1 && !sees_itself_) || count_ == 0;
        return complete ? 0 : std::pow(std::min(strongest_, 1.0), bounces + 1);
    }

private:
    void add(const ir::Object& object) {
        const bool front = reflects(object.sides.front), back = reflects(object.sides.back);
        if (!front && !back) {
            return;
        }
        ++count_;
        const Vec3<double> eye = transform_point(inverse(object.world_from_object), scene_.camera.eye);
        const MirrorView view =
            std::visit([&](const auto& shape) { return sees_itself(shape, eye); }, object.shape);
        sees_itself_ |= (front && view.front) || (back && view.back);
        strongest_ = std::max({strongest_, strength(object.sides.front), strength(object.sides.back)});
    }
    bool reflects(std::uint32_t material) const { return has_mirror(scene_.materials[material].phong); }
    double strength(std::uint32_t material) const {
        const auto& reflect = scene_.materials[material].phong.reflect;
        return !reflects(material) ? 0
               : reflect.function != runtime::no_function
                   ? 1
                   : std::max({reflect.value.r, reflect.value.g, reflect.value.b});
    }

    const ir::Scene& scene_;
    int count_ = 0;
    bool sees_itself_ = false;
    double strongest_ = 0;
};

class NeedsOf {
public:
    explicit NeedsOf(const ir::Scene& scene) : scene_(scene) {
        needs_.materials.resize(scene.materials.size());
        needs_.functions.resize(scene.functions.size());
        needs_.fields.resize(scene.functions.size());
        needs_.meshes.resize(scene.meshes.size());
    }

    BlenderNeeds find() {
        if (std::any_of(scene_.materials.begin(), scene_.materials.end(),
                        [](const ir::Material& material) { return lets_through(material.phong); })) {
            needs_.ways = blender_paths(scene_);
        }
        needs_.solids = blender_solids(scene_);
        ir::for_each_object(scene_, [&](const ir::Object& object) { add(object); });
        for (const ir::Light& light : scene_.lights) {
            want("light");
            std::visit([&](const auto& l) { add(l); }, light.light);
        }
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            if (needs_.materials[i]) {
                add(scene_.materials[i].phong);
            }
        }
        find_paths();
        add(scene_.camera);
        measure();
        return std::move(needs_);
    }

private:
    void want(std::string_view feature) { needs_.features.emplace(feature); }

    void find_paths() {
        if (needs_.sees_through()) {
            const auto longest = std::max_element(
                needs_.ways.paths.begin(), needs_.ways.paths.end(),
                [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
            needs_.bounces = static_cast<int>(longest->size());
            needs_.cut_off = needs_.ways.cut_off;
            want("through");
            want("mirror");
            return;
        }
        const Mirrors mirrors(scene_);
        needs_.bounces = mirrors.bounces();
        needs_.cut_off = mirrors.cut_off(needs_.bounces);
        want("opaque");
        if (needs_.bounces > 0) {
            want("mirror");
        }
    }

    void add(const runtime::Camera<double>& camera) {
        want(camera.projection == runtime::Projection::spherical ? "panorama" : "window");
        want(camera.lens_radius > 0 ? "lens" : "pinhole");
        if (scene_.settings.point == runtime::PixelPoint::corner) {
            want("corner");
        }
    }
    void add(const ir::Object& object) {
        if (!std::holds_alternative<runtime::Csg<double>>(object.shape)) {
            add(object.sides);
        }
        std::visit([&](const auto& shape) { add(object, shape); }, object.shape);
    }
    void want_formula(const BlenderFace& face) {
        using Formula = BlenderFace::Formula;
        switch (face.formula) {
        case Formula::none:
            return;
        case Formula::ball:
            want("ball");
            want("quadric");
            break;
        case Formula::round:
            want("round");
            want("quadric");
            break;
        case Formula::ring:
            want("ring");
            break;
        case Formula::quadric:
            want("any_quadric");
            want("quadric");
            break;
        case Formula::field:
            want("field");
            needs_.fields[static_cast<std::size_t>(face.field)] = true;
            add(*field_for_nodes(scene_, face.field));
            break;
        }
        want("formula");
    }
    void add(const ir::Object&, const runtime::Box<double>&) {
        want("box");
        want("flat");
    }
    void add(const ir::Object&, const runtime::Disc<double>& disc) {
        want("disc");
        want("flat");
        if (disc.hole > 0) {
            want("hole");
        }
    }
    void add(const ir::Object& object, const runtime::Sphere<double>&) {
        want("sphere");
        add_curved(object);
    }
    void add(const ir::Object& object, const runtime::Cylinder<double>& cylinder) {
        want("cylinder");
        add_curved(object);
        if (cylinder.caps) {
            want("cap");
            want("flat");
        }
    }
    void add(const ir::Object& object, const runtime::Cone<double>& cone) {
        want("cone");
        add_curved(object);
        if (cone.caps) {
            want("cap");
            want("flat");
        }
    }
    void add_curved(const ir::Object& object) {
        want("curved");
        if (some_function(scene_, object, reads_p)) {
            want("curved_p");
        }
    }
    void add(const ir::Object& object, const runtime::Plane<double>&) {
        want("plane");
        want(has_pattern(object, scene_) ? "horizon" : "flat");
    }
    void add(const runtime::Sides& sides) {
        needs_.materials[sides.front] = needs_.materials[sides.back] = true;
        if (sides.front != sides.back) {
            want("two_sided");
        }
    }
    void add(const ir::Object& object, const runtime::Implicit<double>&) { add_solid(object); }
    void add_solid(const ir::Object& object) {
        const auto solid = needs_.solids.find(object.path);
        if (solid == needs_.solids.end()) {
            return; // dropped
        }
        want("solid");
        const bool is_cut = solid->second.is_part;
        want(is_cut ? "smooth" : "flat");
        if (is_cut) {
            want("boolean");
        }
        for_each_part(solid->second, [&](const BlenderSolid& part) {
            for (const BlenderFace& face : part.faces) {
                add(face.sides);
                want_formula(face);
            }
        });
    }
    void add(const ir::Object& object, const runtime::Torus<double>&) {
        want("torus");
        add_curved(object);
    }
    void add(const ir::Object& object, const runtime::Quadric<double>&) { add_solid(object); }
    void add(const ir::Object& object, const runtime::Triangle<double>&) {
        want("triangle");
        want(is_smooth(object.shape, scene_) ? "smooth" : "flat");
    }
    void add(const ir::Object& object, const runtime::Csg<double>&) { add_solid(object); }
    void add(const ir::Object& object, const runtime::Mesh<double>& mesh) {
        want("mesh");
        want(is_smooth(object.shape, scene_) ? "smooth" : "flat");
        needs_.meshes[mesh.mesh] = true;
    }

    void add(const runtime::PointLight<double>& light) { // a rectangle light is many
        want("point");
        if (is_attenuated(light)) {
            want("attenuation");
        }
    }
    void add(const runtime::SpotLight<double>& light) {
        add(static_cast<const runtime::PointLight<double>&>(light));
        want("spot");
    }
    void add(const runtime::DirectionalLight<double>&) { want("directional"); }

    void add(const Phong<double>& phong) {
        if (is_present(phong.specular)) {
            want("specular");
        }
        if (is_present(phong.emission)) {
            want("emission");
        }
        if (phong.bump != runtime::no_function) {
            want("bump");
        }
        Phong<double> drawn = phong;
        if (!needs_.sees_through()) {
            drawn.transmit = {}; // is not written
        }
        for (const std::int32_t function : ir::functions_of(drawn)) {
            if (function != runtime::no_function) {
                needs_.functions[static_cast<std::size_t>(function)] = true;
                want("function");
                add(scene_.functions[static_cast<std::size_t>(function)]);
            }
        }
    }

    void add(const ir::Function& function) {
        if (function.reads(Input::uv_x, Input::uv_y)) {
            want("uv");
        }
        for (const std::shared_ptr<const ir::Image>& image : function.images) {
            want("image");
            if (std::none_of(needs_.images.begin(), needs_.images.end(),
                             [&](const auto& other) { return other->key == image->key; })) {
                needs_.images.push_back(image);
            }
        }
    }

    void measure() {
        runtime::Bounds<double> box = world_bounds(scene_);
        box.add(scene_.camera.eye);
        for (const ir::Light& light : scene_.lights) {
            std::visit([&](const auto& l) { include(l, box); }, light.light);
        }
        ir::for_each_shape(scene_, [&]<class Shape>(const Shape& shape, const runtime::Affine<double>& place,
                                                    const runtime::Sides&) {
            if constexpr (std::is_same_v<Shape, runtime::Plane<double>>) {
                box.add(foot(shape, place, scene_.camera.eye));
            }
        });
        needs_.center = box.center();
        const double extent = length(box.max - needs_.center);
        needs_.extent = extent > 0 ? extent : 1;
    }

    static void include(const runtime::PointLight<double>& light, runtime::Bounds<double>& box) {
        box.add(light.position);
    }
    static void include(const runtime::RectangleLight<double>& light, runtime::Bounds<double>& box) {
        box.add(light.position);
        box.add(light.position + (light.edge_u + light.edge_v));
    }
    static void include(const runtime::DirectionalLight<double>&, runtime::Bounds<double>&) {}

    static Vec3<double> foot(const runtime::Plane<double>& plane, const runtime::Affine<double>& place,
                             const Vec3<double>& eye) {
        const Vec3<double>& normal = plane.normal;
        const Vec3<double> m = transform_normal(inverse(place), normal);
        const Vec3<double> on_plane = transform_point(place, plane.offset * normal);
        return eye - (dot(m, eye - on_plane) / dot(m, m)) * m;
    }

    const ir::Scene& scene_;
    BlenderNeeds needs_;
};

} // namespace

bool is_present(const runtime::Varying<runtime::Rgb<double>>& color) {
    return color.function != runtime::no_function || !(color.value == runtime::Rgb<double>{});
}

bool is_smooth(const ir::Shape& shape, const ir::Scene& scene) {
    if (const auto* triangle = std::get_if<runtime::Triangle<double>>(&shape)) {
        return triangle->smooth;
    }
    const auto* mesh = std::get_if<runtime::Mesh<double>>(&shape);
    return mesh != nullptr && !scene.meshes[mesh->mesh].normals.empty();
}

bool is_window_flat(const runtime::Camera<double>& camera) {
    return camera.projection != runtime::Projection::spherical && camera.lens_radius == 0;
}

bool has_pattern(const ir::Object& object, const ir::Scene& scene) {
    return is_window_flat(scene.camera) && some_function(scene, object, reads_point);
}

BlenderNeeds blender_needs(const ir::Scene& scene) {
    return NeedsOf(scene).find();
}

} // namespace scc::compiler
