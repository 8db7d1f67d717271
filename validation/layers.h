#pragma once

#include "runtime/image.h"
#include "validation/image_tools.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// What two renderers' rays meet, compared before the light that they bring.
namespace scc::validation {

/// Of the ray through each pixel's centre. Pictures have three channels; where a ray meets nothing, `object`
/// is 0.
struct Layers {
    runtime::Image position; ///< world coordinates
    runtime::Image normal;   ///< unit, on the eye's side
    runtime::Image object;   ///< number in the scene, from 1; no pixels: not known, and no coverage either
};

struct LayerDifference {
    std::string layer;      ///< "object", "position", "depth", "normal"
    std::string unit;       ///< of `largest`: "pixels", "world units", "1"
    double tolerance = 0;   ///< what the other renderer's file and arithmetic may be off by
    double largest = 0;     ///< away from edges, where both meet the same object
    std::size_t pixels = 0; ///< of those, with more than the tolerance; of objects: where they differ
    std::size_t compared = 0;
    int x = 0, y = 0; ///< of the largest
};

struct LayerTolerances {
    double position = 1e-4; ///< of the extent of what is seen
    double normal = 1e-3;
};
/// By the name of the renderer: POV-Ray's files have 16 bits, Blender has single precision and meshes.
LayerTolerances layer_tolerances(const std::string& renderer);

/// `eye`: depths are distances from it.
std::vector<LayerDifference> compare_layers(const Layers& ours, const Layers& theirs,
                                            const std::array<double, 3>& eye,
                                            const LayerTolerances& tolerances);

/// More than a few pixels of one in a thousand.
bool differs(const LayerDifference& difference);

nlohmann::ordered_json to_json(const LayerDifference& difference);

} // namespace scc::validation
