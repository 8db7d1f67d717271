#pragma once

#include "compiler/backends/render.h"
#include "compiler/cli/commands.h"
#include "runtime/math/vec.h"

#include <optional>
#include <string>
#include <utility>

/// The chapters of `scc explain`, each as text for people or as JSON.
namespace scc::cli {

struct ExplainOptions {
    SceneOptions scene;
    bool needs = false;
    bool matrices = false;
    std::optional<std::pair<int, int>> pixel;   ///< from the top left corner of the picture
    std::optional<std::pair<int, int>> sample;  ///< of the pixel's n x n, from its top left corner
    std::optional<runtime::Vec3<double>> point; ///< instead of the camera's target, for the matrices
    host::RenderOptions render;
    std::optional<compiler::Precision> precision;
    bool json = false;
};

/// L1 to L4 and L6: of a scene that the passes have not run over.
std::string explain_matrices(const Loaded& loaded, const ExplainOptions& options);
std::string explain_needs(const Loaded& loaded, const ExplainOptions& options);
/// One pixel of a ray picture (L11 to L15) or of a raster picture (L3 to L10). Both throw host::UsageError
/// for a pixel or sample that the picture does not have.
std::string explain_rays(const Loaded& loaded, const ExplainOptions& options);
std::string explain_raster(const Loaded& loaded, const ExplainOptions& options);
/// The same of rays as JSON; numbers that are not finite are null.
std::string pixel_json(const Loaded& loaded, const runtime::RenderSettings& settings,
                       const compiler::PixelPlace& place, const compiler::PrecisionChoice& precision,
                       const compiler::ExplainedPixel& explained);

} // namespace scc::cli
