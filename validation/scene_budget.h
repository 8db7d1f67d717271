#pragma once

#include "validation/budget.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Limits of its own that a scene states, with the reason, in a comment on a line of its own:
///
///     //@ budget blender: above_1e-3 = 60, away_from_edges = 2e-4 because the lens has 64 random points
///
/// `max_error` and `away_from_edges` are errors in linear light, `outliers` and `above_1e-3` pixels of 640 x
/// 480, as those in budget.cpp.
namespace scc::validation {

struct BudgetError : std::runtime_error {
    BudgetError(int at_line, const std::string& text) : std::runtime_error(text), line(at_line) {}
    int line; ///< of the scene, from 1
};

struct SceneBudget {
    std::string renderer;
    std::optional<double> max_error;
    std::optional<double> away_from_edges;
    std::optional<int> outliers;
    std::optional<int> above_1e3;
    std::string reason;
    int line = 0;
};

/// In the order of the text, at most one per renderer. Throws BudgetError for whatever begins with `//@` and
/// is none.
std::vector<SceneBudget> read_scene_budgets(std::string_view scene_text);

/// The budget with those limits replaced that the scene states; its reason says so.
Budget with_scene_budget(Budget budget, const SceneBudget& stated, int width, int height);

} // namespace scc::validation
