#pragma once

#include "runtime/shapes/box.h"
#include "runtime/shapes/cone.h"
#include "runtime/shapes/cylinder.h"
#include "runtime/shapes/sphere.h"

#include <algorithm>

/// Whether a point lies in a closed convex shape or on its surface. Open cylinders and cones count as closed.
namespace scc::compiler {

inline bool encloses(const runtime::Sphere<double>& sphere, const runtime::Vec3<double>& p) {
    return length(p - sphere.center) <= sphere.radius;
}
inline bool encloses(const runtime::Box<double>& box, const runtime::Vec3<double>& p) {
    const runtime::Vec3<double> low = p - box.min, high = box.max - p;
    return std::min({low.x, low.y, low.z, high.x, high.y, high.z}) >= 0;
}
inline bool encloses(const runtime::Cylinder<double>& cylinder, const runtime::Vec3<double>& p) {
    const runtime::Vec3<double> axis = cylinder.to - cylinder.from, start = p - cylinder.from;
    const double along = dot(start, axis) / dot(axis, axis);
    return along >= 0 && along <= 1 && length(start - along * axis) <= cylinder.radius;
}
inline bool encloses(const runtime::Cone<double>& cone, const runtime::Vec3<double>& p) {
    const runtime::Vec3<double> axis = cone.to - cone.from, start = p - cone.from;
    const double along = dot(start, axis) / dot(axis, axis);
    const double radius = cone.radius_from + along * (cone.radius_to - cone.radius_from);
    return along >= 0 && along <= 1 && length(start - along * axis) <= radius;
}

} // namespace scc::compiler
