#include "compiler/backends/looking_kernel.h"

#include "runtime/draw_aovs.h"
#include "runtime/explain_pixel.h"

// Compiled once per precision: SCC_LOOKING_REAL is the number type, and ends the functions' names.
#define SCC_JOIN(name, real) name##_##real
#define SCC_NAME(name, real) SCC_JOIN(name, real)

bool SCC_NAME(scc_draw_aovs, SCC_LOOKING_REAL)(const scc::runtime::DynamicScene<SCC_LOOKING_REAL>& scene,
                                               const scc::runtime::RenderRequest& request,
                                               scc::runtime::AovImage& to) {
    return scc::runtime::draw_aovs(scene, request, to);
}

void SCC_NAME(scc_explain_pixel, SCC_LOOKING_REAL)(const scc::runtime::DynamicScene<SCC_LOOKING_REAL>& scene,
                                                   const scc::runtime::RenderRequest& request, int i, int j,
                                                   scc::runtime::Explanation* to,
                                                   scc::runtime::Rgb<float>& pixel) {
    pixel = scc::runtime::explain_pixel(scene, request, i, j, to);
}
