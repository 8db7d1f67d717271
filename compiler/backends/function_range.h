#pragma once

#include "compiler/ir/function.h"

#include <array>
#include <limits>
#include <vector>

namespace scc::compiler {

/// All values between min and max; the ends may be infinite.
struct Range {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();

    friend bool operator==(const Range&, const Range&) = default;
};

using InputRanges = std::array<Range, ir::input_count>;

/// For every node of the function a range that contains its values for all inputs in `inputs`: the runtime's
/// intervals in long double, rounded to the nearest double, which is what is good to write into other
/// programs.
std::vector<Range> node_ranges(const ir::Function& function, const InputRanges& inputs);

/// Which nodes give whole numbers only.
std::vector<bool> whole_nodes(const ir::Function& function);

/// Whether the operator's result is 1 or 0.
bool is_truth(ir::Op op);

} // namespace scc::compiler
