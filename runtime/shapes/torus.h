#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/bracket.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"
#include "runtime/shapes/axis.h"

#include <array>
#include <string_view>
#include <tuple>

namespace scc::runtime {

/// The points at distance `minor` from a circle of radius `major`. The front end makes sure that minor <=
/// major.
template <class R>
struct Torus {
    static constexpr std::string_view name = "torus";

    Vec3<R> center{0, 0, 0};
    Vec3<R> axis{0, 1, 0}; ///< unit
    R major = 1;
    R minor = R(0.25);

    static constexpr auto fields() {
        return std::tuple{
            field("center", &Torus::center, Rule::any, "centre"),
            field("axis", &Torus::axis, Rule::direction, "about which it is round"),
            field("major", &Torus::major, Rule::positive, "radius of the circle in the middle of the tube"),
            field("minor", &Torus::minor, Rule::positive, "radius of the tube, at most `major`")};
    }

    constexpr Bounds<R> bounds() const {
        const R slack = 64 * roundoff<R>() * (largest_component(absolute(center)) + major + minor);
        const R thick = minor + slack;
        const Vec3<R> half = disc_reach(axis, major) + Vec3<R>{thick, thick, thick};
        return {center - half, center + half};
    }

    template <class L>
    ShapeHit<L> intersect(const Ray<L>& ray) const {
        return cross(ray).hit;
    }

    /// The first point of the surface in each ray's range. Which one it is does not depend on t_max; called
    /// again with t_min behind a hit it gives the next.
    template <class L>
    Crossing<L> cross(const Ray<L>& ray) const {
        const Line<L> line(*this, ray);
        Crossing<L> result{{}, MaskOf<L>(false)};
        MaskOf<L> searching = line.squared_reach >= 0;
        if (none(searching)) {
            return result;
        }
        const L finest = L(2 * std::numeric_limits<R>::epsilon());
        const L reach = square_root(maximum(L(0), line.squared_reach));
        const std::array<L, 5> ends = line.monotone_pieces(reach, finest, searching);
        MaskOf<L> inside(false); // at the begin of the piece
        for (std::size_t i = 0; i < 4; ++i) {
            const L &low = ends[i], &high = ends[i + 1];
            L slope;
            const MaskOf<L> inside_after = i < 3 ? MaskOf<L>(line.excess(high, slope) < 0) : MaskOf<L>(false);
            const MaskOf<L> here = searching & !(inside == inside_after) & (line.t(high) >= ray.t_min);
            if (any(here)) {
                const auto excess = [&](const L& s, L& slope_there) { return line.excess(s, slope_there); };
                const L t = line.t(bracketed_root(excess, low, high, inside, here, finest));
                const MaskOf<L> met = here & (t >= ray.t_min);
                result.hit.t = choose(met, t, result.hit.t);
                result.outwards = (met & inside) | result.outwards;
                searching = searching & !met;
            }
            inside = inside_after;
        }
        result.hit.t = choose(result.hit.t <= ray.t_max, result.hit.t, infinity<L>());
        result.outwards = result.outwards & (result.hit.t < infinity<L>());
        return result;
    }

    template <class L>
    Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        const L u = roundoff<L>();
        const Vec3<L> c = lanes<L>(center), n = lanes<L>(axis);
        const Vec3<L> from_center = (ray.org - c) + hit.t * ray.dir;
        const L height = dot(from_center, n);
        const Vec3<L> across = from_center - n * height;
        const L distance = length(across);
        const Vec3<L> radial = across * choose(distance > 0, 1 / distance, L(0));
        const Vec3<L> from_circle = radial * (distance - L(major)) + n * height;
        const L off = length(from_circle);
        // Of a tube thinner than rounding the hit may lie on the circle itself.
        const Vec3<L> normal = choose(off > 0, from_circle * (1 / off), n);
        const Vec3<L> point = c + (radial * L(major) + normal * L(minor));
        // The way from the centre, at most major + minor, is rounded here and in Line.
        return {point, absolute(point) * (4 * u) + absolute(normal) * (32 * u * L(major + minor)), normal,
                normal};
    }

    /// Around the axis as on a cylinder's side, and around the tube: 1/2 farthest from the axis.
    template <class L, class T>
    Vec2<T> uv(const Ray<L>&, const ShapeHit<L>&, const Vec3<T>& point) const {
        const PlanarAxes<R> axes = planar_axes(axis);
        const Vec3<T> d = point - lanes<T>(center);
        const T x = dot(d, lanes<T>(axes.u)), z = -dot(d, lanes<T>(axes.v));
        return {around(x, z), around(dot(d, lanes<T>(axis)), square_root(x * x + z * z) - T(major))};
    }

private:
    /// A ray's line with the circle's radius as the unit, by the distance s from its point nearest to the
    /// centre.
    template <class L>
    struct Line {
        L nearest_t, scale; ///< t = nearest_t + scale s
        L height, climb;    ///< along the axis, at s = 0 and per unit of s
        Vec3<L> across, dir_across;
        L squared_minor;
        L squared_reach; ///< of s, within the ball around the torus; negative where the line misses that
        L a, b;          ///< of slope()

        Line(const Torus& torus, const Ray<L>& ray) {
            const L inverse = 1 / dot(ray.dir, ray.dir), unit = L(1 / torus.major);
            const Vec3<L> org = ray.org - lanes<L>(torus.center), n = lanes<L>(torus.axis);
            nearest_t = -dot(org, ray.dir) * inverse;
            const L inverse_length = square_root(inverse);
            scale = L(torus.major) * inverse_length;
            const Vec3<L> dir = ray.dir * inverse_length, nearest = (org + nearest_t * ray.dir) * unit;
            height = dot(nearest, n);
            climb = dot(dir, n);
            across = nearest - n * height;
            dir_across = dir - n * climb;
            const L minor = L(torus.minor) * unit, squared_distance = dot(nearest, nearest);
            squared_minor = minor * minor;
            squared_reach =
                (1 + minor) * (1 + minor) * L(1 + 16 * std::numeric_limits<R>::epsilon()) - squared_distance;
            a = squared_distance - squared_minor - 1 + 2 * climb * climb;
            b = 2 * height * climb;
        }

        L t(const L& s) const { return nearest_t + scale * s; }

        /// Squared distance from the circle less the squared radius of the tube: unlike the quartic's terms
        /// its terms are no larger than they need be.
        L excess(const L& s, L& slope) const {
            const Vec3<L> here = across + s * dir_across;
            const L distance = length(here), off = distance - 1, up = height + s * climb;
            slope = 2 * (off * (dot(here, dir_across) / distance) + up * climb);
            return off * off + up * up - squared_minor;
        }

        /// A quarter of the derivative of the quartic (|p|^2 + 1 - minor^2)^2 - 4 (|p|^2 - height^2), whose
        /// sign is that of `excess`. As s begins at the nearest point, there is no s^2.
        L quartic_slope(const L& s, L& slope) const {
            slope = 3 * s * s + a;
            return (s * s + a) * s + b;
        }

        /// -reach, three values and reach in order, between each two of which the quartic is monotone: the
        /// zeros of its derivative, themselves between the zeros of the second derivative.
        std::array<L, 5> monotone_pieces(const L& reach, const L& finest, const MaskOf<L>& among) const {
            const L turn = minimum(square_root(maximum(L(0), a * L(R(-1) / 3))), reach);
            const std::array<L, 4> ends{-reach, -turn, turn, reach};
            std::array<L, 5> result{-reach, -turn, turn, reach, reach};
            L ignored;
            MaskOf<L> negative = quartic_slope(ends[0], ignored) < 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const MaskOf<L> negative_after = quartic_slope(ends[i + 1], ignored) < 0;
                const MaskOf<L> here = among & !(negative == negative_after);
                if (any(here)) {
                    const auto slope = [&](const L& s, L& slope_there) {
                        return quartic_slope(s, slope_there);
                    };
                    const L zero = bracketed_root(slope, ends[i], ends[i + 1], negative, here, finest);
                    result[i + 1] = choose(here, zero, result[i + 1]);
                }
                negative = negative_after;
            }
            return result;
        }
    };
};

} // namespace scc::runtime
