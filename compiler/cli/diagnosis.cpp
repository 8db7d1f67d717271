#include "compiler/cli/diagnosis.h"

#include "compiler/backends/render.h"
#include "compiler/cli/comparison.h"
#include "compiler/cli/layer_scene.h"
#include "compiler/ir/objects.h"
#include "compiler/passes/passes.h"
#include "runtime/aov.h"
#include "validation/scratch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

namespace scc::cli {

namespace {

namespace ir = compiler::ir;
using runtime::Aov;
using runtime::Image;
using runtime::Vec3;
using validation::CauseInput;
using validation::Layers;
using validation::LightPart;

/// More of them would take long, and be hard to tell apart.
constexpr std::size_t most_lights = 12;

runtime::AovImage draw_layers(const Subject& subject) {
    constexpr runtime::AovSet set =
        bit(Aov::position) | bit(Aov::normal) | bit(Aov::object) | bit(Aov::depth);
    const runtime::RenderSettings& s = subject.request.settings;
    runtime::AovImage aovs(s.width, s.height, set);
    compiler::make_drawable(subject.loaded.scene, compiler::Precision::full)
        .draw_aovs(with_deadline(subject.request, subject.timeout_seconds), aovs);
    return aovs;
}

Image image_of(const runtime::AovImage& from, const std::array<std::vector<float>, 3>& channels) {
    Image image(from.width, from.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] = channels[i % 3][i / 3];
    }
    return image;
}

Layers layers_of(const runtime::AovImage& aovs, bool with_objects) {
    Layers layers;
    layers.position = image_of(aovs, aovs.position);
    layers.normal = image_of(aovs, aovs.normal);
    if (with_objects) {
        layers.object = Image(aovs.width, aovs.height);
        for (std::size_t i = 0; i < layers.object.pixels.size(); ++i) {
            layers.object.pixels[i] = static_cast<float>(aovs.object[i / 3]);
        }
    }
    return layers;
}

/// Nothing if the scene shows nothing.
std::optional<PositionRange> range_of(const runtime::AovImage& aovs) {
    constexpr double margin = 0.05;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    PositionRange range{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::size_t i = 0; i < aovs.depth.size(); ++i) {
        if (!std::isfinite(aovs.depth[i])) {
            continue;
        }
        const Vec3<double> p{double{aovs.position[0][i]}, double{aovs.position[1][i]},
                             double{aovs.position[2][i]}};
        range.low = {std::min(range.low.x, p.x), std::min(range.low.y, p.y), std::min(range.low.z, p.z)};
        range.high = {std::max(range.high.x, p.x), std::max(range.high.y, p.y), std::max(range.high.z, p.z)};
    }
    const Vec3<double> size = range.high - range.low;
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest >= 0) || !std::isfinite(largest)) {
        return std::nullopt;
    }
    const double more = margin * std::max(largest, 1e-3 * (1 + length(range.high)));
    range.low = range.low - Vec3<double>{more, more, more};
    range.high = range.high + Vec3<double>{more, more, more};
    return range;
}

/// The layers as the other renderer draws them.
class OtherLayers {
public:
    OtherLayers(const Subject& subject, const std::string& renderer, int threads)
        : subject_(subject), run_{.exporter = *compiler::find_exporter(renderer),
                                  .folder = folder_.path(),
                                  .threads = threads,
                                  .timeout_seconds = subject.timeout_seconds,
                                  .cache = &subject.cache} {}

    /// Nothing if one of the pictures fails.
    std::optional<Layers> draw(const PositionRange& range, bool with_objects) {
        const ir::Scene& scene = subject_.loaded.scene;
        const auto position = picture(position_scene(scene, range));
        const auto above = picture(normal_scene(scene, 1));
        const auto below = picture(normal_scene(scene, -1));
        const auto object = with_objects ? picture(object_scene(scene)) : Image();
        if (!position || !above || !below || !object) {
            return std::nullopt;
        }
        Layers layers{*position, *above, *object};
        const std::array<double, 3> low{range.low.x, range.low.y, range.low.z};
        const std::array<double, 3> high{range.high.x, range.high.y, range.high.z};
        for (std::size_t i = 0; i < layers.position.pixels.size(); ++i) {
            float& p = layers.position.pixels[i];
            p = static_cast<float>(low[i % 3] + double{p} * (high[i % 3] - low[i % 3]));
            layers.normal.pixels[i] -= below->pixels[i];
        }
        for (float& number : layers.object.pixels) {
            number = static_cast<float>(std::round(double{number} * object_scale));
        }
        return layers;
    }

private:
    std::optional<Image> picture(const ir::Scene& scene) {
        runtime::RenderSettings settings = scene.settings;
        settings.width = subject_.request.settings.width;
        settings.height = subject_.request.settings.height;
        compiler::Ledger ledger;
        validation::RenderResult drawn = run_exported_scene(run_, scene, settings, 1, ledger);
        return drawn.status == validation::RenderStatus::done ? std::optional(std::move(drawn.image))
                                                              : std::nullopt;
    }

    const Subject& subject_;
    validation::ScratchFolder folder_;
    ExportedRun run_;
};

void add_layers(validation::RendererReport& result, const Subject& subject, const runtime::AovImage& aovs,
                int threads) {
    const std::optional<PositionRange> range = range_of(aovs);
    if (!range) {
        result.warnings.emplace_back("the picture's rays meet nothing: there are no layers to compare");
        return;
    }
    const bool with_objects = ir::object_count(subject.loaded.scene) <= most_objects;
    OtherLayers others(subject, result.renderer, threads);
    const std::optional<Layers> theirs = others.draw(*range, with_objects);
    if (!theirs) {
        result.warnings.emplace_back("its layers could not be drawn");
        return;
    }
    const Vec3<double>& eye = subject.loaded.scene.camera.eye;
    result.layers = validation::compare_layers(layers_of(aovs, with_objects), *theirs, {eye.x, eye.y, eye.z},
                                               validation::layer_tolerances(result.renderer));
}

/// Our picture with one of the lights, and nothing that shines by itself.
Image draw_light(const Subject& subject, std::size_t light) {
    ir::Scene one = subject.loaded.scene;
    one.lights = {one.lights[light]};
    one.ambient = {};
    one.background = {};
    for (runtime::BandGroup<double>& band : one.bands) {
        band.ambient = {};
        band.background = {};
    }
    const auto darken = [](runtime::Phong<double>& phong) {
        phong.ambient = {};
        phong.emission = {};
    };
    for (ir::Material& material : one.materials) {
        darken(material.phong);
        std::for_each(material.bands.begin(), material.bands.end(), darken);
    }
    compiler::derive_traits(one);
    return draw_subject(subject, one, compiler::Precision::full);
}

std::vector<double> distances(const ir::Light& light, const runtime::AovImage& aovs) {
    return std::visit(
        [&](const auto& l) {
            std::vector<double> result;
            if constexpr (requires { l.position; }) {
                for (std::size_t i = 0; i < aovs.depth.size(); ++i) {
                    result.push_back(std::isfinite(aovs.depth[i])
                                         ? std::hypot(double{aovs.position[0][i]} - l.position.x,
                                                      double{aovs.position[1][i]} - l.position.y,
                                                      double{aovs.position[2][i]} - l.position.z)
                                         : std::numeric_limits<double>::infinity());
                }
            }
            return result;
        },
        light.light);
}

Image redraw(const Subject& subject, double dx, double dy) {
    ir::Scene moved = subject.loaded.scene;
    const runtime::RenderSettings& s = subject.request.settings;
    const bool spherical = moved.camera.projection == runtime::Projection::spherical;
    moved.camera.shift_x += dx / (spherical ? s.width : s.height);
    moved.camera.shift_y -= dy / s.height;
    return draw_subject(subject, moved, compiler::Precision::full);
}

void add_cause(validation::RendererReport& result, const Subject& subject, const runtime::AovImage& aovs) {
    CauseInput input;
    input.reference = subject.report.reference;
    input.other = validation::in_color(result.image);
    input.layers = result.layers;
    input.redraw = [&](double dx, double dy) { return redraw(subject, dx, dy); };
    const ir::Scene& scene = subject.loaded.scene;
    for (std::size_t i = 0; scene.lights.size() <= most_lights && i < scene.lights.size(); ++i) {
        input.lights.push_back(
            {scene.lights[i].name, draw_light(subject, i), distances(scene.lights[i], aovs)});
    }
    result.cause = validation::find_cause(input);
}

} // namespace

void diagnose(validation::RendererReport& result, const Subject& subject, int threads) {
    const bool failed = result.judgement.verdict == validation::Verdict::failed;
    const bool layers =
        subject.layers == LayerUse::always || (failed && subject.layers == LayerUse::automatic);
    const bool exported = compiler::find_exporter(result.renderer) != nullptr;
    if (!result.metrics || subject.request.settings.method != runtime::Method::ray ||
        !(failed || (layers && exported))) {
        return;
    }
    try {
        const runtime::AovImage aovs = draw_layers(subject);
        if (layers && exported) {
            add_layers(result, subject, aovs, threads);
        }
        if (failed) {
            add_cause(result, subject, aovs);
        }
    } catch (const RenderTimedOut& error) {
        result.warnings.push_back(fmt::format("why it differs was not found out: {}", error.what()));
    }
}

} // namespace scc::cli
