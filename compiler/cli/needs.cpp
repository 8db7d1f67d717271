#include "compiler/cli/needs.h"

#include "compiler/backends/render.h"
#include "compiler/ir/objects.h"
#include "compiler/ir/traits.h"
#include "compiler/passes/passes.h"
#include "runtime/host/image_file.h"
#include "runtime/host/parallel.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

namespace scc::cli {

std::string place_of(const Loaded& loaded, const lang::Span& span) {
    if (!loaded.sources.contains(span.file)) {
        return "";
    }
    const lang::SourceFile& file = loaded.sources.file(span.file);
    return fmt::format("{}:{}", file.path(), file.position(span.begin).line);
}

std::string line_of(const Loaded& loaded, const lang::Span& span) {
    if (!loaded.sources.contains(span.file)) {
        return "";
    }
    const std::string_view text = loaded.sources.file(span.file).text();
    std::size_t begin = text.rfind('\n', span.begin > 0 ? span.begin - 1 : 0);
    begin = begin == std::string_view::npos || span.begin == 0 ? 0 : begin + 1;
    begin = std::min(text.find_first_not_of(" \t", begin), text.size());
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    return std::string(text.substr(begin, end - begin));
}

std::vector<Feature> needed_features(const Loaded& loaded) {
    const auto reason_without_place = [](std::string_view name) {
        return name == "accelerator"
                   ? fmt::format("more than {} bounded shapes", runtime::accelerator_threshold)
               : name == "spectra" ? std::string("a colour is a spectrum")
               : name.ends_with("directional_lights") || name.ends_with("shadows")
                   ? std::string("the headlight of a scene without lights")
               : name == "perspective" ? std::string("the camera of a scene without one")
                                       : std::string();
    };
    std::vector<Feature> features;
    const std::vector<compiler::Need> needs = compiler::needs_of(loaded.scene);
    for (const std::string& name : compiler::ir::feature_names(loaded.scene.traits)) {
        Feature feature{name, "", ""};
        for (const compiler::Need& need : needs) {
            const std::vector<std::string> asked = compiler::ir::feature_names(need.traits);
            if (std::find(asked.begin(), asked.end(), name) != asked.end()) {
                feature.place = place_of(loaded, need.span);
                feature.line = line_of(loaded, need.span);
                break;
            }
        }
        if (feature.place.empty()) {
            feature.line = reason_without_place(name);
        }
        features.push_back(feature);
    }
    return features;
}

std::vector<std::string> features_left_out(const compiler::ir::Scene& scene) {
    const std::vector<std::string> kept = compiler::ir::feature_names(scene.traits);
    std::vector<std::string> left_out = compiler::ir::feature_names(runtime::everything);
    std::erase_if(left_out, [&](const std::string& name) {
        return std::find(kept.begin(), kept.end(), name) != kept.end();
    });
    return left_out;
}

compiler::PrecisionChoice program_precision(const compiler::ir::Scene& scene) {
    if (!host::keeps_8_bits(scene.file, 8)) {
        return {compiler::Precision::full, "the scene names no `file` that keeps but 8 bits of each value"};
    }
    return compiler::choose_precision_for_8_bits(scene, scene.settings, {.threads = host::core_count()});
}

} // namespace scc::cli
