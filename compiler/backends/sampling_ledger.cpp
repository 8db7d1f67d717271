#include "compiler/backends/sampling_ledger.h"

#include <fmt/core.h>

#include <cmath>

namespace scc::compiler {

namespace {

/// The lowering has taken out what raster mode has not: shadows, mirrors, refraction.
void record_raster(const ir::Scene& scene, Ledger& ledger) {
    const runtime::RasterSettings& raster = scene.settings.raster;
    if (raster.shading == runtime::RasterShading::phong) {
        ledger.push_back({.fidelity = Fidelity::approximated,
                          .feature = "raster",
                          .subject = "render",
                          .span = scene.method_span,
                          .how =
                              "by rays, which meet the surfaces and not triangles; bound: their distance, in "
                              "picture heights",
                          .bound = raster.tessellation});
    } else {
        ledger.push_back(
            {.fidelity = Fidelity::dropped,
             .feature = fmt::format("shading \"{}\"", word(runtime::raster_shading_names, raster.shading)),
             .subject = "render",
             .span = scene.method_span,
             .how = "it lights each pixel by itself"});
    }
    if (raster.cull == runtime::Cull::back) {
        ledger.push_back({.fidelity = Fidelity::dropped,
                          .feature = "cull",
                          .subject = "render",
                          .span = scene.method_span,
                          .how = "it draws surfaces from both sides"});
    }
    for (const ir::Polyline& line : scene.polylines) {
        ledger.push_back({.fidelity = Fidelity::dropped,
                          .feature = "polyline",
                          .subject = "polyline",
                          .span = line.span,
                          .how = "without a `radius` no ray can meet it"});
    }
}

} // namespace

void record_sampling(const ir::Scene& scene, Ledger& ledger) {
    if (scene.settings.method == runtime::Method::raster) {
        record_raster(scene, ledger);
    }
    const runtime::RenderSettings& settings = scene.settings;
    const auto add = [&](Fidelity fidelity, const char* feature, const char* how, double bound = 0) {
        ledger.push_back({.fidelity = fidelity,
                          .feature = feature,
                          .subject = "render",
                          .span = scene.method_span,
                          .how = how,
                          .bound = bound});
    };
    if (settings.sampler == runtime::Sampler::low_discrepancy) {
        add(Fidelity::approximated, "sampler",
            "on a grid of about as many samples; bound: standard error of a mean over the range of what is "
            "seen "
            "in a pixel, of samples that know nothing of each other",
            1 / (2 * std::sqrt(settings.samples)));
    }
    if (settings.adaptive > 0) {
        add(Fidelity::approximated, "adaptive",
            "on a grid of as many samples everywhere; bound: the standard error allowed", settings.adaptive);
    }
    if (settings.filter != runtime::PixelFilter::box) {
        add(Fidelity::dropped, "filter", "its own recipe for a pixel of several samples is their mean");
    }
}

} // namespace scc::compiler
