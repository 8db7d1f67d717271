#include "compiler/ir/function.h"

#include <algorithm>

namespace scc::compiler::ir {

namespace {

constexpr OperatorRow rows[] = {
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender) {#name, arity, cpp, sdl, blender},
#include "runtime/operators.def"
#undef SCC_OPERATOR
};

} // namespace

const OperatorRow& row(Op op) {
    return rows[static_cast<std::size_t>(op)];
}

std::optional<Op> find_operator(std::string_view name) {
    const auto* found =
        std::find_if(std::begin(rows), std::end(rows), [&](const OperatorRow& r) { return r.name == name; });
    if (found == std::end(rows)) {
        return std::nullopt;
    }
    return static_cast<Op>(found - std::begin(rows));
}

std::size_t arity(const Node& node) {
    return node.kind == Node::Kind::apply   ? static_cast<std::size_t>(row(node.op).arity)
           : node.kind == Node::Kind::image ? 2
                                            : 0;
}

std::string_view name(Input input) {
    constexpr std::string_view names[] = {"p.x", "p.y", "p.z", "world.x", "world.y", "world.z",
                                          "n.x", "n.y", "n.z", "uv.x",    "uv.y"};
    return names[static_cast<std::size_t>(input)];
}

bool Function::reads(Input first, Input last) const {
    return std::any_of(nodes.begin(), nodes.end(), [&](const Node& node) {
        return node.kind == Node::Kind::input && node.input >= first && node.input <= last;
    });
}

} // namespace scc::compiler::ir
