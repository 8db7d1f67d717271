#include "runtime/host/layers.h"

#include "runtime/host/json.h"
#include "runtime/host/options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace scc::host {

namespace {

using runtime::Aov;

constexpr auto rows = std::to_array<AovRow>({{Aov::depth, "depth"},
                                             {Aov::planar, "planar"},
                                             {Aov::position, "position"},
                                             {Aov::normal, "normal"},
                                             {Aov::uv, "uv"},
                                             {Aov::object, "object"},
                                             {Aov::material, "material"}});

const AovRow& row_of(std::string_view name) {
    std::string all;
    for (const AovRow& row : rows) {
        if (row.name == name) {
            return row;
        }
        all += (all.empty() ? "" : ", ") + std::string(row.name);
    }
    throw UsageError("there is no `" + std::string(name) + "`; there are " + all);
}

/// The numbers in the picture with their names, each once; `name_of` takes a number less 1.
template <class NameOf>
std::string manifest(std::vector<std::uint32_t> ids, NameOf&& name_of) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::string text = "{";
    for (const std::uint32_t id : ids) {
        if (id != 0) {
            text += (text.size() > 1 ? "," : "") + json(std::string_view(name_of(id - 1))) + ":" +
                    std::to_string(id);
        }
    }
    return text + "}";
}

} // namespace

std::span<const AovRow> aov_rows() {
    return rows;
}

runtime::AovSet parse_aovs(const std::string& text) {
    runtime::AovSet set = 0;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const AovRow& row = row_of(std::string_view(text).substr(begin, end - begin));
        if (has(set, row.aov)) {
            throw UsageError("`" + std::string(row.name) + "` is named twice");
        }
        set |= runtime::bit(row.aov);
        if (end == text.size()) {
            return set;
        }
        begin = end + 1;
    }
}

void add_layers(const runtime::AovImage& aovs, const SceneNames& names, ExrContent& content) {
    const auto add = [&](const char* name, const auto& list) {
        if (!list.empty()) {
            content.channels.push_back(
                {name, list.data(), 1,
                 std::is_same_v<std::decay_t<decltype(list)>, std::vector<std::uint32_t>>});
        }
    };
    add("depth.Z", aovs.depth);
    add("planar.Z", aovs.planar);
    add("position.X", aovs.position[0]);
    add("position.Y", aovs.position[1]);
    add("position.Z", aovs.position[2]);
    add("normal.X", aovs.normal[0]);
    add("normal.Y", aovs.normal[1]);
    add("normal.Z", aovs.normal[2]);
    add("uv.U", aovs.uv[0]);
    add("uv.V", aovs.uv[1]);
    add("object.X", aovs.object);
    add("material.X", aovs.material);
    if (!aovs.object.empty()) {
        content.texts.emplace_back("object.manifest",
                                   manifest(aovs.object, [&](std::uint32_t id) { return names.object(id); }));
    }
    if (!aovs.material.empty()) {
        content.texts.emplace_back("material.manifest", manifest(aovs.material, [&](std::uint32_t index) {
                                       return names.material(index);
                                   }));
    }
}

} // namespace scc::host
