#include "compiler/lower_view.h"

#include "compiler/bounds.h"
#include "compiler/schema.h"
#include "compiler/values.h"
#include "lang/schema.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace scc::compiler {

using lang::Diag;
using lang::Thing;
using lang::TypeKind;
using runtime::Vec3;

namespace {

std::vector<const Thing*> things_of(const lang::Module& module, TypeKind type) {
    std::vector<const Thing*> found;
    for (const lang::ThingPtr& item : module.items) {
        if (item->constructor->type == type) {
            found.push_back(item.get());
        }
    }
    return found;
}

std::vector<const Thing*> settings_of(const lang::Module& module, std::string_view name) {
    std::vector<const Thing*> found = things_of(module, TypeKind::setting);
    std::erase_if(found, [&](const Thing* thing) { return thing->constructor->name != name; });
    return found;
}

/// The last one; null: none.
const Thing* world_of(const lang::Module& module) {
    const std::vector<const Thing*> worlds = settings_of(module, "world");
    return worlds.empty() ? nullptr : worlds.back();
}

const Thing* method_of(const Thing& render) {
    const lang::Value* method = render.get("method");
    return method != nullptr ? to_thing(*method).get() : nullptr;
}

runtime::Method method_kind(const Thing* method) {
    return method != nullptr && method->constructor->name == "raster" ? runtime::Method::raster
                                                                      : runtime::Method::ray;
}

/// What is drawn and how. Without a render by the method that is asked for, the first one tells the rest.
struct ChosenRender {
    runtime::Method method = runtime::Method::ray;
    const Thing* render = nullptr;   ///< null: there is none
    const Thing* settings = nullptr; ///< of the method; null: its defaults
};
ChosenRender choose_render(const lang::Module& module, std::optional<runtime::Method> wanted) {
    const std::vector<const Thing*> renders = settings_of(module, "render");
    if (renders.empty()) {
        return {wanted.value_or(runtime::Method::ray), nullptr, nullptr};
    }
    const runtime::Method method = wanted.value_or(method_kind(method_of(*renders.front())));
    for (const Thing* render : renders) {
        if (method_kind(method_of(*render)) == method) {
            return {method, render, method_of(*render)};
        }
    }
    return {method, renders.front(), nullptr};
}

/// Those that another method draws; a person who asked for a method knows.
void report_other_renders(const lang::Module& module, runtime::Method drawn, lang::Diagnostics& diagnostics) {
    for (const Thing* render : settings_of(module, "render")) {
        if (const runtime::Method method = method_kind(method_of(*render)); method != drawn) {
            const bool has_method = render->find("method") != nullptr;
            diagnostics.report(Diag::render_left_out, has_method ? place_of(*render, "method") : render->span,
                               word(runtime::method_names, method));
        }
    }
}

// ---- camera
// ------------------------------------------------------------------------------------------------

const Thing* choose_camera(const lang::Module& module, const LowerOptions& options,
                           lang::Diagnostics& diagnostics) {
    const std::vector<const Thing*> cameras = things_of(module, TypeKind::camera);
    std::string wanted = options.camera;
    lang::Span place;
    if (const Thing* render = choose_render(module, options.method).render;
        wanted.empty() && render != nullptr && render->find("camera") != nullptr) {
        wanted = to_text(*render->get("camera"));
        place = place_of(*render, "camera");
    }
    if (wanted.empty()) {
        return cameras.empty() ? nullptr : cameras.front();
    }
    std::string names;
    for (const Thing* camera : cameras) {
        if (camera->name == wanted) {
            return camera;
        }
        if (!camera->name.empty()) {
            names += (names.empty() ? "; there is `" : ", `") + camera->name + "`";
        }
    }
    diagnostics.report(Diag::unknown_camera, place, wanted,
                       names.empty() ? "; a camera gets its name from `let name = perspective_camera { }`"
                                     : names);
    return cameras.empty() ? nullptr : cameras.front();
}

// L2. False if the frame does not exist.
bool orient(runtime::Camera<double>& camera, Vec3<double> target, Vec3<double> up) {
    const Vec3<double> back = camera.eye - target;
    if (!(dot(back, back) > 0)) {
        return false;
    }
    camera.n = to_direction(back);
    const Vec3<double> right = cross(to_direction(up), camera.n);
    if (!(dot(right, right) > 1e-24)) {
        return false;
    }
    camera.u = normalize(right);
    camera.v = cross(camera.n, camera.u);
    return true;
}

void frame_everything(ir::Scene& scene, lang::Diagnostics& diagnostics) {
    const runtime::Bounds<double> box = world_bounds(scene);
    const bool bounded = box.min.x <= box.max.x;
    const Vec3<double> center = bounded ? 0.5 * (box.min + box.max) : Vec3<double>{0, 0, 0};
    const double radius = bounded ? 0.5 * length(box.max - box.min) : 1;
    const double fov_y = std::numbers::pi / 4;
    runtime::Camera<double>& camera = scene.camera;
    camera.half_height = std::tan(fov_y / 2);
    const double narrow = std::min(1.0, static_cast<double>(scene.settings.width) / scene.settings.height);
    const double distance = radius / std::sin(std::atan(narrow * camera.half_height));
    camera.eye = center + distance * normalize(Vec3<double>{1, 0.8, 2});
    orient(camera, center, {0, 1, 0});
    scene.camera.near = std::max(distance - radius, 1e-3 * distance);
    scene.camera.far = distance + radius;
    diagnostics.report(
        Diag::no_camera, lang::Span{},
        fmt::format(
            "perspective_camera {{ eye = ({:.4g}, {:.4g}, {:.4g}), target = ({:.4g}, {:.4g}, {:.4g}) }}",
            camera.eye.x, camera.eye.y, camera.eye.z, center.x, center.y, center.z));
}

void lower_window(const Thing& camera, ir::Scene& scene, lang::Diagnostics& diagnostics) {
    scene.camera.near = to_number(*camera.get("near"));
    scene.camera.far = to_number(*camera.get("far"));
    if (scene.camera.near >= scene.camera.far) {
        diagnostics.report(Diag::impossible_camera, place_of(camera, "near"),
                           fmt::format("near is {} and far is {}; near is less than far", scene.camera.near,
                                       scene.camera.far));
    }
    const auto& shift = std::get<lang::Vec2Value>(camera.get("shift")->v).v;
    scene.camera.shift_x = shift[0].value;
    scene.camera.shift_y = shift[1].value;
}

// ---- lights --------------------------------------------------------------------------------------------

/// By which a lamp's power multiplies its colour: the flux over the sphere is its intensity, and a white
/// surface scatters 1/pi of what arrives into each direction.
double strength_of(const Thing& light) {
    const lang::FieldValue* power = light.find("power");
    return power != nullptr ? to_number(power->value) / (4 * std::numbers::pi * std::numbers::pi) : 1;
}

ir::LightColors colors_of(const Thing& light, const Rendition& by) {
    const double strength = strength_of(light);
    const runtime::Rgb<double> diffuse = by.rendered(*light.get("color"), ColorRole::light) * strength;
    const lang::FieldValue* specular = light.find("specular");
    return {diffuse,
            specular != nullptr ? by.rendered(specular->value, ColorRole::light) * strength : diffuse};
}

/// What all lights have that shine from points.
runtime::PointLight<double> source_at(const Thing& thing, const char* position,
                                      lang::Diagnostics& diagnostics) {
    runtime::PointLight<double> light;
    light.position = to_vec3(*thing.get(position));
    const bool has_power = thing.find("power") != nullptr;
    if (has_power && thing.find("attenuation") != nullptr) {
        diagnostics.report(Diag::impossible_light, place_of(thing, "attenuation"),
                           "this light has both `attenuation` and `power`, which falls off as 1 / d^2");
    }
    const Vec3<double> k = has_power ? Vec3<double>{0, 0, 1} : to_vec3(*thing.get("attenuation"));
    light.kc = k.x;
    light.kl = k.y;
    light.kq = k.z;
    if (k.x == 0 && k.y == 0 && k.z == 0) {
        diagnostics.report(Diag::impossible_light, place_of(thing, "attenuation"),
                           "the attenuation is (0, 0, 0); one of kc, kl, kq is greater than 0");
    }
    return light;
}

runtime::SpotLight<double> spot_light(const Thing& thing, lang::Diagnostics& diagnostics) {
    runtime::SpotLight<double> light{source_at(thing, "position", diagnostics)};
    const Vec3<double> axis = to_vec3(*thing.get("target")) - light.position;
    if (!(length(axis) > 0)) {
        diagnostics.report(Diag::impossible_light, place_of(thing, "target"),
                           "`target` lies at `position`; a spot light shines from the one to the other");
        return light;
    }
    const double inner = to_radians(*thing.get("inner")), outer = to_radians(*thing.get("outer"));
    if (inner > outer) {
        const double degrees = 180 / std::numbers::pi;
        diagnostics.report(Diag::impossible_light, place_of(thing, thing.find("inner") ? "inner" : "outer"),
                           fmt::format("inner is {:.6g}deg and outer is {:.6g}deg; the light fades from "
                                       "`inner` to `outer`, which is not less",
                                       inner * degrees, outer * degrees));
    }
    light.axis = to_direction(axis);
    light.cos_inner = std::cos(inner);
    light.cos_outer = std::cos(outer);
    light.exponent = to_number(*thing.get("exponent"));
    return light;
}

runtime::RectangleLight<double> rectangle_light(const Thing& thing, lang::Diagnostics& diagnostics) {
    runtime::RectangleLight<double> light{source_at(thing, "corner", diagnostics)};
    light.edge_u = to_vec3(*thing.get("edge_u"));
    light.edge_v = to_vec3(*thing.get("edge_v"));
    if (!(length(cross(normalize(light.edge_u), normalize(light.edge_v))) > 1e-12)) {
        diagnostics.report(Diag::impossible_light, place_of(thing, "edge_v"),
                           "`edge_u` and `edge_v` are parallel; they span a rectangle");
    }
    const auto& samples = std::get<lang::Vec2Value>(thing.get("samples")->v).v;
    light.nu = static_cast<std::uint32_t>(samples[0].value);
    light.nv = static_cast<std::uint32_t>(samples[1].value);
    return light;
}

runtime::DirectionalLight<double> directional_light(const Thing& thing, lang::Diagnostics& diagnostics) {
    runtime::DirectionalLight<double> light;
    const bool direction = thing.find("direction") != nullptr;
    if (direction == (thing.find("towards") != nullptr)) {
        diagnostics.report(Diag::impossible_light, thing.span,
                           direction
                               ? "this light has both `direction` and `towards`; one of them says where it is"
                               : "this light has neither `direction` nor `towards`");
        return light;
    }
    light.to_light =
        to_direction(direction ? -to_vec3(*thing.get("direction")) : to_vec3(*thing.get("towards")));
    return light;
}

std::vector<const Thing*> enabled_lights(const lang::Module& module) {
    std::vector<const Thing*> lights = things_of(module, TypeKind::light);
    std::erase_if(lights, [](const Thing* light) { return !to_bool(*light->get("enabled")); });
    return lights;
}

std::string unique_light_name(const Thing& thing, std::set<std::string>& taken) {
    const std::string wanted = thing.name.empty() ? std::string(thing.constructor->name) : thing.name;
    std::string name = wanted;
    for (int i = 2; !taken.insert(name).second; ++i) {
        name = fmt::format("{} {}", wanted, i);
    }
    return name;
}

void lower_sampling(const Thing& ray, runtime::RenderSettings& settings, lang::Diagnostics& diagnostics) {
    settings.samples = static_cast<int>(to_number(*ray.get("samples")));
    settings.filter =
        runtime::choice_of<runtime::PixelFilter>(runtime::filter_names, to_text(*ray.get("filter")));
    if (const lang::Value* adaptive = ray.get("adaptive"); adaptive != nullptr) {
        settings.adaptive = to_number(*adaptive);
        settings.sampler = runtime::Sampler::low_discrepancy;
    }
    if (const lang::Value* sampler = ray.get("sampler"); sampler != nullptr) {
        settings.sampler = runtime::choice_of<runtime::Sampler>(runtime::sampler_names, to_text(*sampler));
    }
    if (settings.adaptive > 0 && settings.sampler == runtime::Sampler::grid) {
        const lang::Span place = place_of(ray, "sampler");
        diagnostics
            .report(Diag::impossible_sampling, place,
                    "`adaptive` stops between the samples of a pixel, which a grid has only as a whole")
            .suggest(place, "\"low_discrepancy\"");
    } else if (!fits_sampler(settings)) {
        diagnostics.report(Diag::impossible_sampling, place_of(ray, "samples"),
                           fmt::format("{} samples make no grid; their number is a square (1, 4, 9, 16, ...) "
                                       "unless `sampler` is \"low_discrepancy\"",
                                       settings.samples));
    }
}

void lower_raster(const Thing& raster, runtime::RenderSettings& settings) {
    settings.samples = static_cast<int>(to_number(*raster.get("samples")));
    settings.raster.shading = runtime::choice_of<runtime::RasterShading>(runtime::raster_shading_names,
                                                                         to_text(*raster.get("shading")));
    settings.raster.cull =
        runtime::choice_of<runtime::Cull>(runtime::cull_names, to_text(*raster.get("cull")));
    settings.raster.clip = to_bool(*raster.get("clip"));
    settings.raster.tessellation = to_number(*raster.get("tessellation"));
}

/// What a raster picture cannot be seen through.
void check_raster_camera(const Thing& thing, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    if (scene.settings.method != runtime::Method::raster) {
        return;
    }
    if (scene.camera.projection == runtime::Projection::spherical) {
        diagnostics.report(Diag::raster_needs_plane, thing.span);
    } else if (scene.camera.lens_radius > 0) {
        diagnostics.report(Diag::raster_leaves_out, place_of(thing, "aperture"), "lens",
                           "everything is drawn sharp");
    }
}

} // namespace

void lower_settings(const lang::Module& module, const LowerOptions& options, const Rendition& rec709,
                    ir::Scene& scene, lang::Diagnostics& diagnostics) {
    if (const Thing* world = world_of(module)) {
        scene.ambient = rec709.rendered(*world->get("ambient"), ColorRole::light);
        scene.background = rec709.rendered(*world->get("background"), ColorRole::light);
    }
    const ChosenRender chosen = choose_render(module, options.method);
    scene.settings.method = chosen.method;
    if (!options.method) {
        report_other_renders(module, chosen.method, diagnostics);
    }
    if (chosen.render == nullptr) {
        return;
    }
    const Thing& render = *chosen.render;
    if (const lang::Value* file = render.get("file"); file != nullptr) {
        scene.file = to_text(*file);
    }
    const auto& size = std::get<lang::Vec2Value>(render.get("size")->v).v;
    scene.settings.width = static_cast<int>(size[0].value);
    scene.settings.height = static_cast<int>(size[1].value);
    scene.settings.point =
        runtime::choice_of<runtime::PixelPoint>(runtime::pixel_point_names, to_text(*render.get("sampling")));
    if (chosen.settings == nullptr) {
        return;
    }
    scene.method_span = chosen.settings->span;
    if (chosen.method == runtime::Method::raster) {
        lower_raster(*chosen.settings, scene.settings);
    } else {
        scene.settings.depth = static_cast<int>(to_number(*chosen.settings->get("depth")));
        scene.settings.shadows = to_bool(*chosen.settings->get("shadows"));
        lower_sampling(*chosen.settings, scene.settings, diagnostics);
    }
}

void lower_camera(const lang::Module& module, const LowerOptions& options, ir::Scene& scene,
                  lang::Diagnostics& diagnostics) {
    const Thing* thing = choose_camera(module, options, diagnostics);
    if (thing == nullptr) {
        frame_everything(scene, diagnostics);
        return;
    }
    scene.camera_span = thing->span;
    runtime::Camera<double>& camera = scene.camera;
    camera.eye = to_vec3(*thing->get("eye"));
    const Vec3<double> target = to_vec3(*thing->get("target"));
    if (!orient(camera, target, to_vec3(*thing->get("up")))) {
        diagnostics.report(Diag::impossible_camera, thing->span,
                           "the camera's frame does not exist: `target` lies at `eye`, or `up` is parallel "
                           "to the line of sight");
    }
    if (thing->constructor->name == "spherical_camera") {
        camera.projection = runtime::Projection::spherical;
        camera.half_width = to_radians(*thing->get("fov_x")) / 2;
        camera.half_height = to_radians(*thing->get("fov_y")) / 2;
        check_raster_camera(*thing, scene, diagnostics);
        return;
    }
    lower_window(*thing, scene, diagnostics);
    if (thing->constructor->name == "perspective_camera") {
        camera.projection = runtime::Projection::perspective;
        camera.half_height = std::tan(to_radians(*thing->get("fov_y")) / 2);
        camera.lens_radius = to_number(*thing->get("aperture")) / 2;
        const lang::Value* focus = thing->get("focus");
        camera.focus = focus != nullptr ? to_number(*focus) : length(target - camera.eye);
    } else {
        camera.projection = runtime::Projection::orthographic;
        camera.half_height = to_number(*thing->get("height")) / 2;
    }
    check_raster_camera(*thing, scene, diagnostics);
}

void lower_lights(const lang::Module& module, const Rendition& rec709, ir::Scene& scene,
                  lang::Diagnostics& diagnostics) {
    std::set<std::string> names;
    for (const Thing* thing : enabled_lights(module)) {
        ir::Light light{.light = {}, .name = unique_light_name(*thing, names), .span = thing->span};
        const std::string_view kind = thing->constructor->name;
        if (kind == "point_light") {
            light.light = source_at(*thing, "position", diagnostics);
        } else if (kind == "spot_light") {
            light.light = spot_light(*thing, diagnostics);
        } else if (kind == "rectangle_light") {
            light.light = rectangle_light(*thing, diagnostics);
        } else {
            light.light = directional_light(*thing, diagnostics);
        }
        const ir::LightColors colors = colors_of(*thing, rec709);
        std::visit(
            [&](auto& l) {
                l.diffuse = colors.diffuse;
                l.specular = colors.specular;
            },
            light.light);
        scene.lights.push_back(std::move(light));
    }
    if (things_of(module, TypeKind::light).empty()) {
        diagnostics.report(Diag::no_light, lang::Span{});
        scene.lights.push_back({.light = runtime::DirectionalLight<double>{.to_light = scene.camera.n},
                                .name = "headlight",
                                .span = {}});
    }
}

const lang::Spectrum& illuminant_of(const lang::Module& module) {
    const Thing* world = world_of(module);
    return *lang::find_illuminant(world != nullptr ? to_text(*world->get("illuminant")) : "d65");
}

bool view_has_spectra(const lang::Module& module) {
    const auto has_spectra = [](const Thing* thing) {
        return std::any_of(thing->fields.begin(), thing->fields.end(),
                           [](const lang::FieldValue& field) { return lang::has_spectra(field.value); });
    };
    const std::vector<const Thing*> lights = enabled_lights(module);
    const Thing* world = world_of(module);
    return std::any_of(lights.begin(), lights.end(), has_spectra) ||
           (world != nullptr && (has_spectra(world) || to_text(*world->get("illuminant")) != "d65"));
}

void add_view_bands(const lang::Module& module, const std::vector<Rendition>& bands, ir::Scene& scene) {
    const Thing default_world{.constructor = scene_schema().find("world"),
                              .fields = {},
                              .children = {},
                              .name = {},
                              .span = {},
                              .rows = nullptr};
    const Thing* world = world_of(module) != nullptr ? world_of(module) : &default_world;
    const std::vector<const Thing*> lights = enabled_lights(module);
    const lang::Value white{lang::ColorValue{{lang::Scalar{1}, lang::Scalar{1}, lang::Scalar{1}}}};
    for (const Rendition& band : bands) {
        const auto& [red, green, blue] = band.to_rec709();
        scene.bands.push_back({band.rendered(*world->get("ambient"), ColorRole::light),
                               band.rendered(*world->get("background"), ColorRole::light),
                               {red[0], red[1], red[2]},
                               {green[0], green[1], green[2]},
                               {blue[0], blue[1], blue[2]}});
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            // The headlight of a scene without lights is white.
            const runtime::Rgb<double> headlight = band.rendered(white, ColorRole::light);
            scene.lights[i].bands.push_back(i < lights.size() ? colors_of(*lights[i], band)
                                                              : ir::LightColors{headlight, headlight});
        }
    }
}

} // namespace scc::compiler
