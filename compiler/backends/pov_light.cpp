#include "compiler/backends/pov_light.h"

#include "compiler/backends/attenuation_fit.h"
#include "compiler/backends/pov_text.h"
#include "compiler/backends/surface_distance.h"
#include "compiler/ir/objects.h"
#include "runtime/illumination.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scc::compiler {

using runtime::Rgb;

namespace {

bool black(const Rgb<double>& c) {
    return c == Rgb<double>{};
}

bool has_highlights(const ir::Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), [](const ir::Material& material) {
        const auto& specular = material.phong.specular;
        return specular.function != runtime::no_function || !black(specular.value);
    });
}

/// A light as POV-Ray has it, which gives diffuse light and highlights in one colour.
struct Source {
    std::string head, tail; ///< what stands before and after the colour
};

class LightWriter {
public:
    LightWriter(const ir::Scene& scene, const PovFrame& frame, Writer& out, Ledger& ledger)
        : scene_(scene), frame_(frame), out_(out), ledger_(ledger), highlights_(has_highlights(scene)) {}

    void write(const ir::Light& light) {
        out_.line("// {}", comment_text(light.name));
        std::visit([&](const auto& l) { write(light, l); }, light.light);
    }

private:
    void write(const ir::Light& light, const runtime::PointLight<double>& point) {
        const DistanceRange range = surface_distances(scene_, point.position);
        const FadeSum sum = fades(point, range);
        write(point, sum, "");
        note(light, "point_light", {}, "light_source");
        note_attenuation(light, "point_light", point, sum, range);
        note_specular(light, point.diffuse, point.specular);
    }

    void write(const ir::Light& light, const runtime::SpotLight<double>& spot) {
        const auto degrees = [](double cosine) { return std::acos(cosine) * 180 / std::numbers::pi; };
        const DistanceRange range = surface_distances(scene_, spot.position);
        const FadeSum sum = fades(spot, range);
        // A shadowless spotlight would have no cone, so that its diffuse colour is that of highlights too.
        runtime::PointLight<double> source = spot;
        source.specular = spot.diffuse;
        write(source, sum,
              fmt::format(" spotlight point_at {} radius {} falloff {} tightness {}",
                          pov_vector(frame_.point(spot.position) + spot.axis),
                          number(degrees(spot.cos_inner)), number(degrees(spot.cos_outer)),
                          number(spot.exponent)));
        note(light, "spot_light", {}, "spotlight");
        note_attenuation(light, "spot_light", spot, sum, range);
        if (highlights_ && !(spot.diffuse == spot.specular)) {
            const Rgb<double> off = spot.specular + spot.diffuse * -1.0;
            note(light, "light specular", Fidelity::approximated,
                 "highlights have the light's diffuse colour; bound in radiance",
                 std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)}));
        } else {
            note_specular(light, spot.diffuse, spot.specular);
        }
    }

    /// All points fade alike, as fitted for the distances from any point of the rectangle.
    void write(const ir::Light& light, const runtime::RectangleLight<double>& rectangle) {
        const runtime::Vec3<double> middle = 0.5 * (rectangle.edge_u + rectangle.edge_v);
        const double reach = 0.5 * std::max(length(rectangle.edge_u + rectangle.edge_v),
                                            length(rectangle.edge_u - rectangle.edge_v));
        DistanceRange range = surface_distances(scene_, rectangle.position + middle);
        range = {std::max(0.0, range.near - reach), range.far + reach};
        const FadeSum sum = fades(rectangle, range);
        for_each_point(rectangle, [&](const runtime::PointLight<double>& point) { write(point, sum, ""); });
        note(light, "rectangle_light", {}, fmt::format("{} x {} light_sources", rectangle.nu, rectangle.nv));
        note_attenuation(light, "rectangle_light", rectangle, sum, range);
        note_specular(light, rectangle.diffuse, rectangle.specular);
    }

    FadeSum fades(const runtime::PointLight<double>& point, const DistanceRange& range) const {
        const double s = frame_.scale;
        return fade_lights({point.kc, point.kl / s, point.kq / (s * s)}, s * range.near, s * range.far);
    }

    void write(const runtime::PointLight<double>& point, const FadeSum& sum, const std::string& cone) {
        for (const Fade& fade : sum.lights) {
            Source source{pov_vector(frame_.point(point.position)), cone};
            if (fade.power != 0) {
                source.tail +=
                    fmt::format(" fade_distance {} fade_power {}", number(fade.distance), number(fade.power));
            }
            write(source, fade.gain, point.diffuse, point.specular);
        }
    }

    void write(const ir::Light& light, const runtime::DirectionalLight<double>& sun) {
        // Occluders beyond the light's plane would cast no shadow; POV-Ray sees nothing beyond 1e7 anyway.
        const Source source{pov_vector(1e6 * sun.to_light), " parallel point_at 0"};
        write(source, 1, sun.diffuse, sun.specular);
        note(light, "directional_light", {}, "parallel light_source");
        note_specular(light, sun.diffuse, sun.specular);
    }

    /// A shadowless light gives no highlight and, despite its name, obeys `projected_through`: it then shines
    /// where an object stands in the way. So Id - Is everywhere, less Id - Is in the shadows, goes on top of
    /// Is.
    void write(const Source& source, double gain, const Rgb<double>& diffuse, const Rgb<double>& specular) {
        const Rgb<double> both = (highlights_ ? specular : diffuse) * gain;
        const Rgb<double> rest = (diffuse + specular * -1.0) * gain;
        if (!black(both)) {
            write(source, both, "");
        }
        if (!highlights_ || black(rest)) {
            return;
        }
        write(source, rest, " shadowless");
        if (scene_.settings.shadows) {
            write(source, rest * -1.0,
                  fmt::format(" shadowless projected_through {{ {} }}", pov_objects_name));
        }
    }

    void write(const Source& source, const Rgb<double>& color, const std::string& kind) {
        out_.line("light_source {{ {} rgb scc_exposure*{}{}{} }}", source.head, pov_color(color), source.tail,
                  kind);
    }

    void note(const ir::Light& light, std::string feature, Fidelity fidelity, std::string how,
              double bound = 0) {
        ledger_.push_back({fidelity, std::move(feature), light.name, light.span, std::move(how), bound});
    }

    void note_attenuation(const ir::Light& light, std::string_view word,
                          const runtime::PointLight<double>& point, const FadeSum& sum,
                          const DistanceRange& range) {
        if (!is_attenuated(point)) {
            return;
        }
        const std::string feature = fmt::format("{} attenuation", word);
        if (sum.exact) {
            note(light, feature, Fidelity::exact,
                 fmt::format("sum of {} lights with fade_distance and fade_power", sum.lights.size()));
            return;
        }
        note(light, feature, Fidelity::approximated,
             fmt::format(
                 "sum of {} lights with fade_distance and fade_power, fitted for distances from {:.6g} to "
                 "{:.6g}; bound relative to the light's intensity at the nearer",
                 sum.lights.size(), range.near, range.far),
             sum.bound);
    }

    void note_specular(const ir::Light& light, const Rgb<double>& diffuse, const Rgb<double>& specular) {
        if (!(diffuse == specular)) {
            note(light, "light specular", Fidelity::exact,
                 highlights_ ? "Id - Is by shadowless lights on top of Is"
                             : "left out: no material has a highlight");
        }
    }

    const ir::Scene& scene_;
    const PovFrame& frame_;
    Writer& out_;
    Ledger& ledger_;
    bool highlights_;
};

} // namespace

bool needs_object_union(const ir::Scene& scene) {
    return scene.settings.shadows && has_highlights(scene) && ir::object_count(scene) > 0 &&
           std::any_of(scene.lights.begin(), scene.lights.end(), [](const ir::Light& light) {
               return !std::holds_alternative<runtime::SpotLight<double>>(light.light) &&
                      std::visit([](const auto& l) { return !(l.diffuse == l.specular); }, light.light);
           });
}

void emit_lights(const ir::Scene& scene, const PovFrame& frame, Writer& out, Ledger& ledger) {
    LightWriter writer(scene, frame, out, ledger);
    for (const ir::Light& light : scene.lights) {
        writer.write(light);
    }
}

} // namespace scc::compiler
