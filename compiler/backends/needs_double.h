#pragma once

#include "compiler/ir/scene.h"

#include <optional>
#include <string>

namespace scc::compiler {

/// Why the scene's numbers ask for double even where the picture's values are kept to 8 bits; nothing if they
/// do not. What covers many pixels a trial finds better; this is for what it may miss.
std::optional<std::string> needs_double(const ir::Scene& scene);

} // namespace scc::compiler
