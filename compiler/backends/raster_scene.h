#pragma once

#include "runtime/aov.h"
#include "runtime/explanation.h"
#include "runtime/raster/model.h"
#include "runtime/render_request.h"
#include "runtime/scene.h"

/// What of raster pictures takes less time than to compile it for several instruction sets.
namespace scc::compiler {

/// As runtime::raster_model. Throws std::length_error for more triangles than there are numbers.
runtime::RasterModel<float> raster_model_of(const runtime::DynamicScene<float>& scene,
                                            const runtime::RenderSettings& settings);
runtime::RasterModel<double> raster_model_of(const runtime::DynamicScene<double>& scene,
                                             const runtime::RenderSettings& settings);

/// As runtime::draw_raster_aovs.
bool raster_aovs_of(const runtime::DynamicScene<float>& scene, const runtime::RenderRequest& request,
                    runtime::AovImage& to);
bool raster_aovs_of(const runtime::DynamicScene<double>& scene, const runtime::RenderRequest& request,
                    runtime::AovImage& to);

/// As runtime::explain_raster.
runtime::RasterExplanation raster_explanation_of(const runtime::DynamicScene<float>& scene,
                                                 const runtime::RenderRequest& request, int i, int j);
runtime::RasterExplanation raster_explanation_of(const runtime::DynamicScene<double>& scene,
                                                 const runtime::RenderRequest& request, int i, int j);

} // namespace scc::compiler
