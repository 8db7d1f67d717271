#pragma once

#include "runtime/image.h"
#include "validation/layers.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

/// What kind of mistake makes two pictures of a scene differ. Each class is a hypothesis of which it is
/// tested how much of the difference (of its sum of squares) it explains.
namespace scc::validation {

enum class CauseClass { geometry, shading, sampling, encoding, unclear };
const char* name_of(CauseClass cause);

struct Evidence {
    std::string test;     ///< "tone curve", "shift", "layers", "lights"
    std::string finding;  ///< in words
    double explained = 0; ///< part of the squared difference; of layers 1 if they differ, else 0
};

struct Cause {
    CauseClass cause = CauseClass::unclear;
    std::string summary;
    std::vector<Evidence> evidence; ///< all tests that were made, in their order
};

/// What one light alone adds to the reference.
struct LightPart {
    std::string name;
    runtime::Image image;
    /// Per pixel, from the light to what is seen there; not finite where there is nothing. Empty: it has
    /// no place.
    std::vector<double> distance;
};

struct CauseInput {
    runtime::Image reference; ///< three channels each
    runtime::Image other;
    std::vector<LayerDifference> layers; ///< empty: not known
    std::vector<LightPart> lights;       ///< empty: not known
    /// The reference as it is seen through a grid of samples that is moved by so many pixels to the right and
    /// down; null: not to be had.
    std::function<runtime::Image(double dx, double dy)> redraw;
};

Cause find_cause(const CauseInput& input);

nlohmann::ordered_json to_json(const Cause& cause);

} // namespace scc::validation
