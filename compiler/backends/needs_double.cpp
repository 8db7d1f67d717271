#include "compiler/backends/needs_double.h"

#include "compiler/bounds.h"
#include "compiler/condition.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace scc::compiler {

namespace {

// Float has 24 bits. The limits leave, measured on spheres, an error of a hundredth of an 8-bit step.
constexpr double most_sizes_away = 4000;
constexpr double most_stretched = 300;
constexpr double most_shininess = 500;
/// Mirrors one after the other: each adds its roundings, and a curved one multiplies those before it.
constexpr int most_mirrors = 64;
/// Far to near plane, which z-buffers divide their digits among.
constexpr double deepest = 1e6;
/// Squares and products of coordinates beyond these leave float's range.
constexpr double largest = 1e9, smallest = 1e-9;

double largest_coordinate(const runtime::Vec3<double>& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// Of a box: its middle extent, since a flat shape has no curvature across and a long one none along.
double size_of(const runtime::Bounds<double>& box) {
    std::array<double, 3> extents{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    std::sort(extents.begin(), extents.end());
    return extents[1];
}

/// `path` is a function: few paths are asked for.
template <class Path>
std::optional<std::string> too_much(const std::optional<runtime::Bounds<double>>& own,
                                    const runtime::Affine<double>& place, double stretch, double eye,
                                    const Path& path) {
    if (!(stretch <= most_stretched)) {
        return fmt::format("the transform of `{}` stretches it by more than {} to 1", path(), most_stretched);
    }
    if (!own) {
        return std::nullopt;
    }
    const runtime::Bounds<double> box = transform_bounds(place, *own);
    const double away = std::max({eye, largest_coordinate(box.min), largest_coordinate(box.max)});
    const double size = size_of(box);
    if (!(away <= largest && size >= smallest)) {
        return fmt::format("the numbers of `{}` are too large or too small for float", path());
    }
    if (!(away <= most_sizes_away * size)) {
        return fmt::format("`{}` or the camera is more than {} times the object's size from the origin",
                           path(), most_sizes_away);
    }
    return std::nullopt;
}

std::optional<std::string> too_much(const ir::ObjectColumn& column, const ir::Scene& scene, double eye) {
    const double stretch = condition(column.world_from_object);
    return std::visit(
        [&](const auto& shapes) {
            std::optional<std::string> reason;
            for (std::size_t round = 0; !reason && round < shapes.size(); ++round) {
                reason = too_much(object_bounds(shapes[round], scene), column.world_from_object, stretch, eye,
                                  [&] { return column.path_of(round); });
            }
            return reason;
        },
        column.shapes);
}

std::optional<std::string> too_much(const ir::Material& material, const runtime::RenderSettings& settings) {
    const runtime::Phong<double>& phong = material.phong;
    if (phong.shininess.function < 0 && !(phong.shininess.value <= most_shininess)) {
        return fmt::format("the shininess of `{}` is above {}", material.name, most_shininess);
    }
    if (settings.method != runtime::Method::ray) {
        return std::nullopt;
    }
    if (refracts(phong)) {
        return fmt::format("`{}` bends rays, which multiplies what is rounded where they graze it",
                           material.name);
    }
    const bool mirrors =
        phong.reflect.function != runtime::no_function || !(phong.reflect.value == runtime::Rgb<double>{});
    if (settings.depth > most_mirrors && mirrors) {
        return fmt::format("`{}` may mirror rays more than {} times", material.name, most_mirrors);
    }
    return std::nullopt;
}

std::optional<std::string> too_deep(const ir::Scene& scene) {
    const runtime::Camera<double>& camera = scene.camera;
    if (scene.settings.method == runtime::Method::raster && camera.far > deepest * camera.near &&
        camera.projection == runtime::Projection::perspective) {
        return fmt::format("the far plane is more than {} times as far as the near plane", deepest);
    }
    return std::nullopt;
}

} // namespace

std::optional<std::string> needs_double(const ir::Scene& scene) {
    const double eye = largest_coordinate(scene.camera.eye);
    std::optional<std::string> reason;
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            if (!reason) {
                reason = too_much(object_bounds(object.shape, scene), object.world_from_object,
                                  condition(object.world_from_object), eye, [&] { return object.path; });
            }
        },
        [&](const ir::ObjectArray& array) {
            for (std::size_t i = 0; !reason && i < array.columns.size(); ++i) {
                reason = too_much(array.columns[i], scene, eye);
            }
        });
    for (std::size_t i = 0; !reason && i < scene.members.size(); ++i) {
        const ir::Object& member = scene.members[i];
        reason = too_much(object_bounds(member.shape, scene), member.world_from_object,
                          condition(member.world_from_object), eye, [&] { return member.path; });
    }
    if (reason) {
        return reason;
    }
    for (const ir::Material& material : scene.materials) {
        if (auto of_material = too_much(material, scene.settings)) {
            return of_material;
        }
    }
    return too_deep(scene);
}

} // namespace scc::compiler
