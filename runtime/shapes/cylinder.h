#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/axis.h"
#include "runtime/shapes/quadratic.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// A round tube between two points, closed by discs where `caps`. The front end makes sure that from != to.
template <class R>
struct Cylinder {
    static constexpr std::string_view name = "cylinder";

    Vec3<R> from{0, 0, 0};
    Vec3<R> to{0, 1, 0};
    R radius = 1;
    bool caps = true;

    static constexpr auto fields() {
        return std::tuple{field("from", &Cylinder::from, Rule::any, "centre of one end"),
                          field("to", &Cylinder::to, Rule::any, "centre of the other end"),
                          field("radius", &Cylinder::radius, Rule::positive, "radius"),
                          field("caps", &Cylinder::caps, Rule::any, "whether discs close the ends")};
    }

    constexpr Bounds<R> bounds() const {
        const Vec3<R> axis = normalize(to - from);
        const R magnitude = largest_component(maximum(absolute(from), absolute(to)));
        const R slack = 32 * roundoff<R>() * (magnitude + radius);
        const Vec3<R> half = disc_reach(axis, radius) + Vec3<R>{slack, slack, slack};
        return {minimum(from, to) - half, maximum(from, to) + half};
    }

    /// Part 0 is the side, 1 the cap at `from`, 2 the cap at `to`.
    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const AxisFrame<L> f(from, to, ray);
        const CircleRoots<L> side = intersect_circle(f.org_across, f.dir_across, L(radius));
        return caps ? CappedStretch<L>(f, inside(f, side)).first(ray) : intersect_open(ray, f, side);
    }

    /// Of the ray's line within, if there are caps.
    template <class L>
    constexpr Stretch<L> stretch(const Ray<L>& ray) const {
        const AxisFrame<L> f(from, to, ray);
        return CappedStretch<L>(f, inside(f, intersect_circle(f.org_across, f.dir_across, L(radius)))).inside;
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const L u = roundoff<L>();
        const AxisFrame<L> f(from, to, ray);
        const MaskOf<L> on_side = hit.part == IndexOf<L>(0);
        const MaskOf<L> at_from = hit.part == IndexOf<L>(1);
        const L height = choose(on_side, f.org_along + hit.t * f.dir_along, choose(at_from, L(0), f.height));
        // Made perpendicular once more: what is left along the axis grows with the ray's distance.
        const Vec3<L> nearly_across = f.org_across + hit.t * f.dir_across;
        const Vec3<L> across = nearly_across - f.axis * dot(nearly_across, f.axis);
        const Vec3<L> radial = normalize(across);
        const Vec3<L> normal = choose(on_side, radial, choose(at_from, -f.axis, f.axis));
        const Vec3<L> from_axis = choose(on_side, radial * L(radius), across);
        const Vec3<L> point = lanes<L>(from) + (f.axis * height + from_axis);
        // As the sphere's, where splitting org - from along the axis costs roundings of its length, at most
        // height + r.
        const L size = f.height + L(radius);
        return {point, absolute(point) * (4 * u) + absolute(normal) * (32 * u * size), normal, normal};
    }

    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>& hit, const Vec3<T>& point) const {
        return uv_about_axis(from, to, radius, radius, hit.part, point);
    }

private:
    template <class L>
    static constexpr ShapeHit<L> intersect_open(const Ray<L>& ray, const AxisFrame<L>& f,
                                                const CircleRoots<L>& side) {
        if (none(side.real)) {
            return {};
        }
        return {minimum(f.between_ends(ray, side.near, side.real), f.between_ends(ray, side.far, side.real)),
                {}};
    }

    /// The part of the ray within the endless cylinder.
    template <class L>
    static constexpr Stretch<L> inside(const AxisFrame<L>& f, const CircleRoots<L>& side) {
        const L inf = infinity<L>();
        const MaskOf<L> along_axis = dot(f.dir_across, f.dir_across) == 0;
        const L everywhere = choose(along_axis & (side.excess <= 0), inf, -inf);
        return {choose(side.real, side.near, -everywhere), choose(side.real, side.far, everywhere)};
    }
};

} // namespace scc::runtime
