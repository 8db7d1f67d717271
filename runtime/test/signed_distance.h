#pragma once

#include "runtime/mesh_trace.h"
#include "runtime/shapes/list.h"

#include <algorithm>
#include <cmath>

/// How far a point near the surface is from it, in long double; positive on the side that the normal points
/// to. Of the surface's piece that `normal` belongs to, where there are several.
namespace scc::runtime::test {

using Wide = Vec3<long double>;

template <class R>
long double signed_distance(const Sphere<R>& s, const Wide& p, const Wide&) {
    return length(p - lanes<long double>(s.center)) - static_cast<long double>(s.radius);
}
template <class R>
long double signed_distance(const Box<R>& s, const Wide& p, const Wide& n) {
    const auto face = [](long double component, R min, R max, long double coordinate) {
        return component > 0 ? coordinate - static_cast<long double>(max)
                             : static_cast<long double>(min) - coordinate;
    };
    return std::abs(n.x) > 0.5L   ? face(n.x, s.min.x, s.max.x, p.x)
           : std::abs(n.y) > 0.5L ? face(n.y, s.min.y, s.max.y, p.y)
                                  : face(n.z, s.min.z, s.max.z, p.z);
}
template <class R>
long double signed_distance(const Plane<R>& s, const Wide& p, const Wide&) {
    return dot(normalize(lanes<long double>(s.normal)), p) - static_cast<long double>(s.offset);
}
template <class R>
long double signed_distance(const Cylinder<R>& s, const Wide& p, const Wide& n) {
    const Wide from = lanes<long double>(s.from), axis = lanes<long double>(s.to) - from;
    const Wide w = normalize(axis), f = p - from;
    const long double along = dot(f, w), slope = dot(n, w);
    if (std::abs(slope) > 0.5L) {
        return slope > 0 ? along - length(axis) : -along;
    }
    return length(f - w * along) - static_cast<long double>(s.radius);
}
template <class R>
long double signed_distance(const Cone<R>& s, const Wide& p, const Wide& n) {
    const Wide from = lanes<long double>(s.from), axis = lanes<long double>(s.to) - from;
    const Wide w = normalize(axis), f = p - from;
    const long double r = static_cast<long double>(s.radius_from);
    const long double k = (static_cast<long double>(s.radius_to) - r) / length(axis);
    const long double along = dot(f, w), slope = dot(n, w), secant = std::sqrt(1 + k * k);
    if (std::abs(slope + k / secant) > 1e-3L) {
        return slope > 0 ? along - length(axis) : -along;
    }
    return (length(f - w * along) - (r + k * along)) / secant;
}
template <class R>
long double signed_distance(const Disc<R>& s, const Wide& p, const Wide&) {
    return dot(normalize(lanes<long double>(s.normal)), p - lanes<long double>(s.center));
}
template <class R>
long double signed_distance(const Torus<R>& s, const Wide& p, const Wide&) {
    const Wide f = p - lanes<long double>(s.center), axis = normalize(lanes<long double>(s.axis));
    const long double along = dot(f, axis);
    return std::hypot(length(f - axis * along) - static_cast<long double>(s.major), along) -
           static_cast<long double>(s.minor);
}
/// To first order.
template <class R>
long double signed_distance(const Quadric<R>& s, const Wide& p, const Wide&) {
    const Wide a = lanes<long double>(s.squares), m = lanes<long double>(s.products),
               l = lanes<long double>(s.linear);
    const long double value = a.x * p.x * p.x + a.y * p.y * p.y + a.z * p.z * p.z + m.x * p.x * p.y +
                              m.y * p.y * p.z + m.z * p.z * p.x + dot(l, p) +
                              static_cast<long double>(s.constant);
    const Wide gradient{2 * a.x * p.x + m.x * p.y + m.z * p.z + l.x,
                        2 * a.y * p.y + m.x * p.x + m.y * p.z + l.y,
                        2 * a.z * p.z + m.y * p.y + m.z * p.x + l.z};
    return value / length(gradient);
}
template <class R>
long double signed_distance(const Triangle<R>& s, const Wide& p, const Wide&) {
    const Wide a = lanes<long double>(s.points[0]);
    return dot(normalize(cross(lanes<long double>(s.points[1]) - a, lanes<long double>(s.points[2]) - a)),
               p - a);
}

} // namespace scc::runtime::test
