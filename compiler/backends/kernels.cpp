#include "compiler/backends/kernels.h"

#include "compiler/backends/raster_kernel.h"
#include "compiler/backends/render_kernel.h"
#include "runtime/host/options.h"
#include "runtime/host/program.h"

#include <fmt/core.h>

#include <cstdlib>

namespace scc::compiler {

std::vector<KernelSet> usable_kernels() {
    std::vector<KernelSet> usable{{"baseline",
                                   host::compiled_isa,
                                   {scc_render_float_baseline, scc_raster_float_baseline},
                                   {scc_render_double_baseline, scc_raster_double_baseline}}};
#if SCC_AVX_KERNELS
    // What compiler/CMakeLists.txt has them compiled for.
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
        __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt")) {
        usable.push_back({"avx2",
                          "avx2",
                          {scc_render_float_avx2, scc_raster_float_avx2},
                          {scc_render_double_avx2, scc_raster_double_avx2}});
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
            __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
            __builtin_cpu_supports("avx512vl")) {
            usable.push_back({"avx512",
                              "avx512",
                              {scc_render_float_avx512, scc_raster_float_avx512},
                              {scc_render_double_avx512, scc_raster_double_avx512}});
        }
    }
#endif
    return usable;
}

KernelSet choose_kernels() {
    const std::vector<KernelSet> usable = usable_kernels();
    const char* wanted = std::getenv("SCC_ISA");
    if (wanted == nullptr || *wanted == '\0') {
        return usable.back();
    }
    std::string names;
    for (const KernelSet& kernels : usable) {
        if (kernels.name == wanted) {
            return kernels;
        }
        names += names.empty() ? "" : ", ";
        names += kernels.name;
    }
    throw host::UsageError(fmt::format("SCC_ISA is `{}`; on this machine it may be: {}", wanted, names));
}

} // namespace scc::compiler
