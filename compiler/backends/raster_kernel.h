#pragma once

#include "runtime/image.h"
#include "runtime/raster/model.h"
#include "runtime/render_request.h"
#include "runtime/scene.h"

/// The raster renderer's kernels, one for each instruction set and precision, as those of render_kernel.h.
#define SCC_DECLARE_RASTER_KERNEL(isa)                                                                       \
    extern "C" void scc_raster_float_##isa(                                                                  \
        const scc::runtime::DynamicScene<float>&, const scc::runtime::RasterModel<float>&,                   \
        const scc::runtime::RenderRequest&, scc::runtime::Image&, scc::runtime::RenderResult&);              \
    extern "C" void scc_raster_double_##isa(                                                                 \
        const scc::runtime::DynamicScene<double>&, const scc::runtime::RasterModel<double>&,                 \
        const scc::runtime::RenderRequest&, scc::runtime::Image&, scc::runtime::RenderResult&)

SCC_DECLARE_RASTER_KERNEL(baseline);
SCC_DECLARE_RASTER_KERNEL(avx2);
SCC_DECLARE_RASTER_KERNEL(avx512);

#undef SCC_DECLARE_RASTER_KERNEL
