#include "compiler/backends/needs_double.h"

#include "compiler/bounds.h"
#include "compiler/condition.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>
#include <vector>

namespace scc::compiler {

namespace {

// Float has 24 bits. The limits leave, measured on spheres, an error of a hundredth of an 8-bit step, and
// 1e-4 in small pictures.
constexpr double most_sizes_away = 2000;
constexpr double most_tubes_away = 1000; ///< of a torus, whose equation is of degree 4
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

/// The condition of the map with rows of one length, since rounding leaves each row its digits: 1 of what is
/// stretched along the world's axes last.
double condition_of_rows(runtime::Affine<double> map) {
    for (auto& row : map.m) {
        const double size = std::hypot(row[0], row[1], row[2]);
        for (double& entry : row) {
            entry /= size;
        }
    }
    return condition(map);
}

/// What of the shape is as large as its curvature: of a torus a piece of the tube.
template <class Shape>
runtime::Bounds<double> curved_part(const Shape& shape, const runtime::Bounds<double>& all) {
    if constexpr (std::is_same_v<Shape, runtime::Torus<double>>) {
        const runtime::Vec3<double> reach{shape.minor, shape.minor, shape.minor};
        return {shape.center - reach, shape.center + reach};
    } else {
        return all;
    }
}

/// The trial sees it: it lies in the view and has a few hundredths of the picture.
bool is_large_in_view(const runtime::Camera<double>& camera, const runtime::Bounds<double>& box) {
    const runtime::Vec3<double> center = 0.5 * (box.min + box.max);
    const double depth = dot(camera.eye - center, camera.n);
    const double aside = length(camera.eye - depth * camera.n - center);
    const bool is_parallel = camera.projection == runtime::Projection::orthographic;
    const double height = 2 * camera.half_height * (is_parallel ? 1 : depth);
    return camera.projection != runtime::Projection::spherical && depth > 0 && aside < 0.5 * height &&
           size_of(box) > 0.2 * height;
}

/// Of an object as it is placed; `path` is a function: few paths are asked for.
template <class Shape, class Path>
std::optional<std::string> too_much(const Shape& shape, const ir::Scene& scene,
                                    const runtime::Affine<double>& place, double stretch, const Path& path) {
    const std::optional<runtime::Bounds<double>> own = object_bounds(shape, scene);
    const runtime::Bounds<double> box = own ? transform_bounds(place, *own) : runtime::Bounds<double>{};
    const bool is_tried = own && is_large_in_view(scene.camera, box);
    if (!(stretch <= most_stretched) && !(is_tried && condition_of_rows(place) <= most_stretched)) {
        return fmt::format("the transform of `{}` stretches it by more than {} to 1", path(), most_stretched);
    }
    if (!own) {
        return std::nullopt;
    }
    const double away = std::max(
        {largest_coordinate(scene.camera.eye), largest_coordinate(box.min), largest_coordinate(box.max)});
    const double size = size_of(transform_bounds(place, curved_part(shape, *own)));
    if (!(away <= largest && size >= smallest) && !is_tried) {
        return fmt::format("the numbers of `{}` are too large or too small for float", path());
    }
    const double most_away =
        std::is_same_v<Shape, runtime::Torus<double>> ? most_tubes_away : most_sizes_away;
    if (!(away <= most_away * size)) {
        return fmt::format("`{}` or the camera is more than {} times the object's size from the origin",
                           path(), most_away);
    }
    return std::nullopt;
}

std::optional<std::string> too_much(const ir::Object& object, const ir::Scene& scene) {
    return std::visit(
        [&](const auto& shape) {
            return too_much(shape, scene, object.world_from_object, condition(object.world_from_object),
                            [&] { return object.path; });
        },
        object.shape);
}

std::optional<std::string> too_much(const ir::ObjectColumn& column, const ir::Scene& scene) {
    const double stretch = condition(column.world_from_object);
    return std::visit(
        [&](const auto& shapes) {
            std::optional<std::string> reason;
            for (std::size_t round = 0; !reason && round < shapes.size(); ++round) {
                reason = too_much(shapes[round], scene, column.world_from_object, stretch,
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
    std::optional<std::string> reason;
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            if (!reason) {
                reason = too_much(object, scene);
            }
        },
        [&](const ir::ObjectArray& array) {
            for (std::size_t i = 0; !reason && i < array.columns.size(); ++i) {
                reason = too_much(array.columns[i], scene);
            }
        });
    for (std::size_t i = 0; !reason && i < scene.members.size(); ++i) {
        reason = too_much(scene.members[i], scene);
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
