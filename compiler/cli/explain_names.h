#pragma once

#include "compiler/cli/needs.h"
#include "compiler/scene_names.h"
#include "runtime/explanation.h"

#include <fmt/core.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace scc::cli {

/// Names of what the renderer knows by number.
class Names {
public:
    explicit Names(const Loaded& loaded)
        : loaded_(loaded), objects_(compiler::names_of(loaded.scene)),
          members_(compiler::member_names_of(loaded.scene)) {}

    std::string object(std::uint32_t id) const { return objects_.object(id); }
    std::string surface(std::uint32_t id, std::uint32_t member) const {
        return id == member ? object(id) : fmt::format("{}, of {}", members_.at(member), object(id));
    }
    std::string material(std::uint32_t index) const {
        const compiler::ir::Material& material = loaded_.scene.materials[index];
        const std::string place = place_of(loaded_, material.span);
        return fmt::format("`{}`{}", material.name, place.empty() ? "" : " (" + place + ")");
    }
    std::string light(const runtime::LightTerms& terms) const {
        std::uint32_t count = 0;
        for (const compiler::ir::Light& light : loaded_.scene.lights) {
            if (kind_of(light) == terms.kind && count++ == terms.index) {
                const std::string place = place_of(loaded_, light.span);
                return fmt::format("`{}`{}{}", light.name,
                                   terms.kind == runtime::LightTerms::Kind::rectangle
                                       ? fmt::format(", point {} of its grid", terms.part + 1)
                                       : "",
                                   place.empty() ? "" : " (" + place + ")");
            }
        }
        return "?";
    }

private:
    static runtime::LightTerms::Kind kind_of(const compiler::ir::Light& light) {
        using Kind = runtime::LightTerms::Kind;
        static constexpr std::array kinds{Kind::point, Kind::directional, Kind::spot, Kind::rectangle};
        return kinds[light.light.index()];
    }

    const Loaded& loaded_;
    host::SceneNames objects_;
    std::map<std::uint32_t, std::string> members_;
};

} // namespace scc::cli
