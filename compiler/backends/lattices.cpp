#include "compiler/backends/lattices.h"

#include "compiler/backends/function_range.h"
#include "compiler/backends/pov_frame.h"
#include "compiler/function_term.h"
#include "compiler/ir/objects.h"
#include "runtime/math/noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scc::compiler {

namespace {

using ir::Node;
using ir::Op;

/// Whole numbers along each axis, from the first on.
struct Cells {
    std::array<double, 3> first{}, count{};

    double rows() const { return count[1] * count[2]; }
};

/// All cells that values in these ranges, and what rounding makes of them, lie in; none if they are too many.
std::optional<Cells> cells_about(const std::array<Range, 3>& ranges) {
    constexpr double most_cells = 1 << 18, most_texels_across = 16384;
    Cells cells;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& [min, max] = ranges[i];
        const double slack = min == max ? 0 : 1e-4 * (1 + std::abs(min) + std::abs(max));
        cells.first[i] = std::floor(min - slack);
        cells.count[i] = std::floor(max + slack) + 1 - cells.first[i];
    }
    const bool fits = cells.rows() <= most_texels_across && 3 * cells.count[0] <= most_texels_across &&
                      cells.rows() * cells.count[0] <= most_cells; // not where one is infinite or no number
    return fits ? std::optional(cells) : std::nullopt;
}

/// The values that a cell's look-ups give: of noise those at its corners, x first.
std::vector<float> texels_of(Op op, const Cells& cells) {
    std::vector<float> texels;
    for (double row = 0; row < cells.rows(); ++row) {
        for (double column = 0; column < cells.count[0]; ++column) {
            const double x = cells.first[0] + column, y = cells.first[1] + std::fmod(row, cells.count[1]),
                         z = cells.first[2] + std::floor(row / cells.count[1]);
            if (op == Op::random) {
                texels.push_back(static_cast<float>(runtime::random_number(x, y, z)));
                continue;
            }
            for (unsigned i = 0; i < 8; ++i) {
                texels.push_back(static_cast<float>(
                    runtime::noise_number(x + (i & 1U), y + (i >> 1U & 1U), z + (i >> 2U))));
            }
            texels.push_back(0); // three colours have nine numbers
        }
    }
    return texels;
}

std::shared_ptr<const ir::Image> image_of(Op op, const Cells& cells) {
    const auto texels = std::make_shared<const std::vector<float>>(texels_of(op, cells));
    auto image = std::make_shared<ir::Image>();
    image->name = row(op).name;
    image->key = fmt::format("{} {} {} {} {} {} {}", image->name, cells.first[0], cells.first[1],
                             cells.first[2], cells.count[0], cells.count[1], cells.count[2]);
    runtime::ImageData& data = image->data;
    data.values = texels->data();
    data.channels = op == Op::random ? 1 : 3;
    data.width = static_cast<std::uint32_t>(cells.count[0]) * (op == Op::random ? 1 : 3);
    data.height = static_cast<std::uint32_t>(cells.rows());
    data.wrap = runtime::Wrap::clamp;
    data.filter = runtime::Filter::nearest;
    data.max = {1, 1, 1};
    image->owner = texels;
    return image;
}

/// A function with its look-ups.
class LatticeWriter {
public:
    LatticeWriter(const ir::Function& function, const InputRanges& inputs)
        : function_(function), ranges_(node_ranges(function, inputs)), whole_(whole_nodes(function)) {}

    ir::Function run() {
        std::vector<std::uint32_t> made = builder_.include(
            function_, [&](ir::Input which) { return builder_.input(ir::name(which)); },
            [&](std::size_t node, const std::vector<std::uint32_t>& operands) {
                return replaced(node, operands);
            });
        std::vector<lang::Scalar> results;
        for (const std::uint32_t result : function_.results) {
            results.push_back({0, made[result]});
        }
        ir::Function function = builder_.finish(results);
        function.name = function_.name;
        return function;
    }

private:
    std::optional<std::uint32_t> replaced(std::size_t at, const std::vector<std::uint32_t>& operands) {
        const Node& node = function_.nodes[at];
        const bool is_random = node.op == Op::random;
        if (node.op != Op::noise && !is_random) {
            return std::nullopt;
        }
        std::array<Range, 3> ranges;
        for (std::size_t i = 0; i < 3; ++i) {
            ranges[i] = ranges_[node.operands[i]];
            if (is_random && !whole_[node.operands[i]]) {
                return std::nullopt;
            }
        }
        const std::optional<Cells> cells = cells_about(ranges);
        if (!cells) {
            return std::nullopt;
        }
        const std::shared_ptr<const ir::Image> image = image_of(node.op, *cells);
        const std::array<Term, 3> p{term(operands[0]), term(operands[1]), term(operands[2])};
        return (is_random ? random(*cells, image, p) : noise(*cells, image, p)).node;
    }

    Term term(std::uint32_t node) { return {&builder_, node}; }
    static Term floor_of(const Term& a) { return a.of("floor", {a.node}); }

    /// A cell's `texel`, as the image has them side by side. `low`: the cell's whole numbers.
    Term look_up(const Cells& cells, const std::shared_ptr<const ir::Image>& image,
                 const std::array<Term, 3>& low, std::uint8_t texel, std::uint8_t channel) {
        const double texels = image->data.width / cells.count[0];
        const Term u = ((low[0] - cells.first[0]) * texels + (texel + 0.5)) * (1.0 / image->data.width);
        const Term row = (low[1] - cells.first[1]) + (low[2] - cells.first[2]) * cells.count[1];
        const Term v = (row + 0.5) * (1.0 / image->data.height);
        return term(builder_.look_up(image, channel, u.node, v.node));
    }
    Term random(const Cells& cells, const std::shared_ptr<const ir::Image>& image,
                const std::array<Term, 3>& p) {
        return look_up(cells, image, {floor_of(p[0]), floor_of(p[1]), floor_of(p[2])}, 0, 0);
    }
    Term noise(const Cells& cells, const std::shared_ptr<const ir::Image>& image,
               const std::array<Term, 3>& p) {
        const std::array<Term, 3> low{floor_of(p[0]), floor_of(p[1]), floor_of(p[2])};
        const auto corner = [&](unsigned i) {
            return look_up(cells, image, low, static_cast<std::uint8_t>(i / 3),
                           static_cast<std::uint8_t>(i % 3));
        };
        const auto curve = [&](std::size_t axis) {
            const Term t = p[axis] - low[axis];
            return t * t * t * (t * (t * 6 - 15) + 10);
        };
        const auto between = [](const Term& a, const Term& b, const Term& t) { return a + (b - a) * t; };
        const Term x = curve(0), y = curve(1), z = curve(2);
        const auto along_x = [&](unsigned i) { return between(corner(i), corner(i + 1), x); };
        return between(between(along_x(0), along_x(2), y), between(along_x(4), along_x(6), y), z);
    }

    const ir::Function& function_;
    std::vector<Range> ranges_;
    std::vector<bool> whole_;
    FunctionBuilder builder_;
};

/// What a function is asked for, by all that have it.
class Inputs {
public:
    void cover(const InputRanges& more) {
        for (std::size_t i = 0; ranges_ && i < more.size(); ++i) {
            Range& range = (*ranges_)[i];
            range = {std::min(range.min, more[i].min), std::max(range.max, more[i].max)};
        }
        ranges_ = ranges_.value_or(more);
    }
    const std::optional<InputRanges>& ranges() const { return ranges_; }

private:
    std::optional<InputRanges> ranges_;
};

} // namespace

bool has_lattice(const ir::Function& function) {
    return std::any_of(function.nodes.begin(), function.nodes.end(), [](const Node& node) {
        return node.kind == Node::Kind::apply && (node.op == Op::noise || node.op == Op::random);
    });
}

ir::Scene with_lattices(const ir::Scene& scene) {
    std::vector<Inputs> inputs(scene.functions.size());
    ir::for_each_surface(scene, [&](const ir::Object& object) {
        const InputRanges ranges = input_ranges(object, scene);
        for (const std::uint32_t material : {object.sides.front, object.sides.back}) {
            for (const std::int32_t function : ir::functions_of(scene.materials[material].phong)) {
                if (function != runtime::no_function) {
                    inputs[static_cast<std::size_t>(function)].cover(ranges);
                }
            }
        }
    });
    ir::Scene result = scene;
    for (std::size_t i = 0; i < scene.functions.size(); ++i) {
        if (inputs[i].ranges() && has_lattice(scene.functions[i])) {
            result.functions[i] = LatticeWriter(scene.functions[i], *inputs[i].ranges()).run();
        }
    }
    return result;
}

ir::Function field_with_lattices(const ir::Scene& scene, std::int32_t field) {
    const ir::Function& function = scene.functions[static_cast<std::size_t>(field)];
    Inputs inputs;
    ir::for_each_surface(scene, [&](const ir::Object& object) {
        const auto* implicit = std::get_if<runtime::Implicit<double>>(&object.shape);
        if (implicit != nullptr && implicit->field == field) {
            inputs.cover(input_ranges(object, scene));
        }
    });
    return inputs.ranges() && has_lattice(function) ? LatticeWriter(function, *inputs.ranges()).run()
                                                    : function;
}

} // namespace scc::compiler
