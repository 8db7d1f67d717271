#pragma once

#include "lang/source.h"

#include <string>
#include <vector>

namespace scc::compiler {

enum class Fidelity { exact, approximated, dropped };

/// How one feature of the scene went into an export.
struct LedgerEntry {
    Fidelity fidelity = Fidelity::exact;
    std::string feature; ///< what the author wrote: "cylinder", "point_light attenuation", "two_sided"
    std::string subject; ///< path or name of the object, light or material
    lang::Span span;     ///< where it was written
    std::string how;     ///< by which means; for a dropped feature, why
    double bound = 0;    ///< of an approximation: largest error in the unit that `how` states
    bool is_refined_mesh = false; ///< it went there as a mesh, refined to that bound
    bool is_differenced = false;  ///< the other renderer takes slopes by differences
};

using Ledger = std::vector<LedgerEntry>;

} // namespace scc::compiler
