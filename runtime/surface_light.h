#pragma once

#include "runtime/encounter.h"
#include "runtime/illumination.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// The light that leaves a surface by itself and by what lights send there (L7, L8), whoever asks: rays
/// (shade.h) and triangles (raster/).
namespace scc::runtime::detail {

/// What a Shader tells of each ray: nothing. One that `observes` has the functions that the Shader calls (see
/// explain_pixel.h); its lanes are one, and its scene has everything.
struct Unobserved {
    static constexpr bool observes = false;
};

/// Constant tables of lights up to this size are unrolled.
inline constexpr std::size_t unrolled_lights = 4;

/// f(light, its index) for each.
template <class Table, class F>
void for_each_light(const Table& table, F&& f) {
    constexpr std::size_t size = constant_size<Table>;
    if constexpr (size > 0 && size <= unrolled_lights) {
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            (f(table[i], i), ...);
        }
        (std::make_index_sequence<size>{});
    } else {
        for (std::size_t i = 0; i < table.size(); ++i) {
            f(table[i], i);
        }
    }
}

/// Of all rectangle lights.
template <class S>
std::vector<PointLight<typename S::Real>> grid_points_of([[maybe_unused]] const S& scene) {
    std::vector<PointLight<typename S::Real>> points;
    if constexpr (S::traits.rectangle_lights) {
        for (const auto& light : scene.rectangle_lights) {
            for_each_point(light, [&](const auto& point) { points.push_back(point); });
        }
    }
    return points;
}

template <class L>
MaskOf<L> is_black(const Rgb<L>& c) {
    return (c.r == 0) & (c.g == 0) & (c.b == 0);
}

/// A material's fields at a point.
template <class L>
struct Reflectances {
    Rgb<L> ambient, diffuse, specular, emission, reflect, transmit;
    L shininess;
    L ior;
    L fresnel; ///< 1 or 0
};

/// No larger than the numbers of L's type, so that it is black times black. What is no number stays so.
template <class L>
L bounded(const L& x) {
    constexpr RealOf<L> most = std::numeric_limits<RealOf<L>>::max();
    return choose(x > L(most), L(most), choose(x < L(-most), L(-most), x));
}
template <class L>
Rgb<L> bounded(const Rgb<L>& c) {
    return {bounded(c.r), bounded(c.g), bounded(c.b)};
}

/// What a function of the scene has given; where it has no value, as the logarithm of a negative number, 0.
template <class L>
L value_or_none(const L& x) {
    return bounded(choose(x == x, x, L(0)));
}

template <class S, class L, class R>
inline Rgb<L> value_at([[maybe_unused]] const S& scene, const Varying<Rgb<R>>& field,
                       [[maybe_unused]] const SurfacePoint<L>& point) {
    if constexpr (S::traits.functions) {
        if (field.function != no_function) {
            const Rgb<L> value = scene.color_function(field.function, point);
            return {value_or_none(value.r), value_or_none(value.g), value_or_none(value.b)};
        }
    }
    return lanes<L>(field.value);
}
template <class S, class L, class R>
inline L value_at([[maybe_unused]] const S& scene, const Varying<R>& field,
                  [[maybe_unused]] const SurfacePoint<L>& point) {
    if constexpr (S::traits.functions) {
        if (field.function != no_function) {
            return value_or_none(scene.number_function(field.function, point));
        }
    }
    return L(field.value);
}

/// f(material, lanes, whether it is the first) for each that one of the active lanes has; there is one.
template <class L, class S, class F>
inline void for_each_material(const S& scene, const IndexOf<L>& materials, const MaskOf<L>& active, F&& f) {
    bool first = true;
    MaskOf<L> among = active;
    do {
        const std::uint32_t index = lane(materials, first_lane(among));
        const MaskOf<L> here = among & (materials == IndexOf<L>(index));
        f(scene.materials[index], here, first);
        first = false;
        among = among & !here;
    } while (any(among));
}

/// What the active lanes' materials are at a point.
template <class S, class L>
inline void look_up(const S& scene, const IndexOf<L>& materials, const SurfacePoint<L>& point,
                    const MaskOf<L>& active, Reflectances<L>& result) {
    using R = typename S::Real;
    for_each_material<L>(
        scene, materials, active, [&](const Phong<R>& material, const MaskOf<L>& here, bool first) {
            put(first, here, value_at(scene, material.ambient, point), result.ambient);
            put(first, here, value_at(scene, material.diffuse, point), result.diffuse);
            if constexpr (S::traits.emission) {
                put(first, here, value_at(scene, material.emission, point), result.emission);
            }
            if constexpr (S::traits.specular) {
                put(first, here, value_at(scene, material.specular, point), result.specular);
                put(first, here, value_at(scene, material.shininess, point), result.shininess);
            }
            if constexpr (S::traits.reflection) {
                put(first, here, value_at(scene, material.reflect, point), result.reflect);
            }
            if constexpr (S::traits.transmission) {
                put(first, here, value_at(scene, material.transmit, point), result.transmit);
            }
            if constexpr (S::traits.refraction) {
                put(first, here, L(material.ior), result.ior);
                put(first, here, L(truth(material.fresnel)), result.fresnel);
            }
        });
}

/// What needs no light.
template <class S, class L>
inline Rgb<L> own_light(const S& scene, const Reflectances<L>& material) {
    Rgb<L> light = lanes<L>(scene.ambient) * material.ambient;
    if constexpr (S::traits.emission) {
        light = light + material.emission;
    }
    return light;
}

/// Those of the lanes in `among` that the light shines at, unless something is in between.
template <class L, class Light>
inline MaskOf<L> lit_lanes([[maybe_unused]] const Light& light, [[maybe_unused]] const LightAt<L>& seen,
                           const L& cosine, const MaskOf<L>& among) {
    MaskOf<L> lit = among & (cosine > 0);
    if constexpr (requires { light.cos_outer; }) {
        lit = lit & (cone_cosine(light, seen.to_light) > L(light.cos_outer));
    }
    return lit;
}

/// What lit surfaces reflect of a light to where `dir`, of any length, comes from. `cosine`: of the normal
/// with the way to the light.
template <class S, class L, class Light, class Observer>
inline Rgb<L> reflected_light(const Light& light, const Reflectances<L>& material,
                              [[maybe_unused]] const Vec3<L>& normal, [[maybe_unused]] const Vec3<L>& dir,
                              const LightAt<L>& seen, const L& cosine, [[maybe_unused]] const MaskOf<L>& lit,
                              [[maybe_unused]] Observer& observer) {
    Rgb<L> reflected = lanes<L>(light.diffuse) * material.diffuse * cosine;
    if constexpr (Observer::observes) {
        observer.tell([&](auto& o) { o.diffuse(reflected); });
    }
    if constexpr (S::traits.specular) {
        const MaskOf<L> highlit = lit & !is_black(material.specular);
        if (any(highlit)) {
            const Rgb<L> color = lanes<L>(S::traits.separate_specular ? light.specular : light.diffuse);
            const L strength = highlight(normal, seen.to_light, -normalize(dir), material.shininess);
            reflected = choose(highlit, reflected + color * material.specular * strength, reflected);
            if constexpr (Observer::observes) {
                observer.tell([&](auto& o) { o.specular(strength, color * material.specular * strength); });
            }
        }
    }
    if constexpr (S::traits.attenuation && requires { light.kc; }) {
        if (is_attenuated(light)) {
            reflected = reflected / attenuation(light, seen.distance);
        }
    }
    if constexpr (requires { light.cos_outer; }) {
        reflected = reflected * cone_share(light, cone_cosine(light, seen.to_light));
    }
    return reflected;
}

/// All of it, without shadows. `grid_points`: of the rectangle lights.
template <class S, class L>
Rgb<L> unshadowed_light(const S& scene, const std::vector<PointLight<typename S::Real>>& grid_points,
                        const Reflectances<L>& material, const Vec3<L>& point, const Vec3<L>& normal,
                        const Vec3<L>& dir, const MaskOf<L>& active) {
    Rgb<L> light = own_light(scene, material);
    Unobserved observer;
    const auto add = [&](const auto& source, std::size_t) {
        const LightAt<L> seen = light_at(source, point);
        const L cosine = dot(seen.to_light, normal);
        const MaskOf<L> lit = lit_lanes(source, seen, cosine, active);
        if (any(lit)) {
            light = choose(
                lit, light + reflected_light<S>(source, material, normal, dir, seen, cosine, lit, observer),
                light);
        }
    };
    if constexpr (S::traits.point_lights) {
        for_each_light(scene.point_lights, add);
    }
    if constexpr (S::traits.directional_lights) {
        for_each_light(scene.directional_lights, add);
    }
    if constexpr (S::traits.spot_lights) {
        for_each_light(scene.spot_lights, add);
    }
    if constexpr (S::traits.rectangle_lights) {
        for_each_light(grid_points, add);
    }
    return light;
}

} // namespace scc::runtime::detail
