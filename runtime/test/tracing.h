#pragma once

#include "runtime/accel/build.h"
#include "runtime/raycast.h"

/// Tracing in scenes of every kind, which takes longest to compile of all that tests call: compiled once, in
/// tracing.cpp, for all files of a test program.
namespace scc::runtime {

#define SCC_TRACING_OF(LINKAGE, R, L)                                                                        \
    LINKAGE template Hit<L> closest_hit(const DynamicScene<R>&, Ray<L>);                                     \
    LINKAGE template MaskOf<L> any_hit(const DynamicScene<R>&, Ray<L>);                                      \
    LINKAGE template void closest_hits<packs_together<DynamicScene<R>, L>>(                                  \
        const DynamicScene<R>&, std::span<Ray<L>>, Apex, std::span<Hit<L>>, Candidates);                     \
    LINKAGE template void any_hits<packs_together<DynamicScene<R>, L>>(                                      \
        const DynamicScene<R>&, std::span<Ray<L>>, Apex, std::span<MaskOf<L>>);

#define SCC_TRACING(LINKAGE)                                                                                 \
    SCC_TRACING_OF(LINKAGE, float, float)                                                                    \
    SCC_TRACING_OF(LINKAGE, float, WidestLane<float>)                                                        \
    SCC_TRACING_OF(LINKAGE, double, double)                                                                  \
    SCC_TRACING_OF(LINKAGE, double, WidestLane<double>)                                                      \
    SCC_TRACING_OF(LINKAGE, long double, long double)                                                        \
    LINKAGE template Accelerator build_accelerator(const DynamicScene<float>&, const BuildOptions&);         \
    LINKAGE template Accelerator build_accelerator(const DynamicScene<double>&, const BuildOptions&);        \
    LINKAGE template Accelerator build_accelerator(const DynamicScene<long double>&, const BuildOptions&);

SCC_TRACING(extern)

} // namespace scc::runtime
