#include "compiler/backends/render_kernel.h"

#include "runtime/render.h"

// Compiled once per instruction set and precision: SCC_KERNEL names the function, SCC_KERNEL_REAL is its
// number type.
void SCC_KERNEL(const scc::runtime::DynamicScene<SCC_KERNEL_REAL>& scene,
                const scc::runtime::RenderRequest& request, scc::runtime::Image& image,
                scc::runtime::RenderResult& result) {
    result = scc::runtime::render(scene, request, image);
}
