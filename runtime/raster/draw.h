#pragma once

#include "runtime/aov.h"
#include "runtime/image.h"
#include "runtime/raster/model.h"
#include "runtime/render_request.h"

#include <vector>

namespace scc::runtime {

/// Draws the crop into the image, which has its size and 3 channels. The pixels depend on neither the crop
/// nor the number of threads nor the lanes that a register holds. The calling thread draws too, and it alone
/// calls `request.progress`. `pseudodepth`, if any, gets z* of L4 of the nearest opaque surface at each pixel
/// of the crop, or 1: at the pixel's centre, or with an even number of samples across right below it.
template <class L, SceneModel S>
RenderResult draw_raster_with_lanes(const S& scene, const RasterModel<typename S::Real>& model,
                                    const RenderRequest& request, Image& image,
                                    std::vector<typename S::Real>* pseudodepth = nullptr);

template <SceneModel S>
RenderResult draw_raster(const S& scene, const RasterModel<typename S::Real>& model,
                         const RenderRequest& request, Image& image,
                         std::vector<typename S::Real>* pseudodepth = nullptr);

/// As draw_aovs, of the triangles.
template <SceneModel S>
bool draw_raster_aovs(const S& scene, const RasterModel<typename S::Real>& model,
                      const RenderRequest& request, AovImage& to);

} // namespace scc::runtime
