#pragma once

#include "runtime/math/vec.h"

#include <cstdint>

namespace scc::runtime {

/// L8, w = 1. Intensity at distance d is color / (kc + kl d + kq d^2); kc, kl, kq >= 0, not all zero.
template <class R>
struct PointLight {
    Vec3<R> position{0, 0, 0};
    Rgb<R> diffuse{1, 1, 1};  ///< Id
    Rgb<R> specular{1, 1, 1}; ///< Is
    R kc = 1, kl = 0, kq = 0;
};

/// A point light that shines into a cone: its light is multiplied by the exponent-th power of the cosine c of
/// the angle to the axis, and by a smooth step of c from 0 at cos_outer and beyond to 1 at cos_inner.
template <class R>
struct SpotLight : PointLight<R> {
    Vec3<R> axis{0, -1, 0}; ///< unit; the way the light travels in the cone's middle
    R cos_inner = 1;        ///< of half angles; cos_inner >= cos_outer >= 0
    R cos_outer = 0;
    R exponent = 0;
};

/// A grid of point lights at the centres of nu x nv cells of the parallelogram with a corner at `position`.
/// Colours are those of all of them together.
template <class R>
struct RectangleLight : PointLight<R> {
    Vec3<R> edge_u{1, 0, 0}, edge_v{0, 0, 1};
    std::uint32_t nu = 4, nv = 4;
};

/// One of them.
template <class R>
constexpr PointLight<R> point_of(const RectangleLight<R>& light, std::uint32_t u, std::uint32_t v) {
    const auto middle = [](std::uint32_t i, std::uint32_t n) {
        return (static_cast<R>(i) + R(0.5)) / static_cast<R>(n);
    };
    const R share = 1 / static_cast<R>(light.nu * light.nv);
    PointLight<R> point = light;
    point.position =
        light.position + (light.edge_u * middle(u, light.nu) + light.edge_v * middle(v, light.nv));
    point.diffuse = light.diffuse * share;
    point.specular = light.specular * share;
    return point;
}
/// f(point) for each, row by row.
template <class R, class F>
constexpr void for_each_point(const RectangleLight<R>& light, F&& f) {
    for (std::uint32_t v = 0; v < light.nv; ++v) {
        for (std::uint32_t u = 0; u < light.nu; ++u) {
            f(point_of(light, u, v));
        }
    }
}

/// L8, w = 0.
template <class R>
struct DirectionalLight {
    Vec3<R> to_light{0, 1, 0}; ///< unit vector towards the source
    Rgb<R> diffuse{1, 1, 1};
    Rgb<R> specular{1, 1, 1};
};

} // namespace scc::runtime
