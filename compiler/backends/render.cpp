#include "compiler/backends/render.h"

#include "compiler/backends/kernels.h"
#include "compiler/backends/tables.h"
#include "compiler/ir/traits.h"
#include "runtime/accel/build.h"

#include <chrono>
#include <memory>

namespace scc::compiler {

namespace {

template <class R>
runtime::FunctionProgram<R> program_of(const ir::Function& function) {
    runtime::FunctionProgram<R> program;
    for (const ir::Node& node : function.nodes) {
        runtime::Instruction<R> instruction;
        switch (node.kind) {
        case ir::Node::Kind::constant:
            instruction.code = runtime::Opcode::constant;
            instruction.constant = static_cast<R>(node.constant);
            break;
        case ir::Node::Kind::input:
            instruction.code = static_cast<runtime::Opcode>(static_cast<int>(runtime::Opcode::p_x) +
                                                            static_cast<int>(node.input));
            break;
        case ir::Node::Kind::apply:
            instruction.code = static_cast<runtime::Opcode>(static_cast<int>(runtime::Opcode::n_z) + 1 +
                                                            static_cast<int>(node.op));
            instruction.operands = node.operands;
            break;
        }
        program.instructions.push_back(instruction);
    }
    program.results = function.results;
    return program;
}

// A scene together with the meshes that its tables point into.
template <class R>
struct OwnedScene {
    runtime::DynamicScene<R> scene;
    std::vector<runtime::MeshStorage> meshes;
};

template <class R>
std::shared_ptr<const OwnedScene<R>> build(const ir::Scene& scene) {
    auto owned = std::make_shared<OwnedScene<R>>();
    runtime::DynamicScene<R>& out = owned->scene;
    for (const ir::Mesh& mesh : scene.meshes) {
        owned->meshes.push_back(
            runtime::build_mesh(mesh.positions, mesh.indices, mesh.normals, mesh.normal_indices));
    }
    for (const runtime::MeshStorage& mesh : owned->meshes) {
        out.meshes.push_back(mesh.data());
    }
    for_each_primitive<R>(scene, [&](const auto& primitive) { out.add(primitive); });
    out.materials = materials_of<R>(scene);
    out.point_lights = lights_of<runtime::PointLight, R>(scene);
    out.directional_lights = lights_of<runtime::DirectionalLight, R>(scene);
    for (const ir::Function& function : scene.functions) {
        out.functions.push_back(program_of<R>(function));
    }
    out.camera = convert(scene.camera, R{});
    out.ambient = convert(scene.ambient, R{});
    out.background = convert(scene.background, R{});
    prepare(out);
    return owned;
}

template <class R>
void set_renderer(host::Drawable& drawable, const ir::Scene& scene, const KernelSet& kernels) {
    drawable.render = [owned = build<R>(scene), kernel = kernels.of(R{})](
                          const runtime::RenderRequest& request, runtime::Image& image) {
        runtime::RenderResult result;
        kernel(owned->scene, request, image, result);
        return result;
    };
}

} // namespace

host::Drawable make_drawable(const ir::Scene& scene, Precision precision) {
    const KernelSet kernels = choose_kernels();
    host::Drawable drawable{.scene = scene.name,
                            .precision = name_of(precision),
                            .isa = kernels.isa,
                            .features = ir::feature_names(scene.traits),
                            .settings = scene.settings,
                            .times_ms = {},
                            .render = {}};
    const auto start = std::chrono::steady_clock::now();
    if (precision == Precision::single) {
        set_renderer<float>(drawable, scene, kernels);
    } else {
        set_renderer<double>(drawable, scene, kernels);
    }
    const std::chrono::duration<double, std::milli> gone = std::chrono::steady_clock::now() - start;
    drawable.times_ms.emplace_back("accel", gone.count());
    return drawable;
}

} // namespace scc::compiler
