#include "compiler/backends/blender_ledger.h"

#include "compiler/backends/sampling_ledger.h"
#include "compiler/backends/spectra.h"
#include "compiler/ir/objects.h"
#include "runtime/illumination.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace scc::compiler {

namespace {

using runtime::Phong;
using runtime::Rgb;
using runtime::Varying;

struct Account {
    Fidelity fidelity;
    std::string how;
    double bound = 0;
};

// Positions this many times as large as the objects near them leave too few of 24 bits.
constexpr double farthest = 1e3;
// The near plane of a camera in Blender is at 1e-6 at least.
constexpr double smallest_scene = 1e-5;

template <class Shape>
Account account(const Shape&, bool mirror, bool smooth, bool pattern) {
    using namespace runtime;
    if constexpr (std::is_same_v<Shape, Sphere<double>> || std::is_same_v<Shape, Cylinder<double>> ||
                  std::is_same_v<Shape, Cone<double>> || std::is_same_v<Shape, Torus<double>>) {
        return {Fidelity::approximated,
                "hit and normal exact, computed in the material; outline and shadow by a mesh; bound in "
                "pixels, for a "
                "radius of up to 500",
                0.004};
    } else if constexpr (std::is_same_v<Shape, Quadric<double>>) {
        return {Fidelity::dropped, "Blender has no quadrics, and one without end has no mesh"};
    } else if constexpr (std::is_same_v<Shape, Disc<double>>) {
        return {Fidelity::approximated, "a polygon; bound of its rim in pixels", 0.004};
    } else if constexpr (std::is_same_v<Shape, Plane<double>>) {
        return {Fidelity::approximated,
                pattern ? "triangles to the horizon, the pattern exact where the camera sees it; in mirrors "
                          "its cells "
                          "may swap near the horizon; bound: sine of the flattest angle at which it is seen"
                        : "triangles to the horizon; bound: sine of the flattest angle at which it is seen",
                1e-6};
    } else if (smooth && mirror) {
        return {
            Fidelity::approximated,
            "normals interpolated exactly; Cycles bends mirror rays that would enter the surface, bound in "
            "radiance at such pixels",
            1};
    } else {
        return {Fidelity::exact,
                smooth ? "triangles, with normals interpolated in the material" : "triangles"};
    }
}

class Recorder {
public:
    Recorder(const ir::Scene& scene, const BlenderNeeds& needs, Ledger& ledger)
        : scene_(scene), needs_(needs), ledger_(ledger) {}

    void record() {
        ir::for_each_object(scene_, [&](const ir::Object& object) { record(object); });
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            if (needs_.materials[i]) {
                record(scene_.materials[i]);
            }
        }
        for (const ir::Light& light : scene_.lights) {
            std::visit([&](const auto& l) { record(light, l); }, light.light);
        }
        record_camera();
        record_settings();
    }

private:
    void add(Account account, std::string feature, const std::string& subject, lang::Span span) {
        ledger_.push_back({.fidelity = account.fidelity,
                           .feature = std::move(feature),
                           .subject = subject,
                           .span = span,
                           .how = std::move(account.how),
                           .bound = account.bound});
    }

    bool has_reflection(const Phong<double>& p) const {
        return needs_.sees_through() ? is_present(p.reflect) : has_mirror(p);
    }
    bool reflects(std::uint32_t material) const {
        return needs_.bounces > 0 && has_reflection(scene_.materials[material].phong);
    }

    void record(const ir::Object& object) {
        const auto solid = needs_.solids.find(object.path);
        if (solid != needs_.solids.end()) {
            record(object, solid->second);
            return;
        }
        const bool mirror = reflects(object.sides.front) || reflects(object.sides.back);
        const bool smooth = is_smooth(object.shape, scene_);
        const bool pattern = has_pattern(object, scene_);
        std::visit(
            [&]<class Shape>(const Shape& shape) {
                add(account(shape, mirror, smooth, pattern), std::string(Shape::name), object.path,
                    object.span);
            },
            object.shape);
        if (!(object.world_from_object == runtime::Affine<double>{})) {
            record_transform(object);
        }
        if (object.sides.front != object.sides.back) {
            record_sides(object);
        }
    }

    void record(const ir::Object& object, const BlenderSolid& solid) {
        const auto* csg = std::get_if<runtime::Csg<double>>(&object.shape);
        const auto name_of = []<class Shape>(const Shape&) { return std::string(Shape::name); };
        const std::string word = csg != nullptr ? std::string(ir::csg_word(scene_.csg_nodes[csg->root].op))
                                                : std::visit(name_of, object.shape);
        std::size_t triangles = 0, parts = 0, uncertain = 0;
        double deviation = 6e-8 * needs_.extent; // rounding of positions
        std::vector<BlenderFace> faces;
        for_each_part(solid, [&](const BlenderSolid& part) {
            triangles += part.slots.size();
            uncertain += part.uncertain;
            deviation = std::max(deviation, part.deviation);
            faces.insert(faces.end(), part.faces.begin(), part.faces.end());
            ++parts;
        });
        const std::string meshes =
            solid.is_part
                ? fmt::format("Blender's exact Boolean of {} closed meshes, {} triangles", parts, triangles)
                : fmt::format("a closed mesh of {} triangles", triangles);
        std::string how =
            fmt::format("{} with exact normals; {}bound: distance of the mesh from the surface", meshes,
                        has_formula(faces) ? "hits exact, computed in the material; " : "");
        const bool mirrors = std::any_of(faces.begin(), faces.end(), [&](const BlenderFace& face) {
            return reflects(face.sides.front) || reflects(face.sides.back);
        });
        if (solid.is_part && mirrors) {
            how += "; where normals are interpolated, Cycles bends mirror rays that would enter the surface";
        }
        if (uncertain > 0) {
            how += fmt::format("; {} places too small to tell whether there is more", uncertain);
        }
        add({Fidelity::approximated, std::move(how), deviation}, word, object.path, object.span);
        ledger_.back().is_refined_mesh = true;
        const bool is_placed = !(object.world_from_object == runtime::Affine<double>{});
        if (is_placed) {
            record_transform(object);
        }
        if (std::any_of(faces.begin(), faces.end(), [&](const BlenderFace& face) {
                return reads_uv(face.sides.front) || reads_uv(face.sides.back);
            })) {
            add({Fidelity::dropped, "the mesh of a solid has no coordinates on its surface"}, "uv",
                object.path, object.span);
        }
        const auto is_two_sided = [](const BlenderFace& face) { return face.sides.front != face.sides.back; };
        if (std::any_of(faces.begin(), faces.end(), is_two_sided)) {
            record_sides(object);
        }
    }
    bool reads_uv(std::uint32_t material) const {
        const auto functions = ir::functions_of(scene_.materials[material].phong);
        return std::any_of(functions.begin(), functions.end(), [&](std::int32_t index) {
            return index != runtime::no_function &&
                   scene_.functions[static_cast<std::size_t>(index)].reads(ir::Input::uv_x, ir::Input::uv_y);
        });
    }
    static bool has_formula(const std::vector<BlenderFace>& faces) {
        return std::any_of(faces.begin(), faces.end(), [](const BlenderFace& face) {
            return face.formula != BlenderFace::Formula::none;
        });
    }
    void record_transform(const ir::Object& object) {
        add({Fidelity::exact, "the object's matrix, shear and mirroring included"}, "transform", object.path,
            object.span);
    }
    void record_sides(const ir::Object& object) {
        add({Fidelity::exact, "chosen in the material by the side that is seen"}, "two_sided", object.path,
            object.span);
    }

    void record(const ir::Material& material) {
        const Phong<double>& p = material.phong;
        add({Fidelity::exact, "the formula in nodes, one view layer per light"}, "phong", material.name,
            material.span);
        if (needs_.bounces > 0 && has_reflection(p)) {
            add({Fidelity::exact, needs_.sees_through() ? "one view layer per sequence of ways"
                                                        : "one view layer per number of bounces"},
                "reflect", material.name, material.span);
        }
        if (lets_through(p)) {
            record_transparency(p, material);
        }
        record_function(p.ambient.function, "ambient", material);
        record_function(p.diffuse.function, "diffuse", material);
        record_function(p.specular.function, "specular", material);
        record_function(p.emission.function, "emission", material);
        record_function(p.reflect.function, "reflect", material);
        record_function(p.shininess.function, "shininess", material);
        if (p.bump != runtime::no_function) {
            add({Fidelity::exact,
                 "the height's slope in nodes, which tilts the normal; not of the artist's look"},
                "phong bump", material.name, material.span);
        }
    }
    void record_transparency(const Phong<double>& p, const ir::Material& material) {
        const std::string feature = p.fresnel != 0 ? "glass" : "transparency";
        if (!needs_.sees_through()) {
            add({Fidelity::dropped,
                 "nothing is seen through surfaces, and their shadows are black: " + needs_.ways.obstacle},
                feature, material.name, material.span);
        } else if (p.ior == 1 && p.fresnel == 0) {
            add({Fidelity::exact, "one view layer per sequence of ways; shadows are dimmed"}, feature,
                material.name, material.span);
        } else {
            add({Fidelity::approximated,
                 "one view layer per sequence of ways; rays leave curved surfaces from the mesh, with the "
                 "exact normal; bound in radiance at outlines",
                 1},
                feature, material.name, material.span);
        }
        record_function(p.transmit.function, "transmit", material);
    }
    void record_function(std::int32_t function, std::string_view field, const ir::Material& material) {
        if (function == runtime::no_function) {
            return;
        }
        const std::string& name = scene_.functions[static_cast<std::size_t>(function)].name;
        for (const ir::Node& node : scene_.functions[static_cast<std::size_t>(function)].nodes) {
            if (node.kind == ir::Node::Kind::apply &&
                (node.op == ir::Op::random || node.op == ir::Op::noise)) {
                add({Fidelity::dropped,
                     fmt::format("`{}` in `{}` is drawn as its mean, 0.5", row(node.op).name, name)},
                    fmt::format("per-point {}", field), material.name, material.span);
                return;
            }
        }
        if (!scene_.functions[static_cast<std::size_t>(function)].images.empty()) {
            add({Fidelity::approximated,
                 fmt::format(
                     "`{}` as Math nodes and images; bound: of what Cycles' filter of texels loses, in "
                     "their range, as measured",
                     name),
                 1.5e-6},
                fmt::format("per-point {}", field), material.name, material.span);
            return;
        }
        add({Fidelity::approximated,
             fmt::format("`{}` as Math nodes; bound: relative rounding of each operation", name), 6e-8},
            fmt::format("per-point {}", field), material.name, material.span);
    }

    void record(const ir::Light& light, const runtime::PointLight<double>& point) {
        record(light, point, "point_light",
               {Fidelity::exact, "a point lamp for what it reaches, its light computed in the materials"});
    }
    /// Cosines are floats there, of which the fade in a narrow cone uses few digits.
    void record(const ir::Light& light, const runtime::SpotLight<double>& spot) {
        constexpr double rounding = 1.2e-7, steepest = 1.5;
        const double width = spot.cos_inner - spot.cos_outer;
        const std::string how = "a point lamp for what it reaches, its cone computed in the materials";
        if (width > 1e-2) {
            record(light, spot, "spot_light", {Fidelity::exact, how});
        } else {
            record(light, spot, "spot_light",
                   {Fidelity::approximated, how + "; bound relative to the light in its middle",
                    width > 0 ? std::min(1.0, rounding * steepest / width) : 1});
        }
    }
    void record(const ir::Light& light, const runtime::RectangleLight<double>& rectangle) {
        record(light, rectangle, "rectangle_light",
               {Fidelity::exact,
                fmt::format("{} x {} point lamps, one view layer each", rectangle.nu, rectangle.nv)});
    }
    void record(const ir::Light& light, const runtime::PointLight<double>& point, std::string word,
                Account how) {
        add(std::move(how), std::move(word), light.name, light.span);
        if (is_attenuated(point)) {
            add({Fidelity::exact, "computed in the materials"}, "attenuation", light.name, light.span);
        }
        record_negative(light, point);
    }
    void record(const ir::Light& light, const runtime::DirectionalLight<double>& sun) {
        add({Fidelity::exact, "a sun for what it reaches, its light computed in the materials"},
            "directional_light", light.name, light.span);
        record_negative(light, sun);
    }
    template <class Light>
    void record_negative(const ir::Light& light, const Light& l) {
        const auto negative = [](const Rgb<double>& c) { return c.r < 0 || c.g < 0 || c.b < 0; };
        if (negative(l.diffuse) || negative(l.specular)) {
            add({Fidelity::dropped, "Cycles clamps light below 0"}, "negative color", light.name, light.span);
        }
    }

    void record_camera() {
        const runtime::Camera<double>& camera = scene_.camera;
        add({Fidelity::exact, "one ray through each pixel's centre"},
            fmt::format("{}_camera", word(runtime::projection_names, camera.projection)), "camera",
            scene_.camera_span);
        if (camera.lens_radius > 0) {
            add({Fidelity::approximated,
                 "Cycles' depth of field, 64 random points of the lens per pixel (`--samples`); bound: "
                 "standard "
                 "error of the mean over the range of what they see",
                 1 / (2 * std::sqrt(64.0))},
                "aperture", "camera", scene_.camera_span);
        }
        if (scene_.settings.point == runtime::PixelPoint::corner) {
            add(fits_after_shift()
                    ? Account{Fidelity::exact, "the window is shifted by half a pixel"}
                    : Account{Fidelity::dropped, "Cycles' panoramas end at the poles and behind"},
                "sampling", "render", scene_.method_span);
        }
        if (needs_.extent < smallest_scene) {
            add({Fidelity::dropped, "Blender's camera sees nothing nearer than 1e-6"}, "scale", "scene",
                scene_.camera_span);
        }
        const double distance = length(needs_.center);
        if (distance > farthest * needs_.extent) {
            add({Fidelity::approximated,
                 "far from the origin; bound: rounding of a coordinate over the scene's extent",
                 6e-8 * distance / needs_.extent},
                "position", "scene", scene_.camera_span);
        }
    }

    /// Whether what a panorama shows lies within a turn and between the poles when it is half a pixel off.
    bool fits_after_shift() const {
        const runtime::Camera<double>& camera = scene_.camera;
        const runtime::RenderSettings& settings = scene_.settings;
        const double n = samples_per_axis(settings);
        return camera.projection != runtime::Projection::spherical ||
               (camera.half_width * (1 + n / settings.width) <= std::numbers::pi &&
                camera.half_height * (1 + n / settings.height) <= std::numbers::pi / 2);
    }

    void record_settings() {
        if (needs_.sees_through()) {
            add({needs_.cut_off > 0 ? Fidelity::approximated : Fidelity::exact,
                 fmt::format(
                     "{} sequences of at most {} surfaces; bound: share of the light that one of the others "
                     "could add",
                     needs_.ways.paths.size(), needs_.bounces),
                 needs_.cut_off},
                "depth", "render", scene_.camera_span);
        } else if (needs_.cut_off > 0) {
            add({Fidelity::approximated,
                 fmt::format("{} of {} bounces; bound: share of the light that the others could add",
                             needs_.bounces, scene_.settings.depth),
                 needs_.cut_off},
                "depth", "render", scene_.camera_span);
        }
        if (!scene_.lights.empty()) {
            add({Fidelity::exact, scene_.settings.shadows ? "Cycles' shadow rays" : "lamps without shadows"},
                "shadows", "render", scene_.camera_span);
        }
        if (scene_.settings.samples > 1) {
            add({Fidelity::exact,
                 fmt::format(
                     "by `--size` {0} times larger and the mean of {0} x {0} pixels; the script itself takes "
                     "one sample",
                     samples_per_axis(scene_.settings))},
                "samples", "render", scene_.camera_span);
        }
        record_sampling(scene_, ledger_);
    }

    const ir::Scene& scene_;
    const BlenderNeeds& needs_;
    Ledger& ledger_;
};

} // namespace

void record_blender(const ir::Scene& scene, const BlenderNeeds& needs, Ledger& ledger) {
    Recorder(scene, needs, ledger).record();
    record_spectra(scene, ledger);
}

} // namespace scc::compiler
