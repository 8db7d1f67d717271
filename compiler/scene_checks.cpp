#include "compiler/scene_checks.h"

#include "compiler/bounds.h"
#include "compiler/coincident_faces.h"
#include "compiler/ir/objects.h"
#include "compiler/shape_rules.h"
#include "compiler/values.h"
#include "lang/schema.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

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

using Box = runtime::Bounds<double>;

/// f(box, span, path) for every object, the box in world space and none for an unbounded shape; span() and
/// path() are made where they are asked for, since of millions few are.
template <class F>
void for_each_box(const ir::Scene& scene, F f) {
    const auto box = [&](const auto& shape, const runtime::Affine<double>& place) {
        const std::optional<Box> own = object_bounds(shape, scene);
        return own && place != runtime::Affine<double>{} ? transform_bounds(place, *own) : own;
    };
    ir::for_each_piece(
        scene,
        [&](const ir::Object& object) {
            f(
                box(object.shape, object.world_from_object), [&] { return object.span; },
                [&] { return object.path; });
        },
        [&](const ir::ObjectArray& array) {
            for (const ir::ObjectColumn& column : array.columns) {
                std::visit(
                    [&](const auto& shapes) {
                        for (std::size_t round = 0; round < array.rounds; ++round) {
                            f(
                                box(shapes[round], column.world_from_object),
                                [&] { return column.span_of(round); }, [&] { return column.path_of(round); });
                        }
                    },
                    column.shapes);
            }
        });
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

/// L4: at the depth d the pseudodepth changes by 2 far near / ((far - near) d^2) per unit of depth, and -1..1
/// is divided into depth_steps.
void check_depth(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    const double near = scene.camera.near;
    const double far = scene.camera.far;
    const auto resolved_at = [&](double d) { return d * d * (far - near) / (far * near * depth_steps); };
    const auto pixel_at = [&](double d) { return 2 * scene.camera.half_height * d / scene.settings.height; };
    if (scene.camera.projection != runtime::Projection::perspective || resolved_at(far) <= pixel_at(far)) {
        return; // at smaller depths it is better still, whatever there is
    }
    const double depth = farthest_depth(scene);
    const double resolved = resolved_at(depth), pixel = pixel_at(depth);
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

/// Why raster mode has no triangles for a shape; empty: it has.
std::string obstacle_to_raster(const ir::Scene& scene, const ir::Shape& shape) {
    if (std::holds_alternative<runtime::Quadric<double>>(shape) && !object_bounds(shape, scene)) {
        return "a quadric has bounds only by `within`";
    }
    std::string obstacle;
    if (const auto* solid = std::get_if<runtime::Csg<double>>(&shape)) {
        ir::for_each_csg_node(scene, *solid, [&](const ir::CsgNode& node) {
            if (node.op == runtime::CsgOp::member && obstacle.empty()) {
                const ir::Shape& member = scene.members[node.member].shape;
                obstacle = std::holds_alternative<runtime::Mesh<double>>(member)
                               ? "there is a mesh in it"
                               : obstacle_to_raster(scene, member);
            }
        });
    }
    return obstacle;
}

void check_raster(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    if (scene.settings.method != runtime::Method::raster) {
        return;
    }
    for (const ir::Object& object : scene.objects) {
        if (const std::string obstacle = obstacle_to_raster(scene, object.shape); !obstacle.empty()) {
            diagnostics.report(Diag::raster_left_out, object.span, obstacle);
        }
    }
}

/// The place that many objects of a loop share is reported once.
void check_distance(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    struct Far {
        std::size_t count = 0;
        lang::Span span;
        std::string path;
        double steps = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Far> found;
    for_each_box(scene, [&](const std::optional<Box>& box, const auto& span_of, const auto& path_of) {
        if (!box) {
            return;
        }
        const double away = std::max(largest_coordinate(box->min), largest_coordinate(box->max));
        const Vec3<double> extent = box->max - box->min;
        const double steps = float_steps * std::max({extent.x, extent.y, extent.z}) / away;
        if (steps >= fewest_steps || !(away > 0)) {
            return;
        }
        const lang::Span span = span_of();
        const std::pair key{span.file, span.begin};
        Far& far = found[key];
        if (far.count++ == 0) {
            far.span = span;
            far.path = path_of();
            far.steps = steps;
        }
    });
    for (const auto& [key, far] : found) {
        lang::Diagnostic& diagnostic =
            diagnostics.report(Diag::far_from_origin, far.span, far.path, fmt::format("{:.3g}", far.steps));
        if (far.count > 1) {
            diagnostic.note(far.span, fmt::format("the first of {} such objects", far.count));
        }
    }
}

/// Why a shape has no inside, of which it is a boundary. Empty if it has.
std::string opening_of(const ir::Object& object, const ir::Scene& scene) {
    if (std::holds_alternative<runtime::Csg<double>>(object.shape)) {
        return "";
    }
    if (const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape)) {
        const std::string opening = open_part(scene.meshes[mesh->mesh]);
        // To refraction it does not matter whether all triangles face inwards.
        return opening.starts_with("is open") ? opening : "";
    }
    return std::string(open_part(object.shape));
}

/// What bends rays is closed.
void check_openings(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    const auto bends = [&](const runtime::Sides& sides) {
        return refracts(scene.materials[sides.front].phong) || refracts(scene.materials[sides.back].phong);
    };
    const auto check = [&](const ir::Object& object) {
        const std::string opening = bends(object.sides) ? opening_of(object, scene) : "";
        if (!opening.empty()) {
            diagnostics.report(Diag::open_refraction, object.span, object.path, opening);
        }
        return !opening.empty();
    };
    ir::for_each_piece(scene, check, [&](const ir::ObjectArray& array) {
        for (const ir::ObjectColumn& column : array.columns) {
            for (std::size_t round = 0; round < array.rounds; ++round) {
                if (bends(column.sides_of(round)) && check(ir::object_of(column, round))) {
                    break; // the others differ in numbers only
                }
            }
        }
    });
}

/// One index of refraction per body.
void check_bodies(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    if (std::none_of(scene.materials.begin(), scene.materials.end(),
                     [](const ir::Material& m) { return refracts(m.phong); })) {
        return;
    }
    const auto check = [&](const ir::Object& object) {
        const std::vector<double> iors = ir::iors_of(scene, object);
        if (iors.size() > 1) {
            diagnostics.report(Diag::several_iors, object.span, object.path, iors[0], iors[1]);
        }
    };
    ir::for_each_piece(scene, check, [&](const ir::ObjectArray& array) {
        for (const ir::ObjectColumn& column : array.columns) {
            for (std::size_t round = 0; round < column.sides.size(); ++round) {
                if (column.sides[round].front != column.sides[round].back) {
                    check(ir::object_of(column, round));
                }
            }
        }
    });
}

} // namespace

void check_scene(const lang::Module& module, const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    check_depth(module, scene, diagnostics);
    check_distance(scene, diagnostics);
    check_raster(scene, diagnostics);
    check_coincident_faces(scene, diagnostics);
    check_bodies(scene, diagnostics);
    check_openings(scene, diagnostics);
}

} // namespace scc::compiler
