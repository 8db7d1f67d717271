#pragma once

#include "compiler/ir/function.h"
#include "compiler/writer.h"

#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {

/// Which of "p", "world" and "n" the function reads.
std::vector<std::string_view> points_read(const ir::Function& function);

/// A Python function that makes the nodes: `def identifier(g, p, n) -> "Color":`, where g is a Graph of
/// blender/nodes.py. "Float" of one result, "Color" of three, "Field" of a value with its gradient.
void write_function(Writer& out, const ir::Function& function, const std::string& identifier);

} // namespace scc::compiler
