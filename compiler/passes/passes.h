#pragma once

#include "compiler/ir/scene.h"

#include <span>
#include <string_view>

namespace scc::compiler {

struct Pass {
    std::string_view name;
    std::string_view what; ///< one line for people
    void (*run)(ir::Scene&);
};

/// The pipeline between lowering and the backends, in order.
std::span<const Pass> passes();

/// Runs all of them; the IR is verified after each.
void run_passes(ir::Scene& scene);

void flatten_transforms(ir::Scene& scene);
void drop_unused(ir::Scene& scene);
void derive_traits(ir::Scene& scene);

} // namespace scc::compiler
