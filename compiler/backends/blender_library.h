#pragma once

#include <set>
#include <string>
#include <string_view>

namespace scc::compiler {

/// What parts of the fixed Python text a scene needs; the names that stand behind `#:` in blender/*.py.
using BlenderFeatures = std::set<std::string, std::less<>>;

/// The Python files of blender/ in their order. A line `#: a b` starts text that is left out unless the
/// features have a or b, up to the `#: end` that belongs to it.
std::string blender_library(const BlenderFeatures& features);

/// The same for a text given.
std::string select_features(std::string_view text, const BlenderFeatures& features);

} // namespace scc::compiler
