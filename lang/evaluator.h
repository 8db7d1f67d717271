#pragma once

#include "lang/builtins.h"
#include "lang/check.h"
#include "lang/code.h"
#include "lang/components.h"
#include "lang/frame.h"
#include "lang/image_source.h"
#include "lang/run_report.h"
#include "lang/scalar_math.h"
#include "lang/stack_guard.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang {

struct CheckedFile;

/// Runs checked code. What fails becomes an ErrorValue, which passes through everything silently.
class Evaluator {
public:
    /// With a builder, operations on unknown scalars go there, and no shapes can be built.
    Evaluator(const EvaluationLimits& limits, RunReport& report, SymbolBuilder* builder = nullptr,
              ImageSource* images = nullptr)
        : limits_(limits), report_(report), math_(builder), images_(images) {}

    /// The things on the top level of a file.
    std::vector<ThingPtr> run(const BodyCode& file, const FramePtr& globals);
    /// The params of the file, then those of its imports as `name.param`.
    std::vector<Param> params(const CheckedFile& file, const FramePtr& globals);
    /// What the file's `render` says, with the frame that `frame` and `time` tell from here on: the first
    /// one, if none is chosen.
    std::optional<Frames> frames(const CheckedFile& file, const FramePtr& globals,
                                 std::optional<std::int64_t> chosen);
    /// Evaluates what the file imports, then the items of those files.
    void imports(const CheckedFile& file);
    Value call(const FunctionCode& function, const FramePtr& frame, std::vector<Value> arguments, Span span);
    /// The value of a name.
    Value cell(const FramePtr& frame, std::uint32_t index);

    std::vector<std::string> take_prints() { return std::move(prints_); }

private:
    /// The thing or file that items go into.
    struct Target {
        std::vector<FieldValue>* fields;
        std::vector<ThingPtr>* children;
        bool* is_sound;                     ///< becomes false where a field or condition of it fails
        const Constructor* thing = nullptr; ///< null: the file
    };

    Value eval(const Code& code, const FramePtr& frame);
    bool step(Span span);
    void stop(Diag kind, Span span, std::uint64_t limit);
    Value failed() { return {ErrorValue{}}; }
    FramePtr make_frame(const FramePtr& outer, const std::vector<CodePtr>& cells) {
        FramePtr frame = std::make_shared<Frame>(outer, cells, outer->captured, report_.depth());
        frame->is_rehearsed = recording();
        return frame;
    }
    /// A per-point function is being traced.
    bool tracing() const { return math_.builder() != nullptr && !recording(); }
    /// A loop's body is being recorded.
    bool recording() const { return recording_ != nullptr; }
    bool has_unknowns() const { return math_.builder() != nullptr; }
    void locate(Span span);
    /// Says that colours with spectra do not go there.
    Value refuse_spectra(Span span, std::string_view what);
    Value depends_on_surface(Span span, std::string_view what, std::string_view rule);

    // eval_expressions.cpp
    Value run(const code::Failed& node, Span span, const FramePtr& frame);
    Value run(const code::Constant& node, Span span, const FramePtr& frame);
    Value run(const code::Variable& node, Span span, const FramePtr& frame);
    Value run(const code::FunctionValue& node, Span span, const FramePtr& frame);
    Value run(const code::Unary& node, Span span, const FramePtr& frame);
    Value run(const code::Binary& node, Span span, const FramePtr& frame);
    Value run(const code::Tuple& node, Span span, const FramePtr& frame);
    Value run(const code::List& node, Span span, const FramePtr& frame);
    Value run(const code::Comprehension& node, Span span, const FramePtr& frame);
    Value run(const code::Conditional& node, Span span, const FramePtr& frame);
    Value run(const code::Component& node, Span span, const FramePtr& frame);
    Value run(const code::SurfaceInput& node, Span span, const FramePtr& frame);
    Value run(const code::Index& node, Span span, const FramePtr& frame);
    Value run(const code::Imported& node, Span span, const FramePtr& frame);
    Value run(const code::ImportedScene& node, Span span, const FramePtr& frame);
    Value run(const code::Given& node, Span span, const FramePtr& frame);
    // eval_frames.cpp
    Value run(const code::FrameNumber& node, Span span, const FramePtr& frame);
    Value eval_where(const Scalar& condition, bool holds, const Code& code, const FramePtr& frame);
    Value logical(const code::Binary& node, const FramePtr& frame);
    Value operate(const code::Binary& node, const Value& left, const Value& right, Span span);
    Value select(const Scalar& condition, const Value& yes, const Value& no, Span span);

    // eval_calls.cpp
    Value run(const code::BuiltinCall& node, Span span, const FramePtr& frame);
    Value run(const code::ListCall& node, Span span, const FramePtr& frame);
    Value run(const code::Call& node, Span span, const FramePtr& frame);
    Value run(const code::ImageCall& node, Span span, const FramePtr& frame);
    Value filtered(const std::vector<Value>& list, const Closure& function, Span span);
    Value mapped(const std::vector<Value>& list, const Closure& function, Span span);
    Value sum(const std::vector<Value>& list, const Value& zero, Span span);
    bool recurses_by_surface(const FunctionCode& function) const;

    // eval_things.cpp
    Value run(const code::Construct& node, Span span, const FramePtr& frame);
    void body(const BodyCode& body, const FramePtr& frame, const Target& target);
    void items(const std::vector<ItemCode>& items, const FramePtr& frame, const Target& target);
    void item(const FieldCode& item, const FramePtr& frame, const Target& target);
    void item(const ChildCode& item, const FramePtr& frame, const Target& target);
    void item(const RowsCode& item, const FramePtr& frame, const Target& target);
    void item(const ForCode& item, const FramePtr& frame, const Target& target);
    void item(const IfCode& item, const FramePtr& frame, const Target& target);
    void item(const AssertCode& item, const FramePtr& frame, const Target& target);
    void item(const PrintCode& item, const FramePtr& frame, const Target& target);
    void round(const ForCode& item, const Value& value, const FramePtr& frame, FramePtr& inner,
               const Target& target);
    void add_child(const Value& value, Span span, const Target& target);
    Param param(const ParamCode& code, const FramePtr& globals);
    Value scene_of(const ImportedFile& file, std::vector<ThingPtr> things) const;
    /// Calls `each` with every value of a range or list until something stops the run.
    template <class Each>
    void iterate(const Value& range, Span span, const Each& each);

    // eval_fields.cpp: false if something was reported that makes the value unusable
    bool check_field(const Field& field, const Value& value, const Code& code);
    bool check_number(const Field& field, const Value& value, const Code& code);
    bool check_transform(const TransformValue& transform, Span span);

    // eval_loops.cpp
    struct Recording;
    struct RecordedLoop;
    bool run_recorded(const ForCode& item, const Value& range, const FramePtr& frame, Value& current,
                      const Target& target);
    std::optional<RecordedLoop> record(const ForCode& item, const RangeValue& range, const FramePtr& frame);
    void recorded_loop(const ForCode& item, const Value& range, const FramePtr& frame, const Target& target);
    Value cell_outside(const FramePtr& frame, std::uint32_t index);
    Value cell_inside(const FramePtr& frame, std::uint32_t index);
    void cannot_record();
    static bool is_recordable(const Value& value);
    void record_child(const Thing& thing);
    std::optional<Value> recorded_element(const std::vector<Value>& list, const Scalar& index);
    bool require_within(const Field& field, const Components& parts);

    struct Activation {
        const FunctionCode* function;
        std::uint32_t unknown_conditions;
    };

    EvaluationLimits limits_;
    RunReport& report_;
    ScalarMath math_;
    ImageSource* images_; ///< null: no image has a content
    StackGuard stack_;
    std::uint64_t steps_ = 0;
    std::uint64_t children_ = 0;
    std::uint64_t printed_ = 0;
    bool stopped_ = false;
    std::uint32_t unknown_conditions_ = 0; ///< around what is being evaluated
    std::vector<Activation> calls_;
    const std::vector<ThingPtr>* siblings_ = nullptr; ///< of a thing that is built now
    std::vector<std::string> prints_;
    std::optional<Frames> frames_;   ///< nothing: not known yet
    Recording* recording_ = nullptr; ///< of a loop's body, while it is recorded
    std::vector<std::pair<FramePtr, std::uint32_t>>* tried_cells_ =
        nullptr; ///< those that may have to be forgotten
};

template <class Each>
void Evaluator::iterate(const Value& range, Span span, const Each& each) {
    if (const auto* list = std::get_if<ListPtr>(&range.v)) {
        const ListPtr keep = *list;
        for (std::size_t i = 0; i < keep->size() && step(span); ++i) {
            each((*keep)[i]);
        }
        return;
    }
    const auto* numbers = std::get_if<RangeValue>(&range.v);
    if (!numbers) {
        return;
    }
    if (std::floor(numbers->begin) != numbers->begin || std::floor(numbers->end) != numbers->end) {
        report_.report(Diag::fractional_range, span, to_string(range));
        return;
    }
    for (double i = 0; i < numbers->end - numbers->begin && step(span); ++i) {
        each(number(numbers->begin + i));
    }
}

} // namespace scc::lang
