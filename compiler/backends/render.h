#pragma once

#include "compiler/backends/precision.h"
#include "compiler/ir/scene.h"
#include "runtime/accel/build.h"
#include "runtime/explanation.h"
#include "runtime/host/draw.h"

#include <functional>

namespace scc::compiler {

/// The scene in the generic renderer's tables, hierarchies built, ready to be drawn in this process as long
/// as `scene` lives.
host::Drawable make_drawable(const ir::Scene& scene, Precision precision,
                             const runtime::BuildOptions& options = {});

/// The same for a picture of this size and so many samples whose file keeps 8 bits of each value: in float
/// where that, as far as the scene's numbers and a trial with a few thousand samples tell (see
/// precision_trial.h), cannot be seen. The same scene, size and samples give the same choice.
host::Drawable make_drawable_for_8_bits(const ir::Scene& scene, const runtime::RenderSettings& settings,
                                        const runtime::BuildOptions& options);

/// The choice alone.
PrecisionChoice choose_precision_for_8_bits(const ir::Scene& scene, const runtime::RenderSettings& settings,
                                            const runtime::BuildOptions& options);

/// The scene in the generic renderer's tables while `use` runs, for others that read them.
void with_tables(const ir::Scene& scene,
                 const std::function<void(const runtime::DynamicScene<double>&)>& use);

/// A pixel, from the top left corner of the picture, and one of its n x n samples.
struct PixelPlace {
    int x = 0, y = 0;
    int i = 0, j = 0;
};
struct ExplainedPixel {
    runtime::Explanation how; ///< of a scene with spectra: what becomes of the wavelengths of `band`
    std::size_t band = 0;
    runtime::Rgb<float> pixel;    ///< as what is explained adds up
    runtime::Rgb<float> rendered; ///< as the kernels draw it
};
/// The rays are those of the picture of this size and so many samples.
ExplainedPixel explain_pixel(const ir::Scene& scene, Precision precision,
                             const runtime::RenderSettings& settings, const PixelPlace& place);

struct ExplainedRaster {
    runtime::RasterExplanation how; ///< of a scene with spectra: at the wavelengths of `band`
    std::size_t band = 0;
    runtime::Rgb<float> rendered; ///< as the kernels draw it
};
ExplainedRaster explain_raster(const ir::Scene& scene, Precision precision,
                               const runtime::RenderSettings& settings, const PixelPlace& place);

} // namespace scc::compiler
