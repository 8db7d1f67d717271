#include "validation/scene_budget.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace scc::validation {
namespace {

constexpr std::string_view mark = "//@";
constexpr std::array<std::string_view, 4> renderers{"pov", "blender", "opengl", "native"};

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos)
        return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

double number_of(std::string_view text, int line) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value < 0)
        throw BudgetError(line, fmt::format("`{}` is no limit; a number from 0 on is", text));
    return value;
}

int count_of(std::string_view text, int line) {
    constexpr double most = 640.0 * 480.0;
    const double value = number_of(text, line);
    if (value > most || value != std::floor(value))
        throw BudgetError(line, fmt::format("`{}` is no number of pixels of 640 x 480", text));
    return static_cast<int>(value);
}

void read_limit(std::string_view text, SceneBudget& budget) {
    const std::size_t equals = text.find('=');
    const std::string_view name = trimmed(text.substr(0, equals));
    if (equals == std::string_view::npos)
        throw BudgetError(budget.line, fmt::format("`{}` is no limit; `NAME = NUMBER` is", name));
    const std::string_view value = trimmed(text.substr(equals + 1));
    if (name == "max_error")
        budget.max_error = number_of(value, budget.line);
    else if (name == "away_from_edges")
        budget.away_from_edges = number_of(value, budget.line);
    else if (name == "outliers")
        budget.outliers = count_of(value, budget.line);
    else if (name == "above_1e-3")
        budget.above_1e3 = count_of(value, budget.line);
    else
        throw BudgetError(budget.line, fmt::format("there is no limit `{}`; there are max_error, outliers, "
                                                   "away_from_edges and above_1e-3",
                                                   name));
}

/// `text`: what follows the mark.
SceneBudget read_budget(std::string_view text, int line) {
    constexpr std::string_view word = "budget ";
    constexpr std::string_view because = " because ";
    const std::size_t colon = text.find(':');
    const std::size_t reason_at = text.find(because);
    if (!text.starts_with(word) || colon == std::string_view::npos)
        throw BudgetError(line, "`//@` begins `//@ budget RENDERER: LIMIT = NUMBER, ... because REASON`");
    if (reason_at == std::string_view::npos || reason_at < colon)
        throw BudgetError(line, "a budget of the scene's own needs a reason: `... because REASON`");
    SceneBudget budget;
    budget.line = line;
    budget.renderer = trimmed(text.substr(word.size(), colon - word.size()));
    budget.reason = trimmed(text.substr(reason_at + because.size()));
    if (std::find(renderers.begin(), renderers.end(), budget.renderer) == renderers.end())
        throw BudgetError(line, fmt::format("there is no renderer `{}`; there are {}", budget.renderer,
                                            "pov, blender, opengl and native"));
    std::string_view limits = text.substr(colon + 1, reason_at - colon - 1);
    for (;;) {
        const std::size_t comma = limits.find(',');
        read_limit(limits.substr(0, comma), budget);
        if (comma == std::string_view::npos)
            return budget;
        limits.remove_prefix(comma + 1);
    }
}

} // namespace

std::vector<SceneBudget> read_scene_budgets(std::string_view scene_text) {
    std::vector<SceneBudget> budgets;
    for (int line = 1; !scene_text.empty(); ++line) {
        const std::size_t end = std::min(scene_text.find('\n'), scene_text.size());
        const std::string_view text = trimmed(scene_text.substr(0, end));
        scene_text.remove_prefix(std::min(end + 1, scene_text.size()));
        if (!text.starts_with(mark))
            continue;
        SceneBudget budget = read_budget(trimmed(text.substr(mark.size())), line);
        const bool again = std::any_of(budgets.begin(), budgets.end(), [&](const SceneBudget& other) {
            return other.renderer == budget.renderer;
        });
        if (again)
            throw BudgetError(line, fmt::format("`{}` has a budget already", budget.renderer));
        budgets.push_back(std::move(budget));
    }
    return budgets;
}

Budget with_scene_budget(Budget budget, const SceneBudget& stated, int width, int height) {
    if (stated.max_error)
        budget.max_error = *stated.max_error;
    if (stated.outliers)
        budget.outliers = pixels_of_base(*stated.outliers, width, height);
    if (stated.away_from_edges)
        budget.max_away_from_edges = stated.away_from_edges;
    if (stated.above_1e3)
        budget.above_1e3 = pixels_of_base(*stated.above_1e3, width, height);
    budget.reason = fmt::format("the scene's own, line {}: {} (otherwise: {})", stated.line, stated.reason,
                                budget.reason);
    return budget;
}

} // namespace scc::validation
