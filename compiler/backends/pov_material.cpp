#include "compiler/backends/pov_material.h"

#include "compiler/backends/pov_frame.h"
#include "compiler/backends/pov_shape.h"
#include "compiler/ir/objects.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

namespace scc::compiler {

using runtime::Affine;

namespace {

/// Reflectances and emissions are colours that one can see; exponents grow further.
constexpr double largest_color = 8;
constexpr double largest_shininess = 1e5;
constexpr std::string_view uv_and_point =
    "POV-Ray maps a texture by uv or by the point, and this material reads both";
/// Values of heights beyond are cut where they have no bounds.
constexpr double largest_height = 1000;
/// The differences that POV-Ray's normals are made of, in its units. Their own
/// error grows with it, while that of rounding falls, which was measured to be at most 9e-10 of the heights'
/// range over the difference.
constexpr double bump_delta = 6.4e-6;
constexpr double bump_rounding = 1e-9;
/// Stands for one that POV-Ray cannot calculate.
constexpr double usual_shininess = 32;

void include(InputRanges& all, const InputRanges& more) {
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = {std::min(all[i].min, more[i].min), std::max(all[i].max, more[i].max)};
    }
}

bool bends_sharply(const ir::Function& height) {
    return std::any_of(height.nodes.begin(), height.nodes.end(), [](const ir::Node& node) {
        return node.kind == ir::Node::Kind::image ||
               (node.kind == ir::Node::Kind::apply &&
                (node.op == ir::Op::noise || node.op == ir::Op::random));
    });
}

} // namespace

PovMaterials::PovMaterials(const ir::Scene& scene, double scale, ExportFiles& files, Writer& functions,
                           Writer& textures, Ledger& ledger)
    : scene_(scene), scale_(scale), functions_(scene.functions, files, functions), textures_(textures),
      ledger_(ledger), ranges_(scene.materials.size()), noted_(scene.materials.size()) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    for (InputRanges& ranges : ranges_) {
        ranges.fill({inf, -inf});
    }
    ir::for_each_surface(scene, [&](const ir::Object& object) {
        const InputRanges ranges = input_ranges(object, scene);
        include(ranges_[object.sides.front], ranges);
        include(ranges_[object.sides.back], ranges);
        for (const std::uint32_t material : {object.sides.front, object.sides.back}) {
            for (const std::int32_t function : ir::functions_of(scene.materials[material].phong)) {
                if (function != runtime::no_function) {
                    functions_.cover(function, ranges);
                }
            }
        }
        if (const auto* implicit = std::get_if<runtime::Implicit<double>>(&object.shape)) {
            const runtime::Bounds<double> box = pov_field_box(implicit->within);
            InputRanges inputs;
            inputs[0] = {box.min.x, box.max.x};
            inputs[1] = {box.min.y, box.max.y};
            inputs[2] = {box.min.z, box.max.z};
            functions_.cover(implicit->field, inputs);
        }
    });
}

PovMaterials::Use PovMaterials::use(std::uint32_t material, const ir::Object& object) {
    const bool in_world = ir::material_reads(scene_, material, ir::Input::world_x, ir::Input::world_z);
    const bool in_object = ir::material_reads(scene_, material, ir::Input::p_x, ir::Input::p_z);
    const std::string& name = scene_.materials[material].name;
    if (in_world && in_object && !(object.world_from_object == Affine<double>{})) {
        return declare(material, fmt::format("{}_of_{}", name, object.path), &object.world_from_object);
    }
    const auto [entry, is_new] = shared_.try_emplace(material);
    if (is_new) {
        entry->second = declare(material, name, nullptr);
        entry->second.in_world = in_world && !in_object;
    }
    return entry->second;
}

PovMaterials::Use PovMaterials::declare(std::uint32_t material, const std::string& name,
                                        const Affine<double>* world_from_object) {
    const runtime::Phong<double>& phong = scene_.materials[material].phong;
    PaintedPhong painted;
    painted.ambient = color(phong.ambient, "ambient", material, world_from_object);
    painted.diffuse = color(phong.diffuse, "diffuse", material, world_from_object);
    painted.specular = color(phong.specular, "specular", material, world_from_object);
    painted.emission = color(phong.emission, "emission", material, world_from_object);
    painted.reflect = color(phong.reflect, "reflect", material, world_from_object);
    painted.transmit = color(phong.transmit, "transmit", material, world_from_object);
    painted.fresnel = phong.fresnel;
    painted.shininess = shininess(phong.shininess, material, world_from_object);
    if (phong.bump != runtime::no_function) {
        painted.normal = normal(phong.bump, material, world_from_object);
    }
    if (!has_writable_highlight(painted)) {
        painted.specular = {};
        note(material, "phong specular",
             {Fidelity::dropped, "POV-Ray has no coloured highlight on a surface whose transparency varies"});
    }
    Outcome varying_shininess;
    Use use{textures_.declare(name, painted, varying_shininess)};
    use.varies = ir::material_reads(scene_, material, ir::Input::p_x, ir::Input::world_z);
    use.by_uv = !use.varies && ir::material_reads(scene_, material, ir::Input::uv_x, ir::Input::uv_y);
    if (varying_shininess.fidelity != Fidelity::exact) {
        note(material, "phong shininess", varying_shininess);
    }
    note(material, phong.fresnel ? "glass" : "phong", {Fidelity::exact, "texture", 0});
    noted_[material] = true;
    return use;
}

Paint PovMaterials::color(const runtime::Varying<runtime::Rgb<double>>& value, std::string_view field,
                          std::uint32_t material, const Affine<double>* world_from_object) {
    if (value.function == runtime::no_function) {
        return {value.value, {}, false, runtime::no_function};
    }
    return paint(value.function, field, material, largest_color, world_from_object).first;
}

Paint PovMaterials::shininess(const runtime::Varying<double>& value, std::uint32_t material,
                              const Affine<double>* world_from_object) {
    double constant = value.value;
    if (value.function != runtime::no_function) {
        auto [result, fidelity] =
            paint(value.function, "shininess", material, largest_shininess, world_from_object);
        if (fidelity != Fidelity::dropped) {
            return result;
        }
        constant = usual_shininess;
    }
    return {{constant, constant, constant}, {}, false, runtime::no_function};
}

/// POV-Ray subtracts 5 a (0.02 / delta) times the sum of h(p + delta v) v over the corners v of a regular
/// tetrahedron: 2/15 a times the gradient of h. Without no_bump_scale it would do so to normals of unit
/// length in the object's space, and not to what the object's transform makes of the world's. Its world is
/// `scale_` times as large, and so are heights.
std::string PovMaterials::normal(std::int32_t bump, std::uint32_t material,
                                 const Affine<double>* world_from_object) {
    auto [height, outcome] =
        functions_.scaled_number(bump, {ranges_[material], largest_height, world_from_object, {}});
    const double range = height.high - height.low, delta = bump_delta / scale_;
    const bool dropped = outcome.fidelity == Fidelity::dropped;
    if (dropped) {
        outcome.how = "the surface stays smooth: " + outcome.how;
    } else {
        const bool bends = bends_sharply(scene_.functions[static_cast<std::size_t>(bump)]);
        outcome.fidelity = Fidelity::approximated;
        outcome.how =
            fmt::format("normals from differences over {}, {}; {}", number(delta),
                        bends ? "coarse where an image or noise bends within it, bound in radiance at "
                                "such pixels"
                              : "bound of their rounding",
                        outcome.how);
        outcome.bound = bends ? 1 : std::max(outcome.bound, bump_rounding * range / delta);
        outcome.is_differenced = bends;
    }
    outcome.how =
        fmt::format("function `{}`: {}", scene_.functions[static_cast<std::size_t>(bump)].name, outcome.how);
    note(material, "phong bump", outcome);
    return dropped ? ""
                   : fmt::format("normal {{ function {{ {} }} {} accuracy {} no_bump_scale }}", height.t,
                                 number(7.5 * range * scale_), number(delta));
}

std::pair<Paint, Fidelity> PovMaterials::paint(std::int32_t function, std::string_view field,
                                               std::uint32_t material, double largest,
                                               const Affine<double>* world_from_object) {
    const bool reads_point = ir::material_reads(scene_, material, ir::Input::p_x, ir::Input::world_z);
    auto [result, outcome] = functions_.paint(
        function, {ranges_[material], largest, world_from_object, reads_point ? uv_and_point : ""});
    outcome.how = fmt::format("function `{}`: {}", scene_.functions[static_cast<std::size_t>(function)].name,
                              outcome.how);
    note(material, fmt::format("phong {}", field), outcome);
    return {std::move(result), outcome.fidelity};
}

void PovMaterials::note(std::uint32_t material, std::string_view feature, const Outcome& outcome) {
    if (!noted_[material]) {
        const ir::Material& m = scene_.materials[material];
        ledger_.push_back(
            {outcome.fidelity, std::string(feature), m.name, m.span, outcome.how, outcome.bound});
        ledger_.back().is_differenced = outcome.is_differenced;
    }
}

} // namespace scc::compiler
