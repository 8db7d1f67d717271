#include "lang/evaluator.h"
#include "lang/transforms.h"
#include "lang/wording.h"

#include <algorithm>

namespace scc::lang {
namespace {

bool is_error(const Value& value) {
    return std::holds_alternative<ErrorValue>(value.v);
}

const FramePtr& frame_at(const FramePtr& frame, std::uint32_t depth) {
    const FramePtr* at = &frame;
    for (; depth > 0; --depth) {
        at = &(*at)->parent;
    }
    return *at;
}

bool has_zero(const Components& divisor) {
    return std::any_of(divisor.v.begin(), divisor.v.begin() + divisor.count,
                       [](const Scalar& s) { return s.is_constant() && s.value == 0; });
}

} // namespace

bool Evaluator::step(Span span) {
    if (stopped_) {
        return false;
    }
    if (++steps_ > limits_.steps) {
        stop(Diag::steps_exceeded, span, limits_.steps);
    } else if (stack_.exhausted()) {
        stop(Diag::too_deep, span, 0);
    }
    return !stopped_;
}

/// Ends the run: everything after this gives ErrorValue at once.
void Evaluator::stop(Diag kind, Span span, std::uint64_t limit) {
    if (!stopped_) {
        report_.report(kind, span, limit);
        stopped_ = true;
    }
}

Value Evaluator::depends_on_surface(Span span, std::string_view what, std::string_view rule) {
    report_.report(Diag::depends_on_surface, span, what, rule);
    return failed();
}

Value Evaluator::refuse_spectra(Span span, std::string_view what) {
    report_.report(Diag::spectral_color, span, what);
    return failed();
}

Value Evaluator::eval(const Code& code, const FramePtr& frame) {
    if (!step(code.span)) {
        return failed();
    }
    return std::visit([&](const auto& node) { return run(node, code.span, frame); }, code.node);
}

/// What is only needed where an unknown condition holds, or where it does not.
Value Evaluator::eval_where(const Scalar& condition, bool holds, const Code& code, const FramePtr& frame) {
    ++unknown_conditions_;
    math_.builder()->enter(condition.symbol, holds);
    Value value = eval(code, frame);
    math_.builder()->leave();
    --unknown_conditions_;
    return value;
}

/// A value that needs itself finds an ErrorValue, which the checker has explained.
Value Evaluator::cell(const FramePtr& frame, std::uint32_t index) {
    if (!frame->cells[index].ready) {
        if (recording() && !frame->is_rehearsed) {
            return cell_outside(frame, index);
        }
        if (tried_cells_ != nullptr) {
            tried_cells_->emplace_back(frame, index);
        }
        frame->set(index, failed());
        report_.enter_definition(frame->depth);
        frame->set(index, recording() ? cell_inside(frame, index) : eval(*(*frame->code)[index], frame));
        report_.leave();
    }
    return frame->cells[index].value;
}

Value Evaluator::run(const code::Failed&, Span, const FramePtr&) {
    return failed();
}

Value Evaluator::run(const code::Constant& node, Span, const FramePtr&) {
    return node.value;
}

Value Evaluator::run(const code::Variable& node, Span, const FramePtr& frame) {
    return cell(frame_at(frame, node.depth), node.cell);
}

Value Evaluator::run(const code::FunctionValue& node, Span, const FramePtr& frame) {
    const FramePtr& around = frame_at(frame, node.depth);
    if (!around->is_captured) {
        around->is_captured = true;
        around->captured->add(around);
    }
    return {std::make_shared<const Closure>(Closure{node.function, around})};
}

void Evaluator::locate(Span span) {
    if (math_.builder() != nullptr) {
        math_.builder()->locate(span);
    }
}

Value Evaluator::run(const code::Unary& node, Span, const FramePtr& frame) {
    const Components operand = components(eval(*node.operand, frame));
    const ScalarOp op = node.op == ast::UnaryOp::minus ? ScalarOp::neg : ScalarOp::logical_not;
    return each(math_, op, operand.kind, operand);
}

Value Evaluator::run(const code::Binary& node, Span span, const FramePtr& frame) {
    if (node.op == ast::BinaryOp::logical_and || node.op == ast::BinaryOp::logical_or) {
        return logical(node, frame);
    }
    const Value left = eval(*node.left, frame);
    const Value right = eval(*node.right, frame);
    if (is_error(left) || is_error(right)) {
        return failed();
    }
    return operate(node, left, right, span);
}

Value Evaluator::logical(const code::Binary& node, const FramePtr& frame) {
    const bool is_and = node.op == ast::BinaryOp::logical_and;
    const Value left = eval(*node.left, frame);
    const auto* first = std::get_if<BoolValue>(&left.v);
    if (!first) {
        return failed();
    }
    if (first->v.is_constant()) {
        return (first->v.value != 0) == is_and ? eval(*node.right, frame) : left;
    }
    const Value right = eval_where(first->v, is_and, *node.right, frame);
    const auto* second = std::get_if<BoolValue>(&right.v);
    if (!second) {
        return failed();
    }
    if (second->v.is_constant()) {
        return (second->v.value != 0) == is_and ? left : right;
    }
    return boolean(math_.apply(is_and ? ScalarOp::logical_and : ScalarOp::logical_or, first->v, second->v));
}

Value Evaluator::operate(const code::Binary& node, const Value& left, const Value& right, Span span) {
    if (node.op == ast::BinaryOp::then) {
        return {then(std::get<TransformValue>(left.v), std::get<TransformValue>(right.v))};
    }
    if (node.op == ast::BinaryOp::range) {
        const Scalar& begin = std::get<NumberValue>(left.v).v;
        const Scalar& end = std::get<NumberValue>(right.v).v;
        if (!begin.is_constant() || !end.is_constant()) {
            return depends_on_surface(span, "a bound of this range",
                                      "a per-point function loops over known ranges");
        }
        return {RangeValue{begin.value, end.value}};
    }
    const bool divides = node.op == ast::BinaryOp::div || node.op == ast::BinaryOp::mod;
    if (divides && has_zero(components(right))) {
        report_.report(Diag::division_by_zero, node.right->span);
        return failed();
    }
    if (has_spectra(left) || has_spectra(right)) {
        if (!takes_spectra(node.op, components(left), components(right))) {
            return refuse_spectra(span, "this operation");
        }
    }
    const Components divisor = divides ? components(right) : Components{};
    for (std::size_t i = 0; i < divisor.count; ++i) {
        math_.require(ScalarOp::ne, divisor.v[i], {0});
    }
    locate(span);
    return binary(math_, node.op, left, right);
}

Value Evaluator::run(const code::Tuple& node, Span, const FramePtr& frame) {
    std::array<Scalar, 3> v{};
    bool complete = true;
    for (std::size_t i = 0; i < node.elements.size(); ++i) {
        const Value element = eval(*node.elements[i], frame);
        complete = complete && !is_error(element);
        v[i] = components(element).v[0];
    }
    return complete ? compose(node.elements.size() == 2 ? TypeKind::vec2 : TypeKind::vec3, v) : failed();
}

Value Evaluator::run(const code::List& node, Span, const FramePtr& frame) {
    auto list = std::make_shared<std::vector<Value>>();
    bool complete = true;
    for (const CodePtr& element : node.elements) {
        list->push_back(eval(*element, frame));
        complete = complete && !is_error(list->back());
    }
    return complete ? Value{ListPtr(std::move(list))} : failed();
}

Value Evaluator::run(const code::Comprehension& node, Span span, const FramePtr& frame) {
    const Value range = eval(*node.range, frame);
    auto list = std::make_shared<std::vector<Value>>();
    bool complete = !is_error(range);
    Value current;
    report_.enter_loop(node.variable_span, node.variable, &current);
    iterate(range, node.range->span, [&](const Value& value) {
        if (list->size() >= limits_.list_length) {
            stop(Diag::list_too_long, span, limits_.list_length);
            return;
        }
        current = value;
        const FramePtr inner = make_frame(frame, node.cells);
        inner->set(0, value);
        list->push_back(eval(*node.element, inner));
        complete = complete && !is_error(list->back());
    });
    report_.leave();
    return complete && !stopped_ ? Value{ListPtr(std::move(list))} : failed();
}

Value Evaluator::run(const code::Conditional& node, Span span, const FramePtr& frame) {
    const Value condition = eval(*node.condition, frame);
    const auto* truth = std::get_if<BoolValue>(&condition.v);
    if (!truth) {
        return failed();
    }
    if (truth->v.is_constant()) {
        return eval(truth->v.value != 0 ? *node.yes : *node.no, frame);
    }
    const Value yes = eval_where(truth->v, true, *node.yes, frame);
    const Value no = eval_where(truth->v, false, *node.no, frame);
    return is_error(yes) || is_error(no) ? failed() : select(truth->v, yes, no, span);
}

Value Evaluator::select(const Scalar& condition, const Value& yes, const Value& no, Span span) {
    const Components a = components(yes);
    const Components b = components(no);
    if (a.kind == TypeKind::error) {
        return depends_on_surface(span, "this choice",
                                  "a surface chooses between numbers, vectors and colors");
    }
    return lang::select(math_, condition, a, b);
}

Value Evaluator::run(const code::Component& node, Span span, const FramePtr& frame) {
    const Components object = components(eval(*node.object, frame));
    if (object.spectral) {
        return refuse_spectra(span, "`.r .g .b`");
    }
    return object.kind == TypeKind::error ? failed() : number(object.v[node.index]);
}

Value Evaluator::run(const code::SurfaceInput& node, Span, const FramePtr& frame) {
    if (is_error(eval(*node.object, frame))) {
        return failed();
    }
    const TypeKind kind = node.name == "uv" ? TypeKind::vec2 : TypeKind::vec3;
    std::array<Scalar, 3> v;
    constexpr std::array<std::string_view, 3> axes{".x", ".y", ".z"};
    for (std::size_t i = 0; i < (kind == TypeKind::vec2 ? 2 : 3); ++i) {
        v[i] = {0, math_.builder()->input(std::string(node.name) + std::string(axes[i]))};
    }
    return compose(kind, v);
}

Value Evaluator::run(const code::Index& node, Span, const FramePtr& frame) {
    const Value object = eval(*node.object, frame);
    const Value position = eval(*node.index, frame);
    if (is_error(object) || is_error(position)) {
        return failed();
    }
    const std::vector<Value>& list = *std::get<ListPtr>(object.v);
    const Scalar& index = std::get<NumberValue>(position.v).v;
    if (recording() && !index.is_constant()) {
        if (std::optional<Value> element = recorded_element(list, index)) {
            return *element;
        }
    }
    if (!index.is_constant()) {
        return depends_on_surface(node.index->span, "this index", "a list takes a known index");
    }
    if (std::floor(index.value) != index.value) {
        report_.report(Diag::index_out_of_range, node.index->span, to_string(position),
                       "an index is a whole number");
        return failed();
    }
    if (!(index.value >= 0 && index.value < static_cast<double>(list.size()))) {
        report_.report(Diag::index_out_of_range, node.index->span, to_string(position),
                       list.empty()
                           ? "the list is empty"
                           : fmt::format("the list has {}, counted from 0", counted(list.size(), "element")));
        return failed();
    }
    return list[static_cast<std::size_t>(index.value)];
}

} // namespace scc::lang
