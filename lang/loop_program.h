#pragma once

#include "lang/scalar_math.h"
#include "lang/value.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace scc::lang {

/// What a loop's body computes, recorded once for all rounds: operations on scalars, of which equal ones are
/// stored once, and what has to hold for the body to be right.
class LoopRecorder final : public SymbolBuilder {
public:
    enum class Kind : std::uint8_t { constant, input, apply, lookup };
    struct Node {
        Kind kind{};
        ScalarOp op{};
        std::array<std::uint32_t, 3> operands{}; ///< earlier nodes; of a lookup: the index, then the list
        double constant = 0;
        std::uint32_t input = 0;
    };

    std::uint32_t constant(double value) override;
    /// A per-point function's; there is none here.
    std::uint32_t input(std::string_view name) override;
    std::uint32_t apply(std::string_view op, const std::vector<std::uint32_t>& operands) override;
    bool has_requirements() const override { return true; }
    void require(std::uint32_t condition) override;
    std::optional<std::uint32_t> lookup(std::vector<double> list, std::uint32_t index) override;
    void enter(std::uint32_t condition, bool holds) override;
    void leave() override { guards_.pop_back(); }

    /// The variable of the n-th loop from outside.
    std::uint32_t variable(std::uint32_t loop);

    const std::vector<Node>& nodes() const { return nodes_; }
    const std::vector<std::vector<double>>& lists() const { return lists_; }
    const std::vector<std::uint32_t>& requirements() const { return requirements_; }

    /// Puts other conditions in the place of those that are entered now.
    std::vector<std::uint32_t> exchange_guards(std::vector<std::uint32_t> guards) {
        return std::exchange(guards_, std::move(guards));
    }

private:
    using Key = std::tuple<Kind, std::uint64_t, std::array<std::uint32_t, 3>>;
    std::uint32_t add(const Key& key, const Node& node);
    std::uint32_t apply(ScalarOp op, std::array<std::uint32_t, 3> operands);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> guards_; ///< each together with those before it
    std::vector<std::vector<double>> lists_;
    std::vector<std::uint32_t> requirements_;
    std::map<Key, std::uint32_t> known_;
    std::map<std::vector<double>, std::uint32_t> known_lists_;
};

/// Runs a recorded body for many rounds at a time, each operation in a loop of its own over all of them.
class LoopProgram {
public:
    static constexpr std::size_t lanes = 256;

    /// Computes these nodes and the requirements.
    LoopProgram(const LoopRecorder& recorder, const std::vector<std::uint32_t>& results);

    /// Fill the variables of the loops that enclose the body, then run; lanes past the last round hold
    /// anything.
    double* variable(std::size_t loop) { return variables_[loop].data(); }
    void run();

    const double* result(std::size_t i) const { return registers_[results_[i]].data(); }
    /// Some requirement does not hold in this lane.
    bool fails(std::size_t lane) const;
    bool fails_anywhere(std::size_t count) const;

private:
    using Lanes = std::array<double, lanes>;
    using Kernel = void (*)(const double* a, const double* b, const double* c, double* out);
    struct Step {
        Kernel kernel; ///< null: a lookup
        std::uint32_t a, b, c, out;
    };
    void look_up(const Step& step);

    const LoopRecorder& recorder_;
    std::vector<Lanes> registers_;
    std::vector<Lanes> variables_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> inputs_; ///< register, loop
    std::vector<Step> steps_;
    std::vector<std::uint32_t> results_;
    std::vector<std::uint32_t> requirements_; ///< registers
};

} // namespace scc::lang
