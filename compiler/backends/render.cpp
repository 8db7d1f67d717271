#include "compiler/backends/render.h"

#include "compiler/backends/kernels.h"
#include "compiler/backends/needs_double.h"
#include "compiler/backends/tables.h"
#include "compiler/ir/traits.h"
#include "compiler/mesh_cache.h"
#include "runtime/accel/build.h"
#include "runtime/host/srgb.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
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

using Meshes = std::vector<BuiltMesh>;
using Render = decltype(host::Drawable::render);

std::shared_ptr<const Meshes> build_meshes(const ir::Scene& scene, const runtime::BuildOptions& options) {
    auto meshes = std::make_shared<Meshes>();
    for (const ir::Mesh& mesh : scene.meshes) {
        meshes->push_back(build_mesh(mesh, options));
    }
    return meshes;
}

// A scene together with the meshes that its tables point into, which are the same in both precisions.
template <class R>
struct OwnedScene {
    runtime::DynamicScene<R> scene;
    std::shared_ptr<const Meshes> meshes;
};

template <class R>
std::shared_ptr<const OwnedScene<R>> build(const ir::Scene& scene, std::shared_ptr<const Meshes> meshes,
                                           const runtime::BuildOptions& options) {
    auto owned = std::make_shared<OwnedScene<R>>();
    owned->meshes = std::move(meshes);
    runtime::DynamicScene<R>& out = owned->scene;
    for (const BuiltMesh& mesh : *owned->meshes) {
        out.meshes.push_back(mesh.data);
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
Render make_renderer(const ir::Scene& scene, const std::shared_ptr<const Meshes>& meshes,
                     const KernelSet& kernels, const runtime::BuildOptions& options) {
    return [owned = build<R>(scene, meshes, options),
            kernel = kernels.of(R{})](const runtime::RenderRequest& request, runtime::Image& image) {
        runtime::RenderResult result;
        kernel(owned->scene, request, image, result);
        return result;
    };
}
Render make_renderer(Precision precision, const ir::Scene& scene, const std::shared_ptr<const Meshes>& meshes,
                     const KernelSet& kernels, const runtime::BuildOptions& options) {
    return precision == Precision::single ? make_renderer<float>(scene, meshes, kernels, options)
                                          : make_renderer<double>(scene, meshes, kernels, options);
}

host::Drawable describe(const ir::Scene& scene, const KernelSet& kernels) {
    return {.scene = scene.name,
            .precision = {},
            .precision_reason = {},
            .isa = kernels.isa,
            .features = ir::feature_names(scene.traits),
            .settings = scene.settings,
            .times_ms = {},
            .render = {}};
}

class Stopwatch {
public:
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// In steps of an 8-bit file; infinite for what is no number in both.
double steps_between(float a, float b) {
    constexpr double steps = 255, steepest = 12.92; // of the sRGB encoding, at 0
    const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
    if (difference * steepest * steps < 1e-3) {
        return difference * steepest * steps; // most are, and need no power
    }
    if (!std::isfinite(a) || !std::isfinite(b)) {
        return std::numeric_limits<double>::infinity();
    }
    return steps * std::abs(host::encode_srgb(a) - host::encode_srgb(b));
}

/// Where both precisions see the same surface, float is about 1e-4 steps off. Where edges, reflections or a
/// loss of digits make it more, that covers too much of a picture as soon as one sample of the trials meets
/// it.
constexpr double most_steps = 1.0 / 32; // an eighth of what may be lost
/// First a rough trial, which is enough to see that many scenes need double: one sample of so many.
constexpr int trial_parts[] = {1000, 200};
constexpr double fewest_trial_samples = 250, most_trial_samples = 5000;
/// Below, a trial costs more than float saves.
constexpr double worth_a_trial = 200 * fewest_trial_samples;

double samples_of(const runtime::RenderSettings& settings) {
    return static_cast<double>(settings.width) * settings.height * settings.samples_per_axis *
           settings.samples_per_axis;
}

double trial_samples_of(const runtime::RenderSettings& settings, int part) {
    return std::clamp(samples_of(settings) / part, fewest_trial_samples, most_trial_samples);
}

/// The whole view with few samples.
std::vector<runtime::RenderRequest> sparse_trial(const runtime::RenderSettings& settings, int part) {
    const double samples = trial_samples_of(settings, part);
    const double scale = std::sqrt(samples / (static_cast<double>(settings.width) * settings.height));
    const auto scaled = [&](int side) {
        return static_cast<int>(std::lround(std::clamp(scale * side, 1.0, samples)));
    };
    runtime::RenderRequest trial;
    trial.settings = settings;
    trial.settings.width = scaled(settings.width);
    trial.settings.height = scaled(settings.height);
    trial.crop = {0, 0, trial.settings.width, trial.settings.height};
    return {trial};
}

/// As many in blocks of neighbours, in rows and columns over the whole picture. They see less of it, but rays
/// far apart take ten times as long in a mesh, of which they share no part.
std::vector<runtime::RenderRequest> block_trial(const runtime::RenderSettings& settings, int part) {
    constexpr int side = 4;
    const double distance = side * std::sqrt(static_cast<double>(settings.width) * settings.height /
                                             trial_samples_of(settings, part));
    const int columns = std::max(1, static_cast<int>(settings.width / distance));
    const int rows = std::max(1, static_cast<int>(settings.height / distance));
    const auto start = [](int i, int count, int size) {
        return std::max(0, static_cast<int>((i + 0.5) / count * size) - side / 2);
    };
    std::vector<runtime::RenderRequest> trials;
    for (int i = 0; i < rows * columns; ++i) {
        runtime::RenderRequest& trial = trials.emplace_back();
        trial.settings = settings;
        const int x = start(i % columns, columns, settings.width),
                  y = start(i / columns, rows, settings.height);
        trial.crop = {x, y, std::min(x + side, settings.width), std::min(y + side, settings.height)};
    }
    return trials;
}

/// The largest difference between what the two renderers draw, a sample per pixel.
double try_both(const Render& single, const Render& full, std::vector<runtime::RenderRequest> trials,
                int threads) {
    double most = 0;
    for (runtime::RenderRequest& trial : trials) {
        trial.settings.samples_per_axis = 1;
        trial.threads = threads;
        runtime::Image a(trial.crop.x1 - trial.crop.x0, trial.crop.y1 - trial.crop.y0), b = a;
        single(trial, a);
        full(trial, b);
        for (std::size_t i = 0; i < a.pixels.size(); ++i) {
            most = std::max(most, steps_between(a.pixels[i], b.pixels[i]));
        }
    }
    return most;
}

std::optional<std::string> reason_against_float(const ir::Scene& scene,
                                                const runtime::RenderSettings& settings) {
    if (samples_of(settings) < worth_a_trial) {
        return "the picture is too small for float to save time";
    }
    return needs_double(scene);
}

} // namespace

host::Drawable make_drawable(const ir::Scene& scene, Precision precision,
                             const runtime::BuildOptions& options) {
    const KernelSet kernels = choose_kernels();
    host::Drawable drawable = describe(scene, kernels);
    drawable.precision = name_of(precision);
    const Stopwatch watch;
    drawable.render = make_renderer(precision, scene, build_meshes(scene, options), kernels, options);
    drawable.times_ms.emplace_back("accel", watch.milliseconds());
    return drawable;
}

host::Drawable make_drawable_for_8_bits(const ir::Scene& scene, const runtime::RenderSettings& settings,
                                        const runtime::BuildOptions& options) {
    if (const std::optional<std::string> reason = reason_against_float(scene, settings)) {
        host::Drawable drawable = make_drawable(scene, Precision::full, options);
        drawable.precision_reason = *reason;
        return drawable;
    }
    const KernelSet kernels = choose_kernels();
    host::Drawable drawable = describe(scene, kernels);
    const Stopwatch build_watch;
    const std::shared_ptr<const Meshes> meshes = build_meshes(scene, options);
    Render single = make_renderer<float>(scene, meshes, kernels, options);
    drawable.times_ms.emplace_back("accel", build_watch.milliseconds());

    const Stopwatch watch;
    Render full = make_renderer<double>(scene, meshes, kernels, options);
    double steps = 0;
    for (const int part : trial_parts) {
        if (steps <= most_steps) {
            const auto trials = meshes->empty() ? sparse_trial(settings, part) : block_trial(settings, part);
            steps = std::max(steps, try_both(single, full, trials, options.threads));
        }
    }
    const bool fine = steps <= most_steps;
    drawable.precision = name_of(fine ? Precision::single : Precision::full);
    drawable.precision_reason =
        fmt::format("float was {:.2g} 8-bit steps off in a trial; {} are allowed", steps, most_steps);
    drawable.render = fine ? std::move(single) : std::move(full);
    drawable.times_ms.emplace_back("precision", watch.milliseconds());
    return drawable;
}

} // namespace scc::compiler
