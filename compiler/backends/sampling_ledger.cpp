#include "compiler/backends/sampling_ledger.h"

#include <cmath>

namespace scc::compiler {

void record_sampling(const ir::Scene& scene, Ledger& ledger) {
    const runtime::RenderSettings& settings = scene.settings;
    const auto add = [&](Fidelity fidelity, const char* feature, const char* how, double bound = 0) {
        ledger.push_back({.fidelity = fidelity,
                          .feature = feature,
                          .subject = "render",
                          .span = scene.sampling_span,
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
