#include "compiler/backends/raster_kernel.h"

#include "runtime/raster/draw.h"

// Compiled once per instruction set and precision: SCC_KERNEL names the function, SCC_KERNEL_REAL is its
// number type.
void SCC_KERNEL(const scc::runtime::DynamicScene<SCC_KERNEL_REAL>& scene,
                const scc::runtime::RasterModel<SCC_KERNEL_REAL>& model,
                const scc::runtime::RenderRequest& request, scc::runtime::Image& image,
                scc::runtime::RenderResult& result) {
    result = scc::runtime::draw_raster(scene, model, request, image);
}
