#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
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
        const auto reach = [&](R cosine) {
            return radius * square_root(maximum(R(0), 1 - cosine * cosine)) + slack;
        };
        const Vec3<R> half{reach(axis.x), reach(axis.y), reach(axis.z)};
        return {minimum(from, to) - half, maximum(from, to) + half};
    }

    /// Part 0 is the side, 1 the cap at `from`, 2 the cap at `to`.
    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const Frame<L> f(*this, ray);
        const CircleRoots<L> side = intersect_circle(f.org_across, f.dir_across, L(radius));
        return caps ? intersect_closed(ray, f, side) : intersect_open(ray, f, side);
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const L u = roundoff<L>();
        const Frame<L> f(*this, ray);
        const MaskOf<L> on_side = hit.part == IndexOf<L>(0);
        const MaskOf<L> at_from = hit.part == IndexOf<L>(1);
        const L height = choose(on_side, f.org_along + hit.t * f.dir_along, choose(at_from, L(0), f.height));
        const Vec3<L> across = f.org_across + hit.t * f.dir_across;
        const Vec3<L> radial = normalize(across);
        const Vec3<L> normal = choose(on_side, radial, choose(at_from, -f.axis, f.axis));
        const Vec3<L> from_axis = choose(on_side, radial * L(radius), across);
        const Vec3<L> point = lanes<L>(from) + (f.axis * height + from_axis);
        // As the sphere's, where splitting org - from along the axis costs roundings of its length, at most
        // height + r.
        const L size = f.height + L(radius);
        return {point, absolute(point) * (4 * u) + absolute(normal) * (32 * u * size), normal, normal};
    }

private:
    /// A ray relative to the axis.
    template <class L>
    struct Frame {
        Vec3<L> axis; ///< unit
        L height;
        L org_along, dir_along;
        Vec3<L> org_across, dir_across;

        constexpr Frame(const Cylinder& c, const Ray<L>& ray) {
            const Vec3<R> whole = c.to - c.from;
            const R h = length(whole);
            axis = lanes<L>(whole * (1 / h));
            height = L(h);
            const Vec3<L> org = ray.org - lanes<L>(c.from);
            org_along = dot(org, axis);
            dir_along = dot(ray.dir, axis);
            org_across = org - axis * org_along;
            dir_across = ray.dir - axis * dir_along;
        }
    };

    template <class L>
    constexpr ShapeHit<L> intersect_open(const Ray<L>& ray, const Frame<L>& f,
                                         const CircleRoots<L>& side) const {
        if (none(side.real)) {
            return {};
        }
        const auto usable = [&](const L& t) {
            const L along = f.org_along + t * f.dir_along;
            const MaskOf<L> inside = side.real & (along >= 0) & (along <= f.height) & (t >= ray.t_min);
            return choose(inside & (t <= ray.t_max), t, infinity<L>());
        };
        return {minimum(usable(side.near), usable(side.far)), {}};
    }

    /// The ray's stretch inside the endless tube and its stretch between the caps: their common part is
    /// inside the solid, so there is no seam at the rim for a ray to slip through.
    template <class L>
    constexpr ShapeHit<L> intersect_closed(const Ray<L>& ray, const Frame<L>& f,
                                           const CircleRoots<L>& side) const {
        const L inf = infinity<L>();
        const MaskOf<L> along_axis = dot(f.dir_across, f.dir_across) == 0;
        const L everywhere = choose(along_axis & (side.excess <= 0), inf, -inf);
        const L tube_near = choose(side.real, side.near, -everywhere);
        const L tube_far = choose(side.real, side.far, everywhere);

        const L inverse = 1 / f.dir_along;
        const L t_from = -f.org_along * inverse, t_to = (f.height - f.org_along) * inverse;
        const MaskOf<L> across_axis = absolute(inverse) == inf;
        const L between = choose((f.org_along >= 0) & (f.org_along <= f.height), inf, -inf);
        const L caps_near = choose(across_axis, -between, minimum(t_from, t_to));
        const L caps_far = choose(across_axis, between, maximum(t_from, t_to));

        const L entry = maximum(tube_near, caps_near), exit = minimum(tube_far, caps_far);
        const MaskOf<L> crossed = entry <= exit;
        const L t = choose(crossed, first_in_range(ray, entry, exit), inf);
        const MaskOf<L> on_side = t == choose(t == entry, tube_near, tube_far);
        using Index = IndexOf<L>;
        return {t, choose(on_side, Index(0), choose(t == t_from, Index(1), Index(2)))};
    }
};

} // namespace scc::runtime
