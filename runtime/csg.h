#pragma once

#include "runtime/hit.h"
#include "runtime/primitive.h"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Where rays meet solids that are made of others by union, intersection and difference.
///
/// Along a ray a convex member is a stretch of t, and others are several, which are searched for one end
/// after the other. So the ray is swept from one end of a stretch to the next, all lanes of a pack at once:
/// at each of these events the members that begin or end there change between inside and outside, and where
/// that changes the value of the tree, the ray meets the solid.
///
/// Events of members whose surfaces are no farther apart than their error bounds are one event, so that faces
/// in one plane leave no film of single pixels between them: a difference of solids with a face in common has
/// no surface there. A ray that starts within the bound of a member's surface has passed it.
namespace scc::runtime {

namespace detail {

/// A member that some ray of the pack meets.
template <class L>
struct CsgLeaf {
    PrimitiveRef member;
    MaskOf<L> inside;            ///< at the place that the sweep has come to
    MaskOf<L> changed;           ///< by the last event
    L next;                      ///< t of the next change, or infinity
    L exit;                      ///< of a convex one: t at the end of the stretch
    L event;                     ///< t of the last change
    IndexOf<L> part, event_part; ///< of others: the surface's at `next` and at `event`
};

/// Of the tree of those members, operands before operators.
struct CsgStep {
    CsgOp op;
    std::uint32_t operands;
};

template <class L>
struct CsgValue {
    MaskOf<L> inside;
};

/// One per thread and kind of pack: it grows to what the largest solid needs.
template <class L>
struct CsgWorkspace {
    std::vector<CsgLeaf<L>> leaves;
    std::vector<CsgStep> steps;
    std::vector<CsgValue<L>> values;

    static CsgWorkspace& of_this_thread() {
        thread_local CsgWorkspace workspace;
        return workspace;
    }
};

template <class L>
constexpr MaskOf<L> differ(const MaskOf<L>& a, const MaskOf<L>& b) {
    return MaskOf<L>(!(a == b));
}

template <bool AnyHit, class S, class L>
class CsgSearch {
public:
    using R = typename S::Real;
    using Mask = MaskOf<L>;
    using Leaf = CsgLeaf<L>;

    CsgSearch(const S& scene, const Ray<L>& ray)
        : scene_(scene), ray_(ray), workspace_(CsgWorkspace<L>::of_this_thread()) {
        workspace_.leaves.clear();
        workspace_.steps.clear();
    }

    Hit<L> run(std::uint32_t root) {
        Hit<L> hit;
        if (!gather(root)) {
            return hit;
        }
        Mask searching = is_active(ray_);
        pass_start(searching);
        Mask inside = evaluate(now);
        while (true) {
            L next = infinity<L>();
            for (const Leaf& leaf : workspace_.leaves) {
                next = minimum(next, leaf.next);
            }
            searching = searching & (next <= ray_.t_max) & (next < infinity<L>());
            if (none(searching)) {
                return hit;
            }
            mark_event(next, searching);
            for (Leaf& leaf : workspace_.leaves) {
                change(leaf);
            }
            const Mask after = evaluate(now);
            const Mask met = searching & differ<L>(inside, after);
            if (any(met)) {
                report(met, inside, after, hit);
                searching = searching & !met;
            }
            inside = after;
        }
    }

private:
    /// What evaluate takes for a leaf's value.
    static Mask now(const Leaf& leaf) { return leaf.inside; }
    static Mask before(const Leaf& leaf) { return differ<L>(leaf.inside, leaf.changed); }

    /// Adds what the pack's rays meet of a subtree; whether they meet any of it. What they miss is outside
    /// of all that follows from it, and looked at no more.
    bool gather(std::uint32_t at) {
        const CsgNode& node = scene_.csg_nodes[at];
        if (node.op == CsgOp::member) {
            return gather_leaf(node.member);
        }
        const std::size_t leaves = workspace_.leaves.size(), steps = workspace_.steps.size();
        std::uint32_t operands = 0;
        for (std::uint32_t child = at + 1; child < at + node.size; child += scene_.csg_nodes[child].size) {
            if (gather(child)) {
                ++operands;
            } else if (node.op == CsgOp::intersect || (node.op == CsgOp::subtract && operands == 0)) {
                workspace_.leaves.resize(leaves);
                workspace_.steps.resize(steps);
                return false;
            }
        }
        if (operands > 1) {
            workspace_.steps.push_back({node.op, operands});
        }
        return operands > 0;
    }

    bool gather_leaf(const PrimitiveRef& ref) {
        const L inf = infinity<L>();
        Leaf leaf{ref, Mask(false), Mask(false), inf, inf, inf, {}, {}};
        visit_member(scene_, ref, [&](const auto& member) { start(leaf, member.primitive); });
        if (none(leaf.inside | (leaf.next <= ray_.t_max))) {
            return false;
        }
        workspace_.leaves.push_back(leaf);
        workspace_.steps.push_back({CsgOp::member, 0});
        return true;
    }

    template <class Primitive>
    void start(Leaf& leaf, const Primitive& primitive) const {
        if constexpr (is_convex<decltype(primitive.shape)>) {
            const L inf = infinity<L>();
            const Stretch<L> stretch = primitive.shape.stretch(to_object(primitive, ray_));
            const Mask met =
                (stretch.near <= stretch.far) & (stretch.near <= ray_.t_max) & (stretch.far >= ray_.t_min);
            const Mask begun = stretch.near <= ray_.t_min, ended = stretch.far <= ray_.t_min;
            leaf.inside = met & begun & !ended;
            leaf.next = choose(met, choose(begun, choose(ended, inf, stretch.far), stretch.near), inf);
            leaf.exit = stretch.far;
        } else {
            cross(leaf, primitive, ray_.t_min, is_active(ray_));
        }
    }

    /// The next change of a member that is not convex, from t on: beyond the ray's range too, since what a
    /// ray will leave it is in.
    template <class Primitive>
    void cross(Leaf& leaf, const Primitive& primitive, const L& t, const Mask& among) const {
        Ray<L> ray = to_object(primitive, ray_);
        ray.t_min = t;
        ray.t_max = choose(among, infinity<L>(), -infinity<L>());
        const Crossing<L> next = cross_shape(scene_, primitive.shape, ray);
        leaf.inside = Mask((among & next.outwards) | ((!among) & leaf.inside));
        leaf.next = choose(among, next.hit.t, leaf.next);
        leaf.part = choose(among, next.hit.part, leaf.part);
    }

    /// The tree's value where `value(leaf)` is the leaves'.
    template <class Value>
    Mask evaluate(const Value& value) {
        std::vector<CsgValue<L>>& values = workspace_.values;
        values.clear();
        const Leaf* leaf = workspace_.leaves.data();
        for (const CsgStep& step : workspace_.steps) {
            if (step.op == CsgOp::member) {
                values.push_back({value(*leaf++)});
                continue;
            }
            const std::size_t first = values.size() - step.operands;
            Mask result = values[first].inside;
            for (std::size_t i = first + 1; i < values.size(); ++i) {
                const Mask& operand = values[i].inside;
                result = step.op == CsgOp::unite       ? result | operand
                         : step.op == CsgOp::intersect ? result & operand
                                                       : result & !operand;
            }
            values.resize(first);
            values.push_back({result});
        }
        return values.back().inside;
    }

    /// Surfaces farther apart than this, in t, are not looked at for being one: at angles of more than about
    /// a hundredth between ray and surface, none is that has error bounds of a few hundred roundings.
    L screen(const L& t) const {
        const L away = largest_component(absolute(ray_.org)) / largest_component(absolute(ray_.dir));
        return (1 << 14) * roundoff<L>() * (away + absolute(t));
    }

    /// The error bound is that of the distance along the ray, too: of a far origin much is lost.
    Surface<L> surface_at(const Leaf& leaf, const L& t, const Mask& needed) const {
        Surface<L> surface;
        const Vec3<L> magnitude = absolute(ray_.org) + absolute(t) * absolute(ray_.dir);
        visit_member(scene_, leaf.member, [&](const auto& member) {
            const ShapeHit<L> hit = hit_at(member.primitive, t, leaf.part, needed);
            Vec3<L> object_point;
            surface = surface_of(scene_, member.primitive, ray_, hit, needed, object_point);
            surface.error = surface.error + rounding_of(member.primitive, magnitude);
        });
        return surface;
    }
    /// What is lost of a point on the ray that is no larger than `magnitude`: as for transform_surface.
    template <class Shape>
    static Vec3<L> rounding_of(const Bare<Shape>&, const Vec3<L>& magnitude) {
        return magnitude * (8 * roundoff<L>());
    }
    template <class Shape>
    static Vec3<L> rounding_of(const Placed<Shape, R>& primitive, const Vec3<L>& magnitude) {
        const Vec3<L> in_object = transform_magnitude(primitive.object_from_world, magnitude) +
                                  absolute(lanes<L>(translation_of(primitive.object_from_world)));
        return (transform_magnitude(primitive.world_from_object, in_object) + magnitude) *
               (8 * roundoff<L>());
    }
    /// The hit at the end of a stretch; a convex member's own test finds the part.
    template <class Primitive>
    ShapeHit<L> hit_at(const Primitive& primitive, const L& t, [[maybe_unused]] const IndexOf<L>& part,
                       [[maybe_unused]] const Mask& needed) const {
        if constexpr (is_convex<decltype(primitive.shape)>) {
            Ray<L> ray = to_object(primitive, ray_);
            ray.t_min = t;
            ray.t_max = choose(needed, t, -infinity<L>());
            return {t, primitive.shape.intersect(ray).part};
        } else {
            return {t, part};
        }
    }

    /// Lanes of a leaf whose next change is at a surface within its own bound, and `error`, of the place `t`.
    Mask is_within_error(const Leaf& leaf, const L& t, const Vec3<L>& error, const Mask& among) const {
        const Surface<L> surface = surface_at(leaf, leaf.next, among);
        const L apart = (leaf.next - t) * absolute(dot(ray_.dir, surface.normal));
        return among & (apart <= dot(absolute(surface.normal), error + surface.error));
    }

    void pass_start(const Mask& searching) {
        const L limit = ray_.t_min + screen(ray_.t_min);
        for (Leaf& leaf : workspace_.leaves) {
            const Mask close = searching & (leaf.next <= limit);
            if (any(close)) {
                leaf.changed = is_within_error(leaf, ray_.t_min, {}, close);
                change(leaf);
            }
        }
    }

    /// Which leaves change at `next`, or so little beyond that it is the same event.
    void mark_event(const L& next, const Mask& searching) {
        const L limit = next + screen(next);
        Mask close(false);
        for (Leaf& leaf : workspace_.leaves) {
            leaf.changed = searching & (leaf.next == next);
            close = close | (searching & (leaf.next > next) & (leaf.next <= limit));
        }
        if (any(close)) {
            mark_close(next, limit, close);
        }
    }
    void mark_close(const L& next, const L& limit, const Mask& close) {
        Vec3<L> error{L(0), L(0), L(0)};
        for (const Leaf& leaf : workspace_.leaves) {
            const Mask here = close & leaf.changed;
            if (any(here)) {
                error = choose(here, maximum(error, surface_at(leaf, next, here).error), error);
            }
        }
        for (Leaf& leaf : workspace_.leaves) {
            const Mask here = close & (leaf.next > next) & (leaf.next <= limit);
            if (any(here)) {
                leaf.changed = leaf.changed | is_within_error(leaf, next, error, here);
            }
        }
    }

    void change(Leaf& leaf) const {
        leaf.event = choose(leaf.changed, leaf.next, leaf.event);
        leaf.event_part = choose(leaf.changed, leaf.part, leaf.event_part);
        if (any(leaf.changed)) {
            visit_member(scene_, leaf.member, [&](const auto& member) { pass(leaf, member.primitive); });
        }
    }
    template <class Primitive>
    void pass(Leaf& leaf, const Primitive& primitive) const {
        if constexpr (is_convex<decltype(primitive.shape)>) {
            const Mask leaves_it = leaf.changed & leaf.inside;
            leaf.next = choose(leaf.changed, choose(leaves_it, infinity<L>(), leaf.exit), leaf.next);
            leaf.inside = differ<L>(leaf.inside, leaf.changed);
        } else {
            // Behind the event by more than rounding, so that the sweep gets on.
            const L away = largest_component(absolute(ray_.org)) / largest_component(absolute(ray_.dir));
            const L behind = leaf.event + 8 * roundoff<L>() * (away + absolute(leaf.event));
            cross(leaf, primitive, behind, leaf.changed);
        }
    }

    /// Of several leaves that change together, the first in source order counts that alone would have done
    /// or without which the others would not.
    void report(const Mask& met, const Mask& was, const Mask& is, Hit<L>& hit) {
        Mask one(false), several(false);
        for (const Leaf& leaf : workspace_.leaves) {
            several = several | (one & leaf.changed);
            one = one | leaf.changed;
        }
        Mask open = met;
        for (const Leaf& leaf : workspace_.leaves) {
            Mask here = open & leaf.changed;
            if (any(here & several)) {
                here = here & ((!several) | explains(leaf, was, is));
            }
            take(leaf, here, hit);
            open = open & !here;
        }
        for (const Leaf& leaf : workspace_.leaves) {
            const Mask here = open & leaf.changed;
            take(leaf, here, hit);
            open = open & !here;
        }
    }
    Mask explains(const Leaf& one, const Mask& was, const Mask& is) {
        const Mask alone =
            evaluate([&](const Leaf& leaf) { return &leaf == &one ? now(leaf) : before(leaf); });
        const Mask others =
            evaluate([&](const Leaf& leaf) { return &leaf == &one ? before(leaf) : now(leaf); });
        return differ<L>(alone, was) | differ<L>(others, is);
    }

    void take(const Leaf& leaf, const Mask& here, Hit<L>& hit) const {
        if (none(here)) {
            return;
        }
        hit.shape.t = choose(here, leaf.event, hit.shape.t);
        if constexpr (!AnyHit) {
            using Index = IndexOf<L>;
            visit_member(scene_, leaf.member, [&](const auto& member) {
                const ShapeHit<L> found = hit_at(member.primitive, leaf.event, leaf.event_part, here);
                hit.shape.part = choose(here, found.part, hit.shape.part);
                hit.id = choose(here, Index(member.primitive.tag.id), hit.id);
            });
            hit.kind = choose(here, Index(member_kinds + leaf.member.kind), hit.kind);
            hit.index = choose(here, Index(leaf.member.index), hit.index);
        }
    }

    const S& scene_;
    const Ray<L>& ray_;
    CsgWorkspace<L>& workspace_;
};

} // namespace detail

/// Where the rays first meet the solid in their ranges; with AnyHit the distances only. A call of its own,
/// since the tests around it want the registers.
template <bool AnyHit, class S, class L>
[[gnu::noinline]] Hit<L> intersect_solid(const S& scene, std::uint32_t root, const Ray<L>& ray) {
    return detail::CsgSearch<AnyHit, S, L>(scene, ray).run(root);
}

} // namespace scc::runtime
