#pragma once

#include "compiler/ir/scene.h"

#include <map>
#include <string>
#include <vector>

namespace scc::compiler {

/// What is seen through surfaces in Blender: Cycles would take one way of several at random, so each view
/// layer follows one sequence of ways.
struct BlenderPaths {
    /// Of each view layer (and light), at one surface after the other: T through it or, beyond the critical
    /// angle, back; R mirrored. The shorter ones and those that count more come first.
    std::vector<std::string> paths;
    double cut_off = 0; ///< what share of what is seen there the best of those left out counts, at most
    /// Of bodies that lie in others, by their objects' paths: the index of refraction around them.
    std::map<std::string, double> outside;
    std::string obstacle; ///< why nothing is seen through surfaces after all; empty: nothing is in the way
};

/// Of a scene with materials that let light through.
BlenderPaths blender_paths(const ir::Scene& scene);

} // namespace scc::compiler
