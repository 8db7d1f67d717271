#pragma once

#include "runtime/accel/occluders.h"
#include "runtime/media.h"
#include "runtime/render_request.h"
#include "runtime/surface_light.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

/// The colour that a ray sees: L7 to L9, L14, L15, and refraction.
namespace scc::runtime {

namespace detail {

/// Where a ray goes on in two directions, one that could change a pixel by no more than this part of what is
/// seen there is not followed: else their number doubles with each bounce.
template <class R>
inline constexpr R least_weight = R(1e-9);

/// Strictly between: what the light itself lies on does not shadow it, up to the rounding of t.
template <class R>
inline constexpr R before_the_light = 1 - 32 * std::numeric_limits<R>::epsilon();

template <SceneModel S, class L, class Observer = Unobserved>
class Shader {
    static constexpr int N = packs_together<S, L>;

public:
    using R = typename S::Real;
    using Mask = MaskOf<L>;

    Shader(const S& scene, const RenderSettings& settings, RayCounts& counts, Observer observer = {})
        : scene_(scene), depth_(settings.depth), shadows_(settings.shadows), counts_(counts),
          observer_(observer), grid_points_(grid_points_of(scene)) {
        if constexpr (S::traits.transmission) {
            for (const Phong<R>& material : scene.materials) {
                transmits_ = transmits_ || lets_through(material);
                refracts_ = refracts_ || refracts(material);
            }
        }
        if constexpr (S::traits.bump) {
            for (const Phong<R>& material : scene.materials) {
                bumps_ = bumps_ || material.bump != no_function;
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

    /// What comes from along each ray of the active lanes, which meet but the candidates first. Mirrors and
    /// transparent surfaces are followed one after the other, each weighing what is behind it; after the last
    /// bounce they show black. Where a ray goes on in two directions, the mirrored one waits.
    void radiance(std::array<Ray<L>, N>& rays, Apex apex, Candidates candidates,
                  const std::array<Mask, N>& among, std::array<Rgb<L>, N>& sums) {
        Packs packs;
        for (std::size_t i = 0; i < packs.count; ++i) {
            packs[i].active = among[i];
            packs[i].weight = {L(1), L(1), L(1)};
            sums[i] = {L(0), L(0), L(0)};
        }
        if constexpr (S::traits.transmission) {
            start(packs, rays);
        }
        for (int bounce = 0;; ++bounce) {
            std::array<Hit<L>, N> hits;
            for (std::size_t i = 0; i < packs.count; ++i) {
                rays[i].t_max = choose(packs[i].active, rays[i].t_max, -infinity<L>());
            }
            if constexpr (Observer::observes) {
                observer_.tell([&](auto& o) { o.ray(rays[0], packs[0].weight, packs[0].bounces); });
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
                    if constexpr (S::traits.bump) {
                        bump(pack, rays[i]);
                    }
                    look_up(scene_, pack.at.material, pack.at.point, pack.active, pack.material);
                    if constexpr (Observer::observes) {
                        observer_.tell([&](auto& o) { o.met(hits[i], pack.at, pack.material); });
                    }
                }
            }
            if (goes_on) {
                illuminate(packs, rays);
            } else if (!S::traits.transmission) {
                return;
            }
            goes_on = false;
            for (std::size_t i = 0; i < packs.count; ++i) {
                Pack& pack = packs[i];
                if (any(pack.active)) {
                    sums[i] = choose(pack.active, sums[i] + pack.weight * pack.light, sums[i]);
                    if constexpr (Observer::observes) {
                        observer_.tell([&](auto& o) { o.leaves(pack.light); });
                    }
                    if constexpr (S::traits.transmission) {
                        go_through(pack, rays[i], waiting_[i]);
                    } else if constexpr (S::traits.reflection) {
                        goes_on = go_back(pack, rays[i], bounce) || goes_on;
                    }
                }
                if constexpr (S::traits.transmission) {
                    goes_on = take_up(pack, rays[i], waiting_[i]) || goes_on;
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
        // Only with transmission:
        L bounces; ///< each ray's own
        IndexOf<L> media;
        Rgb<L> filter; ///< what transparent surfaces leave of the light in question
        // Only with bumps:
        Mask is_bumped;
        Vec3<L> facing; ///< the geometric normal on the ray's side
    };
    /// A mirrored ray that waits until what is seen through its surface is done.
    struct Branch {
        Mask active;
        Rgb<L> weight;
        L bounces;
        IndexOf<L> media;
        Vec3<L> org, dir;
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

    /// Fills in `pack.at`.
    void meet(const Ray<L>& ray, const Hit<L>& hit, Pack& pack) const {
        constexpr EncounterParts parts{S::traits.refraction, S::traits.functions, S::traits.uv,
                                       S::traits.bump};
        bool reads_uv = false;
        if constexpr (S::traits.uv) {
            reads_uv = scene_.reads_uv;
        }
        detail::meet<parts>(scene_, ray, hit, pack.active, reads_uv, bumps_, pack.at);
    }

    /// Replaces the shading normals of bumped surfaces.
    void bump(Pack& pack, const Ray<L>& ray) const {
        pack.is_bumped = Mask(false);
        if (!bumps_) {
            return;
        }
        Encounter<L>& at = pack.at;
        const Vec3<L>& outward = at.surface.normal;
        pack.facing = choose(dot(outward, ray.dir) > 0, -outward, outward);
        for_each_material<L>(
            scene_, at.material, pack.active, [&](const Phong<R>& material, const Mask& here, bool) {
                if (material.bump != no_function) {
                    const Dual<L, 3> height =
                        scene_.number_function(material.bump, with_slopes(at.point, at.slopes));
                    const Vec3<L> slope{height.d[0], height.d[1], height.d[2]};
                    at.normal = choose(here, bumped_normal(at.normal, outward, slope), at.normal);
                    pack.is_bumped = pack.is_bumped | here;
                }
            });
    }
    /// s.m. A bump is not lit by what its surface itself is turned away from.
    L cosine_towards(const Vec3<L>& to_light, const Pack& pack) const {
        const L cosine = dot(to_light, pack.at.normal);
        if constexpr (S::traits.bump) {
            if (bumps_) {
                const L of_surface = dot(to_light, pack.facing);
                return choose(pack.is_bumped & !(of_surface > 0), minimum(of_surface, cosine), cosine);
            }
        }
        return cosine;
    }
    Vec3<L> mirror_direction(const Vec3<L>& dir, const Pack& pack) const {
        const Vec3<L> result = reflect(dir, pack.at.normal);
        if constexpr (S::traits.bump) {
            if (bumps_) {
                return choose(pack.is_bumped, reflect_bumped(dir, pack.at.normal, pack.facing), result);
            }
        }
        return result;
    }
    Refraction<L> refracted(const Vec3<L>& dir, const Pack& pack, const L& from, const L& to) const {
        if constexpr (S::traits.bump) {
            if (bumps_) {
                const Vec3<L> flat = choose(pack.is_bumped, pack.facing, pack.at.normal);
                return refract_bumped(dir, pack.at.normal, flat, from, to);
            }
        }
        return refract(dir, pack.at.normal, from, to);
    }

    void start(Packs& packs, const std::array<Ray<L>, N>& rays) {
        media_.clear();
        for (std::size_t i = 0; i < packs.count; ++i) {
            packs[i].bounces = L(0);
            packs[i].media = IndexOf<L>(Media<R>::air);
            if (refracts_) {
                for_each_lane(packs[i].active, [&](int k) {
                    const Vec3<L>& org = rays[i].org;
                    set_lane(packs[i].media, k, media_at({lane(org.x, k), lane(org.y, k), lane(org.z, k)}));
                });
            }
        }
    }
    template <class F>
    static void for_each_lane(const Mask& among, F&& f) {
        for (unsigned left = bits(among); left != 0; left &= left - 1) {
            f(__builtin_ctz(left));
        }
    }

    /// Sends a pack's rays back from mirrors; whether some go on.
    bool go_back(Pack& pack, Ray<L>& ray, int bounce) const {
        pack.active = pack.active & !is_black(pack.material.reflect);
        if (bounce >= depth_ || none(pack.active)) {
            return false;
        }
        pack.weight = bounded(pack.weight * pack.material.reflect);
        const Vec3<L> dir = mirror_direction(ray.dir, pack);
        ray = {start_off(pack.at.surface, dir), dir, spawned_t_min<L>(), infinity<L>()};
        counts_.reflected += count_lanes(pack.active);
        return true;
    }

    /// Sends a pack's rays through the surfaces that they have met and, where none is seen through, back from
    /// mirrors; mirrored rays of the others are left waiting.
    void go_through(Pack& pack, Ray<L>& ray, std::vector<Branch>& waiting) {
        const Reflectances<L>& material = pack.material;
        Mask through = pack.active & !is_black(material.transmit);
        Rgb<L> reflected{L(0), L(0), L(0)}, transmitted = material.transmit;
        if constexpr (S::traits.reflection) {
            reflected = material.reflect;
        }
        Vec3<L> dir = ray.dir;
        L bounces = pack.bounces;
        IndexOf<L> media = pack.media;
        if constexpr (S::traits.refraction) {
            const Mask dielectric = through | (pack.active & (material.fresnel != 0));
            if (refracts_ && any(dielectric)) {
                L from(1), to(1);
                cross(pack, dielectric, media, from, to);
                const Mask bent = dielectric & (from != to);
                const Refraction<L> refraction = refracted(ray.dir, pack, from, to);
                const Mask total = bent & through & refraction.is_total;
                const L share = choose(bent, refraction.reflectance, L(0));
                const Mask fresnel = dielectric & (material.fresnel != 0);
                reflected = choose(fresnel, reflected * share, reflected);
                transmitted = choose(fresnel, transmitted * (1 - share), transmitted);
                reflected = choose(total, Rgb<L>{L(1), L(1), L(1)}, reflected);
                through = through & !total & !(bent & (bounces >= L(static_cast<R>(depth_))));
                counts_.refracted += count_lanes(bent & through);
                if constexpr (Observer::observes) {
                    observer_.tell([&](auto& o) { o.crosses(from, to, share, total); });
                }
                dir = choose(bent, refraction.dir, dir);
                bounces = choose(bent, bounces + 1, bounces);
            }
        }
        through = through & !is_black(transmitted);
        Mask mirrored = pack.active & !is_black(reflected) & (pack.bounces < L(static_cast<R>(depth_)));
        const Mask both = through & mirrored;
        const Rgb<L> mirrored_weight = bounded(pack.weight * reflected),
                     through_weight = bounded(pack.weight * transmitted);
        mirrored = mirrored & !(both & is_slight(mirrored_weight));
        through = through & !(both & is_slight(through_weight));
        counts_.reflected += count_lanes(mirrored);
        if constexpr (Observer::observes) {
            observer_.tell([&](auto& o) { o.goes_on(reflected, mirrored, transmitted, through); });
        }
        Branch branch{Mask(mirrored & through), mirrored_weight, pack.bounces + 1, pack.media, {}, {}};
        if (any(mirrored)) {
            branch.dir = mirror_direction(ray.dir, pack);
            branch.org = start_off(pack.at.surface, branch.dir);
            if (any(branch.active)) {
                waiting.push_back(branch);
            }
        }
        const Vec3<L> org = start_off(pack.at.surface, dir);
        pack.active = through | mirrored;
        pack.weight = choose(through, through_weight, mirrored_weight);
        pack.bounces = choose(through, bounces, branch.bounces);
        pack.media = choose(through, media, branch.media);
        ray = {choose(through, org, branch.org), choose(through, dir, branch.dir), spawned_t_min<L>(),
               infinity<L>()};
    }
    static Mask is_slight(const Rgb<L>& weight) {
        return maximum(maximum(weight.r, weight.g), weight.b) < L(least_weight<R>);
    }

    /// The media behind the surfaces that lanes have met, and the indices of refraction on both sides.
    void cross(const Pack& pack, const Mask& among, IndexOf<L>& media, L& from, L& to) {
        for_each_lane(among, [&](int k) {
            const typename Media<R>::Crossing crossing =
                media_.cross(lane(pack.media, k), lane(pack.at.body, k), lane(pack.material.ior, k));
            set_lane(media, k, crossing.media);
            set_lane(from, k, crossing.from);
            set_lane(to, k, crossing.to);
        });
    }

    /// Gives a pack without active rays the last of those that wait; whether it has some.
    bool take_up(Pack& pack, Ray<L>& ray, std::vector<Branch>& waiting) const {
        if (none(pack.active) && !waiting.empty()) {
            const Branch& branch = waiting.back();
            pack.active = branch.active;
            pack.weight = branch.weight;
            pack.bounces = branch.bounces;
            pack.media = branch.media;
            ray = {branch.org, branch.dir, spawned_t_min<L>(), infinity<L>()};
            waiting.pop_back();
            if constexpr (Observer::observes) {
                observer_.tell([&](auto& o) { o.takes_up(); });
            }
        }
        return any(pack.active);
    }

    /// What a ray that starts at a place is in.
    std::uint32_t media_at(const Vec3<R>& place) {
        if (!(place == start_)) {
            start_ = place;
            around_start_ = bodies_around(place);
        }
        std::uint32_t media = Media<R>::air;
        for (const Body& body : around_start_) {
            media = media_.push(media, body.id, body.ior);
        }
        return media;
    }

    /// A transparent body that a ray from the place in question has met.
    struct Body {
        std::uint32_t id;
        R ior;
        bool by_count;      ///< of a mesh, whose normals may point to either side
        bool leaves_first;  ///< the first time the ray met it was from inside
        bool crosses_oddly; ///< the ray met it an odd number of times
    };

    /// The bodies that a place is in, from the outermost one. A ray from there leaves the inner ones first.
    /// Two opposite rays, since one may go away from the surface of a body without end; in a direction in
    /// which edges are rare.
    std::vector<Body> bodies_around(const Vec3<R>& place) const {
        const Vec3<R> dir{R(0.4837), R(0.7512), R(-0.4493)};
        const std::vector<Body> met = bodies_along(place, dir), opposite = bodies_along(place, -dir);
        const auto same = [](const std::vector<Body>& list, const Body& body) {
            return std::find_if(list.begin(), list.end(), [&](const Body& b) { return b.id == body.id; });
        };
        std::vector<Body> around;
        for (const Body& body : met) {
            const auto other = same(opposite, body);
            if (body.by_count ? body.crosses_oddly && other != opposite.end() && other->crosses_oddly
                              : body.leaves_first) {
                around.push_back(body);
            }
        }
        for (const Body& body : opposite) {
            if (!body.by_count && body.leaves_first && same(around, body) == around.end()) {
                around.push_back(body);
            }
        }
        std::reverse(around.begin(), around.end());
        return around;
    }

    /// The transparent bodies that a ray meets, in the order in which it first does.
    std::vector<Body> bodies_along(const Vec3<R>& place, const Vec3<R>& direction) const {
        std::vector<Body> bodies;
        Mask one(false);
        set_lane(one, 0, true);
        const Vec3<L> dir = lanes<L>(direction);
        Ray<L> ray{lanes<L>(place), dir, L(0), choose(one, infinity<L>(), -infinity<L>())};
        while (true) {
            Hit<L> hit;
            closest_hits<N, S, L>(scene_, {&ray, 1}, Apex::none, {&hit, 1});
            if (lane(hit.kind, 0) == no_kind) {
                return bodies;
            }
            Packs packs;
            Pack& pack = packs[0];
            pack.active = one;
            meet(ray, hit, pack);
            add_body(bodies, hit, one, lane(dot(pack.at.surface.normal, dir), 0) > 0);
            ray = {start_off(pack.at.surface, dir), dir, spawned_t_min<L>(),
                   choose(one, infinity<L>(), -infinity<L>())};
        }
    }
    void add_body(std::vector<Body>& bodies, const Hit<L>& hit, const Mask& one, bool leaves) const {
        for_each_primitive(
            scene_, hit, one,
            [&]<class Primitive>(const Primitive& primitive, const Mask&, auto, std::uint32_t id) {
                const auto known =
                    std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.id == id; });
                const Phong<R>&front = scene_.materials[primitive.tag.sides.front],
                      &back = scene_.materials[primitive.tag.sides.back];
                if (known != bodies.end()) {
                    known->crosses_oddly = !known->crosses_oddly;
                } else if (is_closed(primitive.shape) && (lets_through(front) || lets_through(back))) {
                    bodies.push_back({id, lets_through(front) ? front.ior : back.ior,
                                      is_mesh<decltype(primitive.shape)>, leaves, true});
                }
            });
    }
    template <class Shape>
    static bool is_closed(const Shape& shape) {
        if constexpr (requires { shape.caps; }) {
            return shape.caps;
        } else {
            return is_solid<Shape>;
        }
    }

    void illuminate(Packs& packs, const std::array<Ray<L>, N>& rays) const {
        for (std::size_t i = 0; i < packs.count; ++i) {
            Pack& pack = packs[i];
            if (none(pack.active)) {
                continue;
            }
            pack.light = own_light(scene_, pack.material);
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
            cosine[i] = cosine_towards(seen[i].to_light, packs[i]);
            lit[i] = lit_lanes(light, seen[i], cosine[i], lit[i]);
            if constexpr (Observer::observes) {
                observer_.tell([&](auto& o) { o.light(light, seen[i], cosine[i], lit[i]); });
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
        Rgb<L> reflected =
            reflected_light<S>(light, pack.material, pack.at.normal, dir, seen, cosine, lit, observer_);
        if constexpr (S::traits.transmission && S::traits.shadows) {
            reflected = reflected * pack.filter;
        }
        if constexpr (Observer::observes) {
            observer_.tell([&](auto& o) { o.adds_light(reflected); });
        }
        pack.light = choose(lit, pack.light + reflected, pack.light);
    }

    /// L14: feelers that start off the surfaces, for the lit lanes. They go straight through transparent
    /// surfaces.
    template <class Light>
    void take_shadowed(const Light& light, [[maybe_unused]] std::size_t index, Packs& packs,
                       std::array<Mask, N>& lit) const {
        if constexpr (S::traits.shadows) {
            if constexpr (S::traits.transmission) {
                for (Pack& pack : packs.list) {
                    pack.filter = {L(1), L(1), L(1)};
                }
            }
            if (!shadows_) {
                return;
            }
            if constexpr (S::traits.transmission) {
                if (transmits_) {
                    filter(light, index, packs, lit);
                    return;
                }
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
            if constexpr (Observer::observes) {
                observer_.tell([&](auto& o) { o.feeler(feeler(light, packs[0].at.surface), blocked[0]); });
            }
            for (std::size_t i = 0; i < packs.count; ++i) {
                lit[i] = lit[i] & !blocked[i];
            }
        }
    }
    /// Multiplies by what each surface on the way to the light lets through.
    template <class Light>
    void filter(const Light& light, [[maybe_unused]] std::size_t index, Packs& packs,
                std::array<Mask, N>& lit) const {
        std::array<Ray<L>, N> rays;
        std::array<Mask, N> open = lit;
        for (std::size_t i = 0; i < packs.count; ++i) {
            if (any(open[i])) {
                counts_.shadow += count_lanes(open[i]);
                rays[i] = feeler(light, packs.list[i].at.surface);
            }
        }
        Candidates candidates = all_candidates;
        if constexpr (!has_hierarchy<S>) {
            candidates = occluders(light, index).before(rays[0], lit[0]);
        }
        bool goes_on = true;
        while (goes_on) {
            std::array<Hit<L>, N> hits;
            for (std::size_t i = 0; i < packs.count; ++i) {
                rays[i].t_max = choose(open[i], rays[i].t_max, -infinity<L>());
            }
            closest_hits<N, S, L>(scene_, rays, apex_of(light), hits, candidates);
            goes_on = false;
            for (std::size_t i = 0; i < packs.count; ++i) {
                open[i] = open[i] & (hits[i].kind != IndexOf<L>(no_kind));
                if constexpr (Observer::observes) {
                    observer_.tell([&](auto& o) { o.feeler(rays[i], open[i]); });
                }
                if (any(open[i])) {
                    pass(light, rays[i], hits[i], open[i], packs[i].filter);
                    if constexpr (Observer::observes) {
                        observer_.tell([&](auto& o) { o.filtered(hits[i], packs[i].filter); });
                    }
                    lit[i] = lit[i] & !is_black(packs[i].filter);
                    open[i] = open[i] & lit[i];
                    goes_on = goes_on || any(open[i]);
                }
            }
        }
    }
    /// Takes feelers through the surfaces that they have met.
    template <class Light>
    void pass(const Light& light, Ray<L>& ray, const Hit<L>& hit, const Mask& open, Rgb<L>& filter) const {
        Packs packs;
        Pack& pack = packs[0];
        pack.active = open;
        meet(ray, hit, pack);
        Rgb<L> transmit;
        for_each_material<L>(scene_, pack.at.material, pack.active,
                             [&](const Phong<R>& material, const Mask& here, bool first) {
                                 put(first, here, value_at(scene_, material.transmit, pack.at.point),
                                     transmit);
                             });
        filter = choose(open, filter * transmit, filter);
        ray = feeler(light, pack.at.surface);
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
    [[no_unique_address]] mutable Observer observer_;
    bool transmits_ = false; ///< some material lets light through
    bool refracts_ = false;  ///< and has an index of refraction
    bool bumps_ = false;     ///< some material is bumped
    Media<R> media_;
    std::array<std::vector<Branch>, N> waiting_; ///< of each pack
    Vec3<R> start_{std::numeric_limits<R>::quiet_NaN(), 0, 0};
    std::vector<Body> around_start_;         ///< that it is in, from the outermost one
    std::vector<PointLight<R>> grid_points_; ///< of all rectangle lights
    /// Without a hierarchy: of point lights, spot lights and grid points.
    std::vector<Occluders<PointLight<R>>> point_occluders_;
    std::vector<Occluders<DirectionalLight<R>>> directional_occluders_;
};

} // namespace detail

} // namespace scc::runtime
