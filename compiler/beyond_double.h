#pragma once

#include "compiler/ir/scene.h"

#include <optional>
#include <string>

namespace scc::compiler {

/// Where an object is drawn from too far away, or too far from the origin, for what the picture shows of it.
struct BeyondDouble {
    double away = 0;  ///< the largest coordinate there, the eye's included
    double steps = 0; ///< that double has across the picture's height there
    lang::Span span;
    std::string path;
};

/// Of all objects the one that shows it most; nothing if none does, as far as boxes around them tell.
std::optional<BeyondDouble> beyond_double(const ir::Scene& scene);

} // namespace scc::compiler
