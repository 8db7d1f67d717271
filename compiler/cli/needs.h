#pragma once

#include "compiler/backends/precision.h"
#include "compiler/cli/commands.h"
#include "compiler/ir/scene.h"

#include <string>
#include <vector>

/// What a scene needs, and why: what `scc build --report` and `scc explain --needs` tell of it.
namespace scc::cli {

struct Feature {
    std::string name;
    std::string place; ///< file:line of the first that asks for it, or empty
    std::string line;  ///< what stands there, or in place of a place what asks for it
};

/// In the order of ir::feature_names.
std::vector<Feature> needed_features(const Loaded& loaded);
std::vector<std::string> features_left_out(const compiler::ir::Scene& scene);

/// Of a program that is built for the scene. Float needs to be told that 8 bits of each value will do: by the
/// scene's own file.
compiler::PrecisionChoice program_precision(const compiler::ir::Scene& scene);

/// `file:line`, or empty where the span is of no file; and that line without the blanks around it.
std::string place_of(const Loaded& loaded, const lang::Span& span);
std::string line_of(const Loaded& loaded, const lang::Span& span);

} // namespace scc::cli
