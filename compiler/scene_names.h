#pragma once

#include "compiler/ir/scene.h"
#include "runtime/host/scene_names.h"

#include <cstdint>
#include <map>
#include <string>

namespace scc::compiler {

/// The objects' paths by their Tag::id, which for_each_primitive gives them, and the materials' names.
host::SceneNames names_of(const ir::Scene& scene);

/// The paths of the solids' members by their Tag::id.
std::map<std::uint32_t, std::string> member_names_of(const ir::Scene& scene);

} // namespace scc::compiler
