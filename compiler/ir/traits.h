#pragma once

#include "runtime/scene.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler::ir {

/// A yes-or-no need of a scene, as SceneTraits holds it.
struct TraitFlag {
    std::string_view name;
    bool runtime::SceneTraits::*member;
};

/// All of them, in the order of the members: the one table that the IR's text, the statistics and the
/// generated program are written from.
inline constexpr auto trait_flags = std::to_array<TraitFlag>({
    {"point_lights", &runtime::SceneTraits::point_lights},
    {"directional_lights", &runtime::SceneTraits::directional_lights},
    {"spot_lights", &runtime::SceneTraits::spot_lights},
    {"rectangle_lights", &runtime::SceneTraits::rectangle_lights},
    {"attenuation", &runtime::SceneTraits::attenuation},
    {"separate_specular", &runtime::SceneTraits::separate_specular},
    {"specular", &runtime::SceneTraits::specular},
    {"emission", &runtime::SceneTraits::emission},
    {"reflection", &runtime::SceneTraits::reflection},
    {"transmission", &runtime::SceneTraits::transmission},
    {"refraction", &runtime::SceneTraits::refraction},
    {"two_sided", &runtime::SceneTraits::two_sided},
    {"functions", &runtime::SceneTraits::functions},
    {"uv", &runtime::SceneTraits::uv},
    {"bump", &runtime::SceneTraits::bump},
    {"smooth_normals", &runtime::SceneTraits::smooth_normals},
    {"shadows", &runtime::SceneTraits::shadows},
    {"accelerator", &runtime::SceneTraits::accelerator},
    {"perspective", &runtime::SceneTraits::perspective},
    {"orthographic", &runtime::SceneTraits::orthographic},
    {"spherical", &runtime::SceneTraits::spherical},
    {"lens", &runtime::SceneTraits::lens},
    {"pixel_sampling", &runtime::SceneTraits::pixel_sampling},
    {"spectra", &runtime::SceneTraits::spectra},
    {"raster", &runtime::SceneTraits::raster},
    {"lines", &runtime::SceneTraits::lines},
});

/// What a scene needs, in words: "sphere", "box (transformed)", "point_lights".
std::vector<std::string> feature_names(const runtime::SceneTraits& traits);

} // namespace scc::compiler::ir
