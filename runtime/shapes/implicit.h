#pragma once

#include "runtime/bounds.h"
#include "runtime/math/dual.h"
#include "runtime/ray.h"
#include "runtime/shapes/container.h"

#include <cstdint>
#include <string_view>

namespace scc::runtime {

/// The solid of the points in a container where a field is negative (L12). Its surface is where the field
/// changes sign, whether continuously or by a jump, and the container's own surface where the field is
/// negative there. Normals point to larger values. Not described by fields: the scene knows the function.
template <class R>
struct Implicit {
    static constexpr std::string_view name = "implicit";

    std::int32_t field = 0; ///< index of the scene's field_function
    Container<R> within{};

    constexpr Bounds<R> bounds() const { return within.bounds(); }

    /// As POV-Ray has it for what has no coordinates of its own.
    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>&, const Vec3<T>& point) const {
        return {point.x, point.y};
    }
};

/// Of the rays since the thread began: those for which it remained open somewhere, within rounding, whether
/// there is a surface, and which show what is behind; and those that ended where the field jumps, where there
/// is no normal.
struct FieldCounts {
    std::uint64_t undecided = 0;
    std::uint64_t at_jumps = 0;
};
inline thread_local FieldCounts field_counts;

/// The part of an implicit surface that is no part of its container.
inline constexpr std::uint32_t field_part = 6;

namespace detail {

/// A field on the lines of rays. Field: T operator()(const Vec3<T>&), where T is a lane type or an interval
/// or a dual number over it.
template <class L, class Field>
class FieldAlongRay {
public:
    FieldAlongRay(const Field& field, const Ray<L>& ray) : field_(field), ray_(ray) {}

    Interval<L> at(const L& t) const {
        return field_(point<Interval<L>>(Interval<L>(t), [](const Interval<L>& x, const L&) { return x; }));
    }
    /// With the derivative by t.
    Dual<Interval<L>, 1> over(const Interval<L>& t) const {
        using D = Dual<Interval<L>, 1>;
        return field_(point<D>(t, [](const Interval<L>& x, const L& slope) {
            D result(x);
            result.d[0] = Interval<L>(slope);
            return result;
        }));
    }
    /// In the lanes' own rounding.
    Dual<L, 1> value_at(const L& t) const {
        using D = Dual<L, 1>;
        return field_(point<D>(t, [](const L& x, const L& slope) {
            D result(x);
            result.d[0] = slope;
            return result;
        }));
    }

private:
    template <class T, class Number, class Make>
    Vec3<T> point(const Number& t, Make&& make) const {
        const auto coordinate = [&](const L& org, const L& dir) {
            return make(t * Number(dir) + Number(org), dir);
        };
        return {coordinate(ray_.org.x, ray_.dir.x), coordinate(ray_.org.y, ray_.dir.y),
                coordinate(ray_.org.z, ray_.dir.z)};
    }

    const Field& field_;
    const Ray<L>& ray_;
};

/// What the search knows of each ray: that the field has `sign` at t = front and no change of sign before.
/// Where the field's bounds at the front include 0, the ray is in a stretch that cannot be decided, since
/// `stretch`.
template <class L>
struct FieldSearch {
    MaskOf<L> searching, found{false}, undecided{false};
    L front, sign;
    Interval<L> value; ///< at the front
    L step;
    L stretch;
    L from{0}, to{0}; ///< around the change of sign that was found

    MaskOf<L> is_open() const { return !((value.min > 0) | (value.max < 0)); }
};

/// Bounds of the field times the sign.
template <class L>
Interval<L> facing(const L& sign, const Interval<L>& x) {
    return choose_lanes(sign < 0, -x, x);
}

/// A lower bound of a function on a stretch of this length, of which lower bounds at both ends and bounds of
/// the derivative are known; it counts where the derivative's have different signs.
template <class L>
L bound_between(const L& at_begin, const L& at_end, const Interval<L>& slope, const L& length) {
    const L where = (at_end - at_begin - slope.max * length) / (slope.min - slope.max);
    const L descent = slope.min * where;
    return (at_begin + descent) - (absolute(at_begin) + absolute(at_end) + absolute(descent)) *
                                      L(16 * std::numeric_limits<RealOf<L>>::epsilon());
}

/// One step for every ray. In the stretch before it the field has no zero where that follows from its bounds,
/// or from those at both ends and of the derivative; it has one where the sign changes, and just one where
/// the derivative has one sign (Mitchell, "Robust Ray Intersection with Interval Arithmetic", 1990). Else the
/// step is halved, down to the `finest` that t can resolve.
template <class L, class Field>
void advance(FieldSearch<L>& s, const FieldAlongRay<L, Field>& field, const L& end, const L& finest) {
    const L next = minimum(s.front + s.step, end);
    const Dual<Interval<L>, 1> over = field.over({s.front, next});
    const Interval<L> at_next = intersection(field.at(next), over.v);
    const Interval<L> all = facing(s.sign, over.v), slope = facing(s.sign, over.d[0]);
    const Interval<L> first = facing(s.sign, s.value), last = facing(s.sign, at_next);

    const MaskOf<L> open = s.is_open(), at_limit = s.step <= finest, unknown = s.sign == 0;
    const MaskOf<L> stays = last.min > 0, changes = last.max < 0;
    const MaskOf<L> monotone = (slope.min >= 0) | (slope.max <= 0);
    const MaskOf<L> clear =
        (!open) & ((all.min > 0) |
                   (stays & (monotone | (bound_between(first.min, last.min, slope, next - s.front) > 0))));
    const MaskOf<L> crossed = s.searching & !clear & !unknown & changes & (open | monotone | at_limit);
    s.from = choose(crossed, choose(open, s.stretch, s.front), s.from);
    s.to = choose(crossed, next, s.to);
    s.found = s.found | crossed;
    s.searching = s.searching & !crossed;

    // Beyond what can be resolved, there may have been two changes of sign.
    const MaskOf<L> skipped = (!clear) & (open | at_limit);
    s.undecided = s.undecided | (s.searching & skipped & !unknown);
    const MaskOf<L> moves = clear | skipped;
    s.stretch = choose(open, s.stretch, s.front);
    const L reach = first.min / -slope.min; // no zero before, if the derivative falls that fast
    const L shorter = maximum(s.step * L(RealOf<L>(0.5)),
                              choose((slope.min < 0) & !open,
                                     minimum(reach * L(RealOf<L>(0.99)), s.step * L(RealOf<L>(0.9))), L(0)));
    const L guess = choose(slope.min < 0, last.min / -slope.min, L(0));
    const L longer = minimum(maximum(s.step * 2, choose(clear, guess, L(0))), maximum(end - next, finest));
    s.step = choose(moves, longer, maximum(shorter, finest));
    s.sign = choose(s.searching & unknown,
                    choose(at_next.min > 0, L(1), choose(at_next.max < 0, L(-1), L(0))), s.sign);
    s.front = choose(moves, next, s.front);
    s.value = choose_lanes(moves, at_next, s.value);
}

/// The zero between from and to, to the last digits: Newton's steps, or halving where they lead outside, as
/// they do to the end at a jump.
template <class L, class Field>
L polished(const FieldSearch<L>& s, const FieldAlongRay<L, Field>& field, const L& finest) {
    constexpr int most_halvings = 64;
    MaskOf<L> at_jump(false);
    L low = s.from, high = s.to;
    L t = (low + high) * L(RealOf<L>(0.5));
    MaskOf<L> active = s.found;
    for (int i = 0; i < most_halvings && any(active); ++i) {
        const Dual<L, 1> value = field.value_at(t);
        const MaskOf<L> inside = value.v < 0, before = inside == (s.sign < 0);
        low = choose(active & before, t, low);
        high = choose(active & !before, t, high);
        const L newton = t - value.v / value.d[0];
        const L next = choose((newton >= low) & (newton <= high), newton, (low + high) * L(RealOf<L>(0.5)));
        const L change = absolute(next - t);
        at_jump = (active & !(absolute(newton - t) <= finest * 1000)) | (at_jump & !active);
        t = choose(active, next, t);
        active = active & (change > absolute(t) * L(std::numeric_limits<RealOf<L>>::epsilon()));
    }
    field_counts.at_jumps += count_lanes(MaskOf<L>(at_jump & s.found));
    return t;
}

/// The smallest t that a coordinate of the ray's points can show.
template <class L>
L finest_step(const Ray<L>& ray, const L& from, const L& to) {
    const L origin = largest_component(absolute(ray.org)) / largest_component(absolute(ray.dir));
    return (maximum(absolute(from), absolute(to)) + origin) *
           L(8 * std::numeric_limits<RealOf<L>>::epsilon());
}

} // namespace detail

/// The first point of the solid's surface in each ray's range. Which one it is does not depend on t_max;
/// called again with t_min behind a hit it gives the next. What the ray's start lies on, within rounding, is
/// no hit.
template <class L, class R, class Field>
Crossing<L> cross_implicit(const Implicit<R>& shape, const Ray<L>& ray, const Field& field) {
    constexpr int most_steps = 5000;
    using Index = IndexOf<L>;
    const Passage<L> inside = passage(shape.within, ray);
    const L start = maximum(inside.near.t, ray.t_min);
    const MaskOf<L> entering = inside.near.t >= ray.t_min;
    detail::FieldSearch<L> s;
    s.searching = (inside.near.t < infinity<L>()) & (inside.far.t > start) & (start <= ray.t_max);
    if (none(s.searching)) {
        return {{}, MaskOf<L>(false)};
    }
    const L end = choose(s.searching, inside.far.t, L(1)), begin = choose(s.searching, start, L(0));
    const detail::FieldAlongRay<L, Field> along(field, ray);
    const L finest = detail::finest_step(ray, begin, end);
    s.front = s.stretch = begin;
    s.value = along.at(begin);
    const MaskOf<L> outside = s.value.min > 0, within = s.value.max < 0;
    // A ray that enters the container comes from outside the solid.
    const MaskOf<L> capped = s.searching & entering & within;
    s.searching = s.searching & !capped;
    s.sign = choose(entering | outside, L(1), choose(within, L(-1), L(0)));
    s.step = choose(s.is_open(), finest, end - begin);

    for (int i = 0; i < most_steps && any(s.searching); ++i) {
        detail::advance(s, along, end, finest);
        // A zero may lie anywhere in an open stretch.
        const L nearest = choose(s.is_open(), s.stretch, s.front);
        s.searching = s.searching & (s.front < end) & (nearest <= ray.t_max);
    }
    s.undecided = s.undecided | s.searching;
    const MaskOf<L> leaving = (s.sign < 0) & (s.front >= end) & !(s.searching | s.found | capped);
    ShapeHit<L> hit;
    hit.t = choose(capped, inside.near.t, choose(leaving, inside.far.t, infinity<L>()));
    hit.part = choose(capped, inside.near.part, inside.far.part);
    if (any(s.found)) {
        const L t = detail::polished(s, along, finest);
        hit.t = choose(s.found, maximum(t, ray.t_min), hit.t);
        hit.part = choose(s.found, Index(field_part), hit.part);
    }
    // A change of sign that was found settles the stretch that it is in.
    const MaskOf<L> settled = s.found & (s.from >= s.stretch);
    field_counts.undecided +=
        count_lanes(MaskOf<L>(s.undecided & !settled & (inside.near.t < infinity<L>())));
    hit.t = choose(hit.t <= ray.t_max, hit.t, infinity<L>());
    return {hit, MaskOf<L>((leaving | (s.found & (s.sign < 0))) & (hit.t < infinity<L>()))};
}

template <class L, class R, class Field>
ShapeHit<L> intersect_implicit(const Implicit<R>& shape, const Ray<L>& ray, const Field& field) {
    return cross_implicit(shape, ray, field).hit;
}

/// The bound of the error is how far the field can be from 0 around the point, divided by its gradient: a ray
/// that starts off the surface by twice that starts where the field's sign is certain.
template <class L, class R, class Field>
Surface<L> implicit_surface(const Implicit<R>& shape, const Ray<L>& ray, const ShapeHit<L>& hit,
                            const Field& field) {
    using D = Dual<L, 3>;
    const MaskOf<L> on_field = hit.part == IndexOf<L>(field_part);
    Surface<L> result =
        shape.within.visit([&](const auto& container) { return container.surface(ray, hit); });
    if (none(on_field)) {
        return result;
    }
    const L u = roundoff<L>();
    const Vec3<L> way = hit.t * ray.dir;
    const Vec3<L> point = ray.org + way;
    const Vec3<L> rounding = (absolute(ray.org) + absolute(way) + absolute(point)) * (2 * u);
    const D value = field(Vec3<D>{D::variable(point.x, 0), D::variable(point.y, 1), D::variable(point.z, 2)});
    const Vec3<L> gradient{value.d[0], value.d[1], value.d[2]};
    const L scale = largest_component(absolute(gradient)); // squares of steep gradients overflow
    const Vec3<L> direction = gradient * (1 / scale);
    const L size = length(direction);
    const MaskOf<L> usable = (size >= 1) & (size < 2);
    // Where there is no gradient, as at a tip or where the field jumps, the surface faces the ray.
    const Vec3<L> normal = choose(usable, direction * (1 / size), normalize(-ray.dir));
    const auto around = [](const L& x, const L& e) { return Interval<L>(x - e, x + e); };
    const Interval<L> bounds = field(Vec3<Interval<L>>{
        around(point.x, rounding.x), around(point.y, rounding.y), around(point.z, rounding.z)});
    const L off = maximum(absolute(bounds.min), absolute(bounds.max)) / (scale * size);
    const Bounds<R> box = shape.bounds();
    const L most = L(length(box.max - box.min) * R(0.001));
    const Vec3<L> error =
        rounding + absolute(normal) * choose(usable & (off < most), off, choose(usable, most, L(0)));
    return {choose(on_field, point, result.point), choose(on_field, error, result.error),
            choose(on_field, normal, result.normal), choose(on_field, normal, result.shading_normal)};
}

} // namespace scc::runtime
