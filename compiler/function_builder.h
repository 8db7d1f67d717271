#pragma once

#include "compiler/image_table.h"
#include "compiler/ir/function.h"
#include "lang/value.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

namespace scc::compiler {

/// Records the operations of one per-point function; an operation that was recorded before is reused.
class FunctionBuilder : public lang::SymbolBuilder {
public:
    /// Without a table of images there are none.
    explicit FunctionBuilder(ImageTable* images = nullptr) : table_(images) {}

    std::uint32_t constant(double value) override;
    std::uint32_t input(std::string_view name) override;
    std::uint32_t apply(std::string_view op, const std::vector<std::uint32_t>& operands) override;

    std::optional<std::array<lang::Scalar, 3>> image(const lang::ThingPtr& image,
                                                     const std::array<lang::Scalar, 2>& uv) override;

    std::uint32_t look_up(const std::shared_ptr<const ir::Image>& image, std::uint8_t channel,
                          std::uint32_t u, std::uint32_t v);

    /// Records all operations of a function, of whose inputs input(which) are the nodes; returns its nodes.
    template <class Input>
    std::vector<std::uint32_t> include(const ir::Function& function, Input&& input) {
        return include(function, input,
                       [](std::size_t, const auto&) { return std::optional<std::uint32_t>(); });
    }
    /// Of operations, replaced(which, its operands) is taken instead if there is one.
    template <class Input, class Replaced>
    std::vector<std::uint32_t> include(const ir::Function& function, Input&& input, Replaced&& replaced);

    void locate(lang::Span span) override { place_ = span; }

    /// The function with these results; nodes that no result needs are left out.
    ir::Function finish(const std::vector<lang::Scalar>& results);

private:
    using Key = std::tuple<int, std::uint64_t, std::array<std::uint32_t, 3>>;
    std::uint32_t add(const Key& key, const ir::Node& node);

    std::uint32_t apply_row(ir::Op op, const std::vector<std::uint32_t>& operands);
    std::uint32_t whole_power(std::uint32_t base, unsigned exponent);

    ImageTable* table_;
    std::vector<std::shared_ptr<const ir::Image>> images_;
    std::vector<ir::Node> nodes_;
    std::vector<lang::Span> places_; ///< of the nodes
    lang::Span place_{};
    std::map<Key, std::uint32_t> known_;
};

template <class Input, class Replaced>
std::vector<std::uint32_t> FunctionBuilder::include(const ir::Function& function, Input&& input,
                                                    Replaced&& replaced) {
    std::vector<std::uint32_t> moved;
    for (std::size_t i = 0; i < function.nodes.size(); ++i) {
        const ir::Node& node = function.nodes[i];
        locate(function.places[i]);
        std::vector<std::uint32_t> operands;
        for (std::size_t k = 0; k < arity(node); ++k) {
            operands.push_back(moved[node.operands[k]]);
        }
        switch (node.kind) {
        case ir::Node::Kind::constant:
            moved.push_back(constant(node.constant));
            break;
        case ir::Node::Kind::input:
            moved.push_back(input(node.input));
            break;
        case ir::Node::Kind::apply:
            if (const std::optional<std::uint32_t> instead = replaced(i, operands)) {
                moved.push_back(*instead);
            } else {
                moved.push_back(apply(row(node.op).name, operands));
            }
            break;
        case ir::Node::Kind::image:
            moved.push_back(look_up(function.images[node.image], node.channel, operands[0], operands[1]));
            break;
        }
    }
    return moved;
}

} // namespace scc::compiler
