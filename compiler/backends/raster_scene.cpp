#include "compiler/backends/raster_scene.h"

#include "runtime/raster/draw.h"

namespace scc::compiler {

namespace {

template <class R>
bool draw_aovs(const runtime::DynamicScene<R>& scene, const runtime::RenderRequest& request,
               runtime::AovImage& to) {
    return runtime::draw_raster_aovs(scene, runtime::raster_model(scene, request.settings), request, to);
}

} // namespace

runtime::RasterModel<float> raster_model_of(const runtime::DynamicScene<float>& scene,
                                            const runtime::RenderSettings& settings) {
    return runtime::raster_model(scene, settings);
}
runtime::RasterModel<double> raster_model_of(const runtime::DynamicScene<double>& scene,
                                             const runtime::RenderSettings& settings) {
    return runtime::raster_model(scene, settings);
}

bool raster_aovs_of(const runtime::DynamicScene<float>& scene, const runtime::RenderRequest& request,
                    runtime::AovImage& to) {
    return draw_aovs(scene, request, to);
}
bool raster_aovs_of(const runtime::DynamicScene<double>& scene, const runtime::RenderRequest& request,
                    runtime::AovImage& to) {
    return draw_aovs(scene, request, to);
}

} // namespace scc::compiler
