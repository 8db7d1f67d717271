#pragma once

#include "compiler/ir/scene.h"
#include "runtime/bounds.h"

#include <type_traits>

/// The flat parts of shapes' surfaces.
namespace scc::compiler {

/// In world space.
struct FlatFace {
    runtime::Vec3<double> normal; ///< unit, out of the shape
    double offset;                ///< dot(normal, p) of its points
    runtime::Bounds<double> box;  ///< of the face itself; of planes without end
};

/// f(face) for each face of the shape that is flat all over. Meshes are not looked into.
template <class Shape, class F>
void for_each_flat_face(const Shape& shape, const runtime::Affine<double>& world_from_object, F&& f) {
    using runtime::Bounds;
    using runtime::Vec3;
    const auto face = [&](const Vec3<double>& normal, const Vec3<double>& point, const Bounds<double>& box) {
        const Vec3<double> n = normalize(transform_normal(inverse(world_from_object), normal));
        return FlatFace{n, dot(n, transform_point(world_from_object, point)),
                        transform_bounds(world_from_object, box)};
    };
    if constexpr (std::is_same_v<Shape, runtime::Box<double>>) {
        const auto add_pair = [&](double Vec3<double>::*axis) {
            Vec3<double> normal{};
            normal.*axis = 1;
            Bounds<double> low{shape.min, shape.max}, high = low;
            low.max.*axis = shape.min.*axis;
            high.min.*axis = shape.max.*axis;
            f(face(normal, shape.max, high));
            f(face(-normal, shape.min, low));
        };
        add_pair(&Vec3<double>::x);
        add_pair(&Vec3<double>::y);
        add_pair(&Vec3<double>::z);
    } else if constexpr (std::is_same_v<Shape, runtime::Plane<double>>) {
        const Vec3<double> all{1e300, 1e300, 1e300};
        FlatFace plane = face(shape.normal, shape.normal * shape.offset, {});
        plane.box = {-all, all};
        f(plane);
    } else if constexpr (std::is_same_v<Shape, runtime::Disc<double>>) {
        const Vec3<double> reach = runtime::disc_reach(shape.normal, shape.radius);
        f(face(shape.normal, shape.center, {shape.center - reach, shape.center + reach}));
    } else if constexpr (std::is_same_v<Shape, runtime::Triangle<double>>) {
        const auto& [a, b, c] = shape.points;
        f(face(cross(b - a, c - a), a, {minimum(a, minimum(b, c)), maximum(a, maximum(b, c))}));
    } else if constexpr (requires { shape.caps; }) {
        const Vec3<double> axis = normalize(shape.to - shape.from);
        const auto add_cap = [&](const Vec3<double>& center, const Vec3<double>& normal, double radius) {
            const Vec3<double> reach = runtime::disc_reach(axis, radius);
            if (radius > 0) {
                f(face(normal, center, {center - reach, center + reach}));
            }
        };
        if constexpr (requires { shape.radius; }) {
            add_cap(shape.from, -axis, shape.radius);
            add_cap(shape.to, axis, shape.radius);
        } else {
            add_cap(shape.from, -axis, shape.radius_from);
            add_cap(shape.to, axis, shape.radius_to);
        }
    }
}

} // namespace scc::compiler
