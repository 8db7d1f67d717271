#include "compiler/cli/explain_terms.h"

#include "lang/spectrum.h"
#include "runtime/host/image_file.h"
#include "runtime/host/options.h"

#include <cmath>

namespace scc::cli {

using runtime::Feeler;
using runtime::LightTerms;
using runtime::RayTerms;
using runtime::Rgb;
using runtime::Vec3;

std::string text(double v) {
    return fmt::format("{:.6g}", v);
}
std::string text(const Vec3<double>& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}
std::string text(const Rgb<double>& c) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", c.r, c.g, c.b);
}

bool is_black(const Rgb<double>& c) {
    return c == Rgb<double>{};
}

Rgb<double> ambient_of(const compiler::ir::Scene& scene, std::size_t band) {
    return scene.bands.empty() ? scene.ambient : scene.bands[band].ambient;
}
Rgb<double> background_of(const compiler::ir::Scene& scene, std::size_t band) {
    return scene.bands.empty() ? scene.background : scene.bands[band].background;
}

compiler::PrecisionChoice choose_precision(const compiler::ir::Scene& scene,
                                           const runtime::RenderRequest& request,
                                           const ExplainOptions& options) {
    if (options.precision) {
        return {*options.precision, "asked for"};
    }
    if (!host::keeps_8_bits(scene.file, options.render.bits)) {
        return {compiler::Precision::full, "the scene names no `file` that keeps but 8 bits of each value"};
    }
    return compiler::choose_precision_for_8_bits(scene, request.settings, {.threads = request.threads});
}

compiler::PixelPlace place_of_sample(const runtime::RenderSettings& settings, const ExplainOptions& options) {
    const auto [x, y] = *options.pixel;
    const int n = samples_per_axis(settings);
    if (x >= settings.width || y >= settings.height) {
        throw host::UsageError(fmt::format("there is no pixel {},{}; the picture has {} x {} pixels", x, y,
                                           settings.width, settings.height));
    }
    const auto [i, j] = options.sample.value_or(std::pair{n / 2, n / 2});
    if (i >= n || j >= n) {
        throw host::UsageError(fmt::format("there is no sample {},{}; each pixel has {} x {}", i, j, n, n));
    }
    return {x, y, i, j};
}

std::string heading(const compiler::ir::Scene& scene, const runtime::RenderSettings& settings,
                    const compiler::PixelPlace& place, const compiler::PrecisionChoice& precision,
                    std::size_t band, bool is_plain) {
    const int n = samples_per_axis(settings);
    std::string out = fmt::format("pixel {},{} of scene `{}`, {} x {} pixels", place.x, place.y, scene.name,
                                  settings.width, settings.height);
    out += n == 1
               ? fmt::format(", one sample at its {}\n",
                             settings.point == runtime::PixelPoint::corner ? "lower left corner" : "centre")
               : fmt::format("; sample {},{} of {} x {}, from the top left corner\n", place.i, place.j, n, n);
    if (!is_plain) {
        out += "as by a plain grid with the box filter, which is not what the scene asks for\n";
    }
    out += fmt::format("in {}: {}\n", name_of(precision.precision), precision.reason);
    if (const auto& o = settings.origin; o != decltype(settings.origin){}) {
        out +=
            fmt::format("the scene stands far from the world's origin: coordinates count from ({}, {}, {})\n",
                        text(o[0]), text(o[1]), text(o[2]));
    }
    if (!scene.bands.empty()) {
        const auto wavelength = [&](std::size_t k) { return lang::wavelength(3 * band + k); };
        out += fmt::format("colours are those of {}, {} and {} nm, the middle ones of {} times three\n",
                           wavelength(0), wavelength(1), wavelength(2), scene.bands.size());
    }
    return out;
}

void TermsWriter::light(const RayTerms& ray, std::size_t depth) {
    line(depth, "light from there (L7): R = {}", text(ray.light));
    line(depth + 1, "ambient: Ia ra = {} {} = {}", text(ambient_), text(ray.ambient),
         text(ambient_ * ray.ambient));
    if (!is_black(ray.emission)) {
        line(depth + 1, "emission: {}", text(ray.emission));
    }
    for (const LightTerms& terms : ray.lights) {
        write(terms, ray, depth + 1);
    }
}

void TermsWriter::write(const LightTerms& terms, const RayTerms& ray, std::size_t depth) {
    line(depth, "{}: s = {}, {}s.m = {}", names_.light(terms), text(terms.to_light),
         std::isinf(terms.distance) ? "" : fmt::format("d = {}, ", text(terms.distance)), text(terms.cosine));
    if (!(terms.cosine > 0)) {
        line(depth + 1, "s.m is not greater than 0: it shines on the other side, and adds nothing");
        return;
    }
    if (!terms.is_in_cone) {
        line(depth + 1, "the point lies outside its cone: it adds nothing");
        return;
    }
    if (!has_shadows_) {
        line(depth + 1, "shadows are off");
    }
    for (const Feeler& feeler : terms.feelers) {
        write(feeler, depth + 1);
    }
    if (!terms.reaches) {
        return;
    }
    line(depth + 1, "diffuse: Id rd (s.m) = {}, with rd = {}", text(terms.diffuse), text(ray.diffuse));
    if (!is_black(ray.specular)) {
        line(depth + 1, "specular: Is rs ((h.m)/|h|)^a = {}, with rs = {}, a = {}, the power {}",
             text(terms.specular), text(ray.specular), text(ray.shininess), text(terms.highlight));
    }
    if (terms.attenuation != 1) {
        line(depth + 1, "attenuation: kc + kl d + kq d^2 = {}, by which both are divided",
             text(terms.attenuation));
    }
    if (terms.kind == LightTerms::Kind::spot) {
        line(depth + 1, "cone: multiplied by {}", text(terms.cone_share));
    }
    line(depth + 1, "adds {}", text(terms.adds));
}

void TermsWriter::write(const Feeler& feeler, std::size_t depth) {
    if (!feeler.is_blocked) {
        line(depth, "shadow feeler (L14): nothing before the light");
    } else if (!feeler.filter || is_black(*feeler.filter)) {
        line(depth, "shadow feeler (L14): {} is in the way at t = {}: no diffuse, no specular",
             names_.object(feeler.id), text(feeler.t));
    } else {
        line(depth, "shadow feeler (L14): {} is in the way at t = {} and leaves {} of the light",
             names_.object(feeler.id), text(feeler.t), text(*feeler.filter));
    }
}

} // namespace scc::cli
