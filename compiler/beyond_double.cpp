#include "compiler/beyond_double.h"

#include "compiler/object_boxes.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace scc::compiler {

namespace {

using runtime::Vec3;

/// Of double's 53 bits, and how many steps across a picture's height have been seen to do: with 4e4 values
/// are 1e-4 off, with ten times as many they are not.
constexpr double double_steps = 1ULL << 53;
constexpr double fewest_picture_steps = 1e5;

/// In distances from the eye: the radius of a ball that might as well be a plane.
constexpr double giant = 1e4;

double largest_coordinate(const Vec3<double>& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

struct PictureSteps {
    double steps, away;
};

/// Of a ball that the eye is near to, whose own size is what its surface is calculated with.
std::optional<PictureSteps> giant_steps(const runtime::Camera<double>& camera, const Vec3<double>& center,
                                        double radius) {
    const double distance = std::abs(length(camera.eye - center) - radius);
    if (!(radius > giant * distance)) {
        return std::nullopt;
    }
    const bool is_parallel = camera.projection == runtime::Projection::orthographic;
    const double height = 2 * camera.half_height * (is_parallel ? 1 : distance);
    return PictureSteps{double_steps * height / radius, radius};
}

/// At the box's point nearest to the view's axis, as deep as its centre; nothing if that is not in the view.
/// `reach`: the largest of the coordinates elsewhere that the surface there is calculated with.
std::optional<PictureSteps> picture_steps(const runtime::Camera<double>& camera, const Box& box,
                                          double reach) {
    const double depth = dot(camera.eye - 0.5 * (box.min + box.max), camera.n);
    const Vec3<double> on_axis = camera.eye - depth * camera.n;
    const Vec3<double> nearest = minimum(maximum(on_axis, box.min), box.max);
    const bool is_parallel = camera.projection == runtime::Projection::orthographic;
    const double height = 2 * camera.half_height * (is_parallel ? 1 : length(nearest - camera.eye));
    if (!(depth > 0) || camera.projection == runtime::Projection::spherical ||
        length(nearest - on_axis) > 2 * height) {
        return std::nullopt;
    }
    const double away = std::max({largest_coordinate(camera.eye), largest_coordinate(nearest), reach});
    return PictureSteps{double_steps * height / away, away};
}

} // namespace

std::optional<BeyondDouble> beyond_double(const ir::Scene& scene) {
    BeyondDouble worst{.steps = fewest_picture_steps, .span = {}, .path = {}};
    // The author's numbers were rounded there before the scene was moved.
    const auto& [x, y, z] = scene.settings.origin;
    const double origin = largest_coordinate({x, y, z});
    const auto look_at = [&]<class Shape>(const Shape& shape, const runtime::Affine<double>& place,
                                          const auto& span_of, const auto& path_of) {
        std::optional<PictureSteps> here;
        if (const std::optional<Box> box = box_in_world(shape, place, scene)) {
            double reach = origin;
            if constexpr (std::is_same_v<Shape, runtime::Triangle<double>>) {
                reach = std::max({reach, largest_coordinate(box->min), largest_coordinate(box->max)});
            }
            here = picture_steps(scene.camera, *box, reach);
        }
        if constexpr (std::is_same_v<Shape, runtime::Sphere<double>>) {
            const bool is_moved = place != runtime::Affine<double>{};
            const double scale = is_moved ? std::cbrt(std::abs(determinant(place))) : 1;
            const auto giant =
                giant_steps(scene.camera, transform_point(place, shape.center), shape.radius * scale);
            here = giant ? giant : here;
        }
        if (here && here->steps < worst.steps) {
            worst = {here->away, here->steps, span_of(), path_of()};
        }
    };
    for_each_placed(scene, look_at);
    return worst.away > 0 ? std::optional(worst) : std::nullopt;
}

} // namespace scc::compiler
