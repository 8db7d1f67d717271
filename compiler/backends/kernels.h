#pragma once

#include "runtime/image.h"
#include "runtime/raster/model.h"
#include "runtime/render_request.h"
#include "runtime/scene.h"

#include <string_view>
#include <vector>

/// The generic renderer, compiled for several instruction sets, and the choice between them at run time.
namespace scc::compiler {

template <class R>
using Kernel = void (*)(const runtime::DynamicScene<R>&, const runtime::RenderRequest&, runtime::Image&,
                        runtime::RenderResult&);

template <class R>
using RasterKernel = void (*)(const runtime::DynamicScene<R>&, const runtime::RasterModel<R>&,
                              const runtime::RenderRequest&, runtime::Image&, runtime::RenderResult&);

/// Of one precision.
template <class R>
struct Kernels {
    Kernel<R> ray;
    RasterKernel<R> raster;
};

struct KernelSet {
    std::string_view name; ///< as SCC_ISA has it
    const char* isa;       ///< as the statistics have it
    Kernels<float> single;
    Kernels<double> full;

    Kernels<float> of(float) const { return single; }
    Kernels<double> of(double) const { return full; }
};

/// Those in this program that this machine can run, the fastest last. They draw the same bits.
std::vector<KernelSet> usable_kernels();

/// The fastest, or the one that the environment's SCC_ISA names. Throws host::UsageError for a name that is
/// unknown or that cannot be run here.
KernelSet choose_kernels();

} // namespace scc::compiler
