#pragma once

#include "runtime/primitive.h"

#include <utility>

/// Closest and any hit of a ray in a scene (L11, L14).
namespace scc::runtime {

inline constexpr std::uint32_t no_kind = ~0U;

template <class R>
struct Hit {
    ShapeHit<R> shape;
    std::uint32_t kind = no_kind;
    std::uint32_t index = 0; ///< in the table of its kind
    std::uint32_t id = ~0U;  ///< Tag::id

    explicit operator bool() const { return kind != no_kind; }
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
        }(std::make_integer_sequence<std::uint32_t, static_cast<std::uint32_t>(size)>{});
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
    }(std::make_integer_sequence<std::uint32_t, primitive_kinds>{});
}

/// One ray's search. Of hits at equal distance the smaller Tag::id counts, so the order of the tests does not matter.
template <bool AnyHit, class S>
class Search {
public:
    using R = typename S::Real;

    Search(const S& scene, const Ray<R>& ray) : scene_(scene), ray_(ray) {}

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

    const Hit<R>& hit() const { return hit_; }

private:
    template <std::uint32_t kind>
    bool test_table() {
        const auto& table = scene_.primitives(Of<PrimitiveOfKind<R, kind>>{});
        return any_of_table(table, [&](const auto& primitive, std::uint32_t index) {
            return test<kind>(primitive, index);
        });
    }

    template <std::uint32_t kind>
    bool test(const PrimitiveOfKind<R, kind>& primitive, std::uint32_t index) {
        const ShapeHit<R> found = intersect<AnyHit>(scene_, primitive, ray_);
        if constexpr (AnyHit) {
            if (found.t < infinity<R>()) {
                hit_.kind = kind;
                return true;
            }
        } else if (found.t < ray_.t_max ||
                   (found.t == ray_.t_max && found.t < infinity<R>() && primitive.tag.id < hit_.id)) {
            hit_ = {found, kind, index, primitive.tag.id};
            ray_.t_max = found.t;
        }
        return false;
    }

    void test_hierarchy() {
        const Accelerator& accelerator = scene_.accelerator;
        const SlabRay<R> slabs(ray_, bounds_of<R>(accelerator.nodes[0]));
        traverse(accelerator.nodes.data(), slabs, ray_.t_min, ray_.t_max,
                 [&](std::uint32_t first, std::uint32_t count) {
                     for (std::uint32_t i = first; i < first + count; ++i) {
                         const PrimitiveRef ref = accelerator.primitives[i];
                         const bool done = any_of_kinds<S>([&]<std::uint32_t kind>() {
                             if constexpr (is_bounded<ShapeOfKind<R, kind>>) {
                                 return kind == ref.kind &&
                                        test<kind>(scene_.primitives(Of<PrimitiveOfKind<R, kind>>{})[ref.index],
                                                   ref.index);
                             } else {
                                 return false;
                             }
                         });
                         if (done) {
                             return true;
                         }
                     }
                     return false;
                 });
    }

    const S& scene_;
    Ray<R> ray_;
    Hit<R> hit_;
};

} // namespace detail

/// The nearest hit in the ray's range; of several at that distance the one with the smallest Tag::id.
template <SceneModel S>
Hit<typename S::Real> closest_hit(const S& scene, const Ray<typename S::Real>& ray) {
    detail::Search<false, S> search(scene, ray);
    search.run();
    return search.hit();
}

/// Whether anything is in the ray's range.
template <SceneModel S>
bool any_hit(const S& scene, const Ray<typename S::Real>& ray) {
    detail::Search<true, S> search(scene, ray);
    search.run();
    return static_cast<bool>(search.hit());
}

/// f(primitive) for the primitive that was hit.
template <SceneModel S, class F>
void with_primitive(const S& scene, const Hit<typename S::Real>& hit, F&& f) {
    detail::any_of_kinds<S>([&]<std::uint32_t kind>() {
        if (kind != hit.kind) {
            return false;
        }
        f(scene.primitives(Of<PrimitiveOfKind<typename S::Real, kind>>{})[hit.index]);
        return true;
    });
}

} // namespace scc::runtime
