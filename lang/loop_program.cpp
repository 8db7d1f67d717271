#include "lang/loop_program.h"

#include "lang/scalar_fold.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace scc::lang {

// ---- recording --------------------------------------------------------------------------------------------

std::uint32_t LoopRecorder::add(const Key& key, const Node& node) {
    const auto [place, inserted] = known_.emplace(key, static_cast<std::uint32_t>(nodes_.size()));
    if (inserted) {
        nodes_.push_back(node);
    }
    return place->second;
}

std::uint32_t LoopRecorder::constant(double value) {
    return add({Kind::constant, std::bit_cast<std::uint64_t>(value), {}},
               {.kind = Kind::constant, .constant = value});
}

std::uint32_t LoopRecorder::input(std::string_view name) {
    throw std::logic_error("a loop's body reads " + std::string(name));
}

std::uint32_t LoopRecorder::variable(std::uint32_t loop) {
    return add({Kind::input, loop, {}}, {.kind = Kind::input, .input = loop});
}

std::uint32_t LoopRecorder::apply(ScalarOp op, std::array<std::uint32_t, 3> operands) {
    return add({Kind::apply, static_cast<std::uint64_t>(op), operands},
               {.kind = Kind::apply, .op = op, .operands = operands});
}

std::uint32_t LoopRecorder::apply(std::string_view op, const std::vector<std::uint32_t>& operands) {
    std::array<std::uint32_t, 3> three{operands[0], operands[0], operands[0]};
    std::copy(operands.begin(), operands.end(), three.begin());
    return apply(scalar_op(op), three);
}

std::optional<std::uint32_t> LoopRecorder::lookup(std::vector<double> list, std::uint32_t index) {
    const auto [place, inserted] = known_lists_.emplace(list, static_cast<std::uint32_t>(lists_.size()));
    if (inserted) {
        lists_.push_back(std::move(list));
    }
    const std::array<std::uint32_t, 3> operands{index, place->second, 0};
    return add({Kind::lookup, 0, operands}, {.kind = Kind::lookup, .operands = operands});
}

void LoopRecorder::enter(std::uint32_t condition, bool holds) {
    const std::uint32_t here =
        holds ? condition : apply(ScalarOp::logical_not, {condition, condition, condition});
    guards_.push_back(guards_.empty() ? here : apply(ScalarOp::logical_and, {guards_.back(), here, here}));
}

void LoopRecorder::require(std::uint32_t condition) {
    if (!guards_.empty()) {
        const std::uint32_t guard = guards_.back();
        const std::uint32_t elsewhere = apply(ScalarOp::logical_not, {guard, guard, guard});
        condition = apply(ScalarOp::logical_or, {elsewhere, condition, condition});
    }
    if (std::find(requirements_.begin(), requirements_.end(), condition) == requirements_.end()) {
        requirements_.push_back(condition);
    }
}

// ---- running ----------------------------------------------------------------------------------------------

namespace {

template <ScalarOp op>
void fold_lanes(const double* __restrict a, const double* __restrict b, const double* __restrict c,
                double* __restrict out) {
    for (std::size_t i = 0; i < LoopProgram::lanes; ++i) {
        out[i] = fold<op>(a[i], b[i], c[i]);
    }
}

using Kernel = void (*)(const double*, const double*, const double*, double*);

template <std::size_t... op>
constexpr std::array<Kernel, scalar_op_count> make_kernels(std::index_sequence<op...>) {
    return {fold_lanes<static_cast<ScalarOp>(op)>...};
}
constexpr std::array<Kernel, scalar_op_count> kernels =
    make_kernels(std::make_index_sequence<scalar_op_count>{});

int operand_count(const LoopRecorder::Node& node) {
    switch (node.kind) {
    case LoopRecorder::Kind::apply:
        return arity(node.op);
    case LoopRecorder::Kind::lookup:
        return 1;
    default:
        return 0;
    }
}

/// For each node the last one that reads it: the count of nodes if the caller does, 0 if none does.
std::vector<std::size_t> last_uses(const std::vector<LoopRecorder::Node>& nodes,
                                   const std::vector<std::uint32_t>& roots) {
    std::vector<std::size_t> last(nodes.size());
    for (const std::uint32_t root : roots) {
        last[root] = nodes.size();
    }
    // Operands come before the nodes that use them, so one pass from the end finds all.
    for (std::size_t i = nodes.size(); i-- > 0;) {
        for (int k = 0; last[i] > 0 && k < operand_count(nodes[i]); ++k) {
            std::size_t& use = last[nodes[i].operands[static_cast<std::size_t>(k)]];
            use = std::max(use, i);
        }
    }
    return last;
}

} // namespace

/// A register is used again once its node has been read for the last time, so that few are in use at once and
/// stay in the nearest cache.
LoopProgram::LoopProgram(const LoopRecorder& recorder, const std::vector<std::uint32_t>& results)
    : recorder_(recorder) {
    const auto& nodes = recorder.nodes();
    std::vector<std::uint32_t> roots = results;
    roots.insert(roots.end(), recorder.requirements().begin(), recorder.requirements().end());
    const std::vector<std::size_t> last = last_uses(nodes, roots);
    std::vector<std::uint32_t> place(nodes.size());
    std::vector<std::uint32_t> free;
    const auto take = [&] {
        if (free.empty()) {
            registers_.emplace_back();
            return static_cast<std::uint32_t>(registers_.size() - 1);
        }
        const std::uint32_t taken = free.back();
        free.pop_back();
        return taken;
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const LoopRecorder::Node& node = nodes[i];
        if (node.kind == LoopRecorder::Kind::input) {
            variables_.resize(std::max<std::size_t>(variables_.size(), node.input + std::size_t{1}));
        }
        const bool lasts =
            node.kind == LoopRecorder::Kind::constant || node.kind == LoopRecorder::Kind::input;
        if (last[i] == 0 || !lasts) {
            continue;
        }
        place[i] = static_cast<std::uint32_t>(registers_.size());
        registers_.emplace_back();
        if (node.kind == LoopRecorder::Kind::constant) {
            registers_.back().fill(node.constant);
        } else {
            inputs_.emplace_back(place[i], node.input);
        }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const LoopRecorder::Node& node = nodes[i];
        const bool is_step =
            node.kind == LoopRecorder::Kind::apply || node.kind == LoopRecorder::Kind::lookup;
        if (last[i] == 0 || !is_step) {
            continue;
        }
        place[i] = take(); // before operands are given back: a kernel's operands are not its result
        const auto operand = [&](std::size_t k) {
            return place[node.operands[static_cast<int>(k) < operand_count(node) ? k : 0]];
        };
        if (node.kind == LoopRecorder::Kind::apply) {
            steps_.push_back(
                {kernels[static_cast<std::size_t>(node.op)], operand(0), operand(1), operand(2), place[i]});
        } else {
            steps_.push_back({nullptr, operand(0), node.operands[1], 0, place[i]});
        }
        std::array<std::uint32_t, 3> seen{};
        for (int k = 0; k < operand_count(node); ++k) {
            const std::uint32_t read = node.operands[static_cast<std::size_t>(k)];
            const bool again = std::find(seen.begin(), seen.begin() + k, read) != seen.begin() + k;
            seen[static_cast<std::size_t>(k)] = read;
            const bool in_step = nodes[read].kind == LoopRecorder::Kind::apply ||
                                 nodes[read].kind == LoopRecorder::Kind::lookup;
            if (last[read] == i && in_step && !again) {
                free.push_back(place[read]);
            }
        }
    }
    for (const std::uint32_t result : results) {
        results_.push_back(place[result]);
    }
    for (const std::uint32_t requirement : recorder.requirements()) {
        requirements_.push_back(place[requirement]);
    }
}

/// Anything where the list has no such element: a requirement fails there.
void LoopProgram::look_up(const Step& step) {
    const std::vector<double>& list = recorder_.lists()[step.b];
    const double* index = registers_[step.a].data();
    double* out = registers_[step.out].data();
    const auto size = static_cast<double>(list.size());
    for (std::size_t i = 0; i < lanes; ++i) {
        const double at = index[i] >= 0 && index[i] < size ? index[i] : 0;
        out[i] = list[static_cast<std::size_t>(at)];
    }
}

void LoopProgram::run() {
    for (const auto& [place, loop] : inputs_) {
        registers_[place] = variables_[loop];
    }
    for (const Step& step : steps_) {
        if (step.kernel == nullptr) {
            look_up(step);
        } else {
            step.kernel(registers_[step.a].data(), registers_[step.b].data(), registers_[step.c].data(),
                        registers_[step.out].data());
        }
    }
}

bool LoopProgram::fails(std::size_t lane) const {
    return std::any_of(requirements_.begin(), requirements_.end(),
                       [&](std::uint32_t r) { return registers_[r][lane] == 0; });
}

bool LoopProgram::fails_anywhere(std::size_t count) const {
    std::int64_t failures = 0; // counted without a branch, so that the compiler takes many lanes at a time
    for (const std::uint32_t requirement : requirements_) {
        const double* lane = registers_[requirement].data();
        for (std::size_t i = 0; i < count; ++i) {
            failures += lane[i] == 0 ? 1 : 0;
        }
    }
    return failures > 0;
}

} // namespace scc::lang
