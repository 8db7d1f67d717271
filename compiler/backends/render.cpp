#include "compiler/backends/render.h"

#include "compiler/backends/tables.h"
#include "compiler/ir/traits.h"
#include "compiler/mesh_cache.h"
#include "runtime/host/program.h"
#include "runtime/render.h"

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
    std::vector<BuiltMesh> meshes;
};

template <class R>
std::shared_ptr<const OwnedScene<R>> build(const ir::Scene& scene, const runtime::BuildOptions& options) {
    auto owned = std::make_shared<OwnedScene<R>>();
    runtime::DynamicScene<R>& out = owned->scene;
    for (const ir::Mesh& mesh : scene.meshes) {
        owned->meshes.push_back(build_mesh(mesh, options));
        out.meshes.push_back(owned->meshes.back().data);
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
    prepare(out, options);
    return owned;
}

template <class R>
void set_renderer(host::Drawable& drawable, const ir::Scene& scene, const runtime::BuildOptions& options) {
    drawable.render = [owned = build<R>(scene, options)](const runtime::RenderRequest& request,
                                                         runtime::Image& image) {
        return runtime::render(owned->scene, request, image);
    };
}

} // namespace

host::Drawable make_drawable(const ir::Scene& scene, Precision precision,
                             const runtime::BuildOptions& build) {
    host::Drawable drawable{.scene = scene.name,
                            .precision = name_of(precision),
                            .isa = host::compiled_isa,
                            .features = ir::feature_names(scene.traits),
                            .settings = scene.settings,
                            .times_ms = {},
                            .render = {}};
    const auto start = std::chrono::steady_clock::now();
    if (precision == Precision::single) {
        set_renderer<float>(drawable, scene, build);
    } else {
        set_renderer<double>(drawable, scene, build);
    }
    const std::chrono::duration<double, std::milli> gone = std::chrono::steady_clock::now() - start;
    drawable.times_ms.emplace_back("accel", gone.count());
    return drawable;
}

} // namespace scc::compiler
