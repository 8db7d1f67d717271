#include "compiler/depth_checks.h"

#include "compiler/flat_faces.h"
#include "compiler/object_boxes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace scc::compiler {

namespace {

using lang::Diag;
using runtime::Vec3;

/// What graphics hardware and our raster mode keep of a depth, at the least.
constexpr double depth_steps = 1 << 24;

/// L4: at the depth d the pseudodepth changes by 2 far near / ((far - near) d^2) per unit of depth, and -1..1
/// is divided into depth_steps.
double resolved_at(const runtime::Camera<double>& camera, double d) {
    return d * d * (camera.far - camera.near) / (camera.far * camera.near * depth_steps);
}

/// The largest distance in front of the camera of anything drawn, at most `far`.
double farthest_depth(const ir::Scene& scene) {
    double farthest = 0;
    for_each_box(scene, [&](const std::optional<Box>& bounds, const auto&, const auto&) {
        if (!bounds) {
            farthest = scene.camera.far;
            return;
        }
        const Box& box = *bounds;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3<double> p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                 corner & 4 ? box.max.z : box.min.z};
            farthest = std::max(farthest, dot(scene.camera.eye - p, scene.camera.n));
        }
    });
    return std::min(farthest, scene.camera.far);
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

void check_pixel_width(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    const double near = scene.camera.near;
    const double far = scene.camera.far;
    const auto pixel_at = [&](double d) { return 2 * scene.camera.half_height * d / scene.settings.height; };
    if (resolved_at(scene.camera, far) <= pixel_at(far)) {
        return; // at smaller depths it is better still, whatever there is
    }
    const double depth = farthest_depth(scene);
    const double resolved = resolved_at(scene.camera, depth), pixel = pixel_at(depth);
    if (!(depth > near)) {
        return;
    }
    if (resolved > pixel) {
        const double enough =
            depth * (1 - near / far) * scene.settings.height / (2 * scene.camera.half_height * depth_steps);
        diagnostics.report(Diag::depth_precision, depth_range_span(module, scene.camera_span),
                           fmt::format("{:.6g}", near), fmt::format("{:.4g}", depth),
                           fmt::format("{:.2g}", resolved), fmt::format("{:.2g}", pixel),
                           fmt::format("{:.1g}", 2 * enough));
    }
}

struct Face : FlatFace {
    const ir::Object* object;
};

/// Pairs are compared, so that scenes with more are not looked at.
constexpr std::size_t most_faces = 2000;

/// Of single objects outside of loops' tables: a table's are alike, and far apart compared to their size.
std::vector<Face> faces_of(const ir::Scene& scene) {
    std::vector<Face> faces;
    for (const ir::Object& object : scene.objects) {
        std::visit(
            [&](const auto& shape) {
                for_each_flat_face(shape, object.world_from_object, [&](const FlatFace& face) {
                    faces.push_back({face, &object});
                });
            },
            object.shape);
        if (faces.size() > most_faces) {
            return {};
        }
    }
    return faces;
}

/// Two faces, one before the other, and the place where the buffer tells them apart least.
struct Gap {
    const Face *one, *other;
    double depth;   ///< in front of the camera
    double between; ///< in depth there
};

/// Where one face, moved into the other's plane, overlaps it in more than an edge.
std::optional<Box> common_box(const Face& one, const Face& other, double distance) {
    const Vec3<double> move = one.normal * distance;
    const Box box{maximum(one.box.min + move, other.box.min), minimum(one.box.max + move, other.box.max)};
    const Vec3<double> size = box.max - box.min;
    const double slack = 1e-9 * std::max({1.0, std::abs(one.offset), std::abs(distance)});
    const auto is_at_least = [&](double least) {
        return (size.x >= least ? 1 : 0) + (size.y >= least ? 1 : 0) + (size.z >= least ? 1 : 0);
    };
    return is_at_least(-slack) == 3 && is_at_least(slack) >= 2 ? std::optional(box) : std::nullopt;
}

/// At the farthest corner of the place that both faces have before them. Along a ray the planes are farther
/// apart than along their normal.
std::optional<Gap> gap_between(const runtime::Camera<double>& camera, const Face& one, const Face& other) {
    const double cosine = dot(one.normal, other.normal);
    if (std::abs(cosine) < 1 - 1e-9) {
        return std::nullopt;
    }
    const double distance = (cosine > 0 ? other.offset : -other.offset) - one.offset;
    constexpr double rounding = 5e-16; // two of double's, of one coordinate each
    if (std::abs(distance) <= rounding * std::max(1.0, std::abs(one.offset))) {
        return std::nullopt; // one plane: no depths tell what is meant
    }
    const std::optional<Box> box = common_box(one, other, distance);
    if (!box) {
        return std::nullopt;
    }
    std::optional<Gap> farthest;
    for (int i = 0; i < 8; ++i) {
        const Vec3<double> corner{(i & 1) != 0 ? box->max.x : box->min.x,
                                  (i & 2) != 0 ? box->max.y : box->min.y,
                                  (i & 4) != 0 ? box->max.z : box->min.z};
        const double depth = dot(camera.eye - corner, camera.n);
        const double along = std::abs(dot(one.normal, corner - camera.eye)); // of the ray whose depth is 1
        if (depth > camera.near && depth <= camera.far && along > 0 &&
            (!farthest || depth > farthest->depth)) {
            farthest = Gap{&one, &other, depth, std::abs(distance) * depth / along};
        }
    }
    return farthest;
}

/// The gap that is smallest compared to what is told apart there.
void check_gaps(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    const runtime::Camera<double>& camera = scene.camera;
    const std::vector<Face> faces = faces_of(scene);
    const auto share = [&](const Gap& gap) { return gap.between / resolved_at(camera, gap.depth); };
    std::optional<Gap> worst;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t k = i + 1; k < faces.size(); ++k) {
            if (faces[i].object != faces[k].object) {
                const std::optional<Gap> gap = gap_between(camera, faces[i], faces[k]);
                if (gap && (!worst || share(*gap) < share(*worst))) {
                    worst = gap;
                }
            }
        }
    }
    if (!worst || share(*worst) >= 1) {
        return;
    }
    const double enough = 1 / (worst->between * depth_steps / (worst->depth * worst->depth) + 1 / camera.far);
    diagnostics
        .report(Diag::depth_gap, depth_range_span(module, scene.camera_span),
                fmt::format("{:.6g}", camera.near), fmt::format("{:.6g}", camera.far),
                fmt::format("{:.4g}", worst->depth), fmt::format("{:.2g}", resolved_at(camera, worst->depth)),
                worst->one->object->path, worst->other->object->path, fmt::format("{:.2g}", worst->between),
                fmt::format("{:.1g}", 2 * enough))
        .note(worst->other->object->span, "this one would flicker through");
}

} // namespace

void check_depth(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    if (scene.camera.projection != runtime::Projection::perspective) {
        return;
    }
    check_pixel_width(module, scene, diagnostics);
    if (scene.settings.method == runtime::Method::raster) {
        check_gaps(module, scene, diagnostics);
    }
}

} // namespace scc::compiler
