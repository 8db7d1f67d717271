#include "lang/evaluator.h"
#include "lang/loop_program.h"
#include "lang/rows.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

/// Loops whose rounds differ in numbers only. The body is evaluated once, with unknown numbers in the place
/// of the variables; what that records is then run for all rounds at once. Where something has to be reported
/// in a round, that round is evaluated like any other loop's; and so is every round of a body that cannot be
/// recorded.
namespace scc::lang {

struct Evaluator::Recording {
    LoopRecorder recorder;
    std::vector<RangeValue> loops; ///< those around the things, from outside
    std::size_t depth = 0;         ///< loops around what is evaluated now
    bool failed = false;
    bool stopped_outside = false;
};

/// The things of one round, with nodes of the recorder as their unknown numbers.
struct Evaluator::RecordedLoop {
    LoopRecorder recorder;
    std::vector<RangeValue> loops;
    std::vector<ThingPtr> things;
};

namespace {

std::uint64_t rounds_of(const RangeValue& range) {
    constexpr double most = 1e15;
    return static_cast<std::uint64_t>(std::clamp(range.end - range.begin, 0.0, most));
}

bool is_whole(const RangeValue& range) {
    return std::floor(range.begin) == range.begin && std::floor(range.end) == range.end &&
           std::abs(range.begin) < 1e15 && std::abs(range.end) < 1e15;
}

bool is_rehearsed(const FramePtr& frame) {
    for (const Frame* at = frame.get(); at != nullptr; at = at->parent.get()) {
        if (at->is_rehearsed) {
            return true;
        }
    }
    return false;
}

/// Puts what the rounds from `first` on make of the loops' variables.
void fill_variables(LoopProgram& program, const std::vector<RangeValue>& loops, std::uint64_t first,
                    std::size_t count) {
    std::uint64_t within = 1; // rounds of the loops inside
    for (std::size_t loop = loops.size(); loop-- > 0;) {
        double* variable = program.variable(loop);
        const double begin = loops[loop].begin;
        const std::uint64_t length = rounds_of(loops[loop]);
        for (std::size_t lane = 0; lane < count; ++lane) {
            const std::uint64_t outside = within == 1 ? first + lane : (first + lane) / within;
            variable[lane] = begin + static_cast<double>(loop == 0 ? outside : outside % length);
        }
        within *= length;
    }
}

struct Computed {
    std::shared_ptr<const std::vector<Column>> columns;
    std::vector<std::uint64_t> failed; ///< rounds of the outermost loop, ascending
};

Computed compute(const LoopRecorder& recorder, const std::vector<RangeValue>& loops,
                 const std::vector<std::uint32_t>& symbols, std::uint64_t total) {
    auto columns = std::make_shared<std::vector<Column>>();
    for (std::size_t i = 0; i < symbols.size(); ++i) {
        columns->emplace_back(total);
    }
    const std::uint64_t within = total / rounds_of(loops.front());
    LoopProgram program(recorder, symbols);
    Computed computed;
    for (std::uint64_t first = 0; first < total; first += LoopProgram::lanes) {
        const std::size_t count = std::min<std::uint64_t>(LoopProgram::lanes, total - first);
        fill_variables(program, loops, first, count);
        program.run();
        for (std::size_t i = 0; i < symbols.size(); ++i) {
            std::copy_n(program.result(i), count, (*columns)[i].data() + first);
        }
        if (!program.fails_anywhere(count)) {
            continue;
        }
        for (std::size_t lane = 0; lane < count; ++lane) {
            const std::uint64_t round = (first + lane) / within;
            const bool is_new = computed.failed.empty() || computed.failed.back() != round;
            if (is_new && program.fails(lane)) {
                computed.failed.push_back(round);
            }
        }
    }
    computed.columns = std::move(columns);
    return computed;
}

} // namespace

// ---- recording --------------------------------------------------------------------------------------------

void Evaluator::cannot_record() {
    recording_->failed = true;
    stopped_ = true; // to have done with it soon
}

std::optional<Evaluator::RecordedLoop> Evaluator::record(const ForCode& item, const RangeValue& range,
                                                         const FramePtr& frame) {
    Recording recording;
    std::vector<FieldValue> fields;
    std::vector<ThingPtr> things;
    bool is_sound = true;
    const std::uint64_t children = children_;
    const ScalarMath outside = std::exchange(math_, ScalarMath(&recording.recorder));
    recording_ = &recording;
    report_.rehearse(&recording.failed);
    recorded_loop(item, {range}, frame, {&fields, &things, &is_sound});
    report_.rehearse(nullptr);
    recording_ = nullptr;
    math_ = outside;
    children_ = children;
    stopped_ = recording.stopped_outside;
    if (recording.failed || !is_sound || !fields.empty()) {
        return std::nullopt;
    }
    return RecordedLoop{std::move(recording.recorder), std::move(recording.loops), std::move(things)};
}

/// A loop within a loop has to be all that makes things there, so that rounds of both are rounds of one.
void Evaluator::recorded_loop(const ForCode& item, const Value& range, const FramePtr& frame,
                              const Target& target) {
    const auto* numbers = std::get_if<RangeValue>(&range.v);
    const bool fits = numbers && is_whole(*numbers) && rounds_of(*numbers) > 0 && target.children->empty() &&
                      recording_->depth == recording_->loops.size();
    if (!fits) {
        cannot_record();
        return;
    }
    const auto loop = static_cast<std::uint32_t>(recording_->depth++);
    recording_->loops.push_back(*numbers);
    const FramePtr inner = make_frame(frame, item.body.cells);
    inner->set(0, number(Scalar{0, recording_->recorder.variable(loop)}));
    items(item.body.items, inner, target);
    --recording_->depth;
}

void Evaluator::record_child(const Thing& thing) {
    const bool fits = thing.constructor->type == TypeKind::shape && !thing.constructor->takes_children &&
                      recording_->depth == recording_->loops.size();
    if (!fits) {
        cannot_record();
    }
}

/// A function that knows the loop's variable differs from round to round by more than numbers.
bool Evaluator::is_recordable(const Value& value) {
    const auto* closure = std::get_if<ClosurePtr>(&value.v);
    return !closure || !is_rehearsed((*closure)->frame);
}

/// What lies outside the loop is evaluated as ever; it is the same in all rounds. Where it stands under a
/// condition, perhaps no round needs it: then it must not report anything yet.
Value Evaluator::cell_outside(const FramePtr& frame, std::uint32_t index) {
    if (recording_->failed) {
        return failed();
    }
    Recording* recording = std::exchange(recording_, nullptr);
    const ScalarMath inside = std::exchange(math_, ScalarMath());
    const std::uint32_t conditions = std::exchange(unknown_conditions_, 0);
    bool is_wrong = false;
    std::vector<std::pair<FramePtr, std::uint32_t>> tried;
    bool* rehearsal = report_.rehearse(conditions > 0 ? &is_wrong : nullptr);
    tried_cells_ = conditions > 0 ? &tried : nullptr;
    Value value = cell(frame, index);
    tried_cells_ = nullptr;
    report_.rehearse(rehearsal);
    if (is_wrong) {
        for (const auto& [owner, cell] : tried) {
            owner->cells[cell] = {};
        }
        stopped_ = false;
    }
    unknown_conditions_ = conditions;
    math_ = inside;
    recording_ = recording;
    recording_->stopped_outside = stopped_;
    if (stopped_ || is_wrong) {
        cannot_record();
    }
    return value;
}

/// A value that is computed once for several uses must be right whether or not the first one counts.
Value Evaluator::cell_inside(const FramePtr& frame, std::uint32_t index) {
    std::vector<std::uint32_t> guards = recording_->recorder.exchange_guards({});
    Value value = eval(*(*frame->code)[index], frame);
    recording_->recorder.exchange_guards(std::move(guards));
    return value;
}

/// Of a list of known numbers, vectors or the like; nothing for other lists.
std::optional<Value> Evaluator::recorded_element(const std::vector<Value>& list, const Scalar& index) {
    if (list.empty()) {
        return std::nullopt;
    }
    const Components first = components(list.front());
    std::array<std::vector<double>, 3> numbers;
    for (const Value& element : list) {
        const Components parts = components(element);
        if (parts.count == 0 || parts.kind != first.kind || parts.spectral || !lang::is_constant(parts)) {
            return std::nullopt;
        }
        for (std::size_t i = 0; i < parts.count; ++i) {
            numbers[i].push_back(parts.v[i].value);
        }
    }
    math_.require(ScalarOp::eq, math_.apply(ScalarOp::floor, index), index);
    math_.require(ScalarOp::ge, index, {0});
    math_.require(ScalarOp::lt, index, {static_cast<double>(list.size())});
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < first.count; ++i) {
        v[i] = {0, *math_.builder()->lookup(std::move(numbers[i]), index.symbol)};
    }
    return compose(first.kind, v);
}

/// check_number for numbers that are not known yet.
bool Evaluator::require_within(const Field& field, const Components& parts) {
    const Limits& limits = field.limits;
    bool fine = !limits.square;
    Scalar nonzero{0};
    for (std::size_t i = 0; i < parts.count; ++i) {
        const Scalar& v = parts.v[i];
        fine = fine && math_.require(ScalarOp::le, math_.apply(ScalarOp::abs, v),
                                     {std::numeric_limits<double>::max()});
        if (std::isfinite(limits.min)) {
            fine = fine && math_.require(limits.min_excluded ? ScalarOp::gt : ScalarOp::ge, v, {limits.min});
        }
        if (std::isfinite(limits.max)) {
            fine = fine && math_.require(ScalarOp::le, v, {limits.max});
        }
        if (limits.integer) {
            fine = fine && math_.require(ScalarOp::eq, math_.apply(ScalarOp::floor, v), v);
        }
        if (limits.nonzero_vector) {
            nonzero = math_.apply(ScalarOp::logical_or, nonzero, math_.apply(ScalarOp::ne, v, {0}));
        }
    }
    fine = fine && (!limits.nonzero_vector || math_.require(nonzero));
    if (!fine) {
        cannot_record();
    }
    return fine;
}

// ---- running ----------------------------------------------------------------------------------------------

bool Evaluator::run_recorded(const ForCode& item, const Value& range, const FramePtr& frame, Value& current,
                             const Target& target) {
    const auto* numbers = std::get_if<RangeValue>(&range.v);
    if (!numbers || has_unknowns() || stopped_ || rounds_of(*numbers) < limits_.recorded_rounds) {
        return false;
    }
    std::optional<RecordedLoop> loop = record(item, *numbers, frame);
    if (!loop) {
        return false;
    }
    double total = 1;
    for (const RangeValue& one : loop->loops) {
        total *= static_cast<double>(rounds_of(one));
    }
    if (total > static_cast<double>(limits_.steps) ||
        total * static_cast<double>(loop->things.size()) > static_cast<double>(limits_.list_length)) {
        return false; // the evaluator says which limit it is
    }

    std::set<std::uint32_t> nodes;
    for (const ThingPtr& thing : loop->things) {
        const std::vector<std::uint32_t> symbols = symbols_of(*thing);
        nodes.insert(symbols.begin(), symbols.end());
    }
    const std::vector<std::uint32_t> symbols(nodes.begin(), nodes.end());
    std::vector<Scalar> column_of(loop->recorder.nodes().size());
    for (std::uint32_t i = 0; i < symbols.size(); ++i) {
        column_of[symbols[i]] = {0, i};
    }
    for (ThingPtr& thing : loop->things) {
        thing = replaced(thing, column_of);
    }
    const auto rounds = static_cast<std::uint64_t>(total);
    const Computed computed = compute(loop->recorder, loop->loops, symbols, rounds);

    const std::uint64_t outer = rounds_of(*numbers);
    const std::uint64_t within = rounds / outer;
    const auto add_rounds = [&](std::uint64_t begin, std::uint64_t end) {
        steps_ += (end - begin) * within;
        if (begin == end || !step(item.range->span) || loop->things.empty()) {
            return;
        }
        add_child(
            {make_rows({computed.columns, nullptr, begin * within, (end - begin) * within, loop->things})},
            item.range->span, target);
    };
    std::uint64_t done = 0;
    FramePtr inner;
    for (const std::uint64_t failed : computed.failed) {
        add_rounds(done, failed);
        if (!step(item.range->span)) {
            break;
        }
        current = number(numbers->begin + static_cast<double>(failed));
        round(item, current, frame, inner, target);
        done = failed + 1;
    }
    add_rounds(done, outer);
    return true;
}

} // namespace scc::lang
