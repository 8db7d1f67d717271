#include "compiler/backends/render.h"
#include "compiler/cli/explain.h"
#include "compiler/cli/explain_json.h"
#include "compiler/cli/explain_names.h"
#include "compiler/cli/explain_terms.h"

#include <fmt/core.h>

#include <array>
#include <cstddef>
#include <string>

namespace scc::cli {

namespace {

using runtime::DrawnTerms;
using runtime::RasterShading;
using runtime::RayTerms;

const char* word(DrawnTerms::Verdict verdict) {
    static constexpr std::array<const char*, 3> words{"seen", "through", "farther"};
    return words[static_cast<std::size_t>(verdict)];
}
const char* sentence(DrawnTerms::Verdict verdict) {
    static constexpr std::array<const char*, 3> sentences{"the nearest: this is seen",
                                                          "nearer than what is seen, and lets light through",
                                                          "farther, or as far and later in the source"};
    return sentences[static_cast<std::size_t>(verdict)];
}
/// The number of a polyline's segment, or of a triangle of an object, counted from 1.
std::string name_of_drawn(const Names& names, const DrawnTerms& drawn) {
    return drawn.is_line ? fmt::format("line segment {}", drawn.id + 1)
                         : fmt::format("triangle {} of {}", drawn.triangle + 1, names.object(drawn.id));
}

class DrawnWriter : TermsWriter {
public:
    DrawnWriter(Names names, const runtime::Rgb<double>& ambient, RasterShading shading)
        : TermsWriter(std::move(names), ambient, true), shading_(shading) {}

    std::string run(const runtime::RasterExplanation& how) {
        for (const DrawnTerms& drawn : how.drawn) {
            write(drawn);
        }
        return take();
    }

private:
    void write(const DrawnTerms& drawn) {
        line(1, "z* = {:<12} {}: {}", text(drawn.pseudodepth), name_of_drawn(names(), drawn),
             sentence(drawn.verdict));
        if (drawn.is_line) {
            line(2, "its colour, which no light changes: {}", text(drawn.light));
            return;
        }
        line(2, "w = {}, the distance along the view axis; seen from its {}", text(drawn.w),
             drawn.is_front ? "front" : "back");
        if (drawn.has_corners) {
            line(2, "corners {}, {}, {}, which here weigh ({:.6g}, {:.6g}, {:.6g})", text(drawn.corners[0]),
                 text(drawn.corners[1]), text(drawn.corners[2]), drawn.weights[0], drawn.weights[1],
                 drawn.weights[2]);
        }
        if (drawn.verdict != DrawnTerms::Verdict::farther) {
            shading(drawn);
        }
    }
    void shading(const DrawnTerms& drawn) {
        if (drawn.points.empty()) {
            line(2, "hidden lines: painted in the background's colour");
            return;
        }
        for (std::size_t i = 0; i < drawn.points.size(); ++i) {
            const RayTerms& at = drawn.points[i];
            line(2, "{} (L10): at {}, of material {}, m = {}", place_of_point(drawn, i), text(at.point),
                 names().material(at.material), text(at.shading_normal));
            light(at, 3);
        }
        line(2, "its light here: {}", text(drawn.light));
        if (!is_black(drawn.transmit)) {
            line(2, "lets {} through of what is behind", text(drawn.transmit));
        }
    }
    std::string place_of_point(const DrawnTerms& drawn, std::size_t i) const {
        if (drawn.points.size() == 3) {
            return fmt::format("lit at corner {}", i + 1);
        }
        if (shading_ == RasterShading::flat && drawn.has_corners) {
            return "lit at its last corner";
        }
        return drawn.has_corners ? "lit at the sample" : "a plane, lit at the sample";
    }

    RasterShading shading_;
};

Json drawn_json(const Names& names, const DrawnTerms& drawn) {
    Json json{{"what", name_of_drawn(names, drawn)}, {"kind", drawn.is_line ? "line" : "triangle"},
              {"verdict", word(drawn.verdict)},      {"pseudodepth", drawn.pseudodepth},
              {"light", json_of(drawn.light)},       {"transmit", json_of(drawn.transmit)}};
    if (drawn.is_line) {
        return json;
    }
    json["w"] = drawn.w;
    json["side"] = drawn.is_front ? "front" : "back";
    json["weights"] = drawn.weights;
    json["corners"] = Json::array();
    for (const auto& corner : drawn.corners) {
        if (drawn.has_corners) {
            json["corners"].push_back(json_of(corner));
        }
    }
    json["points"] = Json::array();
    for (const RayTerms& at : drawn.points) {
        Json point{{"point", json_of(at.point)},
                   {"material", names.material(at.material)},
                   {"normal", json_of(at.shading_normal)},
                   {"ambient", json_of(at.ambient)},
                   {"diffuse", json_of(at.diffuse)},
                   {"specular", json_of(at.specular)},
                   {"shininess", at.shininess},
                   {"emission", json_of(at.emission)},
                   {"lights", Json::array()},
                   {"light", json_of(at.light)}};
        for (const runtime::LightTerms& terms : at.lights) {
            point["lights"].push_back(json_of(names, terms));
        }
        json["points"].push_back(std::move(point));
    }
    return json;
}

std::string json_text(const Loaded& loaded, const runtime::RenderSettings& settings,
                      const compiler::PixelPlace& place, const compiler::PrecisionChoice& precision,
                      const compiler::ExplainedRaster& explained) {
    Json json{{"schema", 1},
              {"scene", loaded.scene.name},
              {"size", {settings.width, settings.height}},
              {"pixel", {place.x, place.y}},
              {"sample", {place.i, place.j}},
              {"precision", {{"of", name_of(precision.precision)}, {"why", precision.reason}}},
              {"origin", settings.origin},
              {"place", {explained.how.column, explained.how.row}},
              {"drawn", Json::array()}};
    const Names names(loaded);
    for (const DrawnTerms& drawn : explained.how.drawn) {
        json["drawn"].push_back(drawn_json(names, drawn));
    }
    json["sample_color"] = json_of(explained.how.sample);
    json["rendered"] = json_of(explained.rendered);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

std::string explain_raster(const Loaded& loaded, const ExplainOptions& options) {
    const compiler::ir::Scene& scene = loaded.scene;
    const runtime::RenderRequest request = make_request(options.render, scene.settings);
    const runtime::RenderSettings& settings = request.settings;
    const compiler::PixelPlace place = place_of_sample(settings, options);
    const compiler::PrecisionChoice precision = choose_precision(scene, request, options);
    const compiler::ExplainedRaster explained =
        compiler::explain_raster(scene, precision.precision, settings, place);
    if (options.json) {
        return json_text(loaded, settings, place, precision, explained);
    }
    std::string out = heading(scene, settings, place, precision, explained.band, true);
    out += explained.how.drawn.empty() ? fmt::format("\nNO TRIANGLE OR LINE covers it: background {}\n",
                                                     text(background_of(scene, explained.band)))
                                       : "\nTRIANGLES AND LINES that cover it, by z* (L4)\n";
    out += DrawnWriter(Names(loaded), ambient_of(scene, explained.band), settings.raster.shading)
               .run(explained.how);
    return out + fmt::format("\nSUM\n  sample = {}\n  pixel, as the renderer draws it: ({}, {}, {})\n",
                             text(explained.how.sample), explained.rendered.r, explained.rendered.g,
                             explained.rendered.b);
}

} // namespace scc::cli
