#include "compiler/backends/blender_function.h"

#include "compiler/backends/blender_python.h"
#include "compiler/backends/function_range.h"

#include <array>
#include <cassert>
#include <map>
#include <utility>

namespace scc::compiler {

namespace {

using ir::Node;
using ir::Op;

class FunctionWriter {
public:
    FunctionWriter(Writer& out, const ir::Function& function, std::vector<std::string> image_keys)
        : out_(out), function_(function), image_keys_(std::move(image_keys)), texts_(function.nodes.size()) {}

    void write() {
        const std::vector<bool> needed = find_needed();
        for (std::uint32_t i = 0; i < function_.nodes.size(); ++i) {
            if (needed[i]) {
                texts_[i] = text(i);
            }
        }
        std::string results;
        for (const std::uint32_t result : function_.results) {
            results += (results.empty() ? "" : ", ") + texts_[result];
        }
        out_.line("return {}", results);
    }

private:
    std::vector<bool> find_needed() const {
        std::vector<bool> needed(function_.nodes.size());
        for (const std::uint32_t result : function_.results) {
            needed[result] = true;
        }
        for (std::size_t i = function_.nodes.size(); i-- > 0;) {
            const Node& node = function_.nodes[i];
            for (std::size_t k = 0; needed[i] && k < arity(node); ++k) {
                needed[node.operands[k]] = true;
            }
        }
        return needed;
    }

    std::string text(std::uint32_t index) {
        const Node& node = function_.nodes[index];
        switch (node.kind) {
        case Node::Kind::constant:
            return python(node.constant);
        case Node::Kind::input:
            return std::string(name(node.input));
        case Node::Kind::image:
            return look_up(node);
        case Node::Kind::apply:
            break;
        }
        const std::string variable = fmt::format("t{}", index);
        out_.line("{} = {}", variable, applied(node));
        return variable;
    }

    /// One node looks all channels up.
    std::string look_up(const Node& node) {
        const auto [place, is_new] = lookups_.try_emplace({node.image, node.operands[0], node.operands[1]},
                                                          fmt::format("i{}", lookups_.size()));
        if (is_new) {
            out_.line("{} = g.image({}, {}, {})", place->second, python(image_keys_[node.image]),
                      texts_[node.operands[0]], texts_[node.operands[1]]);
        }
        return fmt::format("{}.{}", place->second, "xyz"[node.channel]);
    }

    static std::string math(std::string_view operation, const std::string& a, const std::string& b) {
        return fmt::format("g.f(\"{}\", {}, {})", operation, a, b);
    }
    static std::string inverse_truth(const std::string& truth) { return math("SUBTRACT", "1.0", truth); }

    std::string applied(const Node& node) const {
        const auto operand = [&](std::size_t k) { return texts_[node.operands[k]]; };
        const ir::OperatorRow& operation = row(node.op);
        if (!operation.blender.empty()) {
            std::string operands;
            for (std::size_t k = 0; k < static_cast<std::size_t>(operation.arity); ++k) {
                operands += ", " + operand(k);
            }
            return fmt::format("g.f(\"{}\"{})", operation.blender, operands);
        }
        const std::string a = operand(0);
        const std::string b = operation.arity > 1 ? operand(1) : "";
        switch (node.op) {
        case Op::neg:
            return math("SUBTRACT", "0.0", a);
        case Op::square:
            return math("MULTIPLY", a, a);
        case Op::mod:
            return math("SUBTRACT", a, math("MULTIPLY", b, floor_of_quotient(a, b)));
        case Op::log:
            return math("LOGARITHM", a, "math.e");
        case Op::eq:
            return inverse_truth(differ(a, b));
        case Op::ne:
            return differ(a, b);
        case Op::le:
            return inverse_truth(math("GREATER_THAN", a, b));
        case Op::ge:
            return inverse_truth(math("LESS_THAN", a, b));
        case Op::logical_not:
            return inverse_truth(a);
        case Op::select:
            return selection(node);
        case Op::random:
        case Op::noise:
            return math("ADD", "0.5", "0.0"); // the mean of both; the ledger says so
        default:
            break;
        }
        assert(false && "every operator without a Math node is composed above");
        return "0.0";
    }

    static std::string floor_of_quotient(const std::string& a, const std::string& b) {
        return fmt::format("g.f(\"FLOOR\", {})", math("DIVIDE", a, b));
    }

    // Math's own COMPARE takes numbers as equal that differ by less than a tolerance.
    static std::string differ(const std::string& a, const std::string& b) {
        return math("ADD", math("LESS_THAN", a, b), math("GREATER_THAN", a, b));
    }

    std::string selection(const Node& node) const {
        const Node& condition = function_.nodes[node.operands[0]];
        const std::string text = texts_[node.operands[0]];
        const bool truth = condition.kind == Node::Kind::apply && is_truth(condition.op);
        return fmt::format("g.select({}, {}, {})", truth ? text : differ(text, "0.0"),
                           texts_[node.operands[1]], texts_[node.operands[2]]);
    }

    Writer& out_;
    const ir::Function& function_;
    std::vector<std::string> image_keys_; ///< of the function's images
    std::map<std::array<std::uint32_t, 3>, std::string> lookups_;
    std::vector<std::string> texts_; ///< of each node: a variable, an input or a number
};

} // namespace

std::vector<std::string_view> points_read(const ir::Function& function) {
    using ir::Input;
    struct Point {
        std::string_view name;
        Input first, last;
    };
    constexpr std::array points{Point{"p", Input::p_x, Input::p_z},
                                Point{"world", Input::world_x, Input::world_z},
                                Point{"n", Input::n_x, Input::n_z}, Point{"uv", Input::uv_x, Input::uv_y}};
    std::vector<std::string_view> names;
    for (const Point& point : points) {
        if (function.reads(point.first, point.last)) {
            names.push_back(point.name);
        }
    }
    return names;
}

void write_function(Writer& out, const ir::Function& function, const std::string& identifier,
                    std::vector<std::string> image_keys) {
    std::string parameters = "g";
    for (const std::string_view point : points_read(function)) {
        parameters += fmt::format(", {}", point);
    }
    out.line("def {}({}) -> \"{}\":", identifier, parameters,
             function.results.size() == 4   ? "Field"
             : function.results.size() == 3 ? "Color"
                                            : "Float");
    out.indent();
    FunctionWriter(out, function, std::move(image_keys)).write();
    out.dedent();
}

} // namespace scc::compiler
