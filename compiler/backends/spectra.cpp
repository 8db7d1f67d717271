#include "compiler/backends/spectra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace scc::compiler {

namespace {

using Color = runtime::Rgb<double>;
using Field = runtime::Varying<Color>;
using Phong = runtime::Phong<double>;

/// A colour by the index of the band, and one for those who know none.
struct Rendered {
    Color rec709;
    std::function<Color(std::size_t)> band;
};

/// Of the light that a surface sends back: each wavelength by itself, or in Rec.709.
double difference(const ir::Scene& scene, const Rendered& light, const Rendered& surface) {
    Color exact{};
    for (std::size_t i = 0; i < scene.bands.size(); ++i) {
        const Color sent = light.band(i) * surface.band(i);
        const auto sum = [&](const Color& weights) {
            return weights.r * sent.r + weights.g * sent.g + weights.b * sent.b;
        };
        exact = exact + Color{sum(scene.bands[i].red), sum(scene.bands[i].green), sum(scene.bands[i].blue)};
    }
    const Color near = light.rec709 * surface.rec709;
    return std::max({std::abs(exact.r - near.r), std::abs(exact.g - near.g), std::abs(exact.b - near.b)});
}

bool is_constant(const Field& field) {
    return field.function == runtime::no_function;
}

Rendered surface(const ir::Material& material, Field Phong::*field) {
    return {(material.phong.*field).value,
            [&material, field](std::size_t i) { return (material.bands[i].*field).value; }};
}

/// The lights that a field reflects.
std::vector<Rendered> lights_on(const ir::Scene& scene, Field Phong::*field) {
    if (field == &Phong::ambient) {
        return {{scene.ambient, [&scene](std::size_t i) { return scene.bands[i].ambient; }}};
    }
    std::vector<Rendered> lights;
    for (const ir::Light& light : scene.lights) {
        const auto color = field == &Phong::specular ? &ir::LightColors::specular : &ir::LightColors::diffuse;
        const Color rec709 = std::visit(
            [&](const auto& l) { return field == &Phong::specular ? l.specular : l.diffuse; }, light.light);
        lights.push_back({rec709, [&light, color](std::size_t i) { return light.bands[i].*color; }});
    }
    return lights;
}

} // namespace

void record_spectra(const ir::Scene& scene, Ledger& ledger) {
    if (scene.bands.empty()) {
        return;
    }
    constexpr std::array fields{&Phong::ambient, &Phong::diffuse, &Phong::specular};
    for (const ir::Material& material : scene.materials) {
        double bound = 0;
        bool is_known = is_constant(material.phong.reflect);
        for (const auto field : fields) {
            is_known = is_known && is_constant(material.phong.*field);
            for (const Rendered& light : lights_on(scene, field)) {
                bound = std::max(bound, difference(scene, light, surface(material, field)));
            }
        }
        ledger.push_back({Fidelity::approximated, "spectrum", material.name, material.span,
                          is_known
                              ? "light and surface meet in Rec.709, not wavelength by wavelength; largest "
                                "difference of one term of one light, before attenuation"
                              : "light and surface meet in Rec.709, not wavelength by wavelength; the bound "
                                "leaves out what differs from point to point",
                          bound});
    }
}

} // namespace scc::compiler
