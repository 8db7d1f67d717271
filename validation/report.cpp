#include "validation/report.h"

#include "runtime/host/image_file.h"

#include <fmt/core.h>

#include <cctype>
#include <set>
#include <system_error>

namespace scc::validation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int schema_number = 1;

std::string file_name_part(const std::string& text) {
    std::string result;
    for (const char c : text)
        result += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ? c : '_';
    return result.empty() ? "_" : result;
}

/// Distinct names for files, in the order they are asked for.
class FileNames {
public:
    std::string make(const std::string& scene, const std::string& renderer) {
        const std::string stem = fmt::format("images/{}-{}", file_name_part(scene), file_name_part(renderer));
        std::string name = stem + ".exr";
        for (int i = 2; !taken_.insert(name).second; ++i)
            name = fmt::format("{}-{}.exr", stem, i);
        return name;
    }

private:
    std::set<std::string> taken_;
};

struct SceneFiles {
    std::string reference; ///< empty if there is no image
    std::vector<std::string> renderers;
};

std::vector<SceneFiles> name_files(const Report& report) {
    FileNames names;
    std::vector<SceneFiles> files;
    for (const SceneReport& scene : report.scenes) {
        SceneFiles scene_files;
        if (!scene.reference.pixels.empty())
            scene_files.reference = names.make(scene.name, "reference");
        for (const RendererReport& renderer : scene.renderers)
            scene_files.renderers.push_back(
                renderer.image.pixels.empty() ? "" : names.make(scene.name, renderer.renderer));
        files.push_back(std::move(scene_files));
    }
    return files;
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json to_json(const std::vector<LedgerRow>& ledger) {
    Json json = Json::array();
    for (const LedgerRow& row : ledger)
        json.push_back({{"fidelity", row.fidelity},
                        {"feature", row.feature},
                        {"subject", row.subject},
                        {"place", row.place},
                        {"how", row.how},
                        {"bound", row.bound}});
    return json;
}

Json to_json(const RendererReport& renderer, const std::string& file) {
    Json json{{"renderer", renderer.renderer}, {"version", text_or_null(renderer.version)}};
    json["command"] = text_or_null(renderer.command);
    json["verdict"] = name_of(renderer.judgement.verdict);
    json["reason"] = text_or_null(renderer.judgement.reason);
    json["budget"] = renderer.budget ? validation::to_json(*renderer.budget) : Json(nullptr);
    json["metrics"] = renderer.metrics ? validation::to_json(*renderer.metrics) : Json(nullptr);
    json["layers"] = Json::array();
    for (const LayerDifference& layer : renderer.layers)
        json["layers"].push_back(validation::to_json(layer));
    json["cause"] = renderer.cause ? validation::to_json(*renderer.cause) : Json(nullptr);
    json["times_s"] = validation::to_json(renderer.times);
    json["from_cache"] = renderer.from_cache;
    json["file"] = text_or_null(file);
    json["ledger"] = to_json(renderer.ledger);
    json["warnings"] = renderer.warnings;
    json["worst_pixel"] = text_or_null(renderer.worst_pixel);
    return json;
}

void write_exr(const runtime::Image& image, const fs::path& folder, const std::string& name) {
    if (!name.empty())
        host::write_image((folder / name).string(), image, {.bits = 8, .compact = true});
}

} // namespace

ReportSummary summarize(const Report& report) {
    ReportSummary summary;
    for (const SceneReport& scene : report.scenes) {
        summary.broken += !scene.failure.empty();
        for (const RendererReport& renderer : scene.renderers) {
            summary.passed += renderer.judgement.verdict == Verdict::passed;
            summary.failed += renderer.judgement.verdict == Verdict::failed;
            summary.skipped += renderer.judgement.verdict == Verdict::skipped;
        }
    }
    return summary;
}

Json to_json(const Report& report) {
    const std::vector<SceneFiles> files = name_files(report);
    const ReportSummary summary = summarize(report);
    Json json{{"schema", schema_number}, {"title", report.title}};
    json["versions"] = Json::object();
    for (const auto& [program, version] : report.versions)
        json["versions"][program] = version;
    json["summary"] = {{"passed", summary.passed},
                       {"failed", summary.failed},
                       {"skipped", summary.skipped},
                       {"broken", summary.broken}};
    json["scenes"] = Json::array();
    for (std::size_t i = 0; i < report.scenes.size(); ++i) {
        const SceneReport& scene = report.scenes[i];
        Json entry{{"name", scene.name}, {"description", scene.description}};
        entry["failure"] = text_or_null(scene.failure);
        entry["size"] = {scene.reference.width, scene.reference.height};
        entry["reference"] = {{"made_by", scene.reference_made_by},
                              {"file", text_or_null(files[i].reference)},
                              {"times_s", validation::to_json(scene.times)}};
        entry["renderers"] = Json::array();
        for (std::size_t k = 0; k < scene.renderers.size(); ++k)
            entry["renderers"].push_back(to_json(scene.renderers[k], files[i].renderers[k]));
        json["scenes"].push_back(entry);
    }
    json["sweeps"] = Json::array();
    for (const SweepScene& sweep : report.sweeps)
        json["sweeps"].push_back(validation::to_json(sweep));
    return json;
}

void write_report(const Report& report, const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder / "images", error);
    if (error)
        throw host::FileError(
            fmt::format("cannot make the folder `{}`: {}", folder.string(), error.message()));
    const std::vector<SceneFiles> files = name_files(report);
    for (std::size_t i = 0; i < report.scenes.size(); ++i) {
        write_exr(report.scenes[i].reference, folder, files[i].reference);
        for (std::size_t k = 0; k < report.scenes[i].renderers.size(); ++k)
            write_exr(report.scenes[i].renderers[k].image, folder, files[i].renderers[k]);
    }
    // Renderers' texts may hold any bytes; what is not UTF-8 is replaced.
    const std::string text = to_json(report).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    host::replace_file((folder / "report.json").string(), text);
    host::replace_file((folder / "index.html").string(), to_html(report));
}

} // namespace scc::validation
