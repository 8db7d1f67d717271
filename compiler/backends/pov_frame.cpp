#include "compiler/backends/pov_frame.h"

#include "compiler/backends/pov_text.h"
#include "compiler/bounds.h"
#include "compiler/extent.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace scc::compiler {

using runtime::Affine;
using runtime::Bounds;
using runtime::Vec3;

namespace {

double magnification(const Affine<double>& a) {
    double largest = 0;
    for (int column = 0; column < 3; ++column) {
        largest = std::max(largest, length(Vec3<double>{a.m[0][column], a.m[1][column], a.m[2][column]}));
    }
    return largest;
}

/// In the middle of what POV-Ray draws without error, with room for horizons: it sees nothing beyond 1e7.
constexpr double comfortable_size = 8;

/// Neighbouring triangles of a mesh shadow each other over short distances, and POV-Ray sees no occluder
/// nearer than 1e-3: such scenes are written larger, at the price of the horizon.
constexpr double comfortable_mesh_size = 512;

/// Rays cross the corners of bodies that let light through over ways as short as one likes.
constexpr double comfortable_glass_size = 4096;

} // namespace

std::string PovFrame::texture_transform() const {
    std::string text;
    if (!(origin == Vec3<double>{})) {
        text += " translate " + pov_vector(-origin);
    }
    if (scale != 1) {
        text += " scale " + number(scale);
    }
    return text;
}

namespace {

/// Surfaces that shadow and mirror themselves, or neighbours that do so to each other, at distances far below
/// their size.
bool has_folds(const ir::Scene& scene) {
    const auto count = [&]<class Shape>(const Shape&) {
        return std::count_if(scene.objects.begin(), scene.objects.end(), [](const ir::Object& object) {
            return std::holds_alternative<Shape>(object.shape);
        });
    };
    return !scene.meshes.empty() || count(runtime::Implicit<double>{}) > 0 ||
           count(runtime::Triangle<double>{}) > 1;
}

/// The extent to which a scene is scaled.
double wanted_size(const ir::Scene& scene) {
    const bool lets_light_through =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const ir::Material& material) { return lets_through(material.phong); });
    return lets_light_through ? comfortable_glass_size
           : has_folds(scene) ? comfortable_mesh_size
                              : comfortable_size;
}

} // namespace

PovFrame choose_frame(const ir::Scene& scene) {
    PovFrame frame;
    const Extent extent = extent_of(scene);
    if (!extent.is_usable()) {
        return frame;
    }
    const double wanted = wanted_size(scene);
    const double smallest = wanted > comfortable_size ? wanted / 2 : 1;
    if (extent.size < smallest || extent.size > 1000) {
        frame.scale = nearest_power_of_two(wanted / extent.size);
    }
    const double distance = length(extent.center);
    if (distance > 10 * extent.size && distance * frame.scale > 1e4) {
        frame.origin = extent.round_center();
    }
    return frame;
}

double mesh_scale(const ir::Mesh& mesh) {
    const double size = mesh.box.min.x <= mesh.box.max.x ? length(mesh.box.max - mesh.box.min) : 0;
    return size > 0 && (size < 0.1 || size > 1e4) ? nearest_power_of_two(comfortable_size / size) : 1;
}

Placement place(const ir::Object& object, const ir::Scene& scene, const PovFrame& frame) {
    Placement placement;
    const double total = frame.scale * magnification(object.world_from_object);
    if (const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape)) {
        placement.shape_scale = mesh_scale(scene.meshes[mesh->mesh]);
    } else if (frame.scale != 1 || total < 1e-3 || total > 1e3) {
        placement.shape_scale = nearest_power_of_two(total);
    }
    const Vec3<double> moved = frame.point(translation_of(object.world_from_object));
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            placement.transform.m[row][column] =
                object.world_from_object.m[row][column] * (frame.scale / placement.shape_scale);
        }
    }
    placement.transform.m[0][3] = moved.x;
    placement.transform.m[1][3] = moved.y;
    placement.transform.m[2][3] = moved.z;
    return placement;
}

InputRanges input_ranges(const ir::Object& object, const ir::Scene& scene) {
    InputRanges ranges;
    const auto set = [&](ir::Input first, const Bounds<double>& b) {
        const auto at = static_cast<std::size_t>(first);
        ranges[at] = {b.min.x, b.max.x};
        ranges[at + 1] = {b.min.y, b.max.y};
        ranges[at + 2] = {b.min.z, b.max.z};
    };
    if (const auto bounds = object_bounds(object.shape, scene)) {
        set(ir::Input::p_x, *bounds);
        set(ir::Input::world_x, transform_bounds(object.world_from_object, *bounds));
    }
    set(ir::Input::n_x, {{-1, -1, -1}, {1, 1, 1}});
    if (const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape)) {
        const std::span<const float> uvs = scene.meshes[mesh->mesh].uvs;
        for (const ir::Input input : {ir::Input::uv_x, ir::Input::uv_y}) {
            // Between the corners it is interpolated.
            Range range{0, 0};
            for (std::size_t i = input == ir::Input::uv_x ? 0 : 1; i < uvs.size(); i += 2) {
                const double value = uvs[i];
                range = i < 2 ? Range{value, value}
                              : Range{std::min(range.min, value), std::max(range.max, value)};
            }
            ranges[static_cast<std::size_t>(input)] = range;
        }
    }
    return ranges;
}

} // namespace scc::compiler
