#include "compiler/backends/function_range.h"

#include "compiler/backends/function_program.h"
#include "runtime/function.h"

#include <algorithm>

namespace scc::compiler {

namespace {

using ir::Op;
using Wide = runtime::Interval<long double>;

Range nearest(const Wide& bounds) {
    return {static_cast<double>(bounds.min), static_cast<double>(bounds.max)};
}

} // namespace

std::vector<Range> node_ranges(const ir::Function& function, const InputRanges& inputs) {
    std::array<Wide, ir::input_count> x;
    std::transform(inputs.begin(), inputs.end(), x.begin(),
                   [](const Range& range) { return Wide(range.min, range.max); });
    const runtime::SurfacePoint<Wide> point{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8]}};
    const auto program = program_of<long double>(function);
    const Wide* bounds = run(program, point);
    std::vector<Range> ranges(function.nodes.size());
    std::transform(bounds, bounds + ranges.size(), ranges.begin(), nearest);
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
