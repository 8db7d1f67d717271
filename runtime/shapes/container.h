#pragma once

#include "runtime/shapes/box.h"
#include "runtime/shapes/cone.h"
#include "runtime/shapes/cylinder.h"
#include "runtime/shapes/sphere.h"

#include <cstdint>

namespace scc::runtime {

/// A convex, closed and bounded shape in which something unbounded is looked at.
template <class R>
struct Container {
    enum class Kind : std::uint32_t { sphere, box, cylinder, cone };

    Kind kind = Kind::box;
    Vec3<R> first{-1, -1, -1}; ///< centre, min or from
    Vec3<R> second{1, 1, 1};   ///< max or to
    R radius = 1;              ///< of the sphere or at `first`
    R radius_to = 1;           ///< of the cone

    static constexpr Container of(const Sphere<R>& s) {
        return {Kind::sphere, s.center, s.center, s.radius, 0};
    }
    static constexpr Container of(const Box<R>& b) { return {Kind::box, b.min, b.max, 0, 0}; }
    static constexpr Container of(const Cylinder<R>& c) {
        return {Kind::cylinder, c.from, c.to, c.radius, 0};
    }
    static constexpr Container of(const Cone<R>& c) {
        return {Kind::cone, c.from, c.to, c.radius_from, c.radius_to};
    }

    /// What f gives for the shape.
    template <class F>
    constexpr auto visit(F&& f) const {
        switch (kind) {
        case Kind::sphere:
            return f(Sphere<R>{first, radius});
        case Kind::box:
            return f(Box<R>{first, second});
        case Kind::cylinder:
            return f(Cylinder<R>{first, second, radius, true});
        case Kind::cone:
            break;
        }
        return f(Cone<R>{first, second, radius, radius_to, true});
    }

    constexpr Bounds<R> bounds() const {
        return visit([](const auto& shape) { return shape.bounds(); });
    }
};

/// Where a ray's line is inside a container; missed where near.t is infinite.
template <class L>
struct Passage {
    ShapeHit<L> near, far;
};

/// By a convex shape's own test: its first hit in all of the line, and its first after that.
template <class L, class R>
constexpr Passage<L> passage(const Container<R>& container, const Ray<L>& ray) {
    return container.visit([&](const auto& shape) {
        Ray<L> line{ray.org, ray.dir, -infinity<L>(), infinity<L>()};
        Passage<L> result{shape.intersect(line), {}};
        const L t = result.near.t;
        line.t_min =
            t + (absolute(t) * L(2 * std::numeric_limits<R>::epsilon()) + L(std::numeric_limits<R>::min()));
        result.far = shape.intersect(line);
        result.near.t = choose(result.far.t < infinity<L>(), t, infinity<L>());
        return result;
    });
}

} // namespace scc::runtime
