#include "compiler/backends/pov_expression.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace scc::compiler {

namespace {

using ir::Node;

/// Smaller expressions are repeated instead of named.
constexpr std::uint64_t small_expression = 2;
/// Deeper expressions are cut, for the sake of POV-Ray's recursive parser.
constexpr std::uint32_t deepest_expression = 40;
constexpr std::size_t most_parameters = 56;
constexpr std::uint32_t most_levels = 200;

} // namespace

PovExpression::PovExpression(const ir::Function& function, std::uint32_t result, const Words& words)
    : function_(function), words_(words), result_(result), needed_(result + 1), shared_(result + 1),
      level_(result + 1), last_use_(result + 1) {
    needed_[result] = true;
    for (std::uint32_t i = result + 1; i-- > 0;) {
        for (std::size_t k = 0; needed_[i] && k < arity(function.nodes[i]); ++k) {
            needed_[function.nodes[i].operands[k]] = true;
        }
    }
    choose_shared();
    assign_levels();
}

bool PovExpression::reads(ir::Input first, ir::Input last) const {
    for (std::uint32_t i = 0; i <= result_; ++i) {
        const Node& node = function_.nodes[i];
        if (needed_[i] && node.kind == Node::Kind::input && node.input >= first && node.input <= last) {
            return true;
        }
    }
    return false;
}

std::string_view PovExpression::unspoken() const {
    for (std::uint32_t i = 0; i <= result_; ++i) {
        const Node& node = function_.nodes[i];
        if (needed_[i] && node.kind == Node::Kind::apply && ir::row(node.op).sdl.empty() &&
            !words_.functions.contains(i)) {
            return ir::row(node.op).name;
        }
    }
    return "";
}

/// How often the node's spelling writes the operand.
std::uint64_t PovExpression::occurrences(std::uint32_t index, std::size_t operand) const {
    const Node& node = function_.nodes[index];
    if (node.kind == Node::Kind::image || words_.functions.contains(index)) {
        return 1;
    }
    const std::string_view spelling = ir::row(node.op).sdl;
    const char placeholder[] = {'{', static_cast<char>('0' + operand), '}'};
    std::uint64_t count = 0;
    for (auto at = spelling.find(placeholder, 0, 3); at != std::string_view::npos;
         at = spelling.find(placeholder, at + 1, 3)) {
        ++count;
    }
    return count;
}

void PovExpression::choose_shared() {
    std::vector<std::uint64_t> size(result_ + 1), uses(result_ + 1);
    std::vector<std::uint32_t> depth(result_ + 1);
    for (std::uint32_t i = 0; i <= result_; ++i) {
        const Node& node = function_.nodes[i];
        for (std::size_t k = 0; k < arity(node); ++k) {
            size[i] = std::min<std::uint64_t>(size[i] + size[node.operands[k]] + 1, 1000);
            depth[i] = std::max(depth[i], depth[node.operands[k]] + 1);
        }
        if (depth[i] > deepest_expression) {
            shared_[i] = true;
            depth[i] = 0;
        }
    }
    shared_[result_] = false;
    uses[result_] = 1;
    for (std::uint32_t i = result_ + 1; i-- > 0;) {
        const Node& node = function_.nodes[i];
        if (!needed_[i] || arity(node) == 0) {
            shared_[i] = false;
            continue;
        }
        shared_[i] = shared_[i] || (uses[i] > 1 && size[i] > small_expression);
        for (std::size_t k = 0; k < arity(node); ++k) {
            uses[node.operands[k]] += occurrences(i, k) * (shared_[i] ? 1 : uses[i]);
        }
    }
}

void PovExpression::assign_levels() {
    for (std::uint32_t i = 0; i <= result_; ++i) {
        const Node& node = function_.nodes[i];
        for (std::size_t k = 0; k < arity(node); ++k) {
            const std::uint32_t operand = node.operands[k];
            level_[i] = std::max(level_[i], level_[operand] + (shared_[operand] ? 1 : 0));
        }
    }
    last_use_[result_] = level_[result_];
    for (std::uint32_t i = result_ + 1; i-- > 0;) {
        const Node& node = function_.nodes[i];
        const std::uint32_t calculated = shared_[i] ? level_[i] : last_use_[i];
        for (std::size_t k = 0; needed_[i] && k < arity(node); ++k) {
            last_use_[node.operands[k]] = std::max(last_use_[node.operands[k]], calculated);
        }
    }
}

std::vector<std::uint32_t> PovExpression::parameters(std::uint32_t level) const {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t i = 0; i <= result_; ++i) {
        if (shared_[i] && level_[i] < level && last_use_[i] >= level) {
            nodes.push_back(i);
        }
    }
    return nodes;
}

bool PovExpression::fits() const {
    const std::uint32_t last = level_[result_];
    for (std::uint32_t level = 1; level <= last; ++level) {
        if (level > most_levels || parameters(level).size() + 6 > most_parameters) {
            return false;
        }
    }
    return true;
}

std::string PovExpression::input(ir::Input input) const {
    static constexpr std::string_view axes[] = {"x", "y", "z"};
    if (input >= ir::Input::uv_x) {
        return std::string(axes[static_cast<std::size_t>(input) - static_cast<std::size_t>(ir::Input::uv_x)]);
    }
    const std::string_view axis = axes[static_cast<std::size_t>(input) % 3];
    const bool second = input >= ir::Input::world_x && reads_p();
    return fmt::format("{}{}", second ? "w" : "", axis);
}

std::string PovExpression::text(std::uint32_t node) const {
    return shared_[node] ? fmt::format("v{}", node) : applied(node);
}

std::string PovExpression::applied(std::uint32_t index) const {
    const Node& node = function_.nodes[index];
    switch (node.kind) {
    case Node::Kind::constant:
        return node.constant < 0 ? fmt::format("({})", number(node.constant)) : number(node.constant);
    case Node::Kind::input:
        return input(node.input);
    case Node::Kind::image:
        return words_.images[node.image]->channel(node.channel, text(node.operands[0]),
                                                  text(node.operands[1]));
    case Node::Kind::apply:
        break;
    }
    std::string operands[3];
    for (std::size_t k = 0; k < arity(node); ++k) {
        operands[k] = text(node.operands[k]);
    }
    if (const auto word = words_.functions.find(index); word != words_.functions.end()) {
        return fmt::format("{}({}, {}, {})", word->second, operands[0], operands[1], operands[2]);
    }
    return fmt::format(fmt::runtime(ir::row(node.op).sdl), operands[0], operands[1], operands[2]);
}

/// The parameters of the function of a level, or, seen from the function before it, the arguments for them.
std::string PovExpression::list(std::uint32_t level, std::uint32_t seen_from) const {
    std::string result = reads_p() && reads_world() ? "x, y, z, wx, wy, wz" : "x, y, z";
    for (const std::uint32_t node : parameters(level)) {
        result += ", " + (level_[node] == seen_from ? applied(node) : text(node));
    }
    return result;
}

std::string PovExpression::declare(std::string_view name, Identifiers& names, Writer& out) const {
    const std::uint32_t last = level_[result_];
    std::vector<std::string> functions{names.make(name)};
    for (std::uint32_t level = 1; level <= last; ++level) {
        functions.push_back(names.make(fmt::format("{}_step", name)));
    }
    for (std::uint32_t level = last + 1; level-- > 0;) {
        const std::string body = level == last
                                     ? text(result_)
                                     : fmt::format("{}({})", functions[level + 1], list(level + 1, level));
        out.line("#declare {} = function({}) {{ {} }}", functions[level], list(level, last + 1), body);
    }
    return functions[0];
}

} // namespace scc::compiler
