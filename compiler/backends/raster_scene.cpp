#include "compiler/backends/raster_scene.h"

#include "runtime/raster/draw.h"
#include "runtime/raster/explain.h"

namespace scc::compiler {

namespace {

template <class R>
bool draw_aovs(const runtime::DynamicScene<R>& scene, const runtime::RenderRequest& request,
               runtime::AovImage& to) {
    return runtime::draw_raster_aovs(scene, runtime::raster_model(scene, request.settings), request, to);
}

template <class R>
runtime::RasterExplanation explain(const runtime::DynamicScene<R>& scene,
                                   const runtime::RenderRequest& request, int i, int j) {
    return runtime::explain_raster(scene, runtime::raster_model(scene, request.settings), request, i, j);
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

runtime::RasterExplanation raster_explanation_of(const runtime::DynamicScene<float>& scene,
                                                 const runtime::RenderRequest& request, int i, int j) {
    return explain(scene, request, i, j);
}
runtime::RasterExplanation raster_explanation_of(const runtime::DynamicScene<double>& scene,
                                                 const runtime::RenderRequest& request, int i, int j) {
    return explain(scene, request, i, j);
}

} // namespace scc::compiler
