#pragma once

#include "compiler/ir/function.h"
#include "compiler/writer.h"

#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {

/// Which of "p", "world", "n" and "uv" the function reads.
std::vector<std::string_view> points_read(const ir::Function& function);

/// A Python function that makes the nodes: `def identifier(g, p, n) -> "Color":`, where g is a Graph of
/// blender/nodes.py. "Float" of one result, "Color" of three, "Field" of a value with its gradient.
/// `image_keys`: what the function's images are called in IMAGES.
void write_function(Writer& out, const ir::Function& function, const std::string& identifier,
                    std::vector<std::string> image_keys);

} // namespace scc::compiler
