#pragma once

#include "compiler/cli/subject.h"
#include "validation/sweep.h"

namespace scc::cli {

/// Error and time of the renderers in `against` (pov, blender, native) and of ourselves, scene by scene, one
/// process at a time. Scenes that are wrong are reported and left out; `complete` becomes false. Throws
/// Interrupted.
std::vector<validation::SweepScene> sweep_scenes(const ValidateOptions& options,
                                                 const std::vector<std::string>& against, bool& complete);

} // namespace scc::cli
