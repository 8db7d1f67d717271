#include "compiler/cli/layer_scene.h"

#include "compiler/function_builder.h"
#include "compiler/ir/objects.h"
#include "compiler/passes/passes.h"

#include <fmt/core.h>

#include <array>
#include <variant>

namespace scc::cli {

namespace {

namespace ir = compiler::ir;

/// Nothing lights it but what is added; its materials are still to be painted.
ir::Scene unlit(const ir::Scene& scene) {
    ir::Scene result = scene;
    result.lights.clear();
    result.ambient = {};
    result.background = {};
    result.bands.clear();
    for (ir::Material& material : result.materials) {
        material.bands.clear();
    }
    result.camera.lens_radius = 0;
    result.settings = with_plain_grid(result.settings);
    result.settings.samples = 1;
    result.settings.shadows = false;
    return result;
}

ir::Scene finished(ir::Scene scene) {
    compiler::drop_unused(scene);
    compiler::derive_traits(scene);
    return scene;
}

runtime::Phong<double> black() {
    runtime::Phong<double> phong;
    phong.shininess.value = 1;
    return phong;
}

/// (world - low) / (high - low) per coordinate, within 0..1.
ir::Function position_function(const PositionRange& range) {
    constexpr std::array inputs{ir::Input::world_x, ir::Input::world_y, ir::Input::world_z};
    const std::array<double, 3> low{range.low.x, range.low.y, range.low.z};
    const std::array<double, 3> high{range.high.x, range.high.y, range.high.z};
    compiler::FunctionBuilder builder;
    std::vector<lang::Scalar> results;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t above =
            builder.apply("sub", {builder.input(ir::name(inputs[i])), builder.constant(low[i])});
        const std::uint32_t part = builder.apply("mul", {above, builder.constant(1 / (high[i] - low[i]))});
        const std::uint32_t least = builder.apply("max", {part, builder.constant(0)});
        results.push_back({0, builder.apply("min", {least, builder.constant(1)})});
    }
    ir::Function function = builder.finish(results);
    function.name = "position";
    return function;
}

} // namespace

ir::Scene position_scene(const ir::Scene& scene, const PositionRange& range) {
    ir::Scene result = unlit(scene);
    result.functions.push_back(position_function(range));
    for (ir::Material& material : result.materials) {
        material.phong = black();
        material.phong.emission.function = static_cast<std::int32_t>(result.functions.size() - 1);
    }
    return finished(std::move(result));
}

ir::Scene normal_scene(const ir::Scene& scene, int sign) {
    ir::Scene result = unlit(scene);
    for (ir::Material& material : result.materials) {
        material.phong = black();
        material.phong.diffuse.value = {1, 1, 1};
    }
    const double s = sign;
    const std::array<std::pair<runtime::Vec3<double>, runtime::Rgb<double>>, 3> axes{
        {{{s, 0, 0}, {1, 0, 0}}, {{0, s, 0}, {0, 1, 0}}, {{0, 0, s}, {0, 0, 1}}}};
    for (const auto& [to_light, color] : axes) {
        ir::Light light;
        light.light = runtime::DirectionalLight<double>{to_light, color, {}};
        light.name = fmt::format("axis {}", result.lights.size() + 1);
        result.lights.push_back(std::move(light));
    }
    return finished(std::move(result));
}

ir::Scene object_scene(const ir::Scene& scene) {
    ir::Scene result = unlit(scene);
    result.materials.clear();
    const auto paint = [&](std::size_t number) {
        const double value = static_cast<double>(number + 1) / object_scale;
        ir::Material material;
        material.name = fmt::format("object {}", number + 1);
        material.phong = black();
        material.phong.emission.value = {value, value, value};
        result.materials.push_back(std::move(material));
        const auto index = static_cast<std::uint32_t>(result.materials.size() - 1);
        return runtime::Sides{index, index};
    };
    std::size_t number = 0;
    ir::for_each_piece(
        result,
        [&](ir::Object& object) {
            object.sides = paint(number++);
            if (const auto* solid = std::get_if<runtime::Csg<double>>(&object.shape)) {
                ir::for_each_csg_node(result, *solid, [&](const ir::CsgNode& node) {
                    if (node.op == runtime::CsgOp::member) {
                        result.members[node.member].sides = object.sides;
                        ++number; // members have numbers of their own, which no ray tells
                    }
                });
            }
        },
        [&](ir::ObjectArray& array) {
            for (ir::ObjectColumn& column : array.columns) {
                column.sides.clear();
            }
            for (std::size_t round = 0; round < array.rounds; ++round) {
                for (ir::ObjectColumn& column : array.columns) {
                    column.sides.push_back(paint(number++));
                }
            }
        });
    return finished(std::move(result));
}

} // namespace scc::cli
