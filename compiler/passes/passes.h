#pragma once

#include "compiler/ir/scene.h"

#include <span>
#include <string_view>
#include <vector>

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

/// What one thing in the scene asks for, and where it is written.
struct Need {
    runtime::SceneTraits traits;
    lang::Span span;
};
/// In the order of objects, materials, lights, camera. All together are the scene's traits, but for
/// `accelerator`, which is due to the objects' number.
std::vector<Need> needs_of(const ir::Scene& scene);

} // namespace scc::compiler
