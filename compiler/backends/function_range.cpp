#include "compiler/backends/function_range.h"

#include "compiler/backends/function_program.h"
#include "runtime/function.h"

#include <algorithm>
#include <cmath>

namespace scc::compiler {

namespace {

using ir::Op;
using Wide = runtime::Interval<long double>;

/// An end that is 0 but for the intervals' rounding is written as 0.
double nearest(long double end, long double other) {
    const long double rounding = 1e-17L * std::abs(other);
    return std::isfinite(rounding) && std::abs(end) < rounding ? 0 : static_cast<double>(end);
}
Range nearest_range(const Wide& bounds) {
    return {nearest(bounds.min, bounds.max), nearest(bounds.max, bounds.min)};
}

} // namespace

std::vector<Range> node_ranges(const ir::Function& function, const InputRanges& inputs) {
    std::array<Wide, ir::input_count> x;
    std::transform(inputs.begin(), inputs.end(), x.begin(),
                   [](const Range& range) { return Wide(range.min, range.max); });
    const runtime::SurfacePoint<Wide> point{
        {x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8]}, {x[9], x[10]}};
    const auto program = program_of<long double>(function);
    const Wide* bounds = run(program, point);
    std::vector<Range> ranges(function.nodes.size());
    std::transform(bounds, bounds + ranges.size(), ranges.begin(), nearest_range);
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

std::vector<bool> whole_nodes(const ir::Function& function) {
    std::vector<bool> whole;
    for (const ir::Node& node : function.nodes) {
        bool is_whole = node.kind == ir::Node::Kind::constant && node.constant == std::floor(node.constant);
        if (node.kind == ir::Node::Kind::apply) {
            const auto operand = [&](std::size_t k) { return whole[node.operands[k]]; };
            switch (node.op) {
            case ir::Op::floor:
            case ir::Op::ceil:
                is_whole = true;
                break;
            case ir::Op::neg:
            case ir::Op::abs:
            case ir::Op::square:
                is_whole = operand(0);
                break;
            case ir::Op::add:
            case ir::Op::sub:
            case ir::Op::mul:
            case ir::Op::mod:
            case ir::Op::min:
            case ir::Op::max:
                is_whole = operand(0) && operand(1);
                break;
            case ir::Op::select:
                is_whole = operand(1) && operand(2);
                break;
            default:
                is_whole = is_truth(node.op);
                break;
            }
        }
        whole.push_back(is_whole);
    }
    return whole;
}

} // namespace scc::compiler
