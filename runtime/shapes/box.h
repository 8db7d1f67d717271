#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// Axis-aligned. The front end makes sure that min < max in every axis.
template <class R>
struct Box {
    static constexpr std::string_view name = "box";

    Vec3<R> min{-1, -1, -1};
    Vec3<R> max{1, 1, 1};

    static constexpr auto fields() {
        return std::tuple{field("min", &Box::min, Rule::any, "the corner with the smallest coordinates"),
                          field("max", &Box::max, Rule::any, "the corner with the largest coordinates")};
    }

    constexpr Bounds<R> bounds() const { return {min, max}; }

    /// The faces are parts 0 to 5: x min, x max, y min, y max, z min, z max.
    template <class L>
    constexpr ShapeHit<L> intersect(const Ray<L>& ray) const {
        const auto [x, y, z] = slabs(ray);
        const auto [entry, exit] = common(x, y, z);
        const MaskOf<L> crossed = entry <= exit;
        if (none(crossed)) {
            return {};
        }
        const L t = choose(crossed, first_in_range(ray, entry, exit), infinity<L>());
        const MaskOf<L> entering = t == entry;
        const MaskOf<L> x_face = t == choose(entering, x.near, x.far);
        const MaskOf<L> y_face = t == choose(entering, y.near, y.far);
        // Of a pair, the face at max is the exit of a ray towards larger coordinates and the entry of others.
        using Index = IndexOf<L>;
        const auto face = [&](std::uint32_t first, const L& d) {
            return choose(entering == (d > 0), Index(first), Index(first + 1));
        };
        return {t,
                choose(x_face, face(0, ray.dir.x), choose(y_face, face(2, ray.dir.y), face(4, ray.dir.z)))};
    }

    /// Of the ray's line within.
    template <class L>
    constexpr Stretch<L> stretch(const Ray<L>& ray) const {
        const auto [x, y, z] = slabs(ray);
        return common(x, y, z);
    }

    template <class L>
    constexpr Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        Vec3<L> point = ray.org + hit.t * ray.dir;
        point = maximum(minimum(point, lanes<L>(max)), lanes<L>(min));
        Vec3<L> normal{L(0), L(0), L(0)};
        const auto put = [&](std::uint32_t face, L& coordinate, R value, L& component, R sign) {
            const MaskOf<L> here = hit.part == IndexOf<L>(face);
            coordinate = choose(here, L(value), coordinate);
            component = choose(here, L(sign), component);
        };
        put(0, point.x, min.x, normal.x, -1);
        put(1, point.x, max.x, normal.x, 1);
        put(2, point.y, min.y, normal.y, -1);
        put(3, point.y, max.y, normal.y, 1);
        put(4, point.z, min.z, normal.z, -1);
        put(5, point.z, max.z, normal.z, 1);
        // The face's coordinate is exact, and comparing with it is. The bound is for what a transform does to
        // it.
        const Vec3<R> magnitude = maximum(absolute(min), absolute(max));
        return {point, lanes<L>(magnitude) * (4 * roundoff<L>()), normal, normal};
    }

    /// 0 to 1 over each face, as it is seen from outside with y upwards; on those across y, -z goes up at the
    /// top and z at the bottom.
    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>& hit, const Vec3<T>& point) const {
        const auto along = [](const T& p, R low, R high) { return (p - T(low)) * T(1 / (high - low)); };
        const T x = along(point.x, min.x, max.x), y = along(point.y, min.y, max.y);
        const T z = along(point.z, min.z, max.z);
        const auto is = [&](std::uint32_t face) { return hit.part == IndexOf<L>(face); };
        const T u = choose(is(0), z, choose(is(1), 1 - z, choose(is(4), 1 - x, x)));
        const T v = choose(is(2), z, choose(is(3), 1 - z, y));
        return {u, v};
    }

private:
    /// Where a ray is between two planes. A ray along them is so always or never; on one of them it is.
    template <class L>
    struct Slab {
        L near, far;

        constexpr Slab(const L& low, const L& high, const L& org, const L& dir) {
            const L inverse = 1 / dir;
            const L t0 = (low - org) * inverse, t1 = (high - org) * inverse;
            const MaskOf<L> along = absolute(inverse) == infinity<L>();
            const MaskOf<L> between = (low <= org) & (org <= high);
            const L everywhere = choose(between, infinity<L>(), -infinity<L>());
            near = choose(along, -everywhere, minimum(t0, t1));
            far = choose(along, everywhere, maximum(t0, t1));
        }
    };
    template <class L>
    struct Slabs {
        Slab<L> x, y, z;
    };
    template <class L>
    constexpr Slabs<L> slabs(const Ray<L>& ray) const {
        return {{L(min.x), L(max.x), ray.org.x, ray.dir.x},
                {L(min.y), L(max.y), ray.org.y, ray.dir.y},
                {L(min.z), L(max.z), ray.org.z, ray.dir.z}};
    }
    template <class L>
    static constexpr Stretch<L> common(const Slab<L>& x, const Slab<L>& y, const Slab<L>& z) {
        return {maximum(maximum(x.near, y.near), z.near), minimum(minimum(x.far, y.far), z.far)};
    }
};

} // namespace scc::runtime
