#include "compiler/ir/objects.h"
#include "compiler/ir/traits.h"
#include "compiler/passes/passes.h"
#include "runtime/illumination.h"
#include "runtime/primitive.h"

#include <algorithm>
#include <bit>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Rgb;
using runtime::SceneTraits;
using runtime::Varying;

bool is_present(const Varying<Rgb<double>>& color) {
    return color.function != runtime::no_function || !(color.value == Rgb<double>{});
}

void need_surface(SceneTraits& traits, const ir::Object& object, const ir::Scene& scene) {
    traits.two_sided |= object.sides.front != object.sides.back;
    if (const auto* triangle = std::get_if<runtime::Triangle<double>>(&object.shape)) {
        traits.smooth_normals |= triangle->smooth;
    } else if (const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape)) {
        traits.smooth_normals |= !scene.meshes[mesh->mesh].normals.empty();
    }
}

void need(SceneTraits& traits, const ir::Object& object, const ir::Scene& scene) {
    const std::uint32_t bit = 1U << object.shape.index();
    (object.world_from_object == Affine<double>{} ? traits.bare_shapes : traits.placed_shapes) |= bit;
    need_surface(traits, object, scene);
}

void need_member(SceneTraits& traits, const ir::Object& member, const ir::Scene& scene) {
    const std::uint32_t bit = 1U << member.shape.index();
    (member.world_from_object == Affine<double>{} ? traits.bare_members : traits.placed_members) |= bit;
    need_surface(traits, member, scene);
}

void need(SceneTraits& traits, const ir::ObjectColumn& column) {
    const std::uint32_t bit = 1U << column.shapes.index();
    (column.world_from_object == Affine<double>{} ? traits.bare_shapes : traits.placed_shapes) |= bit;
    traits.two_sided |= std::any_of(column.sides.begin(), column.sides.end(),
                                    [](const runtime::Sides& sides) { return sides.front != sides.back; });
    if (const auto* triangles = std::get_if<std::vector<runtime::Triangle<double>>>(&column.shapes)) {
        traits.smooth_normals |=
            std::any_of(triangles->begin(), triangles->end(), [](const auto& t) { return t.smooth; });
    }
}

void need(SceneTraits& traits, const runtime::Phong<double>& p, const ir::Scene& scene) {
    traits.specular |= is_present(p.specular);
    traits.emission |= is_present(p.emission);
    traits.transmission |= lets_through(p);
    if (scene.settings.method == runtime::Method::ray) {
        traits.reflection |= scene.settings.depth > 0 && is_present(p.reflect);
        traits.refraction |= refracts(p);
        traits.bump |= p.bump != runtime::no_function;
    }
    for (const std::int32_t function : ir::functions_of(p)) {
        if (function != runtime::no_function) {
            traits.functions = true;
            traits.uv |=
                scene.functions[static_cast<std::size_t>(function)].reads(ir::Input::uv_x, ir::Input::uv_y);
        }
    }
}

void need_of_points(SceneTraits& traits, const runtime::PointLight<double>& light) {
    traits.attenuation |= runtime::is_attenuated(light);
    traits.separate_specular |= !(light.diffuse == light.specular);
}

void need(SceneTraits& traits, const runtime::PointLight<double>& light) {
    traits.point_lights = true;
    need_of_points(traits, light);
}

void need(SceneTraits& traits, const runtime::SpotLight<double>& light) {
    traits.spot_lights = true;
    need_of_points(traits, light);
}

void need(SceneTraits& traits, const runtime::RectangleLight<double>& light) {
    traits.rectangle_lights = true;
    need_of_points(traits, light);
}

void need(SceneTraits& traits, const runtime::DirectionalLight<double>& light) {
    traits.directional_lights = true;
    traits.separate_specular |= !(light.diffuse == light.specular);
}

void add(SceneTraits& traits, const SceneTraits& more) {
    traits.bare_shapes |= more.bare_shapes;
    traits.placed_shapes |= more.placed_shapes;
    traits.bare_members |= more.bare_members;
    traits.placed_members |= more.placed_members;
    for (const ir::TraitFlag& flag : ir::trait_flags) {
        traits.*flag.member |= more.*flag.member;
    }
}

template <class Shape>
std::size_t count_bounded(const Shape&) {
    return runtime::is_bounded<Shape> ? 1 : 0;
}

} // namespace

std::vector<Need> needs_of(const ir::Scene& scene) {
    std::vector<Need> needs;
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            need(needs.emplace_back(SceneTraits{}, object.span).traits, object, scene);
        },
        [&](const ir::ObjectArray& array) {
            for (const ir::ObjectColumn& column : array.columns) {
                need(needs.emplace_back(SceneTraits{}, column.span_of(0)).traits, column);
            }
        });
    for (const ir::Object& member : scene.members) {
        need_member(needs.emplace_back(SceneTraits{}, member.span).traits, member, scene);
    }
    for (const ir::Material& material : scene.materials) {
        SceneTraits& traits = needs.emplace_back(SceneTraits{}, material.span).traits;
        need(traits, material.phong, scene);
        for (const runtime::Phong<double>& phong : material.bands) {
            need(traits, phong, scene);
        }
    }
    for (const ir::Light& light : scene.lights) {
        SceneTraits& traits = needs.emplace_back(SceneTraits{}, light.span).traits;
        traits.shadows = scene.settings.shadows && scene.settings.method == runtime::Method::ray;
        std::visit([&](const auto& l) { need(traits, l); }, light.light);
        traits.separate_specular |=
            std::any_of(light.bands.begin(), light.bands.end(),
                        [](const ir::LightColors& c) { return !(c.diffuse == c.specular); });
    }
    if (!scene.bands.empty()) {
        needs.emplace_back(SceneTraits{}, lang::Span{}).traits.spectra = true;
    }
    SceneTraits& camera = needs.emplace_back(SceneTraits{}, scene.camera_span).traits;
    camera.perspective = scene.camera.projection == runtime::Projection::perspective;
    camera.orthographic = scene.camera.projection == runtime::Projection::orthographic;
    camera.spherical = scene.camera.projection == runtime::Projection::spherical;
    camera.lens = scene.camera.lens_radius > 0;
    SceneTraits& method = needs.emplace_back(SceneTraits{}, scene.method_span).traits;
    method.pixel_sampling = !is_plain_grid(scene.settings);
    method.raster = scene.settings.method == runtime::Method::raster;
    method.lines = method.raster && shows_edges(scene.settings.raster.shading);
    for (const ir::Polyline& line : scene.polylines) {
        needs.emplace_back(SceneTraits{}, line.span).traits.lines = true;
    }
    return needs;
}

void derive_traits(ir::Scene& scene) {
    SceneTraits traits;
    for (const Need& need : needs_of(scene)) {
        add(traits, need.traits);
    }
    std::size_t bounded = 0;
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            bounded += std::visit([](const auto& shape) { return count_bounded(shape); }, object.shape);
        },
        [&](const ir::ObjectArray& array) {
            for (const ir::ObjectColumn& column : array.columns) {
                bounded +=
                    array.rounds *
                    std::visit([](const auto& shapes) { return count_bounded(shapes[0]); }, column.shapes);
            }
        });
    traits.accelerator = !traits.raster && bounded > runtime::accelerator_threshold;
    scene.traits = traits;
}

} // namespace scc::compiler
