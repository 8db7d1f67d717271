#pragma once

#include "runtime/accel/beam.h"
#include "runtime/accel/view.h"
#include "runtime/csg.h"
#include "runtime/hit.h"
#include "runtime/primitive.h"

#include <array>
#include <span>
#include <type_traits>
#include <utility>

/// Closest and any hit of a ray in a scene (L11, L14).
namespace scc::runtime {

namespace detail {

/// Constant tables up to this size are unrolled, so that their numbers become constants of the code.
inline constexpr std::size_t unrolled_primitives = 12;

template <class Table>
inline constexpr std::size_t constant_size = 0;
template <class T, std::size_t n>
inline constexpr std::size_t constant_size<std::array<T, n>> = n;

/// So few shapes are tested against a pack whose rays run apart rather than looked up for each ray.
inline constexpr std::size_t most_without_order = 32;

/// f(element, index) for each until it returns true; whether it did.
template <class Table, class F>
bool any_of_table(const Table& table, F&& f) {
    constexpr std::size_t size = constant_size<Table>;
    if constexpr (size > 0 && size <= unrolled_primitives) {
        return [&]<std::uint32_t... i>(std::integer_sequence<std::uint32_t, i...>) {
            return (f(table[i], i) || ...);
        }
        (std::make_integer_sequence<std::uint32_t, static_cast<std::uint32_t>(size)>{});
    } else {
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            if (f(table[i], i)) {
                return true;
            }
        }
        return false;
    }
}

/// The same for the candidates in a table of bounded primitives, whose bits it takes.
template <class Table, class F>
bool any_candidate(const Table& table, Candidates& left, F&& f) {
    const auto size = static_cast<std::uint32_t>(table.size());
    if (size > 30) {
        for (std::uint32_t i = 0; i < size; ++i) {
            if (next_is_candidate(left) && f(table[i], i)) {
                return true;
            }
        }
        return false;
    }
    unsigned here = static_cast<unsigned>(left) & ((1U << size) - 1);
    left >>= size;
    for (; here != 0; here &= here - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(here));
        if (f(table[i], i)) {
            return true;
        }
    }
    return false;
}

template <class S, std::uint32_t... kind>
constexpr bool uses_mesh_among(std::integer_sequence<std::uint32_t, kind...>) {
    return ((uses_kind(S::traits, kind) && is_mesh<ShapeOfKind<typename S::Real, kind>>) || ...);
}
template <class S, std::uint32_t... kind>
constexpr bool uses_implicit_among(std::integer_sequence<std::uint32_t, kind...>) {
    return (((uses_kind(S::traits, kind) || uses_member_kind(S::traits, kind)) &&
             is_implicit<ShapeOfKind<typename S::Real, kind>>) ||
            ...);
}
template <class S>
inline constexpr bool
    uses_implicit = uses_implicit_among<S>(std::make_integer_sequence<std::uint32_t, primitive_kinds>{});
template <class S>
inline constexpr bool
    uses_mesh = uses_mesh_among<S>(std::make_integer_sequence<std::uint32_t, primitive_kinds>{});

/// f.operator()<kind>() for each kind that the scene can contain, until it returns true; whether it did.
template <class S, class F>
bool any_of_kinds(F&& f) {
    return any_of_kinds_where([]<std::uint32_t kind>() { return uses_kind(S::traits, kind); }, f);
}

/// The same for the kinds whose surfaces a ray can meet: members of solids are met instead of the solids.
template <class S, class F>
bool any_of_surface_kinds(F&& f) {
    return any_of_kinds_where(
        []<std::uint32_t kind>() {
            return !is_csg<ShapeOfKind<typename S::Real, kind>> &&
                   (uses_kind(S::traits, kind) || has_members<S, kind>);
        },
        f);
}

/// Keeps a found hit if it is the nearest so far; whether it was in any lane.
template <class L>
bool keep_nearest(Ray<L>& ray, Hit<L>& hit, const Hit<L>& found) {
    const L& t = found.shape.t;
    const MaskOf<L> nearer = (t < ray.t_max) | ((t == ray.t_max) & (t < infinity<L>()) & (found.id < hit.id));
    if (none(nearer)) {
        return false;
    }
    ray.t_max = choose(nearer, t, ray.t_max);
    hit.shape.t = choose(nearer, t, hit.shape.t);
    hit.shape.part = choose(nearer, found.shape.part, hit.shape.part);
    hit.kind = choose(nearer, found.kind, hit.kind);
    hit.index = choose(nearer, found.index, hit.index);
    hit.id = choose(nearer, found.id, hit.id);
    return true;
}
template <class L>
bool keep_blocked(Ray<L>& ray, MaskOf<L>& blocked, const ShapeHit<L>& found) {
    const MaskOf<L> met = found.t < infinity<L>();
    if (none(met)) {
        return false;
    }
    blocked = blocked | met;
    ray.t_max = choose(met, -infinity<L>(), ray.t_max);
    return true;
}

template <class L>
Hit<L> hit_of(const ShapeHit<L>& found, std::uint32_t kind, std::uint32_t index, std::uint32_t id) {
    using Index = IndexOf<L>;
    return {found, Index(kind), Index(index), Index(id)};
}

/// Where the rays meet a primitive other than a mesh: a ShapeHit for any hit, else a Hit.
template <bool AnyHit, std::uint32_t kind, class S, class L>
auto find_hit(const S& scene, const PrimitiveOfKind<typename S::Real, kind>& primitive,
              [[maybe_unused]] std::uint32_t index, const Ray<L>& ray) {
    if constexpr (is_csg<ShapeOfKind<typename S::Real, kind>>) {
        const Hit<L> found = intersect_solid<AnyHit>(scene, primitive.shape.root, ray);
        if constexpr (AnyHit) {
            return found.shape;
        } else {
            return found;
        }
    } else {
        const ShapeHit<L> found = intersect_shape(scene, primitive.shape, to_object(primitive, ray));
        if constexpr (AnyHit) {
            return found;
        } else {
            return hit_of(found, kind, index, primitive.tag.id);
        }
    }
}

/// The search of one pack through a scene without hierarchies: by value, so that what is known stays in
/// registers. Where all primitives are candidates, their tests are unrolled.
template <bool AnyHit, bool All, class S, class L>
auto search_tables(const S& scene, Ray<L> ray, [[maybe_unused]] Candidates candidates) {
    std::conditional_t<AnyHit, MaskOf<L>, Hit<L>> result{};
    any_of_kinds<S>([&]<std::uint32_t kind>() {
        const auto& table = scene.primitives(Of<PrimitiveOfKind<typename S::Real, kind>>{});
        const auto test = [&](const auto& primitive, [[maybe_unused]] std::uint32_t index) {
            const auto found = find_hit<AnyHit, kind>(scene, primitive, index, ray);
            if constexpr (AnyHit) {
                return keep_blocked(ray, result, found) && none(is_active(ray));
            } else {
                keep_nearest(ray, result, found);
                return false;
            }
        };
        if constexpr (!All && is_bounded<ShapeOfKind<typename S::Real, kind>>) {
            return any_candidate(table, candidates, test);
        } else {
            return any_of_table(table, test);
        }
    });
    return result;
}

/// The search of up to N packs of rays through a scene. Of hits at equal distance the smaller Tag::id counts,
/// so the order of the tests does not matter. What was found so far is in the results and in the rays' t_max.
template <bool AnyHit, class S, class L, int N>
class Search {
public:
    using R = typename S::Real;
    using Result = std::conditional_t<AnyHit, MaskOf<L>, Hit<L>>;

    Search(const S& scene, std::span<Ray<L>> rays, Apex apex, std::span<Result> results,
           Candidates candidates = all_candidates)
        : scene_(scene), rays_(rays), apex_(apex), results_(results), candidates_(candidates) {
        if constexpr (N > 1) {
            live_ = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                live_ |= (any(is_active(rays[i])) ? 1U : 0U) << i;
            }
        }
    }

    void run() {
        if (live_ == 0) {
            return;
        }
        if constexpr (S::traits.accelerator) {
            if (!scene_.accelerator.nodes.empty()) {
                const bool done = any_of_kinds<S>([&]<std::uint32_t kind>() {
                    if constexpr (is_bounded<ShapeOfKind<R, kind>>) {
                        return false;
                    } else {
                        return test_table<kind>();
                    }
                });
                if (!done) {
                    test_hierarchy();
                }
                return;
            }
        }
        any_of_kinds<S>([&]<std::uint32_t kind>() { return test_table<kind>(); });
    }

    void test_hierarchy() {
        const Accelerator& accelerator = scene_.accelerator;
        if constexpr (lane_count<L> == 1) {
            const Bounds<R> root{lanes<R>(accelerator.box.min), lanes<R>(accelerator.box.max)};
            RaysInTurns<R, 1> search;
            search.add(0, SlabRay<R>(rays_[0], root), rays_[0].t_min, is_active(rays_[0]));
            search.run(accelerator.nodes.data(), &rays_[0].t_max,
                       [&](std::size_t, std::uint32_t first, std::uint32_t count) {
                           return test_leaf(first, count, 1);
                       });
        } else {
            // Rays with a common end fill their beam better than others.
            const float most_spread = (apex_ == Apex::end ? 2 : 1) * accelerator.most_spread;
            BeamSet<L> beams;
            unsigned apart = 0;
            for (unsigned left = live_; left != 0;) {
                unsigned gathered = beams.gather_some(rays_, left, apex_, accelerator.box);
                apart |= left & -left & ~gathered;
                left &= ~(gathered | apart);
                while (gathered != 0) {
                    const unsigned joined = beams.join(gathered, most_spread);
                    if (joined != 0) {
                        test_beams(beams);
                        gathered &= ~joined;
                    } else {
                        apart |= gathered & -gathered;
                        gathered &= gathered - 1;
                    }
                }
            }
            test_rays_of(apart);
        }
    }

private:
    /// Packs whose rays run alike.
    void test_beams(BeamSet<L>& beams) {
        beams_ = &beams;
        traverse_beams(
            scene_.accelerator.nodes.data(), beams, [](const BvhLeaf&) {},
            [&](unsigned packs, const Bounds<float>&, std::uint32_t first, std::uint32_t count) {
                return test_leaf(first, count, packs);
            });
        beams_ = nullptr;
    }
    /// Packs whose rays run apart.
    void test_rays_of(unsigned packs) {
        if (const std::size_t count = scene_.accelerator.primitives.size(); count <= most_without_order) {
            if (packs != 0) {
                test_leaf(0, static_cast<std::uint32_t>(count), packs);
            }
            return;
        }
        while (packs != 0) {
            test_in_turns(packs);
        }
    }
    /// The rays of as many packs as may take turns, which are then left out of `packs`.
    void test_in_turns(unsigned& packs) {
        constexpr int lanes_each = lane_count<L>, most = std::min(64 / lanes_each, N);
        const Accelerator& accelerator = scene_.accelerator;
        const Bounds<R> root{lanes<R>(accelerator.box.min), lanes<R>(accelerator.box.max)};
        RaysInTurns<R, most * lanes_each> search;
        std::array<Alone, most * lanes_each> alone;
        R nearest[most * lanes_each] = {};
        std::size_t count = 0;
        for (; packs != 0 && count + lanes_each <= alone.size(); packs &= packs - 1) {
            const auto pack = static_cast<std::size_t>(__builtin_ctz(packs));
            const Ray<L>& ray = rays_[pack];
            search.add(count, SlabRay<L>(ray, root), ray.t_min, is_active(ray));
            for (int i = 0; i < lanes_each; ++i, ++count) {
                alone[count] = {pack, i, lane(ray, i), {}};
                nearest[count] = alone[count].ray.t_max;
                if constexpr (!AnyHit) {
                    alone[count].result = lane(results_[pack], i);
                }
            }
        }
        search.run(accelerator.nodes.data(), nearest,
                   [&](std::size_t i, std::uint32_t first, std::uint32_t in_leaf) {
                       Ray<R>& ray = alone[i].ray;
                       const bool done =
                           Search<AnyHit, S, R, 1>(scene_, {&ray, 1}, Apex::none, {&alone[i].result, 1})
                               .test_leaf(first, in_leaf, 1);
                       nearest[i] = ray.t_max;
                       return done;
                   });
        for (std::size_t i = 0; i < count; ++i) {
            put_back(alone[i]);
        }
    }
    /// One lane's ray by itself.
    struct Alone {
        std::size_t pack = 0;
        int lane = 0;
        Ray<R> ray;
        std::conditional_t<AnyHit, bool, Hit<R>> result{};
    };
    void put_back(const Alone& one) {
        set_lane(rays_[one.pack].t_max, one.lane, one.ray.t_max);
        if constexpr (AnyHit) {
            if (!one.result) {
                return; // it may have been true before
            }
        }
        set_lane(results_[one.pack], one.lane, one.result);
    }

    template <std::uint32_t kind>
    bool test_table() {
        const auto& table = scene_.primitives(Of<PrimitiveOfKind<R, kind>>{});
        const auto test_one = [&](const auto& primitive, std::uint32_t index) {
            return test<kind>(primitive, index, live_);
        };
        if constexpr (is_bounded<ShapeOfKind<R, kind>>) {
            return any_candidate(table, candidates_, test_one);
        } else {
            return any_of_table(table, test_one);
        }
    }

    bool test_leaf(std::uint32_t first, std::uint32_t count, unsigned packs) {
        for (std::uint32_t i = first; i < first + count; ++i) {
            if (test_reference(scene_.accelerator.primitives[i], packs)) {
                return true;
            }
        }
        return false;
    }
    bool test_reference(const PrimitiveRef& ref, unsigned packs) {
        return any_of_kinds<S>([&]<std::uint32_t kind>() {
            if constexpr (is_bounded<ShapeOfKind<R, kind>>) {
                return kind == ref.kind &&
                       test<kind>(scene_.primitives(Of<PrimitiveOfKind<R, kind>>{})[ref.index], ref.index,
                                  packs);
            } else {
                return false;
            }
        });
    }

    /// Whether the search is over.
    template <std::uint32_t kind>
    bool test(const PrimitiveOfKind<R, kind>& primitive, std::uint32_t index, unsigned packs) {
        if constexpr (is_mesh<ShapeOfKind<R, kind>>) {
            test_mesh<kind>(primitive, index, packs);
        } else if constexpr (N == 1) {
            keep(0, find_hit<AnyHit, kind>(scene_, primitive, index, rays_[0]));
        } else {
            for (packs &= live_; packs != 0; packs &= packs - 1) {
                const auto i = static_cast<std::size_t>(__builtin_ctz(packs));
                keep(i, find_hit<AnyHit, kind>(scene_, primitive, index, rays_[i]));
            }
        }
        if constexpr (!AnyHit) {
            return false;
        } else if constexpr (N == 1) {
            return none(is_active(rays_[0]));
        } else {
            return live_ == 0;
        }
    }

    /// A mesh has a hierarchy of its own, for all packs together.
    template <std::uint32_t kind>
    void test_mesh(const PrimitiveOfKind<R, kind>& primitive, std::uint32_t index, unsigned packs) {
        std::array<Ray<L>, N> rays;
        std::array<ShapeHit<L>, N> found;
        std::array<std::size_t, N> from{};
        std::size_t count = 0;
        for (packs &= live_; packs != 0; packs &= packs - 1) {
            from[count] = static_cast<std::size_t>(__builtin_ctz(packs));
            rays[count] = to_object(primitive, rays_[from[count]]);
            found[count++] = {};
        }
        intersect_mesh<AnyHit, L>(scene_.meshes[primitive.shape.mesh], {rays.data(), count}, apex_,
                                  {found.data(), count});
        for (std::size_t i = 0; i < count; ++i) {
            if constexpr (AnyHit) {
                keep(from[i], found[i]);
            } else {
                keep(from[i], hit_of(found[i], kind, index, primitive.tag.id));
            }
        }
    }

    void keep(std::size_t pack, const std::conditional_t<AnyHit, ShapeHit<L>, Hit<L>>& found) {
        Ray<L>& ray = rays_[pack];
        bool kept = false;
        if constexpr (AnyHit) {
            kept = keep_blocked(ray, results_[pack], found);
            if constexpr (N > 1) {
                live_ &= ~((kept && none(is_active(ray)) ? 1U : 0U) << pack);
            }
        } else {
            kept = keep_nearest(ray, results_[pack], found);
        }
        if (!kept) {
            return;
        }
        if constexpr (lane_count<L> != 1) {
            if (beams_ != nullptr) {
                beams_->shorten(static_cast<int>(pack), ray);
            }
        }
    }

    template <bool, class, class, int>
    friend class Search;

    const S& scene_;
    std::span<Ray<L>> rays_;
    Apex apex_;
    std::span<Result> results_;
    Candidates candidates_;
    unsigned live_ = 1; ///< the packs with active rays, as bits
    BeamSet<L>* beams_ = nullptr;
};

} // namespace detail

/// Whether the rays of a scene go through a hierarchy, where many packs together cost less than each alone.
template <class S>
inline constexpr bool has_hierarchy = S::traits.accelerator || detail::uses_mesh<S>;

/// The packs of one pixel block.
template <class S, class L>
inline constexpr int packs_together = has_hierarchy<S>&& lane_count<L> != 1 ? most_packs : 1;

/// The nearest hit in each ray's range; of several at that distance the one with the smallest Tag::id. A lane
/// with t_max < t_min takes no part. At most N packs; hits[i] must be as initialised, and the rays' t_max may
/// become the hits' distances. The rays meet no bounded primitives but the candidates.
template <int N, SceneModel S, class L>
void closest_hits(const S& scene, std::span<Ray<L>> rays, [[maybe_unused]] Apex apex, std::span<Hit<L>> hits,
                  Candidates candidates = all_candidates) {
    if constexpr (has_hierarchy<S>) {
        detail::Search<false, S, L, N>(scene, rays, apex, hits, candidates).run();
    } else {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            hits[i] = candidates == all_candidates
                          ? detail::search_tables<false, true>(scene, rays[i], candidates)
                          : detail::search_tables<false, false>(scene, rays[i], candidates);
        }
    }
}
template <SceneModel S, class L>
Hit<L> closest_hit(const S& scene, Ray<L> ray) {
    Hit<L> hit;
    closest_hits<1, S, L>(scene, {&ray, 1}, Apex::none, {&hit, 1});
    return hit;
}

/// Whether anything is in each ray's range. At most N packs; blocked[i] must be false, and the rays' t_max
/// may become anything.
template <int N, SceneModel S, class L>
void any_hits(const S& scene, std::span<Ray<L>> rays, [[maybe_unused]] Apex apex,
              std::span<MaskOf<L>> blocked) {
    if constexpr (has_hierarchy<S>) {
        detail::Search<true, S, L, N>(scene, rays, apex, blocked).run();
    } else {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            blocked[i] = detail::search_tables<true, true>(scene, rays[i], all_candidates);
        }
    }
}
/// The same for one pack in a scene without hierarchies, which meets no bounded primitives but the
/// candidates.
template <SceneModel S, class L>
requires(!has_hierarchy<S>) MaskOf<L> any_hit(const S& scene, const Ray<L>& ray, Candidates candidates) {
    return detail::search_tables<true, false>(scene, ray, candidates);
}
template <SceneModel S, class L>
MaskOf<L> any_hit(const S& scene, Ray<L> ray) {
    MaskOf<L> blocked(false);
    any_hits<1, S, L>(scene, {&ray, 1}, Apex::none, {&blocked, 1});
    return blocked;
}

/// f(primitive, lanes, inverted, body) for each primitive that one of the lanes in `among` has hit, with
/// those lanes. `inverted`: the primitive's outside is the inside of the solid that it is a member of.
/// `body`: Tag::id of that solid, else the primitive's own.
template <SceneModel S, class L, class F>
void for_each_primitive(const S& scene, const Hit<L>& hit, MaskOf<L> among, F&& f) {
    using Index = IndexOf<L>;
    using R = typename S::Real;
    while (any(among)) {
        const int first = first_lane(among);
        const std::uint32_t hit_kind = lane(hit.kind, first), index = lane(hit.index, first);
        const MaskOf<L> same = among & (hit.kind == Index(hit_kind)) & (hit.index == Index(index));
        const auto visit = [&]<std::uint32_t kind>() {
            using Primitive = PrimitiveOfKind<R, kind>;
            if constexpr (uses_csg(S::traits)) {
                // Only one call each, since much is inlined into it.
                if (kind == hit_kind % member_kinds) {
                    const bool is_member = hit_kind >= member_kinds;
                    const Member<Primitive>* member =
                        is_member ? &scene.members(Of<Primitive>{})[index] : nullptr;
                    const Primitive& primitive =
                        is_member ? member->primitive : scene.primitives(Of<Primitive>{})[index];
                    f(primitive, same, is_member && member->inverted,
                      is_member ? member->solid : primitive.tag.id);
                    return true;
                }
            } else if (kind == hit_kind) {
                const Primitive& primitive = scene.primitives(Of<Primitive>{})[index];
                f(primitive, same, std::false_type{}, primitive.tag.id);
                return true;
            }
            return false;
        };
        detail::any_of_surface_kinds<S>(visit);
        among = among & !same;
    }
}

} // namespace scc::runtime
