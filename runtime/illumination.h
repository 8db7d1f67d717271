#pragma once

#include "runtime/light.h"
#include "runtime/math/unit_power.h"
#include "runtime/math/vec.h"

/// The terms of L7 for one light, over lanes.
namespace scc::runtime {

/// A light as a surface point sees it.
template <class L>
struct LightAt {
    Vec3<L> to_light; ///< s, unit
    L distance;       ///< infinity for a directional light
};

template <class L, class R>
constexpr LightAt<L> light_at(const PointLight<R>& light, const Vec3<L>& point) {
    const Vec3<L> s = lanes<L>(light.position) - point;
    const L distance = length(s);
    return {s * (1 / distance), distance};
}
template <class L, class R>
constexpr LightAt<L> light_at(const DirectionalLight<R>& light, const Vec3<L>&) {
    return {lanes<L>(light.to_light), infinity<L>()};
}

template <class L, class R>
constexpr L attenuation(const PointLight<R>& light, const L& distance) {
    return L(light.kc) + (L(light.kl) + L(light.kq) * distance) * distance;
}
template <class R>
constexpr bool is_attenuated(const PointLight<R>& light) {
    return light.kc != 1 || light.kl != 0 || light.kq != 0;
}

/// The cosine of the angle between the cone's axis and the way to a surface point, to which s leads back.
template <class L, class R>
constexpr L cone_cosine(const SpotLight<R>& light, const Vec3<L>& to_light) {
    return -dot(to_light, lanes<L>(light.axis));
}
/// The part of the light that goes there; for cosines above cos_outer.
template <class L, class R>
L cone_share(const SpotLight<R>& light, const L& cosine) {
    const R width = light.cos_inner - light.cos_outer;
    const L q = minimum((cosine - L(light.cos_outer)) / L(width), L(1)); // a width of 0: infinite, so 1
    const L step = q * q * (3 - 2 * q);
    return light.exponent == 0 ? step : step * unit_power(cosine, L(light.exponent));
}

/// (h.m / |h|)^shininess, not negative; `to_light` and `to_viewer` are unit vectors.
template <class L>
L highlight(const Vec3<L>& normal, const Vec3<L>& to_light, const Vec3<L>& to_viewer, const L& shininess) {
    const Vec3<L> halfway = to_light + to_viewer;
    const L cosine = dot(halfway, normal) / length(halfway);
    return unit_power(maximum(L(0), cosine), shininess);
}

/// The direction of a mirrored ray; as long as `dir`.
template <class L>
constexpr Vec3<L> reflect(const Vec3<L>& dir, const Vec3<L>& normal) {
    return dir - normal * (2 * dot(dir, normal));
}

} // namespace scc::runtime
