#pragma once

#include "runtime/image.h"
#include "runtime/raster/model.h"
#include "runtime/scene.h"

#include <string>
#include <vector>

/// OpenGL's fixed-function pipeline in Mesa, without a display: what raster pictures are compared with.
namespace scc::validation {

struct OpenGlPicture {
    runtime::Image image;      ///< 3 channels
    std::vector<double> depth; ///< z* of L4 at each pixel, 1 where nothing was drawn
    std::string error;         ///< why there is no picture; else empty
};

/// Why OpenGL cannot draw the scene as a raster picture does; empty where it can. It has at most 8 lights,
/// point lights, spots with hard edges and directional ones, exponents of highlights up to 128, materials
/// that do not vary from place to place, and colours at vertices.
std::string unsupported_by_opengl(const runtime::DynamicScene<double>& scene,
                                  const runtime::RasterModel<double>& model,
                                  const runtime::RenderSettings& settings);

/// Whole pictures; with n x n samples, the mean of one that is n times as large.
OpenGlPicture draw_by_opengl(const runtime::DynamicScene<double>& scene,
                             const runtime::RasterModel<double>& model,
                             const runtime::RenderSettings& settings);

} // namespace scc::validation
