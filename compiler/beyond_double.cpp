#include "compiler/beyond_double.h"

#include "compiler/object_boxes.h"

#include <algorithm>
#include <cmath>

namespace scc::compiler {

namespace {

using runtime::Vec3;

/// Of double's 53 bits, and how many steps across a picture's height have been seen to do: with 4e4 values
/// are 1e-4 off, with ten times as many they are not.
constexpr double double_steps = 1ULL << 53;
constexpr double fewest_picture_steps = 1e5;

double largest_coordinate(const Vec3<double>& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

struct PictureSteps {
    double steps, away;
};

/// At the box's point nearest to the view's axis, as deep as its centre; nothing if that is not in the view.
std::optional<PictureSteps> picture_steps(const runtime::Camera<double>& camera, const Box& box) {
    const double depth = dot(camera.eye - 0.5 * (box.min + box.max), camera.n);
    const Vec3<double> on_axis = camera.eye - depth * camera.n;
    const Vec3<double> nearest = minimum(maximum(on_axis, box.min), box.max);
    const bool is_parallel = camera.projection == runtime::Projection::orthographic;
    const double height = 2 * camera.half_height * (is_parallel ? 1 : length(nearest - camera.eye));
    if (!(depth > 0) || camera.projection == runtime::Projection::spherical ||
        length(nearest - on_axis) > 2 * height) {
        return std::nullopt;
    }
    const double away = std::max(largest_coordinate(camera.eye), largest_coordinate(nearest));
    return PictureSteps{double_steps * height / away, away};
}

} // namespace

std::optional<BeyondDouble> beyond_double(const ir::Scene& scene) {
    BeyondDouble worst{.steps = fewest_picture_steps, .span = {}, .path = {}};
    for_each_box(scene, [&](const std::optional<Box>& box, const auto& span_of, const auto& path_of) {
        const auto here = box ? picture_steps(scene.camera, *box) : std::nullopt;
        if (here && here->steps < worst.steps) {
            worst = {here->away, here->steps, span_of(), path_of()};
        }
    });
    return worst.away > 0 ? std::optional(worst) : std::nullopt;
}

} // namespace scc::compiler
