#include "compiler/backends/render.h"

#include "compiler/backends/function_program.h"
#include "compiler/backends/kernels.h"
#include "compiler/backends/looking_kernel.h"
#include "compiler/backends/needs_double.h"
#include "compiler/backends/precision_trial.h"
#include "compiler/backends/raster_scene.h"
#include "compiler/backends/tables.h"
#include "compiler/ir/traits.h"
#include "compiler/mesh_cache.h"
#include "compiler/scene_names.h"
#include "runtime/accel/build.h"

#include <chrono>
#include <memory>
#include <utility>

namespace scc::compiler {

namespace {

using Meshes = std::vector<BuiltMesh>;

/// What draws a scene in one precision.
struct Renderer {
    decltype(host::Drawable::render) render;
    decltype(host::Drawable::draw_aovs) draw_aovs;
};
bool draw_aovs(const runtime::DynamicScene<float>& scene, const runtime::RenderRequest& request,
               runtime::AovImage& to) {
    return scc_draw_aovs_float(scene, request, to);
}
bool draw_aovs(const runtime::DynamicScene<double>& scene, const runtime::RenderRequest& request,
               runtime::AovImage& to) {
    return scc_draw_aovs_double(scene, request, to);
}

std::shared_ptr<const Meshes> build_meshes(const ir::Scene& scene, const runtime::BuildOptions& options) {
    auto meshes = std::make_shared<Meshes>();
    for (const ir::Mesh& mesh : scene.meshes) {
        meshes->push_back(build_mesh(mesh, options));
    }
    return meshes;
}

/// The colours of a scene with spectra, group after group; else without any.
template <class R>
struct Bands {
    std::vector<runtime::BandGroup<R>> groups;
    std::vector<runtime::Phong<R>> materials;
    std::vector<runtime::PointLight<R>> point_lights;
    std::vector<runtime::DirectionalLight<R>> directional_lights;
    std::vector<runtime::SpotLight<R>> spot_lights;
    std::vector<runtime::RectangleLight<R>> rectangle_lights;
    std::vector<runtime::LineSegment<R>> line_segments;

    void give(std::size_t group, runtime::DynamicScene<R>& scene) const {
        const auto give_rows = [&]<class T>(const std::vector<T>& all, std::vector<T>& rows) {
            rows.resize(all.size() / groups.size());
            take_rows(std::span<const T>(all), group, groups.size(), rows);
        };
        give_rows(materials, scene.materials);
        give_rows(point_lights, scene.point_lights);
        give_rows(directional_lights, scene.directional_lights);
        give_rows(spot_lights, scene.spot_lights);
        give_rows(rectangle_lights, scene.rectangle_lights);
        give_rows(line_segments, scene.line_segments);
        scene.ambient = groups[group].ambient;
        scene.background = groups[group].background;
    }
};

// A scene together with the meshes that its tables point into, which are the same in both precisions.
template <class R>
struct OwnedScene {
    runtime::DynamicScene<R> scene;
    std::shared_ptr<const Meshes> meshes;
    Bands<R> bands;
};

template <class R>
std::shared_ptr<OwnedScene<R>> build(const ir::Scene& scene, std::shared_ptr<const Meshes> meshes,
                                     const runtime::BuildOptions& options) {
    auto owned = std::make_shared<OwnedScene<R>>();
    owned->meshes = std::move(meshes);
    runtime::DynamicScene<R>& out = owned->scene;
    for (const BuiltMesh& mesh : *owned->meshes) {
        out.meshes.push_back(mesh.data);
    }
    for_each_primitive<R>(scene, [&](const auto& primitive) { out.add(primitive); });
    out.csg_nodes = csg_nodes_of(scene);
    out.materials = materials_of<R>(scene);
    out.point_lights = lights_of<runtime::PointLight, R>(scene);
    out.directional_lights = lights_of<runtime::DirectionalLight, R>(scene);
    out.spot_lights = lights_of<runtime::SpotLight, R>(scene);
    out.rectangle_lights = lights_of<runtime::RectangleLight, R>(scene);
    out.line_segments = line_segments_of<R>(scene);
    if (!scene.bands.empty()) {
        owned->bands = {bands_of<R>(scene),          std::move(out.materials),
                        std::move(out.point_lights), std::move(out.directional_lights),
                        std::move(out.spot_lights),  std::move(out.rectangle_lights),
                        std::move(out.line_segments)};
        owned->bands.give(0, out);
    }
    for (const ir::Function& function : scene.functions) {
        out.functions.push_back(program_of<R>(function));
    }
    out.reads_uv = scene.traits.uv;
    out.camera = convert(scene.camera, R{});
    out.ambient = convert(scene.ambient, R{});
    out.background = convert(scene.background, R{});
    prepare(out, options);
    return owned;
}

template <class R>
runtime::RenderResult render(OwnedScene<R>& owned, const Kernels<R>& kernels,
                             const runtime::RenderRequest& request, runtime::Image& image) {
    const bool is_raster = request.settings.method == runtime::Method::raster;
    const auto draw = [&](const runtime::RenderRequest& one, runtime::Image& to) {
        runtime::RenderResult result;
        if (is_raster) { // the model of each band has lines in its own colours
            kernels.raster(owned.scene, raster_model_of(owned.scene, one.settings), one, to, result);
        } else {
            kernels.ray(owned.scene, one, to, result);
        }
        return result;
    };
    const Bands<R>& bands = owned.bands;
    if (bands.groups.empty()) {
        return draw(request, image);
    }
    const auto draw_group = [&](std::size_t group, const runtime::RenderRequest& one, runtime::Image& to) {
        bands.give(group, owned.scene);
        return draw(one, to);
    };
    return render_bands(std::span<const runtime::BandGroup<R>>(bands.groups), request, image, draw_group);
}

void explain(const runtime::DynamicScene<float>& scene, const runtime::RenderRequest& request,
             const PixelPlace& place, runtime::Explanation* to, runtime::Rgb<float>& pixel) {
    scc_explain_pixel_float(scene, request, place.i, place.j, to, pixel);
}
void explain(const runtime::DynamicScene<double>& scene, const runtime::RenderRequest& request,
             const PixelPlace& place, runtime::Explanation* to, runtime::Rgb<float>& pixel) {
    scc_explain_pixel_double(scene, request, place.i, place.j, to, pixel);
}

template <class R>
ExplainedPixel explain(const ir::Scene& scene, const runtime::RenderRequest& request,
                       const PixelPlace& place) {
    const runtime::BuildOptions options{.threads = request.threads};
    const std::shared_ptr<OwnedScene<R>> owned = build<R>(scene, build_meshes(scene, options), options);
    ExplainedPixel result;
    const auto& groups = owned->bands.groups;
    if (groups.empty()) {
        explain(owned->scene, request, place, &result.how, result.pixel);
    } else {
        result.band = groups.size() / 2;
        runtime::Image image(1, 1);
        render_bands(std::span<const runtime::BandGroup<R>>(groups), request, image,
                     [&](std::size_t group, const runtime::RenderRequest& one, runtime::Image& to) {
                         owned->bands.give(group, owned->scene);
                         runtime::Rgb<float> color;
                         explain(owned->scene, one, place, group == result.band ? &result.how : nullptr,
                                 color);
                         to.pixels = {color.r, color.g, color.b};
                         return runtime::RenderResult{};
                     });
        result.pixel = {image.pixels[0], image.pixels[1], image.pixels[2]};
    }
    runtime::Image image(1, 1);
    render(*owned, choose_kernels().of(R{}), request, image);
    result.rendered = {image.pixels[0], image.pixels[1], image.pixels[2]};
    return result;
}

template <class R>
ExplainedRaster explain_triangles(const ir::Scene& scene, const runtime::RenderRequest& request,
                                  const PixelPlace& place) {
    const runtime::BuildOptions options{.threads = request.threads};
    const std::shared_ptr<OwnedScene<R>> owned = build<R>(scene, build_meshes(scene, options), options);
    ExplainedRaster result;
    runtime::Image image(1, 1);
    render(*owned, choose_kernels().of(R{}), request, image);
    result.rendered = {image.pixels[0], image.pixels[1], image.pixels[2]};
    if (!owned->bands.groups.empty()) {
        result.band = owned->bands.groups.size() / 2;
        owned->bands.give(result.band, owned->scene);
    }
    result.how = raster_explanation_of(owned->scene, request, place.i, place.j);
    return result;
}

template <class R>
Renderer make_renderer(const ir::Scene& scene, const std::shared_ptr<const Meshes>& meshes,
                       const KernelSet& kernels, const runtime::BuildOptions& options) {
    const std::shared_ptr<OwnedScene<R>> owned = build<R>(scene, meshes, options);
    return {[owned, own = kernels.of(R{})](const runtime::RenderRequest& request, runtime::Image& image) {
                return render(*owned, own, request, image);
            },
            [owned](const runtime::RenderRequest& request, runtime::AovImage& to) {
                return request.settings.method == runtime::Method::raster
                           ? raster_aovs_of(owned->scene, request, to)
                           : draw_aovs(owned->scene, request, to);
            }};
}
Renderer make_renderer(Precision precision, const ir::Scene& scene,
                       const std::shared_ptr<const Meshes>& meshes, const KernelSet& kernels,
                       const runtime::BuildOptions& options) {
    return precision == Precision::single ? make_renderer<float>(scene, meshes, kernels, options)
                                          : make_renderer<double>(scene, meshes, kernels, options);
}

void give(host::Drawable& drawable, Renderer renderer) {
    drawable.render = std::move(renderer.render);
    drawable.draw_aovs = std::move(renderer.draw_aovs);
}

host::Drawable describe(const ir::Scene& scene, const KernelSet& kernels) {
    return {.scene = scene.name,
            .precision = {},
            .precision_reason = {},
            .isa = kernels.isa,
            .features = ir::feature_names(scene.traits),
            .settings = scene.settings,
            .times_ms = {},
            .render = {},
            .draw_aovs = {},
            .names = [&scene] { return names_of(scene); }};
}

class Stopwatch {
public:
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Below, a trial costs more than float saves.
constexpr double worth_a_trial = 50'000;

std::optional<std::string> reason_against_float(const ir::Scene& scene,
                                                const runtime::RenderSettings& settings) {
    const double samples = static_cast<double>(settings.width) * settings.height * settings.samples;
    if (samples < worth_a_trial) {
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
    give(drawable, make_renderer(precision, scene, build_meshes(scene, options), kernels, options));
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
    Renderer single = make_renderer<float>(scene, meshes, kernels, options);
    drawable.times_ms.emplace_back("accel", build_watch.milliseconds());

    const Stopwatch watch;
    Renderer full = make_renderer<double>(scene, meshes, kernels, options);
    const PrecisionTrial trial = try_float(single.render, full.render, settings,
                                           {.coherent = !meshes->empty(), .threads = options.threads});
    drawable.precision = name_of(trial.passed ? Precision::single : Precision::full);
    drawable.precision_reason = trial.reason;
    give(drawable, std::move(trial.passed ? single : full));
    drawable.times_ms.emplace_back("precision", watch.milliseconds());
    return drawable;
}

PrecisionChoice choose_precision_for_8_bits(const ir::Scene& scene, const runtime::RenderSettings& settings,
                                            const runtime::BuildOptions& options) {
    if (const std::optional<std::string> reason = reason_against_float(scene, settings)) {
        return {Precision::full, *reason};
    }
    const host::Drawable drawable = make_drawable_for_8_bits(scene, settings, options);
    const bool single = drawable.precision == name_of(Precision::single);
    return {single ? Precision::single : Precision::full, drawable.precision_reason};
}

void with_tables(const ir::Scene& scene,
                 const std::function<void(const runtime::DynamicScene<double>&)>& use) {
    const runtime::BuildOptions options;
    use(build<double>(scene, build_meshes(scene, options), options)->scene);
}

ExplainedPixel explain_pixel(const ir::Scene& scene, Precision precision,
                             const runtime::RenderSettings& settings, const PixelPlace& place) {
    runtime::RenderRequest request;
    request.settings = settings;
    request.crop = {place.x, place.y, place.x + 1, place.y + 1};
    return precision == Precision::single ? explain<float>(scene, request, place)
                                          : explain<double>(scene, request, place);
}

ExplainedRaster explain_raster(const ir::Scene& scene, Precision precision,
                               const runtime::RenderSettings& settings, const PixelPlace& place) {
    runtime::RenderRequest request;
    request.settings = settings;
    request.crop = {place.x, place.y, place.x + 1, place.y + 1};
    return precision == Precision::single ? explain_triangles<float>(scene, request, place)
                                          : explain_triangles<double>(scene, request, place);
}

} // namespace scc::compiler
