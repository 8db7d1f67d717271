#pragma once

#include "runtime/accel/bvh.h"
#include "runtime/bounds.h"
#include "runtime/math/pack.h"
#include "runtime/ray.h"

#include <cstddef>
#include <limits>
#include <span>

/// Beams: many rays that run alike, as one body for the test against boxes.
namespace scc::runtime {

/// What many rays have in common.
enum class Apex {
    none,
    origin, ///< all start at exactly the same point
    end     ///< all pass through one point at t = 1, up to rounding
};

/// The packs that are traced together.
inline constexpr int most_packs = 16;
using PackLanes = Pack<float, most_packs>;

template <class L>
constexpr MaskOf<L> is_active(const Ray<L>& ray) {
    return ray.t_max >= ray.t_min;
}

/// A coordinate axis along which all rays of a beam run, and where their depth is 0 on it.
struct BeamFrame {
    int axis = 2;
    bool forward = true; ///< towards greater coordinates
    float start = 0;     ///< of the coordinate, times -1 if not forward

    int across(int i) const { return (axis + 1 + i) % 3; }
};

/// Where rays are at a depth s >= 0: between low + low_slope s and high + high_slope s on each of the two
/// other axes, for s in [near, far]. One beam (F = float) or one in each lane.
template <class F>
struct Beam {
    F near{infinity<F>()}, far{-infinity<F>()}; ///< as initialised: no rays
    F low[2] = {infinity<F>(), infinity<F>()};
    F high[2] = {-infinity<F>(), -infinity<F>()};
    F low_slope[2] = {infinity<F>(), infinity<F>()};
    F high_slope[2] = {-infinity<F>(), -infinity<F>()};
};

namespace detail {

template <class L>
const L& component(const Vec3<L>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// where >= 0 ? a : b, for one number or as many as a has.
template <class L>
L by_sign(float where, const L& a, const L& b) {
    return where >= 0 ? a : b;
}
template <class L>
L by_sign(const L& where, const L& a, const L& b) {
    return choose(where >= 0, a, b);
}

} // namespace detail

namespace detail {

/// f(a's member, b's member) for each of two beams.
template <class A, class B, class F>
void for_each_bound(A& a, B& b, F&& f) {
    f(a.near, b.near);
    f(a.far, b.far);
    for (int i = 0; i < 2; ++i) {
        f(a.low[i], b.low[i]);
        f(a.high[i], b.high[i]);
        f(a.low_slope[i], b.low_slope[i]);
        f(a.high_slope[i], b.high_slope[i]);
    }
}

} // namespace detail

inline Beam<float> lane(const Beam<PackLanes>& beams, int i) {
    Beam<float> result;
    detail::for_each_bound(result, beams, [&](float& to, const PackLanes& from) { to = lane(from, i); });
    return result;
}
inline void set_lane(Beam<PackLanes>& beams, int i, const Beam<float>& beam) {
    detail::for_each_bound(beams, beam, [&](PackLanes& to, float from) { set_lane(to, i, from); });
}
/// The beam around two.
inline Beam<float> hull(const Beam<float>& a, const Beam<float>& b) {
    Beam<float> result{minimum(a.near, b.near), maximum(a.far, b.far)};
    for (int i = 0; i < 2; ++i) {
        result.low[i] = minimum(a.low[i], b.low[i]);
        result.high[i] = maximum(a.high[i], b.high[i]);
        result.low_slope[i] = minimum(a.low_slope[i], b.low_slope[i]);
        result.high_slope[i] = maximum(a.high_slope[i], b.high_slope[i]);
    }
    return result;
}

/// Which boxes a beam meets, or which beams a box: F or B is L, the other may be float. `near` becomes the
/// depth at which they meet at the earliest. Errs on the side of meeting, also with NaN.
template <class L, class F, class B>
MaskOf<L> meets(const BeamFrame& frame, const Beam<F>& beam, const B (&min)[3], const B (&max)[3], L& near) {
    const L first = frame.forward ? L(min[frame.axis]) : -L(max[frame.axis]);
    const L last = frame.forward ? L(max[frame.axis]) : -L(min[frame.axis]);
    near = maximum(L(beam.near), first - L(frame.start));
    const L far = minimum(L(beam.far), last - L(frame.start));
    MaskOf<L> met = near <= far;
    for (int i = 0; i < 2; ++i) {
        const L lowest =
            L(beam.low[i]) + L(beam.low_slope[i]) * detail::by_sign(beam.low_slope[i], near, far);
        const L highest =
            L(beam.high[i]) + L(beam.high_slope[i]) * detail::by_sign(beam.high_slope[i], far, near);
        met = met & !(L(max[frame.across(i)]) < lowest) & !(L(min[frame.across(i)]) > highest);
    }
    return met;
}

/// The beams of up to most_packs packs of rays, each pack's and that of all together.
template <class L>
class BeamSet {
public:
    using R = RealOf<L>;

    /// Makes the beams of those of the packs (as bits) that run along one axis as the first with an active
    /// ray does, and returns them. The boxes to be tested lie within `root`.
    unsigned gather_some(std::span<const Ray<L>> rays, unsigned packs, Apex apex, const Bounds<float>& root);
    /// Of gathered packs those that run as the first of them does, with slopes that differ by `most_spread`
    /// at most (or seen from a common origin): the rest may be called for these. None if the first pack's own
    /// rays run apart.
    unsigned join(unsigned packs, float most_spread);
    /// Whether all rays run alike.
    bool gather(std::span<const Ray<L>> rays, Apex apex, const Bounds<float>& root) {
        const unsigned packs = (1U << rays.size()) - 1;
        return gather_some(rays, packs, apex, root) == packs &&
               join(packs, rays.size() > 1 ? most_spread_of_packs : most_spread_of_pack) == packs;
    }

    const BeamFrame& frame() const { return frame_; }
    const Beam<float>& all() const { return all_; }
    /// The point that all rays have in common, if any; of an end, up to rounding.
    Vec3<R> apex_point(std::span<const Ray<L>> rays) const {
        for (const Ray<L>& ray : rays) {
            if (const Seen here = seen(ray); any(here.active)) {
                const int i = first_lane(here.active);
                return {lane(here.org.x, i), lane(here.org.y, i), lane(here.org.z, i)};
            }
        }
        return {};
    }
    /// At least every coordinate of the rays' ends and of the root box.
    float scale() const { return scale_; }
    /// The joined packs that still have rays to trace and whose beams meet the box of the node's child.
    unsigned packs_in(const BvhNode& node, std::uint32_t slot) const {
        const float min[3] = {node.min[0][slot], node.min[1][slot], node.min[2][slot]};
        const float max[3] = {node.max[0][slot], node.max[1][slot], node.max[2][slot]};
        PackLanes near;
        return bits(meets(frame_, each_, min, max, near));
    }
    /// After t_max of a pack's rays was lowered.
    void shorten(int pack, const Ray<L>& ray) {
        set_lane(each_.far, pack, far_of(seen(ray)));
        all_.far = largest(each_.far);
    }

private:
    /// Steeper or more spread rays are traced in smaller parts. Those from one point fill their beam, so that
    /// little in it is tested in vain; for others, in meshes, these are the best of a few that were tried.
    static constexpr float steepest = 4, most_spread_of_view = 0.6F, most_spread_of_packs = 0.05F,
                           most_spread_of_pack = 0.04F;

    /// A ray, or its reverse from the common end.
    struct Seen {
        Vec3<L> org, dir;
        L t_max;
        MaskOf<L> active;
    };
    Seen seen(const Ray<L>& ray) const {
        if (apex_ == Apex::end) {
            return {ray.org + ray.dir, -ray.dir, 1 - ray.t_min, is_active(ray)};
        }
        return {ray.org, ray.dir, ray.t_max, is_active(ray)};
    }
    L depth(const Vec3<L>& v) const {
        const L& x = detail::component(v, frame_.axis);
        return frame_.forward ? x : -x;
    }
    float far_of(const Seen& ray) const {
        const L end = depth(ray.org) + ray.t_max * depth(ray.dir);
        return static_cast<float>(largest(choose(ray.active, end, -infinity<L>()))) - frame_.start + pad_;
    }
    bool choose_frame(std::span<const Ray<L>> rays, unsigned packs);
    bool add(int pack, const Seen& ray);

    Apex apex_ = Apex::none;
    BeamFrame frame_;
    float scale_ = 0, pad_ = 0;
    Beam<float> all_;
    Beam<PackLanes> each_;
    PackLanes ends_; ///< each_.far as gathered
};

template <class L>
unsigned BeamSet<L>::gather_some(std::span<const Ray<L>> rays, unsigned packs, Apex apex,
                                 const Bounds<float>& root) {
    apex_ = apex;
    each_ = {};
    if (!choose_frame(rays, packs)) {
        return 0;
    }
    L size(0), start = infinity<L>();
    unsigned usable = 0;
    for (unsigned left = packs; left != 0; left &= left - 1) {
        const Ray<L>& ray = rays[static_cast<std::size_t>(__builtin_ctz(left))];
        const Seen here = seen(ray);
        if (any(here.active & !(depth(here.dir) > 0))) {
            continue;
        }
        usable |= left & -left;
        const Vec3<L> ends = maximum(absolute(here.org), absolute(ray.org)); // which differ for a common end
        size = maximum(size, choose(here.active, largest_component(ends), L(0)));
        start = minimum(start, choose(here.active, depth(here.org), infinity<L>()));
    }
    scale_ = static_cast<float>(largest(size)) +
             largest_component(maximum(absolute(root.min), absolute(root.max)));
    if (!(scale_ < 1e30F)) {
        return 0;
    }
    frame_.start = static_cast<float>(smallest(start));
    // What the intercepts, the slopes and the test itself lose, and twice what SlabRay adds: 128 roundings.
    pad_ = 64 * std::numeric_limits<float>::epsilon() * scale_;
    for (unsigned left = usable; left != 0; left &= left - 1) {
        const int pack = __builtin_ctz(left);
        if (!add(pack, seen(rays[static_cast<std::size_t>(pack)]))) {
            usable &= ~(left & -left);
        }
    }
    ends_ = each_.far;
    return usable;
}

template <class L>
unsigned BeamSet<L>::join(unsigned packs, float most_spread) {
    const float most = apex_ == Apex::origin ? most_spread_of_view : most_spread;
    const auto is_narrow = [&](const Beam<float>& beam) {
        return beam.high_slope[0] - beam.low_slope[0] <= most &&
               beam.high_slope[1] - beam.low_slope[1] <= most;
    };
    all_ = {};
    unsigned joined = 0;
    for (unsigned left = packs; left != 0; left &= left - 1) {
        const unsigned one = left & -left;
        const Beam<float> both = hull(all_, lane(each_, __builtin_ctz(left)));
        if (is_narrow(both)) {
            all_ = both;
            joined |= one;
        } else if (joined == 0) {
            return 0;
        }
    }
    for (int pack = 0; pack < most_packs; ++pack) {
        set_lane(each_.far, pack, (joined >> pack & 1U) != 0 ? lane(ends_, pack) : -infinity<float>());
    }
    all_.far = largest(each_.far);
    return joined;
}

/// Takes the axis along which some ray of the beam runs most.
template <class L>
bool BeamSet<L>::choose_frame(std::span<const Ray<L>> rays, unsigned packs) {
    for (unsigned left = packs; left != 0; left &= left - 1) {
        const Seen here = seen(rays[static_cast<std::size_t>(__builtin_ctz(left))]);
        if (none(here.active)) {
            continue;
        }
        const int i = first_lane(here.active);
        const Vec3<R> dir{lane(here.dir.x, i), lane(here.dir.y, i), lane(here.dir.z, i)};
        const Vec3<R> size = absolute(dir);
        frame_.axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        frame_.forward = detail::component(dir, frame_.axis) > 0;
        return true;
    }
    return false;
}

/// Whether the pack's slopes stay moderate; only then is it added.
template <class L>
bool BeamSet<L>::add(int pack, const Seen& ray) {
    if (none(ray.active)) {
        return true;
    }
    const L inverse = 1 / depth(ray.dir);
    const auto low = [&](const L& x) {
        return static_cast<float>(smallest(choose(ray.active, x, infinity<L>())));
    };
    const auto high = [&](const L& x) {
        return static_cast<float>(largest(choose(ray.active, x, -infinity<L>())));
    };
    const bool from_apex = apex_ == Apex::origin; // then all start at depth 0
    const L gone = from_apex ? L(0) : depth(ray.org) - L(static_cast<R>(frame_.start));
    Beam<float> beam;
    beam.near = (from_apex ? 0 : low(gone)) - pad_;
    beam.far = far_of(ray);
    for (int i = 0; i < 2; ++i) {
        const L slope = detail::component(ray.dir, frame_.across(i)) * inverse;
        beam.low_slope[i] = low(slope);
        beam.high_slope[i] = high(slope);
        if (!(beam.low_slope[i] >= -steepest && beam.high_slope[i] <= steepest)) {
            return false;
        }
        const L& org = detail::component(ray.org, frame_.across(i));
        const L from = org - slope * gone;
        const float start = from_apex ? static_cast<float>(lane(org, 0)) : 0;
        beam.low[i] = (from_apex ? start : low(from)) - pad_;
        beam.high[i] = (from_apex ? start : high(from)) + pad_;
    }
    set_lane(each_, pack, beam);
    return true;
}

/// Calls leaf(packs, box, first, count) for the leaves that some packs of the beam may meet, near ones first,
/// until it returns true; it may lower t_max of rays and tell `beams`.
template <class L, class Prefetch, class Leaf>
void traverse_beams(const BvhNode* nodes, const BeamSet<L>& beams, Prefetch&& prefetch, Leaf&& leaf) {
    using C = Pack<float, bvh_width>;
    traverse<float>(
        nodes,
        [&](const BvhNode& node, float(&near)[bvh_width]) {
            const C min[3] = {load_lanes<C>(node.min[0]), load_lanes<C>(node.min[1]),
                              load_lanes<C>(node.min[2])};
            const C max[3] = {load_lanes<C>(node.max[0]), load_lanes<C>(node.max[1]),
                              load_lanes<C>(node.max[2])};
            C begin;
            const unsigned met = bits(meets(beams.frame(), beams.all(), min, max, begin));
            store_lanes(near, begin);
            return met;
        },
        [&](float near) { return near <= beams.all().far; }, prefetch,
        [&](const BvhNode& node, std::uint32_t slot, const BvhLeaf& found) {
            const unsigned packs = beams.packs_in(node, slot);
            return packs != 0 && leaf(packs, box_of(node, slot), found.first, found.count);
        });
}

} // namespace scc::runtime
