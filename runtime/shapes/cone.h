#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/axis.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// A round tube whose radius changes evenly from one end to the other, closed by discs where `caps`; radius 0
/// is a sharp tip. The front end makes sure that from != to and that one radius is greater than 0.
template <class R>
struct Cone {
    static constexpr std::string_view name = "cone";

    Vec3<R> from{0, 0, 0};
    Vec3<R> to{0, 1, 0};
    R radius_from = 1;
    R radius_to = 0;
    bool caps = true;

    static constexpr auto fields() {
        return std::tuple{field("from", &Cone::from, Rule::any, "centre of one end"),
                          field("to", &Cone::to, Rule::any, "centre of the other end"),
                          field("radius_from", &Cone::radius_from, Rule::non_negative, "radius at `from`"),
                          field("radius_to", &Cone::radius_to, Rule::non_negative, "radius at `to`"),
                          field("caps", &Cone::caps, Rule::any, "whether discs close the ends")};
    }

    constexpr Bounds<R> bounds() const {
        const Vec3<R> axis = normalize(to - from);
        const R magnitude = largest_component(maximum(absolute(from), absolute(to)));
        const R size = length(to - from) + maximum(radius_from, radius_to);
        const R slack = 32 * roundoff<R>() * (magnitude + size);
        const Vec3<R> at_from = disc_reach(axis, radius_from), at_to = disc_reach(axis, radius_to);
        const Vec3<R> around{slack, slack, slack};
        return {minimum(from - at_from, to - at_to) - around, maximum(from + at_from, to + at_to) + around};
    }

    /// Part 0 is the side, 1 the cap at `from`, 2 the cap at `to`.
    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const AxisFrame<L> f(from, to, ray);
        const SideRoots<L> side(f, L(radius_from), widening(f));
        if (caps) {
            return CappedStretch<L>(f, side.inside()).first(ray);
        }
        return {minimum(f.between_ends(ray, side.near_root, side.real & side.near_counts),
                        f.between_ends(ray, side.far_root, side.real & side.far_counts)),
                {}};
    }

    /// Of the ray's line within, if there are caps.
    template <class L>
    constexpr Stretch<L> stretch(const Ray<L>& ray) const {
        const AxisFrame<L> f(from, to, ray);
        return CappedStretch<L>(f, SideRoots<L>(f, L(radius_from), widening(f)).inside()).inside;
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const L u = roundoff<L>();
        const AxisFrame<L> f(from, to, ray);
        const L k = widening(f);
        const MaskOf<L> on_side = hit.part == IndexOf<L>(0);
        const MaskOf<L> at_from = hit.part == IndexOf<L>(1);
        const L height = choose(on_side, f.org_along + hit.t * f.dir_along, choose(at_from, L(0), f.height));
        // Made perpendicular once more, as the cylinder's; near a tip what is left would tilt the normal, too.
        const Vec3<L> nearly_across = f.org_across + hit.t * f.dir_across;
        const Vec3<L> across = nearly_across - f.axis * dot(nearly_across, f.axis);
        const L distance = length(across);
        // At the very tip there is no radial direction, and the normal is the axis.
        const Vec3<L> radial = across * choose(distance > 0, 1 / distance, L(0));
        const Vec3<L> side_normal = normalize(radial - f.axis * k);
        const Vec3<L> normal = choose(on_side, side_normal, choose(at_from, -f.axis, f.axis));
        const Vec3<L> from_axis = choose(on_side, radial * (L(radius_from) + k * height), across);
        const Vec3<L> point = lanes<L>(from) + (f.axis * height + from_axis);
        // As the cylinder's: what is rounded is at most as large as height + r, and the radius k height along
        // the normal is no more than that.
        const L size = f.height + L(maximum(radius_from, radius_to));
        return {point, absolute(point) * (4 * u) + absolute(normal) * (32 * u * size), normal, normal};
    }

    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>& hit, const Vec3<T>& point) const {
        return uv_about_axis(from, to, radius_from, radius_to, hit.part, point);
    }

private:
    template <class L>
    constexpr L widening(const AxisFrame<L>& f) const {
        return L(radius_to - radius_from) / f.height;
    }

    /// Where the ray meets the endless side, |A + t D| = |p + t v| with A and D the ray's parts across the
    /// axis and p + t v the radius at its height: a t^2 - 2 b t + c = 0. That radius is negative on the
    /// second half of the double cone, beyond the tip, which is no part of the shape.
    ///
    /// The discriminant b^2 - a c, which loses its digits where the ray grazes the side or comes from afar,
    /// is |Y|^2 - X^2 with Y = p D - v A and X = |A x D| (Lagrange's identity). Outside of the cone, where a
    /// ray that has left it starts, it is Y_r^2 - X^2 c / |A|^2 with Y_r the part of Y along A, which does
    /// not cancel at all. One root comes from a sum, the other from c. Whether the radii at the roots are
    /// negative comes from Y as well, not from t: of a ray that leaves the side along a straight line to the
    /// tip, the t of its other root, just beyond the tip, is hardly known, while that sign is.
    template <class L>
    struct SideRoots {
        L near_root, far_root;             ///< not in order: c / q, which exists wherever `real`, and q / a
        MaskOf<L> near_counts, far_counts; ///< the radius there is not negative
        MaskOf<L> real;
        L a, v;
        MaskOf<L> everywhere; ///< along the axis of a cylinder, within it

        constexpr SideRoots(const AxisFrame<L>& f, const L& radius, const L& k) {
            const Vec3<L>&across = f.org_across, &dir = f.dir_across;
            const L p = radius + k * f.org_along;
            v = k * f.dir_along;
            a = dot(dir, dir) - v * v;
            const L b = p * v - dot(across, dir);
            const L squared_distance = dot(across, across);
            const L c = squared_distance - p * p;
            const Vec3<L> y = p * dir - v * across;
            const L x = dot(f.axis, cross(across, dir));
            const L y_across = dot(across, y);
            const L inverse = 1 / squared_distance;
            const L outside = y_across * inverse * y_across - x * x * (c * inverse);
            const L discriminant = choose(c > 0, outside, dot(y, y) - x * x);
            // A ray steeper than the side meets the double cone for certain, be it in the tip.
            real = (discriminant >= 0) | (a < 0);
            const L magnitude = square_root(maximum(L(0), discriminant));
            const L root = choose(b < 0, -magnitude, magnitude);
            const L q = b + root;
            far_root = q / a;
            near_root = choose(q == 0, L(0), c / q); // q = 0: the ray starts where it touches
            near_counts = q * (p * root - y_across) >= 0;
            far_counts = a * (dot(dir, y) + v * root) >= 0;
            everywhere = (a == 0) & (q == 0) & (c <= 0);
        }

        /// The part of the ray within the half of the double cone that counts.
        constexpr Stretch<L> inside() const {
            const L inf = infinity<L>();
            // A steep ray enters for good, or has been inside since ever.
            const L last = maximum(choose(near_counts, near_root, -inf), choose(far_counts, far_root, -inf));
            const L first = minimum(choose(near_counts, near_root, inf), choose(far_counts, far_root, inf));
            const MaskOf<L> steep = a < 0;
            const L near = choose(steep, choose(v > 0, last, -inf), minimum(near_root, far_root));
            const L far = choose(steep, choose(v > 0, inf, first), maximum(near_root, far_root));
            const MaskOf<L> some = real & (near_counts | (steep & far_counts));
            return {choose(everywhere, -inf, choose(some, near, inf)),
                    choose(everywhere, inf, choose(some, far, -inf))};
        }
    };
};

} // namespace scc::runtime
