#include "compiler/function_builder.h"

#include "runtime/function.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

namespace scc::compiler {

namespace {

/// Powers up to this one become products.
constexpr double most_factors = 16;

} // namespace

std::uint32_t FunctionBuilder::add(const Key& key, const ir::Node& node) {
    const auto [place, inserted] = known_.emplace(key, static_cast<std::uint32_t>(nodes_.size()));
    if (inserted) {
        nodes_.push_back(node);
        places_.push_back(place_);
    }
    return place->second;
}

std::uint32_t FunctionBuilder::constant(double value) {
    return add({0, std::bit_cast<std::uint64_t>(value), {}},
               {.kind = ir::Node::Kind::constant, .constant = value});
}

std::uint32_t FunctionBuilder::input(std::string_view name) {
    for (int i = 0; i < ir::input_count; ++i) {
        const auto input = static_cast<ir::Input>(i);
        if (ir::name(input) == name) {
            return add({1, static_cast<std::uint64_t>(i), {}},
                       {.kind = ir::Node::Kind::input, .input = input});
        }
    }
    throw std::logic_error("unknown input " + std::string(name));
}

std::uint32_t FunctionBuilder::apply(std::string_view op, const std::vector<std::uint32_t>& operands) {
    const auto found = ir::find_operator(op);
    if (!found || operands.size() != static_cast<std::size_t>(ir::row(*found).arity)) {
        throw std::logic_error("unknown operator " + std::string(op));
    }
    if (*found == ir::Op::mul && operands[0] == operands[1]) {
        return apply_row(ir::Op::square, {operands[0]});
    }
    if (*found == ir::Op::pow && nodes_[operands[1]].kind == ir::Node::Kind::constant) {
        const double exponent = nodes_[operands[1]].constant;
        if (exponent >= 2 && exponent <= most_factors && exponent == std::floor(exponent)) {
            return whole_power(operands[0], static_cast<unsigned>(exponent));
        }
    }
    return apply_row(*found, operands);
}

std::uint32_t FunctionBuilder::apply_row(ir::Op op, const std::vector<std::uint32_t>& operands) {
    ir::Node node{.kind = ir::Node::Kind::apply, .op = op};
    for (std::size_t i = 0; i < operands.size(); ++i) {
        node.operands[i] = operands[i];
    }
    return add({2, static_cast<std::uint64_t>(op), node.operands}, node);
}

std::optional<std::array<lang::Scalar, 3>> FunctionBuilder::image(const lang::ThingPtr& image,
                                                                  const std::array<lang::Scalar, 2>& uv) {
    const std::shared_ptr<const ir::Image> found = table_ != nullptr ? table_->find(image) : nullptr;
    if (!found) {
        return std::nullopt;
    }
    std::array<std::uint32_t, 2> operands{};
    for (std::size_t i = 0; i < uv.size(); ++i) {
        operands[i] = uv[i].is_constant() ? constant(uv[i].value) : uv[i].symbol;
    }
    std::array<lang::Scalar, 3> channels;
    for (std::uint8_t channel = 0; channel < 3; ++channel) {
        channels[channel] = {0, look_up(found, channel, operands[0], operands[1])};
    }
    return channels;
}

std::uint32_t FunctionBuilder::look_up(const std::shared_ptr<const ir::Image>& image, std::uint8_t channel,
                                       std::uint32_t u, std::uint32_t v) {
    const auto known = std::find(images_.begin(), images_.end(), image);
    ir::Node node{.kind = ir::Node::Kind::image, .channel = channel, .operands = {u, v, 0}};
    node.image = static_cast<std::uint32_t>(known - images_.begin());
    if (known == images_.end()) {
        images_.push_back(image);
    }
    return add({3, runtime::channel_of(node.image, channel), node.operands}, node);
}

/// By squaring, which is faster than the library's power and has narrower bounds than products of the base.
std::uint32_t FunctionBuilder::whole_power(std::uint32_t base, unsigned exponent) {
    if (exponent == 1) {
        return base;
    }
    const std::uint32_t half = whole_power(base, exponent / 2);
    const std::uint32_t even = apply_row(ir::Op::square, {half});
    return exponent % 2 == 0 ? even : apply_row(ir::Op::mul, {even, base});
}

ir::Function FunctionBuilder::finish(const std::vector<lang::Scalar>& results) {
    std::vector<std::uint32_t> roots;
    for (const lang::Scalar& scalar : results) {
        roots.push_back(scalar.is_constant() ? constant(scalar.value) : scalar.symbol);
    }
    std::vector<bool> needed(nodes_.size());
    for (const std::uint32_t root : roots) {
        needed[root] = true;
    }
    // Operands come before the nodes that use them, so one pass from the end marks all.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        for (std::size_t k = 0; needed[i] && k < arity(nodes_[i]); ++k) {
            needed[nodes_[i].operands[k]] = true;
        }
    }
    ir::Function function;
    std::vector<std::uint32_t> renumbered(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (!needed[i]) {
            continue;
        }
        ir::Node node = nodes_[i];
        for (std::uint32_t& operand : node.operands) {
            operand = arity(node) > 0 ? renumbered[operand] : 0;
        }
        if (node.kind == ir::Node::Kind::image) {
            const std::shared_ptr<const ir::Image>& image = images_[node.image];
            const auto known = std::find(function.images.begin(), function.images.end(), image);
            node.image = static_cast<std::uint32_t>(known - function.images.begin());
            if (known == function.images.end()) {
                function.images.push_back(image);
            }
        }
        renumbered[i] = static_cast<std::uint32_t>(function.nodes.size());
        function.nodes.push_back(node);
        function.places.push_back(places_[i]);
    }
    for (const std::uint32_t root : roots) {
        function.results.push_back(renumbered[root]);
    }
    return function;
}

} // namespace scc::compiler
