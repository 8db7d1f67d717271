#include "compiler/backends/pov_function.h"

#include "compiler/backends/function_program.h"
#include "compiler/backends/pov_expression.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace scc::compiler {

namespace {

using ir::Node;
using ir::Op;

/// A value that changes linearly from t = 0 to t = 1.
struct Line {
    double start = 0, end = 0;

    double at(double t) const { return t == 0 ? start : t == 1 ? end : start + t * (end - start); }
};
using MaybeLine = std::optional<Line>;

MaybeLine line_of(const Node& node, bool t_is_truth, std::uint32_t t, const std::vector<MaybeLine>& lines) {
    const auto line = [&](std::size_t k) { return lines[node.operands[k]]; };
    const auto constant = [&](std::size_t k) { return line(k) && line(k)->start == line(k)->end; };
    switch (node.op) {
    case Op::neg:
        return line(0) ? MaybeLine({-line(0)->start, -line(0)->end}) : std::nullopt;
    case Op::add:
    case Op::sub: {
        if (!line(0) || !line(1)) {
            return std::nullopt;
        }
        const double sign = node.op == Op::add ? 1 : -1;
        return Line{line(0)->start + sign * line(1)->start, line(0)->end + sign * line(1)->end};
    }
    case Op::mul: {
        const std::size_t factor = constant(0) ? 0 : 1;
        if (!constant(factor) || !line(1 - factor)) {
            return std::nullopt;
        }
        const double by = line(factor)->start;
        return Line{line(1 - factor)->start * by, line(1 - factor)->end * by};
    }
    case Op::div:
        if (!line(0) || !constant(1)) {
            return std::nullopt;
        }
        return Line{line(0)->start / line(1)->start, line(0)->end / line(1)->start};
    case Op::select:
        if (node.operands[0] != t || !t_is_truth || !constant(1) || !constant(2)) {
            return std::nullopt;
        }
        return Line{line(2)->start, line(1)->start};
    default:
        return std::nullopt;
    }
}

/// Every result as a line in the value of node t, if all are.
std::optional<std::vector<Line>> lines_in(const ir::Function& function, std::uint32_t t, bool t_is_truth) {
    std::vector<MaybeLine> lines(function.nodes.size());
    for (std::uint32_t i = 0; i < function.nodes.size(); ++i) {
        const Node& node = function.nodes[i];
        if (i == t) {
            lines[i] = Line{0, 1};
        } else if (node.kind == Node::Kind::constant) {
            lines[i] = Line{node.constant, node.constant};
        } else if (node.kind == Node::Kind::apply) {
            lines[i] = line_of(node, t_is_truth, t, lines);
        }
    }
    std::vector<Line> results;
    for (const std::uint32_t result : function.results) {
        if (!lines[result]) {
            return std::nullopt;
        }
        results.push_back(*lines[result]);
    }
    return results;
}

struct OneVariable {
    std::uint32_t t = 0;
    bool truth = false;
    std::vector<Line> lines;
};

/// A node on which all results depend, and linearly: conditions first, since they need no scaling.
std::optional<OneVariable> one_variable(const ir::Function& function) {
    // The search takes the square of the function's length.
    if (function.nodes.size() > 4000) {
        return std::nullopt;
    }
    for (const bool truth : {true, false}) {
        for (auto t = static_cast<std::uint32_t>(function.nodes.size()); t-- > 0;) {
            const Node& node = function.nodes[t];
            if (node.kind == Node::Kind::constant ||
                truth != (node.kind == Node::Kind::apply && is_truth(node.op))) {
                continue;
            }
            if (auto lines = lines_in(function, t, truth)) {
                return OneVariable{t, truth, *std::move(lines)};
            }
        }
    }
    return std::nullopt;
}

runtime::Rgb<double> color(const std::vector<double>& channels) {
    return channels.size() == 1 ? runtime::Rgb<double>{channels[0], channels[0], channels[0]}
                                : runtime::Rgb<double>{channels[0], channels[1], channels[2]};
}

/// In 0..1: the textures of POV-Ray start again above 1.
std::string unit_interval(const std::string& value, double low, double high) {
    const std::string shifted = low == 0 ? value : fmt::format("({} - ({}))", value, number(low));
    const std::string stretched =
        high - low == 1 ? shifted : fmt::format("{}/{}", shifted, number(high - low));
    return fmt::format("min(max({}, 0), 1)", stretched);
}

/// The largest distance of sampled values from the range; a lower bound of what cutting does.
double excess(const ir::Function& function, std::uint32_t node, const InputRanges& inputs, Range range) {
    const auto program = program_of<double>(function);
    double largest = 0;
    for (int sample = 0; sample < 4096; ++sample) {
        std::array<double, ir::input_count> x{};
        for (std::size_t i = 0; i < x.size(); ++i) {
            constexpr double primes[] = {0.7548776662, 0.5698402910, 0.8191725134, 0.6710436067,
                                         0.5497004779, 0.4502995221, 0.8566748838, 0.7338918566,
                                         0.6287067210, 0.5385972572, 0.4613935681};
            const double low = std::max(inputs[i].min, -1000.0), high = std::min(inputs[i].max, 1000.0);
            const double fraction = sample * primes[i] - std::floor(sample * primes[i]);
            x[i] = low + fraction * (high - low);
        }
        const runtime::SurfacePoint<double> point{
            {x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8]}, {x[9], x[10]}};
        const double value = run(program, point)[node];
        if (!std::isnan(value)) {
            largest = std::max({largest, range.min - value, value - range.max});
        }
    }
    return std::min(largest, 1e30);
}

std::string map_point(const runtime::Affine<double>& a) {
    static constexpr std::string_view axes[] = {"x", "y", "z"};
    std::string result;
    for (const auto& row : a.m) {
        std::string sum;
        for (std::size_t i = 0; i < 3; ++i) {
            if (row[i] != 0) {
                sum += fmt::format("{}{}*({})", sum.empty() ? "" : " + ", axes[i], number(row[i]));
            }
        }
        result += fmt::format("{}{}{}({})", result.empty() ? "" : ", ", sum, sum.empty() ? "" : " + ",
                              number(row[3]));
    }
    return result;
}

} // namespace

void PovFunctions::cover(std::int32_t index, const InputRanges& inputs) {
    std::optional<InputRanges>& all = inputs_[static_cast<std::size_t>(index)];
    if (!all) {
        all = inputs;
        return;
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        (*all)[i] = {std::min((*all)[i].min, inputs[i].min), std::max((*all)[i].max, inputs[i].max)};
    }
}

const PovExpression::Words& PovFunctions::words(std::int32_t index) {
    std::optional<PovExpression::Words>& words = words_[static_cast<std::size_t>(index)];
    if (words) {
        return *words;
    }
    words.emplace();
    const ir::Function& function = functions_[static_cast<std::size_t>(index)];
    for (const std::shared_ptr<const ir::Image>& image : function.images) {
        words->images.push_back(&images_.declare(*image));
    }
    const std::vector<bool> whole = whole_nodes(function);
    std::vector<Range> ranges;
    for (std::uint32_t i = 0; i < function.nodes.size(); ++i) {
        const Node& node = function.nodes[i];
        if (node.kind != Node::Kind::apply || (node.op != Op::noise && node.op != Op::random)) {
            continue;
        }
        const auto& [a, b, c] = node.operands;
        if (node.op == Op::random && !(whole[a] && whole[b] && whole[c])) {
            continue;
        }
        if (ranges.empty()) {
            ranges = node_ranges(function, inputs_[static_cast<std::size_t>(index)].value_or(InputRanges{}));
        }
        const std::string name = lattices_.declare(fmt::format("{}_{}", function.name, row(node.op).name),
                                                   node.op, {ranges[a], ranges[b], ranges[c]});
        if (!name.empty()) {
            words->functions.emplace(i, name);
        }
    }
    return *words;
}

const PovFunctions::Declared& PovFunctions::declare(std::int32_t index, std::uint32_t node,
                                                    std::string_view suffix) {
    const auto [entry, is_new] = declared_.try_emplace({index, node});
    Declared& declared = entry->second;
    if (!is_new) {
        return declared;
    }
    const ir::Function& function = functions_[static_cast<std::size_t>(index)];
    const PovExpression expression(function, node, words(index));
    declared.reads_p = expression.reads_p();
    declared.reads_world = expression.reads_world();
    declared.reads_uv = expression.reads_uv();
    if (expression.reads_normal()) {
        declared.obstacle = "POV-Ray's functions cannot read the normal n";
    } else if (!expression.unspoken().empty()) {
        declared.obstacle =
            fmt::format("its `{}` would need a table that is unbounded or has more than {} points{}",
                        expression.unspoken(), PovLattices::most_points,
                        expression.unspoken() == "random" ? ", or is not that of whole numbers" : "");
    } else if (!expression.fits()) {
        declared.obstacle = "it needs more parameters or deeper nesting than POV-Ray's functions have";
    } else {
        declared.name = expression.declare(fmt::format("{}{}", function.name, suffix), names_, out_);
    }
    return declared;
}

PovFunctions::Scaled PovFunctions::scaled(std::int32_t index, std::uint32_t node, std::string_view suffix,
                                          const Place& place, Outcome& outcome) {
    const ir::Function& function = functions_[static_cast<std::size_t>(index)];
    const Range whole = node_ranges(function, place.inputs)[node];
    const Range cut{std::clamp(whole.min, -place.largest, place.largest),
                    std::clamp(whole.max, -place.largest, place.largest)};
    const Declared& declared = declare(index, node, suffix);
    const std::string_view obstacle = declared.reads_uv && !place.uv_obstacle.empty() ? place.uv_obstacle
                                      : declared.name.empty()                         ? declared.obstacle
                                                                                      : "";
    if (!obstacle.empty()) {
        outcome = {Fidelity::dropped, fmt::format("drawn with its mean value: {}", obstacle), 0};
        const double middle = std::clamp((cut.min + cut.max) / 2, 0.0, 1.0);
        return {"", middle, middle};
    }
    if (!(whole == cut) && outcome.fidelity != Fidelity::dropped) {
        outcome = {
            Fidelity::approximated,
            fmt::format(
                "the function's bounds are not known; values outside {}..{} are cut, by up to the bound "
                "at 4096 sampled points",
                number(cut.min), number(cut.max)),
            std::max(outcome.bound, excess(function, node, place.inputs, cut))};
    }
    std::string arguments = "x, y, z";
    if (declared.reads_world && place.world_from_object != nullptr) {
        const std::string world = map_point(*place.world_from_object);
        arguments = declared.reads_p ? "x, y, z, " + world : world;
    } else if (declared.reads_world && declared.reads_p) {
        arguments = "x, y, z, x, y, z";
    }
    const std::string value = fmt::format("{}({})", declared.name, arguments);
    const bool truth = function.nodes[node].kind == Node::Kind::apply && is_truth(function.nodes[node].op);
    if (truth) {
        return {value, 0, 1};
    }
    return cut.min < cut.max ? Scaled{unit_interval(value, cut.min, cut.max), cut.min, cut.max}
                             : Scaled{"0", cut.min, cut.min};
}

Outcome PovFunctions::outcome_of(std::int32_t index) {
    const ir::Function& function = functions_[static_cast<std::size_t>(index)];
    Outcome outcome{Fidelity::exact, "as an SDL function", 0};
    if (!words(index).functions.empty()) {
        outcome = {
            Fidelity::approximated,
            "as an SDL function, `noise` and `random` as tables of 32 bits; bound of one of their values",
            PovLattices::error};
    }
    for (const std::shared_ptr<const ir::Image>& image : function.images) {
        if (const double error = images_.declare(*image).error; error > 0) {
            outcome = {Fidelity::approximated,
                       "as an SDL function; bound of what 16 bits make of an image's values",
                       std::max(outcome.bound, error)};
        }
    }
    return outcome;
}

std::pair<PovFunctions::Scaled, Outcome> PovFunctions::scaled_number(std::int32_t index, const Place& place) {
    Outcome outcome = outcome_of(index);
    Scaled value = scaled(index, functions_[static_cast<std::size_t>(index)].results[0], "", place, outcome);
    return {std::move(value), std::move(outcome)};
}

std::pair<Paint, Outcome> PovFunctions::paint(std::int32_t index, const Place& place) {
    const ir::Function& function = functions_[static_cast<std::size_t>(index)];
    Paint paint;
    paint.function = index;
    Outcome outcome = outcome_of(index);
    std::vector<double> middle;
    if (const auto one = one_variable(function)) {
        const Scaled t = scaled(index, one->t, "", place, outcome);
        std::vector<double> low, high;
        for (const Line& line : one->lines) {
            low.push_back(line.at(t.low));
            high.push_back(line.at(t.high));
        }
        paint.parts.push_back({t.t, color(low), color(high)});
        paint.two_valued = one->truth;
        middle = low;
    } else {
        for (std::size_t i = 0; i < function.results.size(); ++i) {
            static constexpr std::string_view suffixes[] = {"_red", "_green", "_blue"};
            const Scaled t = scaled(index, function.results[i], suffixes[i], place, outcome);
            std::vector<double> low(3), high(3);
            low[i] = t.low;
            high[i] = t.high;
            paint.parts.push_back({t.t, color(low), color(high)});
            middle.push_back(t.low);
        }
    }
    if (outcome.fidelity == Fidelity::dropped) {
        return {Paint{color(middle), {}, false, runtime::no_function}, outcome};
    }
    return {std::move(paint), std::move(outcome)};
}

} // namespace scc::compiler
