#pragma once

#include "validation/compare.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace scc::validation {

/// What a renderer's image may differ from ours by. Derived from the measured floor of that renderer, see
/// budget.cpp.
struct Budget {
    std::string renderer; ///< "native", "pov", "blender", "opengl"
    double max_error = 0; ///< of all pixels but `outliers`; infinite: no such limit
    std::size_t outliers = 0;
    std::optional<double> max_away_from_edges;
    std::optional<std::size_t> above_1e3; ///< pixels with an error above 1e-3, edges included
    std::string reason;
};

/// The budget for an image of this size, or nothing for an unknown renderer. Pixel counts are stated per 640
/// x 480 pixels, for Blender per 640 x 480 primary rays, and grow with their number, never below their base.
/// `exposure`: RenderResult::exposure, since a file drawn darker has proportionally coarser steps.
///
/// With n x n samples an edge that falls differently for one ray moves its pixel by contrast / (n * n):
/// Blender's errors at edges are smaller but on up to n * n times as many pixels, hence its growth with the
/// rays. The edge mask sees the averaged image.
std::optional<Budget> budget_for(const std::string& renderer, int width, int height, int samples_per_axis = 1,
                                 double exposure = 1);

/// A count that is stated per 640 x 480 pixels, for a picture of this size; never below itself.
std::size_t pixels_of_base(int count, int width, int height);

/// The same for a picture with surfaces that the renderer got as meshes refined to a fraction of a pixel.
Budget with_refined_meshes(Budget budget, int width, int height, int samples_per_axis = 1);

/// The same for a picture with bumps whose slopes the renderer takes by differences.
Budget with_differenced_bumps(Budget budget, int width, int height);

nlohmann::ordered_json to_json(const Budget& budget);

enum class Verdict { passed, failed, skipped };

struct Judgement {
    Verdict verdict = Verdict::skipped;
    std::string
        reason; ///< every limit that was broken, with the numbers; why it was skipped; empty when passed
};

/// `metrics` must hold the count above `budget.max_error`; see `thresholds_for`. Values that are not finite,
/// in either image, always fail.
Judgement judge(const Budget& budget, const Metrics& metrics);

/// The default thresholds and those that `judge` needs.
std::vector<double> thresholds_for(const Budget& budget);

const char* name_of(Verdict verdict);

} // namespace scc::validation
