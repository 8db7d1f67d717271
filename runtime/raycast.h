#pragma once

#include "runtime/primitive.h"

#include <utility>

/// Closest and any hit of a ray in a scene (L11, L14).
namespace scc::runtime {

inline constexpr std::uint32_t no_kind = ~0U;

template <class L>
struct Hit {
    ShapeHit<L> shape;
    IndexOf<L> kind{no_kind};
    IndexOf<L> index{0U}; ///< in the table of its kind
    IndexOf<L> id{~0U};   ///< Tag::id
};

namespace detail {

/// Constant tables up to this size are unrolled, so that their numbers become constants of the code.
inline constexpr std::size_t unrolled_primitives = 12;

template <class Table>
inline constexpr std::size_t constant_size = 0;
template <class T, std::size_t n>
inline constexpr std::size_t constant_size<std::array<T, n>> = n;

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

/// f.operator()<kind>() for each kind that the scene can contain, until it returns true; whether it did.
template <class S, class F>
bool any_of_kinds(F&& f) {
    const auto one = [&]<std::uint32_t kind>(std::integral_constant<std::uint32_t, kind>) {
        if constexpr (uses_kind(S::traits, kind)) {
            return f.template operator()<kind>();
        } else {
            return false;
        }
    };
    return [&]<std::uint32_t... kind>(std::integer_sequence<std::uint32_t, kind...>) {
        return (one(std::integral_constant<std::uint32_t, kind>{}) || ...);
    }
    (std::make_integer_sequence<std::uint32_t, primitive_kinds>{});
}

/// The search of rays through a scene. Of hits at equal distance the smaller Tag::id counts, so the order of
/// the tests does not matter.
template <bool AnyHit, class S, class L>
class Search {
public:
    using R = typename S::Real;

    Search(const S& scene, const Ray<L>& ray) : scene_(scene), ray_(ray) {}

    void run() {
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

    const Hit<L>& hit() const { return hit_; }
    const MaskOf<L>& blocked() const { return blocked_; }

private:
    template <std::uint32_t kind>
    bool test_table() {
        const auto& table = scene_.primitives(Of<PrimitiveOfKind<R, kind>>{});
        return any_of_table(
            table, [&](const auto& primitive, std::uint32_t index) { return test<kind>(primitive, index); });
    }

    /// Whether the search is over.
    template <std::uint32_t kind>
    bool test(const PrimitiveOfKind<R, kind>& primitive, [[maybe_unused]] std::uint32_t index) {
        const ShapeHit<L> found = intersect<AnyHit>(scene_, primitive, ray_);
        if constexpr (AnyHit) {
            const MaskOf<L> met = found.t < infinity<L>();
            blocked_ = blocked_ | met;
            ray_.t_max = choose(met, -infinity<L>(), ray_.t_max);
            return none(ray_.t_max >= ray_.t_min);
        } else {
            using Index = IndexOf<L>;
            const Index id(primitive.tag.id);
            const MaskOf<L> nearer = (found.t < ray_.t_max) |
                                     ((found.t == ray_.t_max) & (found.t < infinity<L>()) & (id < hit_.id));
            if (any(nearer)) {
                ray_.t_max = choose(nearer, found.t, ray_.t_max);
                hit_.shape.t = choose(nearer, found.t, hit_.shape.t);
                hit_.shape.part = choose(nearer, found.part, hit_.shape.part);
                hit_.kind = choose(nearer, Index(kind), hit_.kind);
                hit_.index = choose(nearer, Index(index), hit_.index);
                hit_.id = choose(nearer, id, hit_.id);
            }
            return false;
        }
    }

    void test_hierarchy() {
        const Accelerator& accelerator = scene_.accelerator;
        const SlabRay<L> slabs(ray_, bounds_of<R>(accelerator.nodes[0]));
        traverse(accelerator.nodes.data(), slabs, ray_.t_min, ray_.t_max,
                 [&](std::uint32_t first, std::uint32_t count) {
                     for (std::uint32_t i = first; i < first + count; ++i) {
                         if (test_reference(accelerator.primitives[i])) {
                             return true;
                         }
                     }
                     return false;
                 });
    }

    bool test_reference(const PrimitiveRef& ref) {
        return any_of_kinds<S>([&]<std::uint32_t kind>() {
            if constexpr (is_bounded<ShapeOfKind<R, kind>>) {
                return kind == ref.kind &&
                       test<kind>(scene_.primitives(Of<PrimitiveOfKind<R, kind>>{})[ref.index], ref.index);
            } else {
                return false;
            }
        });
    }

    const S& scene_;
    Ray<L> ray_;
    Hit<L> hit_;
    MaskOf<L> blocked_{false};
};

} // namespace detail

/// The nearest hit in each ray's range; of several at that distance the one with the smallest Tag::id. A lane
/// with t_max < t_min takes no part.
template <SceneModel S, class L>
Hit<L> closest_hit(const S& scene, const Ray<L>& ray) {
    detail::Search<false, S, L> search(scene, ray);
    search.run();
    return search.hit();
}

/// Whether anything is in each ray's range.
template <SceneModel S, class L>
MaskOf<L> any_hit(const S& scene, const Ray<L>& ray) {
    detail::Search<true, S, L> search(scene, ray);
    search.run();
    return search.blocked();
}

/// f(primitive, lanes) for each primitive that one of the lanes in `among` has hit, with those lanes.
template <SceneModel S, class L, class F>
void for_each_primitive(const S& scene, const Hit<L>& hit, MaskOf<L> among, F&& f) {
    using Index = IndexOf<L>;
    while (any(among)) {
        const int first = first_lane(among);
        const std::uint32_t hit_kind = lane(hit.kind, first), index = lane(hit.index, first);
        const MaskOf<L> same = among & (hit.kind == Index(hit_kind)) & (hit.index == Index(index));
        detail::any_of_kinds<S>([&]<std::uint32_t kind>() {
            if (kind != hit_kind) {
                return false;
            }
            f(scene.primitives(Of<PrimitiveOfKind<typename S::Real, kind>>{})[index], same);
            return true;
        });
        among = among & !same;
    }
}

} // namespace scc::runtime
