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
long double signed_distance(const Triangle<R>& s, const Wide& p, const Wide&) {
    const Wide a = lanes<long double>(s.points[0]);
    return dot(normalize(cross(lanes<long double>(s.points[1]) - a, lanes<long double>(s.points[2]) - a)),
               p - a);
}

} // namespace scc::runtime::test
