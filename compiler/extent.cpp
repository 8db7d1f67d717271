#include "compiler/extent.h"

#include "compiler/object_boxes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <type_traits>

namespace scc::compiler {

using runtime::Affine;
using runtime::Bounds;
using runtime::Vec3;

namespace {

double size_of(const Bounds<double>& bounds) {
    return bounds.min.x <= bounds.max.x ? length(bounds.max - bounds.min) : 0;
}

/// The distance of a point from a plane that was moved.
double plane_distance(const runtime::Plane<double>& plane, const Affine<double>& world_from_object,
                      const Vec3<double>& p) {
    const Affine<double> object_from_world = inverse(world_from_object);
    const Vec3<double> n = normalize(plane.normal);
    return std::abs(dot(n, transform_point(object_from_world, p)) - plane.offset) /
           length(transform_normal(object_from_world, n));
}

/// So many times as large as all that is smaller, and the eye: one stands on it as on a plane.
constexpr double giant = 1e4;

} // namespace

double nearest_power_of_two(double x) {
    return std::exp2(std::round(std::log2(x)));
}

bool Extent::is_usable() const {
    return size > 0 && std::isfinite(size);
}

Vec3<double> Extent::round_center() const {
    const double unit = nearest_power_of_two(size);
    const auto rounded = [unit](double x) { return std::round(x / unit) * unit; };
    return {rounded(center.x), rounded(center.y), rounded(center.z)};
}

Extent extent_of(const ir::Scene& scene) {
    Bounds<double> around;
    double planes = 0;
    std::map<int, Bounds<double>> by_size; // of objects, by the power of two
    around.add(scene.camera.eye);
    ir::for_each_shape(
        scene, [&]<class Shape>(const Shape& shape, const Affine<double>& place, const runtime::Sides&) {
            if constexpr (std::is_same_v<Shape, runtime::Plane<double>>) {
                planes = std::max(planes, plane_distance(shape, place, scene.camera.eye));
            } else if (const std::optional<Box> box = box_in_world(shape, place, scene)) {
                by_size[std::ilogb(size_of(*box))].add(*box);
            } else {
                around.add(translation_of(place));
            }
        });
    for (const auto& [power, boxes] : by_size) {
        if (size_of(around) > 0 && std::exp2(power) > giant * size_of(around)) {
            break;
        }
        around.add(boxes);
    }
    const double bounded = size_of(around);
    return {bounded > 0 ? bounded : planes, around.center(), !(bounded > 0)};
}

} // namespace scc::compiler
