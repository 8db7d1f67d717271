#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// What a picture shows beside light, as compositing programs take it ("arbitrary output variables"): of the
/// sample at each pixel's centre alone, unfiltered, where its ray first meets a surface, transparent or not.
namespace scc::runtime {

enum class Aov : std::uint32_t {
    depth,    ///< distance from the ray's origin, in world units
    planar,   ///< the same along the view axis: -n . (point - eye)
    position, ///< world coordinates
    normal,   ///< m of L7: shading normal, world, unit, on the side that the ray comes from
    uv,       ///< coordinates on the surface; (0, 0) where a shape has none
    object,   ///< Tag::id + 1 of the object (of a solid, the whole), 0 for none
    material  ///< index + 1 in the scene's table, 0 for none
};

/// Those whose bit() is set.
using AovSet = std::uint32_t;

constexpr AovSet bit(Aov one) {
    return 1U << static_cast<std::uint32_t>(one);
}
constexpr bool has(AovSet set, Aov one) {
    return (set & bit(one)) != 0;
}

/// Rows from the top, channel by channel; a list is empty where it was not asked for. Where a ray meets
/// nothing, depth and planar are infinite and the rest is 0.
struct AovImage {
    int width = 0;
    int height = 0;
    std::vector<float> depth, planar;
    std::array<std::vector<float>, 3> position, normal;
    std::array<std::vector<float>, 2> uv;
    std::vector<std::uint32_t> object, material;
    std::array<double, 3> origin{}; ///< added to positions, see RenderSettings::origin

    AovImage() = default;
    AovImage(int w, int h, AovSet set) : width(w), height(h) {
        const std::size_t pixels = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
        const auto take = [&](Aov aov, auto& list) { list.resize(has(set, aov) ? pixels : 0); };
        take(Aov::depth, depth);
        take(Aov::planar, planar);
        for (auto& list : position) {
            take(Aov::position, list);
        }
        for (auto& list : normal) {
            take(Aov::normal, list);
        }
        for (auto& list : uv) {
            take(Aov::uv, list);
        }
        take(Aov::object, object);
        take(Aov::material, material);
    }
};

} // namespace scc::runtime
