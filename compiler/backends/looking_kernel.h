#pragma once

#include "runtime/aov.h"
#include "runtime/explanation.h"
#include "runtime/render_request.h"
#include "runtime/scene.h"

/// What looks at a scene beside drawing it, over any scene's tables: ray by ray, for any machine, since it is
/// to the bit what the kernels' packs of rays find.
#define SCC_DECLARE_LOOKING(real)                                                                            \
    extern "C" bool scc_draw_aovs_##real(const scc::runtime::DynamicScene<real>&,                            \
                                         const scc::runtime::RenderRequest&, scc::runtime::AovImage&);       \
    extern "C" void scc_explain_pixel_##real(const scc::runtime::DynamicScene<real>&,                        \
                                             const scc::runtime::RenderRequest&, int i, int j,               \
                                             scc::runtime::Explanation*, scc::runtime::Rgb<float>&)

SCC_DECLARE_LOOKING(float);
SCC_DECLARE_LOOKING(double);

#undef SCC_DECLARE_LOOKING
