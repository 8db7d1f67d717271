#include "compiler/scene_checks.h"

#include "compiler/bounds.h"
#include "compiler/values.h"
#include "lang/schema.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace scc::compiler {

namespace {

using lang::Diag;
using runtime::Vec3;

/// What graphics hardware and our raster mode keep of a depth, at the least.
constexpr double depth_steps = 1 << 24;
/// Float has 24 bits; below this many steps across an object its shape shows them.
constexpr double float_steps = 1 << 24;
constexpr double fewest_steps = 1000;

double largest_coordinate(const Vec3<double>& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// The largest distance in front of the camera of anything drawn, at most `far`.
double farthest_depth(const ir::Scene& scene) {
    double farthest = 0;
    for (const ir::Object& object : scene.objects) {
        const auto own = object_bounds(object.shape, scene);
        if (!own) {
            return scene.far;
        }
        const runtime::Bounds<double> box = transform_bounds(object.world_from_object, *own);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3<double> p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                 corner & 4 ? box.max.z : box.min.z};
            farthest = std::max(farthest, dot(scene.camera.eye - p, scene.camera.n));
        }
    }
    return std::min(farthest, scene.far);
}

/// Where the author chose the range of depths; else the camera.
lang::Span depth_range_span(const lang::Module& module, lang::Span camera) {
    for (const lang::ThingPtr& thing : module.items) {
        if (thing->span != camera) {
            continue;
        }
        for (const char* field : {"near", "far"}) {
            if (const lang::FieldValue* value = thing->find(field)) {
                return value->value_span;
            }
        }
    }
    return camera;
}

/// L4: at the depth d the pseudodepth changes by 2 far near / ((far - near) d^2) per unit of depth, and -1..1
/// is divided into depth_steps.
void check_depth(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    const double near = scene.near;
    const double far = scene.far;
    const double depth = farthest_depth(scene);
    if (scene.camera.projection != runtime::Projection::perspective || !(depth > near)) {
        return;
    }
    const double resolved = depth * depth * (far - near) / (far * near * depth_steps);
    const double pixel = 2 * scene.camera.half_height * depth / scene.settings.height;
    if (resolved > pixel) {
        const double enough =
            depth * (1 - near / far) * scene.settings.height / (2 * scene.camera.half_height * depth_steps);
        diagnostics.report(Diag::depth_precision, depth_range_span(module, scene.camera_span),
                           fmt::format("{:.6g}", near), fmt::format("{:.4g}", depth),
                           fmt::format("{:.2g}", resolved), fmt::format("{:.2g}", pixel),
                           fmt::format("{:.1g}", 2 * enough));
    }
}

/// The place that many objects of a loop share is reported once.
void check_distance(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    struct Far {
        std::size_t count = 0;
        std::string path;
        double steps = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Far> found;
    std::map<std::pair<std::uint32_t, std::uint32_t>, lang::Span> spans;
    for (const ir::Object& object : scene.objects) {
        const auto own = object_bounds(object.shape, scene);
        if (!own) {
            continue;
        }
        const runtime::Bounds<double> box = transform_bounds(object.world_from_object, *own);
        const double away = std::max(largest_coordinate(box.min), largest_coordinate(box.max));
        const Vec3<double> extent = box.max - box.min;
        const double steps = float_steps * std::max({extent.x, extent.y, extent.z}) / away;
        if (steps >= fewest_steps || !(away > 0)) {
            continue;
        }
        const std::pair key{object.span.file, object.span.begin};
        Far& far = found[key];
        spans[key] = object.span;
        if (far.count++ == 0) {
            far.path = object.path;
            far.steps = steps;
        }
    }
    for (const auto& [key, far] : found) {
        lang::Diagnostic& diagnostic =
            diagnostics.report(Diag::far_from_origin, spans[key], far.path, fmt::format("{:.3g}", far.steps));
        if (far.count > 1) {
            diagnostic.note(spans[key], fmt::format("the first of {} such objects", far.count));
        }
    }
}

} // namespace

void check_scene(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    check_depth(module, scene, diagnostics);
    check_distance(scene, diagnostics);
}

} // namespace scc::compiler
