#pragma once

#include "runtime/image.h"
#include "runtime/render_request.h"
#include "runtime/scene.h"

/// The generic renderer's kernels, one for each instruction set and precision. Linked are those for which
/// SCC_AVX_KERNELS says so.
#define SCC_DECLARE_KERNEL(isa)                                                                              \
    extern "C" void scc_render_float_##isa(const scc::runtime::DynamicScene<float>&,                         \
                                           const scc::runtime::RenderRequest&, scc::runtime::Image&,         \
                                           scc::runtime::RenderResult&);                                     \
    extern "C" void scc_render_double_##isa(const scc::runtime::DynamicScene<double>&,                       \
                                            const scc::runtime::RenderRequest&, scc::runtime::Image&,        \
                                            scc::runtime::RenderResult&)

SCC_DECLARE_KERNEL(baseline);
SCC_DECLARE_KERNEL(avx2);
SCC_DECLARE_KERNEL(avx512);

#undef SCC_DECLARE_KERNEL
