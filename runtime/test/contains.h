#pragma once

#include "runtime/shapes/list.h"

#include <cmath>

/// Whether a point is in a shape, by its formula in long double.
namespace scc::runtime::test {

using Wide = Vec3<long double>;

template <class R>
bool contains(const Sphere<R>& s, const Wide& p) {
    return length(p - lanes<long double>(s.center)) <= static_cast<long double>(s.radius);
}
template <class R>
bool contains(const Box<R>& b, const Wide& p) {
    const Wide low = p - lanes<long double>(b.min), high = lanes<long double>(b.max) - p;
    return low.x >= 0 && low.y >= 0 && low.z >= 0 && high.x >= 0 && high.y >= 0 && high.z >= 0;
}
template <class R>
bool contains(const Plane<R>& s, const Wide& p) {
    return dot(lanes<long double>(s.normal), p) <= static_cast<long double>(s.offset);
}
template <class R>
bool is_in_cone(const Vec3<R>& from, const Vec3<R>& to, long double at_from, long double at_to,
                const Wide& p) {
    const Wide axis = lanes<long double>(to) - lanes<long double>(from), f = p - lanes<long double>(from);
    const long double part = dot(f, axis) / dot(axis, axis);
    return part >= 0 && part <= 1 && length(f - axis * part) <= at_from + part * (at_to - at_from);
}
template <class R>
bool contains(const Cylinder<R>& c, const Wide& p) {
    return is_in_cone(c.from, c.to, c.radius, c.radius, p);
}
template <class R>
bool contains(const Cone<R>& c, const Wide& p) {
    return is_in_cone(c.from, c.to, c.radius_from, c.radius_to, p);
}

template <class R>
bool contains(const Torus<R>& s, const Wide& p) {
    const Wide f = p - lanes<long double>(s.center), axis = lanes<long double>(s.axis);
    const long double along = dot(f, axis);
    return std::hypot(length(f - axis * along) - static_cast<long double>(s.major), along) <=
           static_cast<long double>(s.minor);
}
template <class R>
bool contains(const Quadric<R>& s, const Wide& p) {
    const Wide a = lanes<long double>(s.squares), m = lanes<long double>(s.products);
    return dot(a, Wide{p.x * p.x, p.y * p.y, p.z * p.z}) + dot(m, Wide{p.x * p.y, p.y * p.z, p.z * p.x}) +
               dot(lanes<long double>(s.linear), p) + static_cast<long double>(s.constant) <=
           0;
}

} // namespace scc::runtime::test
