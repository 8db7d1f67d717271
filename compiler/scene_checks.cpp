#include "compiler/scene_checks.h"

#include "compiler/beyond_double.h"
#include "compiler/coincident_faces.h"
#include "compiler/depth_checks.h"
#include "compiler/ir/objects.h"
#include "compiler/object_boxes.h"
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

/// Float has 24 bits; below this many steps across an object its shape shows them.
constexpr double float_steps = 1 << 24;
constexpr double fewest_steps = 1000;

double largest_coordinate(const Vec3<double>& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
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

void check_double(const ir::Scene& scene, lang::Diagnostics& diagnostics) {
    if (diagnostics.has_errors()) {
        return; // the camera may not be what is meant
    }
    if (const auto found = beyond_double(scene)) {
        diagnostics.report(Diag::beyond_double, found->span, found->path, fmt::format("{:.2g}", found->away),
                           fmt::format("{:.2g}", found->steps));
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
    check_double(scene, diagnostics);
    check_raster(scene, diagnostics);
    check_coincident_faces(scene, diagnostics);
    check_bodies(scene, diagnostics);
    check_openings(scene, diagnostics);
}

} // namespace scc::compiler
