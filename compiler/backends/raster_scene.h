#pragma once

#include "runtime/aov.h"
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

} // namespace scc::compiler
