#pragma once

#include "compiler/ir/scene.h"

namespace scc::compiler::ir {

/// Throws std::logic_error if the scene breaks a rule that the backends rely on: indices in range, operands
/// before their uses, finite numbers, unique names. That is a mistake of scc, never of the author.
void verify(const Scene& scene);

} // namespace scc::compiler::ir
