#include "compiler/backends/function_range.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace scc::compiler {

namespace {

using ir::Op;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

Range hull(std::initializer_list<double> values) {
    Range result{inf, -inf};
    for (const double value : values) {
        if (std::isnan(value)) {
            return {};
        }
        result = {std::min(result.min, value), std::max(result.max, value)};
    }
    return result;
}

Range sum(Range a, Range b) {
    return hull({a.min + b.min, a.max + b.max});
}
Range negated(Range a) {
    return {-a.max, -a.min};
}

double product(double a, double b) {
    return a == 0 || b == 0 ? 0 : a * b;
}
Range multiplied(Range a, Range b) {
    return hull({product(a.min, b.min), product(a.min, b.max), product(a.max, b.min), product(a.max, b.max)});
}
Range divided(Range a, Range b) {
    return b.min <= 0 && b.max >= 0 ? Range{} : multiplied(a, {1 / b.max, 1 / b.min});
}

Range modulo(Range a, Range b) {
    if (!(b.min > 0)) {
        return b.max < 0 ? Range{b.min, 0} : Range{};
    }
    const double turn = std::floor(a.min / b.min);
    if (b.min == b.max && std::isfinite(turn) && turn == std::floor(a.max / b.min)) {
        return {a.min - turn * b.min, a.max - turn * b.min};
    }
    return {0, b.max};
}

Range raised(Range a, Range b) {
    if (a.min > 0 || (a.min == 0 && b.min >= 0)) {
        return hull(
            {std::pow(a.min, b.min), std::pow(a.min, b.max), std::pow(a.max, b.min), std::pow(a.max, b.max)});
    }
    if (b.min != b.max || b.min < 0 || b.min != std::floor(b.min)) {
        return {};
    }
    const Range ends = hull({std::pow(a.min, b.min), std::pow(a.max, b.min)});
    const bool even = std::fmod(b.min, 2) == 0;
    return even && a.max > 0 ? Range{0, ends.max} : ends;
}

Range absolute(Range a) {
    const Range ends = hull({std::abs(a.min), std::abs(a.max)});
    return a.min <= 0 && a.max >= 0 ? Range{0, ends.max} : ends;
}

/// Some x = first + 2 pi k lies in the range.
bool contains_turn(Range a, double first) {
    return first + 2 * pi * std::ceil((a.min - first) / (2 * pi)) <= a.max;
}
Range sine(Range a) {
    if (!(a.max - a.min < 2 * pi)) {
        return {-1, 1};
    }
    const Range ends = hull({std::sin(a.min), std::sin(a.max)});
    return {contains_turn(a, -pi / 2) ? -1 : ends.min, contains_turn(a, pi / 2) ? 1 : ends.max};
}
Range tangent(Range a) {
    const bool one_branch = std::floor(a.min / pi + 0.5) == std::floor(a.max / pi + 0.5);
    return one_branch && std::isfinite(a.min) ? Range{std::tan(a.min), std::tan(a.max)} : Range{};
}

template <class F>
Range increasing(Range a, Range domain, F f) {
    return hull({f(std::clamp(a.min, domain.min, domain.max)), f(std::clamp(a.max, domain.min, domain.max))});
}

/// The result of a comparison that is always true, never true, or open.
Range decided(bool always, bool never) {
    return {always ? 1.0 : 0.0, never ? 0.0 : 1.0};
}

Range selected(Range condition, Range where_true, Range where_false) {
    if (condition.min == 0 && condition.max == 0) {
        return where_false;
    }
    if (condition.min > 0 || condition.max < 0) {
        return where_true;
    }
    return {std::min(where_true.min, where_false.min), std::max(where_true.max, where_false.max)};
}

Range applied(Op op, Range a, Range b, Range c) {
    const bool same = a.min == a.max && b == a, apart = a.max < b.min || b.max < a.min;
    switch (op) {
    case Op::neg:
        return negated(a);
    case Op::add:
        return sum(a, b);
    case Op::sub:
        return sum(a, negated(b));
    case Op::mul:
    case Op::logical_and:
        return multiplied(a, b);
    case Op::div:
        return divided(a, b);
    case Op::mod:
        return modulo(a, b);
    case Op::pow:
        return raised(a, b);
    case Op::min:
        return {std::min(a.min, b.min), std::min(a.max, b.max)};
    case Op::max:
    case Op::logical_or:
        return {std::max(a.min, b.min), std::max(a.max, b.max)};
    case Op::abs:
        return absolute(a);
    case Op::floor:
        return {std::floor(a.min), std::floor(a.max)};
    case Op::ceil:
        return {std::ceil(a.min), std::ceil(a.max)};
    case Op::sqrt:
        return increasing(a, {0, inf}, [](double x) { return std::sqrt(x); });
    case Op::sin:
        return sine(a);
    case Op::cos:
        return sine(sum(a, {pi / 2, pi / 2}));
    case Op::tan:
        return tangent(a);
    case Op::asin:
        return increasing(a, {-1, 1}, [](double x) { return std::asin(x); });
    case Op::acos:
        return increasing(a, {-1, 1}, [](double x) { return std::acos(x); });
    case Op::atan2:
        return a == Range{a.min, a.min} && b == Range{b.min, b.min}
                   ? Range{std::atan2(a.min, b.min), std::atan2(a.min, b.min)}
                   : Range{-pi, pi};
    case Op::exp:
        return increasing(a, {-inf, inf}, [](double x) { return std::exp(x); });
    case Op::log:
        return increasing(a, {0, inf}, [](double x) { return std::log(x); });
    case Op::eq:
        return decided(same, apart);
    case Op::ne:
        return decided(apart, same);
    case Op::lt:
        return decided(a.max < b.min, a.min >= b.max);
    case Op::le:
        return decided(a.max <= b.min, a.min > b.max);
    case Op::gt:
        return decided(a.min > b.max, a.max <= b.min);
    case Op::ge:
        return decided(a.min >= b.max, a.max < b.min);
    case Op::logical_not:
        return sum({1, 1}, negated(a));
    case Op::select:
        return selected(a, b, c);
    }
    return {};
}

} // namespace

std::vector<Range> node_ranges(const ir::Function& function, const InputRanges& inputs) {
    std::vector<Range> ranges;
    ranges.reserve(function.nodes.size());
    for (const ir::Node& node : function.nodes) {
        switch (node.kind) {
        case ir::Node::Kind::constant:
            ranges.push_back({node.constant, node.constant});
            break;
        case ir::Node::Kind::input:
            ranges.push_back(inputs[static_cast<std::size_t>(node.input)]);
            break;
        case ir::Node::Kind::apply: {
            const int arity = ir::row(node.op).arity;
            const auto operand = [&](int i) {
                return i < arity ? ranges[node.operands[static_cast<std::size_t>(i)]] : Range{};
            };
            ranges.push_back(applied(node.op, operand(0), operand(1), operand(2)));
            break;
        }
        }
    }
    return ranges;
}

bool is_truth(ir::Op op) {
    switch (op) {
    case Op::eq:
    case Op::ne:
    case Op::lt:
    case Op::le:
    case Op::gt:
    case Op::ge:
    case Op::logical_and:
    case Op::logical_or:
    case Op::logical_not:
        return true;
    default:
        return false;
    }
}

} // namespace scc::compiler
