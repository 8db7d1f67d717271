#include "compiler/backends/needs_double.h"

#include "compiler/bounds.h"

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
constexpr double most_shininess = 2000;
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

/// At least the ratio of the largest to the smallest scale of the map.
double stretch_of(const runtime::Affine<double>& map) {
    const auto norm = [](const runtime::Affine<double>& a) {
        double sum = 0;
        for (const auto& row : a.m) {
            sum += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
        }
        return std::sqrt(sum / 3);
    };
    return norm(map) * norm(inverse(map));
}

} // namespace

std::optional<std::string> needs_double(const ir::Scene& scene) {
    std::vector<runtime::Bounds<double>> mesh_boxes;
    for (const ir::Mesh& mesh : scene.meshes) {
        mesh_boxes.push_back(mesh.box);
    }
    const double eye = largest_coordinate(scene.camera.eye);
    for (const ir::Object& object : scene.objects) {
        const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape);
        const auto own = mesh != nullptr ? mesh_boxes[mesh->mesh] : object_bounds(object.shape, scene);
        if (!(stretch_of(object.world_from_object) <= most_stretched)) {
            return fmt::format("the transform of `{}` stretches it by more than {} to 1", object.path,
                               most_stretched);
        }
        if (!own) {
            continue;
        }
        const runtime::Bounds<double> box = transform_bounds(object.world_from_object, *own);
        const double away = std::max({eye, largest_coordinate(box.min), largest_coordinate(box.max)});
        const double size = size_of(box);
        if (!(away <= largest && size >= smallest)) {
            return fmt::format("the numbers of `{}` are too large or too small for float", object.path);
        }
        if (!(away <= most_sizes_away * size)) {
            return fmt::format("`{}` or the camera is more than {} times the object's size from the origin",
                               object.path, most_sizes_away);
        }
    }
    for (const ir::Material& material : scene.materials) {
        const auto& shininess = material.phong.shininess;
        if (shininess.function < 0 && !(shininess.value <= most_shininess)) {
            return fmt::format("the shininess of `{}` is above {}", material.name, most_shininess);
        }
    }
    return std::nullopt;
}

} // namespace scc::compiler
