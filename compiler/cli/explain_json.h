#pragma once

#include "compiler/cli/explain_names.h"
#include "runtime/explanation.h"

#include <nlohmann/json.hpp>

/// What the explanations of ray and of raster pictures have in common in JSON.
namespace scc::cli {

using Json = nlohmann::ordered_json;

inline Json json_of(const runtime::Vec3<double>& v) {
    return Json::array({v.x, v.y, v.z});
}
template <class R>
Json json_of(const runtime::Rgb<R>& c) {
    return Json::array({c.r, c.g, c.b});
}
inline Json json_of(const Names& names, const runtime::LightTerms& terms) {
    Json json{{"light", names.light(terms)},       {"to_light", json_of(terms.to_light)},
              {"distance", terms.distance},        {"cosine", terms.cosine},
              {"in_cone", terms.is_in_cone},       {"reaches", terms.reaches},
              {"diffuse", json_of(terms.diffuse)}, {"specular", json_of(terms.specular)},
              {"highlight", terms.highlight},      {"attenuation", terms.attenuation},
              {"cone_share", terms.cone_share},    {"adds", json_of(terms.adds)},
              {"feelers", Json::array()}};
    for (const runtime::Feeler& feeler : terms.feelers) {
        json["feelers"].push_back(feeler.is_blocked ? Json{{"blocked_by", names.object(feeler.id)},
                                                           {"t", feeler.t},
                                                           {"leaves", feeler.filter ? json_of(*feeler.filter)
                                                                                    : Json::array({0, 0, 0})}}
                                                    : Json{{"blocked_by", nullptr}});
    }
    return json;
}

} // namespace scc::cli
