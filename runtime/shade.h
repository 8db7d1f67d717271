#pragma once

#include "runtime/accel/occluders.h"
#include "runtime/illumination.h"
#include "runtime/raycast.h"
#include "runtime/render_request.h"

#include <array>
#include <span>
#include <vector>

/// The colour that a ray sees: L7 to L9, L14, L15.
namespace scc::runtime {

namespace detail {

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

template <class L>
MaskOf<L> is_black(const Rgb<L>& c) {
    return (c.r == 0) & (c.g == 0) & (c.b == 0);
}

/// Where rays met surfaces, as their shading needs it.
template <class L>
struct Encounter {
    Surface<L> surface;
    SurfacePoint<L> point; ///< only where the scene has functions
    Vec3<L> normal;        ///< m: shading normal that faces the viewer
    IndexOf<L> material;
};

/// A material's fields at a point.
template <class L>
struct Reflectances {
    Rgb<L> ambient, diffuse, specular, emission, reflect;
    L shininess;
};

/// Strictly between: what the light itself lies on does not shadow it, up to the rounding of t.
template <class R>
inline constexpr R before_the_light = 1 - 32 * std::numeric_limits<R>::epsilon();

template <SceneModel S, class L>
class Shader {
    static constexpr int N = packs_together<S, L>;

public:
    using R = typename S::Real;
    using Mask = MaskOf<L>;

    Shader(const S& scene, const RenderSettings& settings, RayCounts& counts)
        : scene_(scene), depth_(settings.depth), shadows_(settings.shadows), counts_(counts) {
        if constexpr (S::traits.rectangle_lights) {
            for (const auto& light : scene.rectangle_lights) {
                for_each_point(light, [&](const PointLight<R>& point) { grid_points_.push_back(point); });
            }
        }
        if constexpr (S::traits.shadows && !has_hierarchy<S>) {
            const auto balls = primitive_balls(scene);
            for (const auto& light : scene.point_lights) {
                point_occluders_.emplace_back(balls, light);
            }
            for (const auto& light : scene.spot_lights) {
                point_occluders_.emplace_back(balls, light);
            }
            for (const auto& light : grid_points_) {
                point_occluders_.emplace_back(balls, light);
            }
            for (const auto& light : scene.directional_lights) {
                directional_occluders_.emplace_back(balls, light);
            }
        }
    }

    /// What comes from along each ray of the active lanes, which meet but the candidates first. Mirrors are
    /// followed one after the other, each weighing what is behind it; after the last bounce a mirror shows
    /// black.
    void radiance(std::array<Ray<L>, N>& rays, Apex apex, Candidates candidates,
                  const std::array<Mask, N>& among, std::array<Rgb<L>, N>& sums) const {
        Packs packs;
        for (std::size_t i = 0; i < packs.count; ++i) {
            packs[i].active = among[i];
            packs[i].weight = {L(1), L(1), L(1)};
            sums[i] = {L(0), L(0), L(0)};
        }
        for (int bounce = 0;; ++bounce) {
            std::array<Hit<L>, N> hits;
            for (std::size_t i = 0; i < packs.count; ++i) {
                rays[i].t_max = choose(packs[i].active, rays[i].t_max, -infinity<L>());
            }
            closest_hits<N, S, L>(scene_, rays, apex, hits, candidates);
            bool goes_on = false;
            for (std::size_t i = 0; i < packs.count; ++i) {
                Pack& pack = packs[i];
                const Mask missed = pack.active & (hits[i].kind == IndexOf<L>(no_kind));
                sums[i] = choose(missed, sums[i] + pack.weight * lanes<L>(scene_.background), sums[i]);
                pack.active = pack.active & !missed;
                if (any(pack.active)) {
                    goes_on = true;
                    meet(rays[i], hits[i], pack);
                    look_up(pack);
                }
            }
            if (!goes_on) {
                return;
            }
            illuminate(packs, rays);
            goes_on = false;
            for (std::size_t i = 0; i < packs.count; ++i) {
                Pack& pack = packs[i];
                if (none(pack.active)) {
                    continue;
                }
                sums[i] = choose(pack.active, sums[i] + pack.weight * pack.light, sums[i]);
                if constexpr (S::traits.reflection) {
                    pack.active = pack.active & !is_black(pack.material.reflect);
                    if (bounce >= depth_ || none(pack.active)) {
                        continue;
                    }
                    goes_on = true;
                    pack.weight = pack.weight * pack.material.reflect;
                    const Vec3<L> mirrored = reflect(rays[i].dir, pack.at.normal);
                    rays[i] = {start_off(pack.at.surface, mirrored), mirrored, spawned_t_min<L>(),
                               infinity<L>()};
                    counts_.reflected += count_lanes(pack.active);
                }
            }
            if (!goes_on) {
                return;
            }
            apex = Apex::none;
            candidates = all_candidates;
        }
    }

private:
    /// What is known of one pack's rays.
    struct Pack {
        Mask active;
        Rgb<L> weight;
        Encounter<L> at;
        Reflectances<L> material;
        Rgb<L> light; ///< that leaves the encounter towards the ray's origin, but for mirrors
    };
    /// Without values at first: a pack has them from its first hit on, and few have one in every bounce.
    struct Packs {
        Packs() {}
        union {
            std::array<Pack, N> list;
        };
        static constexpr std::size_t count = N;
        Pack& operator[](std::size_t i) { return list[i]; }
    };

    /// Fills in `pack.at`. The material is chosen by the side of the geometric normal that the ray is on. The
    /// shading normal is turned to the viewer by its own sign, so that an interpolated one that already
    /// points away at a silhouette shades as in POV-Ray.
    void meet(const Ray<L>& ray, const Hit<L>& hit, Pack& pack) const {
        Encounter<L>& at = pack.at;
        bool first = true;
        for_each_primitive(
            scene_, hit, pack.active,
            [&](const auto& primitive, const Mask& here, [[maybe_unused]] const auto inverted) {
                Vec3<L> object_point;
                Surface<L> surface = surface_of(scene_, primitive, ray, hit.shape, here, object_point);
                if constexpr (uses_csg(S::traits)) {
                    surface = inverted ? turned_over(surface) : surface;
                }
                const Mask back = dot(surface.normal, ray.dir) > 0;
                const Vec3<L> normal = choose(dot(surface.shading_normal, ray.dir) > 0,
                                              -surface.shading_normal, surface.shading_normal);
                const Sides& sides = primitive.tag.sides;
                using Index = IndexOf<L>;
                const Index material = S::traits.two_sided
                                           ? choose(back, Index(sides.back), Index(sides.front))
                                           : Index(sides.front);
                // Value by value, since whole structures would be copied through memory.
                put(first, here, surface.point, at.surface.point);
                put(first, here, surface.error, at.surface.error);
                put(first, here, surface.normal, at.surface.normal);
                put(first, here, normal, at.normal);
                put(first, here, material, at.material);
                if constexpr (S::traits.functions) {
                    put(first, here, object_point, at.point.p);
                }
                if constexpr (S::traits.uv) {
                    if (scene_.reads_uv) {
                        put(first, here, uv_of(scene_, primitive, ray, hit.shape, here, object_point),
                            at.point.uv);
                    }
                }
                first = false;
            });
        if constexpr (S::traits.functions) {
            at.point.world = at.surface.point;
            at.point.n = at.surface.normal;
        }
    }
    /// What the first group of lanes has may stand in the others too, whose turn comes later or which take
    /// no part.
    template <class T>
    static void put(bool first, const Mask& here, const T& value, T& to) {
        to = first ? value : choose(here, value, to);
    }

    Rgb<L> value(const Varying<Rgb<R>>& field, const SurfacePoint<L>& point) const {
        if constexpr (S::traits.functions) {
            if (field.function != no_function) {
                return scene_.color_function(field.function, point);
            }
        }
        return lanes<L>(field.value);
    }
    L value(const Varying<R>& field, const SurfacePoint<L>& point) const {
        if constexpr (S::traits.functions) {
            if (field.function != no_function) {
                return scene_.number_function(field.function, point);
            }
        }
        return L(field.value);
    }

    /// Fills in `pack.material`.
    void look_up(Pack& pack) const {
        const Encounter<L>& at = pack.at;
        Reflectances<L>& result = pack.material;
        bool first = true;
        Mask among = pack.active;
        do {
            const std::uint32_t index = lane(at.material, first_lane(among));
            const Mask here = among & (at.material == IndexOf<L>(index));
            const Phong<R>& material = scene_.materials[index];
            put(first, here, value(material.ambient, at.point), result.ambient);
            put(first, here, value(material.diffuse, at.point), result.diffuse);
            if constexpr (S::traits.emission) {
                put(first, here, value(material.emission, at.point), result.emission);
            }
            if constexpr (S::traits.specular) {
                put(first, here, value(material.specular, at.point), result.specular);
                put(first, here, value(material.shininess, at.point), result.shininess);
            }
            if constexpr (S::traits.reflection) {
                put(first, here, value(material.reflect, at.point), result.reflect);
            }
            first = false;
            among = among & !here;
        } while (any(among));
    }

    void illuminate(Packs& packs, const std::array<Ray<L>, N>& rays) const {
        for (std::size_t i = 0; i < packs.count; ++i) {
            Pack& pack = packs[i];
            if (none(pack.active)) {
                continue;
            }
            pack.light = lanes<L>(scene_.ambient) * pack.material.ambient;
            if constexpr (S::traits.emission) {
                pack.light = pack.light + pack.material.emission;
            }
        }
        const auto add_light = [&](const auto& light, std::size_t index) { add(light, index, packs, rays); };
        if constexpr (S::traits.point_lights) {
            for_each_light(scene_.point_lights, add_light);
        }
        if constexpr (S::traits.directional_lights) {
            for_each_light(scene_.directional_lights, add_light);
        }
        std::size_t points = scene_.point_lights.size();
        if constexpr (S::traits.spot_lights) {
            for_each_light(scene_.spot_lights,
                           [&](const auto& light, std::size_t index) { add_light(light, points + index); });
            points += scene_.spot_lights.size();
        }
        if constexpr (S::traits.rectangle_lights) {
            for (std::size_t i = 0; i < grid_points_.size(); ++i) {
                add_light(grid_points_[i], points + i);
            }
        }
    }

    /// `index`: in the list of occluders for its kind of light.
    template <class Light>
    void add(const Light& light, std::size_t index, Packs& packs, const std::array<Ray<L>, N>& rays) const {
        std::array<LightAt<L>, N> seen;
        std::array<L, N> cosine;
        std::array<Mask, N> lit;
        bool any_lit = false;
        for (std::size_t i = 0; i < packs.count; ++i) {
            lit[i] = packs[i].active;
            if (none(lit[i])) {
                continue;
            }
            seen[i] = light_at(light, packs[i].at.surface.point);
            cosine[i] = dot(seen[i].to_light, packs[i].at.normal);
            lit[i] = lit[i] & (cosine[i] > 0);
            if constexpr (requires { light.cos_outer; }) {
                lit[i] = lit[i] & (cone_cosine(light, seen[i].to_light) > L(light.cos_outer));
            }
            any_lit = any_lit || any(lit[i]);
        }
        if (!any_lit) {
            return;
        }
        take_shadowed(source(light), index, packs, lit);
        for (std::size_t i = 0; i < packs.count; ++i) {
            if (any(lit[i])) {
                add(light, packs[i], rays[i].dir, seen[i], cosine[i], lit[i]);
            }
        }
    }

    template <class Light>
    void add(const Light& light, Pack& pack, const Vec3<L>& dir, const LightAt<L>& seen, const L& cosine,
             const Mask& lit) const {
        const Reflectances<L>& material = pack.material;
        Rgb<L> reflected = lanes<L>(light.diffuse) * material.diffuse * cosine;
        if constexpr (S::traits.specular) {
            const Mask highlit = lit & !is_black(material.specular);
            if (any(highlit)) {
                const Rgb<L> color = lanes<L>(S::traits.separate_specular ? light.specular : light.diffuse);
                const L strength =
                    highlight(pack.at.normal, seen.to_light, -normalize(dir), material.shininess);
                reflected = choose(highlit, reflected + color * material.specular * strength, reflected);
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
        pack.light = choose(lit, pack.light + reflected, pack.light);
    }

    /// L14: feelers that start off the surfaces, for the lit lanes.
    template <class Light>
    void take_shadowed(const Light& light, [[maybe_unused]] std::size_t index, const Packs& packs,
                       std::array<Mask, N>& lit) const {
        if constexpr (S::traits.shadows) {
            if (!shadows_) {
                return;
            }
            std::array<Ray<L>, N> rays;
            std::array<Mask, N> blocked;
            for (std::size_t i = 0; i < packs.count; ++i) {
                blocked[i] = Mask(false);
                if (any(lit[i])) {
                    counts_.shadow += count_lanes(lit[i]);
                    rays[i] = feeler(light, packs.list[i].at.surface);
                }
                rays[i].t_max = choose(lit[i], rays[i].t_max, -infinity<L>());
            }
            if constexpr (has_hierarchy<S>) {
                any_hits<N, S, L>(scene_, rays, apex_of(light), blocked);
            } else {
                const Candidates candidates = occluders(light, index).before(rays[0], lit[0]);
                blocked[0] = any_hit(scene_, rays[0], candidates);
            }
            for (std::size_t i = 0; i < packs.count; ++i) {
                lit[i] = lit[i] & !blocked[i];
            }
        }
    }
    const Occluders<PointLight<R>>& occluders(const PointLight<R>&, std::size_t index) const {
        return point_occluders_[index];
    }
    const Occluders<DirectionalLight<R>>& occluders(const DirectionalLight<R>&, std::size_t index) const {
        return directional_occluders_[index];
    }
    /// A light as its shadows know it.
    static const PointLight<R>& source(const PointLight<R>& light) { return light; }
    static const DirectionalLight<R>& source(const DirectionalLight<R>& light) { return light; }
    static Apex apex_of(const PointLight<R>&) { return Apex::end; }
    static Apex apex_of(const DirectionalLight<R>&) { return Apex::none; }
    static Ray<L> feeler(const PointLight<R>& light, const Surface<L>& surface) {
        const Vec3<L> position = lanes<L>(light.position);
        const Vec3<L> org = start_off(surface, position - surface.point);
        return {org, position - org, spawned_t_min<L>(), L(before_the_light<R>)};
    }
    static Ray<L> feeler(const DirectionalLight<R>& light, const Surface<L>& surface) {
        const Vec3<L> to_light = lanes<L>(light.to_light);
        return {start_off(surface, to_light), to_light, spawned_t_min<L>(), infinity<L>()};
    }

    const S& scene_;
    int depth_;
    bool shadows_;
    RayCounts& counts_;
    std::vector<PointLight<R>> grid_points_; ///< of all rectangle lights
    /// Without a hierarchy: of point lights, spot lights and grid points.
    std::vector<Occluders<PointLight<R>>> point_occluders_;
    std::vector<Occluders<DirectionalLight<R>>> directional_occluders_;
};

} // namespace detail

} // namespace scc::runtime
