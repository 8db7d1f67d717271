#include "compiler/passes/passes.h"

#include "compiler/ir/verify.h"

namespace scc::compiler {

std::span<const Pass> passes() {
    static constexpr Pass table[] = {
        {"flatten_transforms", "gives shapes in world coordinates where their form allows it exactly",
         flatten_transforms},
        {"drop_unused",
         "leaves out lights that give nothing, and materials, functions and meshes that no object uses",
         drop_unused},
        {"derive_traits", "finds out what the scene needs of the runtime", derive_traits},
    };
    return table;
}

void run_passes(ir::Scene& scene) {
    ir::verify(scene);
    for (const Pass& pass : passes()) {
        pass.run(scene);
        ir::verify(scene);
    }
}

} // namespace scc::compiler
