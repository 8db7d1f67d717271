#include "compiler/backends/render.h"
#include "compiler/cli/explain.h"
#include "compiler/cli/needs.h"
#include "runtime/host/options.h"
#include "runtime/host/parallel.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace scc::cli {

namespace {

/// In which arithmetic something is drawn.
struct Drawn {
    std::string what;
    std::string precision;
    std::string reason;
};

std::vector<Drawn> precisions(const Loaded& loaded, const ExplainOptions& options) {
    const compiler::ir::Scene& scene = loaded.scene;
    const auto row = [](const char* what, const compiler::PrecisionChoice& choice) {
        return Drawn{what, name_of(choice.precision), choice.reason};
    };
    const runtime::RenderRequest request = make_request(options.render, scene.settings);
    return {row("scc render into an 8-bit PNG",
                compiler::choose_precision_for_8_bits(scene, request.settings, {.threads = request.threads})),
            row("scc render into any other file",
                {compiler::Precision::full, "the file keeps more than 8 bits of each value"}),
            row("the program that scc build makes", program_precision(scene))};
}

} // namespace

std::string explain_needs(const Loaded& loaded, const ExplainOptions& options) {
    const std::vector<Feature> needed = needed_features(loaded);
    const std::vector<std::string> left_out = features_left_out(loaded.scene);
    const std::vector<Drawn> drawn = precisions(loaded, options);
    if (options.json) {
        nlohmann::ordered_json json{{"schema", 1}, {"scene", loaded.scene.name}};
        json["needs"] = nlohmann::ordered_json::array();
        for (const Feature& feature : needed) {
            json["needs"].push_back(
                {{"feature", feature.name}, {"asked_for_at", feature.place}, {"by", feature.line}});
        }
        json["left_out"] = left_out;
        json["precision"] = nlohmann::ordered_json::array();
        for (const Drawn& one : drawn) {
            json["precision"].push_back(
                {{"of", one.what}, {"precision", one.precision}, {"reason", one.reason}});
        }
        return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    }
    std::size_t name_width = 0, place_width = 0;
    for (const Feature& feature : needed) {
        name_width = std::max(name_width, feature.name.size());
        place_width = std::max(place_width, feature.place.size());
    }
    std::string out =
        fmt::format("NEEDS of scene `{}`, and the first line that asks for each\n", loaded.scene.name);
    for (const Feature& feature : needed) {
        out += fmt::format("  {:<{}}  {:<{}}  {}\n", feature.name, name_width, feature.place, place_width,
                           feature.line);
    }
    out += fmt::format("\nLEFT OUT of a program built for it\n  {}\n", fmt::join(left_out, ", "));
    out += "\nPRECISION\n";
    for (const Drawn& one : drawn) {
        out += fmt::format("  {}: {}, since {}\n", one.what, one.precision, one.reason);
    }
    return out;
}

} // namespace scc::cli
