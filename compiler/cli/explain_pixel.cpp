#include "compiler/backends/render.h"
#include "compiler/cli/explain.h"
#include "compiler/cli/explain_names.h"
#include "compiler/cli/explain_terms.h"
#include "lang/spectrum.h"
#include "runtime/host/image_file.h"
#include "runtime/host/srgb.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <variant>
#include <vector>

namespace scc::cli {

namespace {

using runtime::Candidate;
using runtime::Feeler;
using runtime::LightTerms;
using runtime::RayTerms;
using runtime::Rgb;
using runtime::Vec3;

constexpr std::size_t most_candidates = 24; ///< of a ray; the rest is counted

std::string bits_text(const Rgb<float>& c) {
    return fmt::format("({}, {}, {})", c.r, c.g, c.b);
}
/// As a further term of a sum.
std::string term(double v) {
    return fmt::format("{} {:.6g}", v < 0 ? "-" : "+", std::abs(v));
}
bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same_bits(const Rgb<float>& a, const Rgb<float>& b) {
    return same_bits(a.r, b.r) && same_bits(a.g, b.g) && same_bits(a.b, b.b);
}

/// Writes the rays as they follow from each other, each below the one that it comes from.
class RayWriter : TermsWriter {
public:
    RayWriter(const compiler::ir::Scene& scene, const runtime::RenderSettings& settings, Names names,
              const compiler::ExplainedPixel& explained)
        : TermsWriter(std::move(names), ambient_of(scene, explained.band), settings.shadows), scene_(scene),
          settings_(settings), explained_(explained) {}

    std::string run() {
        write(0, 0);
        return take();
    }

private:
    Rgb<double> background() const { return background_of(scene_, explained_.band); }

    void write(std::size_t index, std::size_t depth) {
        const RayTerms& ray = explained_.how.rays[index];
        static constexpr std::array<const char*, 3> ways{"PRIMARY RAY", "MIRRORED RAY",
                                                         "RAY THROUGH THE SURFACE"};
        line(depth, "{} from {} along {}", ways[static_cast<std::size_t>(ray.way)], text(ray.org),
             text(ray.dir));
        if (index > 0) {
            line(depth + 1, "what it sees counts {} times; mirrors and refractions so far: {}",
                 text(ray.weight), ray.bounces);
        }
        candidates(ray, depth + 1);
        if (!ray.has_met) {
            line(depth + 1, "it meets nothing: background {}", text(background()));
            return;
        }
        encounter(ray, depth + 1);
        light(ray, depth + 1);
        goes_on(ray, index, depth + 1);
    }

    void candidates(const RayTerms& ray, std::size_t depth) {
        if (ray.candidates.empty()) {
            return;
        }
        line(depth, "surfaces along it, by t (L12; f(p) is what is left of the shape's own equation there):");
        std::size_t shown = 0;
        for (const Candidate& c : ray.candidates) {
            if (shown++ == most_candidates) {
                line(depth + 1, "... and {} more", ray.candidates.size() - most_candidates);
                break;
            }
            line(depth + 1, "t = {:<12} {}: {} it at {}{}; {}", text(c.t), names().surface(c.id, c.member),
                 c.enters ? "enters" : "leaves", text(c.point),
                 c.residual ? fmt::format(", {} = {:.2g}", c.residual->terms, c.residual->value) : "",
                 verdict(c, ray));
        }
    }
    static std::string verdict(const Candidate& c, const RayTerms& ray) {
        switch (c.verdict) {
        case Candidate::Verdict::met:
            return "the nearest: this is seen";
        case Candidate::Verdict::farther:
            return c.t == ray.t ? "as near, but later in the source" : "farther";
        case Candidate::Verdict::inside:
            return "no surface of the solid, which is on both sides";
        case Candidate::Verdict::outside:
            break;
        }
        return "no surface of the solid, which is on neither side";
    }

    void encounter(const RayTerms& ray, std::size_t depth) {
        line(depth, "meets {} at t = {}, on its {} side, of material {}", names().surface(ray.id, ray.member),
             text(ray.t), ray.is_front ? "front" : "back", names().material(ray.material));
        line(depth + 1, "point {}, exact within +- {}", text(ray.point), text(ray.error));
        line(depth + 1, "m = {}, the normal towards the viewer{}", text(ray.shading_normal),
             length(cross(ray.normal, ray.shading_normal)) > 1e-5
                 ? fmt::format(" ({}; the surface's own is {})", ray.is_bumped ? "bumped" : "interpolated",
                               text(ray.normal))
                 : "");
        line(depth + 1, "v = {}, towards the viewer", text(-normalize(ray.dir)));
    }

    void goes_on(const RayTerms& ray, std::size_t index, std::size_t depth) {
        if (ray.refraction) {
            const RayTerms::Refraction& r = *ray.refraction;
            line(depth, "from the index of refraction {} into {}{}", text(r.from), text(r.to),
                 r.is_total ? ": total reflection"
                 : r.from != r.to
                     ? fmt::format(", by Fresnel's equations a part of {} is mirrored", text(r.reflectance))
                     : "");
        }
        if (!is_black(ray.reflected) && !ray.goes_back) {
            line(depth, "mirrors {} (L15), but {}", text(ray.reflected),
                 ray.bounces >= settings_.depth
                     ? fmt::format("after {} mirrors and refractions rays end, in black", settings_.depth)
                     : "that would change nothing that can be seen");
        }
        if (!is_black(ray.transmitted) && !ray.goes_through) {
            line(depth, "lets {} through, but {}", text(ray.transmitted),
                 ray.bounces >= settings_.depth
                     ? fmt::format("after {} mirrors and refractions rays end, in black", settings_.depth)
                     : "that would change nothing that can be seen");
        }
        for (std::size_t i = index + 1; i < explained_.how.rays.size(); ++i) {
            const RayTerms& next = explained_.how.rays[i];
            if (next.parent == static_cast<int>(index)) {
                if (next.way == RayTerms::Way::mirrored) {
                    line(depth,
                         "mirrors {} (L15) of what comes along r = d - 2 (d.m) m:", text(ray.reflected));
                } else {
                    line(depth, "lets {} through of what comes from behind:", text(ray.transmitted));
                }
                write(i, depth + 1);
            }
        }
    }

    const compiler::ir::Scene& scene_;
    const runtime::RenderSettings& settings_;
    const compiler::ExplainedPixel& explained_;
};

/// The rule of runtime/camera.h with its numbers.
std::string panorama_text(const runtime::Camera<double>& c, double across, double up) {
    const double degree = std::numbers::pi / 180;
    const double a = across * c.half_width, b = up * c.half_height;
    return fmt::format("  longitude a = {} degrees, latitude b = {} degrees\n"
                       "  d = sin b v + cos b (sin a u - cos a n) = {}\n",
                       text(a / degree), text(b / degree),
                       text(c.v * std::sin(b) + (c.u * std::sin(a) - c.n * std::cos(a)) * std::cos(b)));
}

/// L11 with its numbers.
std::string camera_text(const compiler::ir::Scene& scene, const runtime::RenderSettings& settings,
                        const runtime::Explanation& how) {
    const runtime::Camera<double>& c = scene.camera;
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const double across = 2 * how.column / settings.width - 1,
                 up = 2 * (settings.height - how.row) / settings.height - 1;
    std::string out = fmt::format("RAY (L11), with rows counted from the bottom: c = {}, r = {}\n",
                                  text(how.column), text(settings.height - how.row));
    out += fmt::format("  eye = {}, u = {}, v = {}, n = {}\n", text(c.eye), text(c.u), text(c.v), text(c.n));
    if (c.projection == runtime::Projection::spherical) {
        return out + panorama_text(c, across, up);
    }
    const bool perspective = c.projection == runtime::Projection::perspective;
    out +=
        fmt::format("  {} W = {}, H = {}\n",
                    perspective ? "half extents of the view plane at N = 1:" : "half extents of the window:",
                    text(c.half_height * aspect), text(c.half_height));
    const double w = c.half_height * (across * aspect + 2 * c.shift_x),
                 h = c.half_height * (up + 2 * c.shift_y);
    const bool shifted = c.shift_x != 0 || c.shift_y != 0;
    out += fmt::format("  W (2c/nCols - 1){} = {}, H (2r/nRows - 1){} = {}\n", shifted ? " + shift" : "",
                       text(w), shifted ? " + shift" : "", text(h));
    out += perspective
               ? fmt::format("  d = -n {} u {} v = {}\n", term(w), term(h), text((c.u * w + c.v * h) - c.n))
               : fmt::format("  parallel: d = -n, from eye {} u {} v\n", term(w), term(h));
    if (c.lens_radius > 0) {
        const RayTerms& ray = how.rays.front();
        out += fmt::format("  through another point of the lens (radius {}), and the same one in focus, {} "
                           "away:\n  org = {}, d = {}\n",
                           text(c.lens_radius), text(c.focus), text(ray.org), text(ray.dir));
    }
    return out;
}

/// Before the file's encoding and after it.
std::string sum_text(const compiler::ir::Scene& scene, const runtime::RenderSettings& settings,
                     const compiler::ExplainedPixel& explained) {
    const runtime::Explanation& how = explained.how;
    std::string out = "SUM: the rays' light, each as often as it counts (linear Rec.709)\n";
    if (!scene.bands.empty()) {
        out = "SUM: the rays' light, each as often as it counts, at the three wavelengths\n";
    }
    for (std::size_t i = 0; i < how.rays.size(); ++i) {
        const RayTerms& ray = how.rays[i];
        static constexpr std::array<const char*, 3> ways{"primary", "mirrored", "through"};
        out += fmt::format("  {:<9} {} {}\n", ways[static_cast<std::size_t>(ray.way)], text(ray.weight),
                           ray.has_met ? text(ray.light) : "background");
    }
    out += fmt::format("  sample = {}\n", text(how.sample));
    const int n = samples_per_axis(settings);
    if (n > 1) {
        out += fmt::format("  pixel, the mean of {} x {} samples", n, n);
    } else {
        out += "  pixel, as a float";
    }
    if (!scene.bands.empty()) {
        out += fmt::format(" and the sum of {} times three wavelengths", scene.bands.size());
    }
    out += fmt::format(" = {}\n", bits_text(explained.pixel));
    out += same_bits(explained.pixel, explained.rendered)
               ? "  the renderer draws the same, to the bit\n"
               : fmt::format("  THE RENDERER DRAWS ANOTHER COLOUR: {}; please report it\n",
                             bits_text(explained.rendered));
    const host::SrgbCodes codes(255, 16);
    const Rgb<float>& p = explained.rendered;
    return out + fmt::format("  in an 8-bit PNG, clamped to 0..1 and encoded as sRGB: {}, {}, {}\n",
                             codes(p.r), codes(p.g), codes(p.b));
}

} // namespace

std::string explain_rays(const Loaded& loaded, const ExplainOptions& options) {
    const compiler::ir::Scene& scene = loaded.scene;
    runtime::RenderRequest request = make_request(options.render, scene.settings);
    const bool is_plain = is_plain_grid(request.settings);
    request.settings = with_plain_grid(request.settings);
    const runtime::RenderSettings& settings = request.settings;
    const compiler::PixelPlace place = place_of_sample(settings, options);
    const compiler::PrecisionChoice precision = choose_precision(scene, request, options);
    const compiler::ExplainedPixel explained =
        compiler::explain_pixel(scene, precision.precision, settings, place);
    if (options.json) {
        return pixel_json(loaded, settings, place, precision, explained);
    }
    std::string out = heading(scene, settings, place, precision, explained.band, is_plain);
    out += "\n" + camera_text(scene, settings, explained.how) + "\n";
    out += RayWriter(scene, settings, Names(loaded), explained).run();
    return out + "\n" + sum_text(scene, settings, explained);
}

} // namespace scc::cli
