#include "compiler/cli/explain.h"
#include "compiler/cli/explain_json.h"
#include "compiler/cli/explain_names.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace scc::cli {

namespace {

using runtime::Candidate;
using runtime::LightTerms;
using runtime::RayTerms;

const char* word(Candidate::Verdict verdict) {
    switch (verdict) {
    case Candidate::Verdict::met:
        return "met";
    case Candidate::Verdict::farther:
        return "farther";
    case Candidate::Verdict::inside:
        return "inside";
    case Candidate::Verdict::outside:
        break;
    }
    return "outside";
}

class PixelJson {
public:
    explicit PixelJson(const Loaded& loaded) : names_(loaded) {}

    Json of(const RayTerms& ray) const {
        static constexpr std::array<const char*, 3> ways{"primary", "mirrored", "through"};
        Json json{{"way", ways[static_cast<std::size_t>(ray.way)]},
                  {"parent", ray.parent < 0 ? Json() : Json(ray.parent)},
                  {"bounces", ray.bounces},
                  {"origin", json_of(ray.org)},
                  {"direction", json_of(ray.dir)},
                  {"weight", json_of(ray.weight)},
                  {"surfaces", Json::array()}};
        for (const Candidate& candidate : ray.candidates) {
            json["surfaces"].push_back(of(candidate));
        }
        json["hit"] = ray.has_met ? hit(ray) : Json();
        return json;
    }

private:
    Json of(const Candidate& c) const {
        Json json{{"t", c.t},
                  {"object", names_.surface(c.id, c.member)},
                  {"enters", c.enters},
                  {"point", json_of(c.point)},
                  {"verdict", word(c.verdict)}};
        json["residual"] =
            c.residual ? Json{{"terms", c.residual->terms}, {"value", c.residual->value}} : Json();
        return json;
    }

    Json hit(const RayTerms& ray) const {
        Json json{{"object", names_.surface(ray.id, ray.member)},
                  {"t", ray.t},
                  {"side", ray.is_front ? "front" : "back"},
                  {"material", names_.material(ray.material)},
                  {"point", json_of(ray.point)},
                  {"error", json_of(ray.error)},
                  {"normal", json_of(ray.normal)},
                  {"shading_normal", json_of(ray.shading_normal)},
                  {"bumped", ray.is_bumped},
                  {"ambient", json_of(ray.ambient)},
                  {"diffuse", json_of(ray.diffuse)},
                  {"specular", json_of(ray.specular)},
                  {"shininess", ray.shininess},
                  {"emission", json_of(ray.emission)},
                  {"lights", Json::array()},
                  {"light", json_of(ray.light)},
                  {"reflected", json_of(ray.reflected)},
                  {"goes_back", ray.goes_back},
                  {"transmitted", json_of(ray.transmitted)},
                  {"goes_through", ray.goes_through}};
        for (const LightTerms& light : ray.lights) {
            json["lights"].push_back(json_of(names_, light));
        }
        if (ray.refraction) {
            json["refraction"] = {{"from", ray.refraction->from},
                                  {"to", ray.refraction->to},
                                  {"reflectance", ray.refraction->reflectance},
                                  {"total", ray.refraction->is_total}};
        }
        return json;
    }

    Names names_;
};

} // namespace

std::string pixel_json(const Loaded& loaded, const runtime::RenderSettings& settings,
                       const compiler::PixelPlace& place, const compiler::PrecisionChoice& precision,
                       const compiler::ExplainedPixel& explained) {
    Json json{{"schema", 1},
              {"scene", loaded.scene.name},
              {"size", {settings.width, settings.height}},
              {"pixel", {place.x, place.y}},
              {"sample", {place.i, place.j}},
              {"precision", {{"of", name_of(precision.precision)}, {"why", precision.reason}}},
              {"origin", settings.origin},
              {"place", {explained.how.column, explained.how.row}},
              {"rays", Json::array()}};
    if (!loaded.scene.bands.empty()) {
        json["band"] = explained.band;
    }
    const PixelJson writer(loaded);
    for (const RayTerms& ray : explained.how.rays) {
        json["rays"].push_back(writer.of(ray));
    }
    json["sum"] = json_of(explained.how.sample);
    json["pixel_color"] = json_of(explained.pixel);
    json["rendered"] = json_of(explained.rendered);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace scc::cli
