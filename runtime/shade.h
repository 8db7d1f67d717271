#pragma once

#include "runtime/illumination.h"
#include "runtime/raycast.h"
#include "runtime/render_request.h"

/// The colour that a ray sees: L7 to L9, L14, L15.
namespace scc::runtime {

namespace detail {

/// Constant tables of lights up to this size are unrolled.
inline constexpr std::size_t unrolled_lights = 4;

template <class Table, class F>
void for_each_light(const Table& table, F&& f) {
    constexpr std::size_t size = constant_size<Table>;
    if constexpr (size > 0 && size <= unrolled_lights) {
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            (f(table[i]), ...);
        }(std::make_index_sequence<size>{});
    } else {
        for (const auto& light : table) {
            f(light);
        }
    }
}

template <class R>
bool is_black(const Rgb<R>& c) {
    return c.r == 0 && c.g == 0 && c.b == 0;
}

/// Where a ray met a surface, as its shading needs it.
template <class R>
struct Encounter {
    Surface<R> surface;
    SurfacePoint<R> point;
    Vec3<R> normal;    ///< m: shading normal that faces the viewer
    Vec3<R> to_viewer; ///< v, unit
    std::uint32_t material = 0;
};

/// Strictly between: what the light itself lies on does not shadow it, up to the rounding of t.
template <class R>
inline constexpr R before_the_light = 1 - 32 * std::numeric_limits<R>::epsilon();

template <SceneModel S>
class Shader {
public:
    using R = typename S::Real;

    Shader(const S& scene, const RenderSettings& settings, RayCounts& counts)
        : scene_(scene), depth_(settings.depth), shadows_(settings.shadows), counts_(counts) {}

    /// What comes from along the ray. Mirrors are followed one after the other, each weighing what is behind it; after
    /// the last bounce a mirror shows black.
    Rgb<R> radiance(Ray<R> ray) const {
        Rgb<R> sum{0, 0, 0};
        Rgb<R> weight{1, 1, 1};
        for (int bounce = 0;; ++bounce) {
            const Hit<R> hit = closest_hit(scene_, ray);
            if (!hit) {
                return sum + weight * scene_.background;
            }
            const Encounter<R> at = encounter(ray, hit);
            const Phong<R>& material = scene_.materials[at.material];
            sum = sum + weight * illumination(at, material);
            if constexpr (S::traits.reflection) {
                if (bounce >= depth_) {
                    return sum;
                }
                const Rgb<R> reflectivity = value(material.reflect, at.point);
                if (is_black(reflectivity)) {
                    return sum;
                }
                weight = weight * reflectivity;
                const Vec3<R> mirrored = reflect(ray.dir, at.normal);
                ray = {start_off(at.surface, mirrored), mirrored, spawned_t_min<R>(), infinity<R>()};
                ++counts_.reflected;
            } else {
                return sum;
            }
        }
    }

private:
    Rgb<R> value(const Varying<Rgb<R>>& field, const SurfacePoint<R>& point) const {
        if constexpr (S::traits.functions) {
            if (field.function != no_function) {
                return scene_.color_function(field.function, point);
            }
        }
        return field.value;
    }
    R value(const Varying<R>& field, const SurfacePoint<R>& point) const {
        if constexpr (S::traits.functions) {
            if (field.function != no_function) {
                return scene_.number_function(field.function, point);
            }
        }
        return field.value;
    }

    /// The normal faces the viewer and the material is chosen by the side of the geometric normal that the ray is on.
    Encounter<R> encounter(const Ray<R>& ray, const Hit<R>& hit) const {
        Encounter<R> result;
        with_primitive(scene_, hit, [&](const auto& primitive) {
            const WorldSurface<R> world = surface_of(scene_, primitive, ray, hit.shape);
            const bool back = dot(world.surface.normal, ray.dir) > 0;
            result.surface = world.surface;
            result.point = {world.object_point, world.surface.point, world.surface.normal};
            result.normal = back ? -world.surface.shading_normal : world.surface.shading_normal;
            result.material = S::traits.two_sided && back ? primitive.tag.sides.back : primitive.tag.sides.front;
        });
        result.to_viewer = -normalize(ray.dir);
        return result;
    }

    Rgb<R> illumination(const Encounter<R>& at, const Phong<R>& material) const {
        const SurfacePoint<R>& point = at.point;
        Rgb<R> sum = scene_.ambient * value(material.ambient, point);
        if constexpr (S::traits.emission) {
            sum = sum + value(material.emission, point);
        }
        const Rgb<R> diffuse = value(material.diffuse, point);
        Rgb<R> specular{0, 0, 0};
        R shininess = 1;
        if constexpr (S::traits.specular) {
            specular = value(material.specular, point);
            shininess = is_black(specular) ? R(1) : value(material.shininess, point);
        }
        const auto add_light = [&](const auto& light) {
            add(sum, light, at, diffuse, specular, shininess);
        };
        if constexpr (S::traits.point_lights) {
            for_each_light(scene_.point_lights, add_light);
        }
        if constexpr (S::traits.directional_lights) {
            for_each_light(scene_.directional_lights, add_light);
        }
        return sum;
    }

    template <class Light>
    void add(Rgb<R>& sum, const Light& light, const Encounter<R>& at, const Rgb<R>& diffuse, const Rgb<R>& specular,
             R shininess) const {
        const LightAt<R> seen = light_at(light, at.surface.point);
        const R cosine = dot(seen.to_light, at.normal);
        if (!(cosine > 0) || is_shadowed(light, at.surface)) {
            return;
        }
        Rgb<R> reflected = light.diffuse * diffuse * cosine;
        if constexpr (S::traits.specular) {
            if (!is_black(specular)) {
                const Rgb<R>& color = S::traits.separate_specular ? light.specular : light.diffuse;
                reflected = reflected +
                            color * specular * highlight(at.normal, seen.to_light, at.to_viewer, shininess);
            }
        }
        if constexpr (S::traits.attenuation && requires { light.kc; }) {
            if (is_attenuated(light)) {
                reflected = reflected / attenuation(light, seen.distance);
            }
        }
        sum = sum + reflected;
    }

    /// L14: a feeler that starts off the surface.
    template <class Light>
    bool is_shadowed(const Light& light, const Surface<R>& surface) const {
        if constexpr (S::traits.shadows) {
            if (!shadows_) {
                return false;
            }
            ++counts_.shadow;
            return any_hit(scene_, feeler(light, surface));
        } else {
            return false;
        }
    }
    static Ray<R> feeler(const PointLight<R>& light, const Surface<R>& surface) {
        const Vec3<R> org = start_off(surface, light.position - surface.point);
        return {org, light.position - org, spawned_t_min<R>(), before_the_light<R>};
    }
    static Ray<R> feeler(const DirectionalLight<R>& light, const Surface<R>& surface) {
        return {start_off(surface, light.to_light), light.to_light, spawned_t_min<R>(), infinity<R>()};
    }

    const S& scene_;
    int depth_;
    bool shadows_;
    RayCounts& counts_;
};

} // namespace detail

} // namespace scc::runtime
