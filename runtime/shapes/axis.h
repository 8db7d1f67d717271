#pragma once

#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/uv.h"

/// What shapes that are round about an axis between two points share.
namespace scc::runtime {

/// A ray relative to the axis.
template <class L>
struct AxisFrame {
    Vec3<L> axis; ///< unit
    L height;
    L org_along, dir_along;
    Vec3<L> org_across, dir_across;

    template <class R>
    constexpr AxisFrame(const Vec3<R>& from, const Vec3<R>& to, const Ray<L>& ray) {
        const Vec3<R> whole = to - from;
        const R h = length(whole);
        axis = lanes<L>(whole * (1 / h));
        height = L(h);
        const Vec3<L> org = ray.org - lanes<L>(from);
        org_along = dot(org, axis);
        dir_along = dot(ray.dir, axis);
        org_across = org - axis * org_along;
        dir_across = ray.dir - axis * dir_along;
    }

    /// t, or infinity where the point there is not between the ends or not in the ray's range.
    constexpr L between_ends(const Ray<L>& ray, const L& t, const MaskOf<L>& usable) const {
        const L along = org_along + t * dir_along;
        const MaskOf<L> inside = usable & (along >= 0) & (along <= height) & (t >= ray.t_min);
        return choose(inside & (t <= ray.t_max), t, infinity<L>());
    }
};

/// The side's stretch and the ray's stretch between the caps: their common part is inside the solid, so there
/// is no seam at the rim for a ray to slip through. Part 0 is the side, 1 the cap at `from`, 2 that at `to`.
template <class L>
struct CappedStretch {
    Stretch<L> side, inside;
    L t_from;

    constexpr CappedStretch(const AxisFrame<L>& f, const Stretch<L>& round) : side(round) {
        const L inf = infinity<L>();
        const L inverse = 1 / f.dir_along;
        const L t_to = (f.height - f.org_along) * inverse;
        t_from = -f.org_along * inverse;
        const MaskOf<L> across_axis = absolute(inverse) == inf;
        const L between = choose((f.org_along >= 0) & (f.org_along <= f.height), inf, -inf);
        const L caps_near = choose(across_axis, -between, minimum(t_from, t_to));
        const L caps_far = choose(across_axis, between, maximum(t_from, t_to));
        inside = {maximum(side.near, caps_near), minimum(side.far, caps_far)};
    }

    constexpr ShapeHit<L> first(const Ray<L>& ray) const {
        const MaskOf<L> crossed = inside.near <= inside.far;
        const L t = choose(crossed, first_in_range(ray, inside.near, inside.far), infinity<L>());
        const MaskOf<L> on_side = t == choose(t == inside.near, side.near, side.far);
        using Index = IndexOf<L>;
        return {t, choose(on_side, Index(0), choose(t == t_from, Index(1), Index(2)))};
    }
};

/// How far a disc about a point of the axis extends from there, along each coordinate axis.
template <class R>
constexpr Vec3<R> disc_reach(const Vec3<R>& axis, R radius) {
    const auto reach = [&](R cosine) { return radius * square_root(maximum(R(0), 1 - cosine * cosine)); };
    return {reach(axis.x), reach(axis.y), reach(axis.z)};
}

/// Of a point on the side (part 0): the way around the axis and along it from 0 to 1, as around() sees the
/// axis y; on a cap (parts 1 and 2): 0 to 1 over the square around it.
template <class R, class Index, class T>
constexpr Vec2<T> uv_about_axis(const Vec3<R>& from, const Vec3<R>& to, R radius_from, R radius_to,
                                const Index& part, const Vec3<T>& point) {
    const Vec3<R> axis = to - from;
    const R height = length(axis);
    const Vec3<R> up = axis * (1 / height);
    const PlanarAxes<R> axes = planar_axes(up);
    const Vec3<T> d = point - lanes<T>(from);
    const Vec2<T> side{around(dot(d, lanes<T>(axes.u)), -dot(d, lanes<T>(axes.v))),
                       dot(d, lanes<T>(up)) * T(1 / height)};
    const Vec2<T> at_from = on_square(d, -up, T(radius_from));
    const Vec2<T> at_to = on_square(point - lanes<T>(to), up, T(radius_to));
    const auto of_part = [&](const T& on_side, const T& on_from, const T& on_to) {
        return choose(part == Index(0), on_side, choose(part == Index(1), on_from, on_to));
    };
    return {of_part(side.x, at_from.x, at_to.x), of_part(side.y, at_from.y, at_to.y)};
}

} // namespace scc::runtime
