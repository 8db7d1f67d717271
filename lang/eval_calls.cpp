#include "lang/evaluator.h"

#include <algorithm>

namespace scc::lang {
namespace {

bool is_error(const Value& value) {
    return std::holds_alternative<ErrorValue>(value.v);
}

/// Known, as far as it is made of numbers.
bool is_known(const Value& value) {
    if (const auto* list = std::get_if<ListPtr>(&value.v)) {
        return std::all_of((*list)->begin(), (*list)->end(), is_known);
    }
    return is_constant(components(value));
}

} // namespace

Value Evaluator::run(const code::BuiltinCall& node, Span span, const FramePtr& frame) {
    std::vector<Value> arguments;
    arguments.reserve(node.arguments.size());
    bool complete = true;
    for (const CodePtr& argument : node.arguments) {
        arguments.push_back(eval(*argument, frame));
        complete = complete && !is_error(arguments.back());
    }
    if (!complete) {
        return failed();
    }
    if (has_unknowns() && node.overload->needs_constants &&
        !std::all_of(arguments.begin(), arguments.end(), is_known)) {
        return node.overload->result.kind == TypeKind::transform
                   ? depends_on_surface(span, "this transform", "transforms are known before a ray is cast")
                   : depends_on_surface(span, "this argument", "this function takes what is known");
    }
    if (!node.overload->takes_spectra && std::any_of(arguments.begin(), arguments.end(), has_spectra)) {
        return refuse_spectra(span, "this function");
    }
    locate(span);
    BuiltinRun run{math_, report_, span};
    return node.overload->run(run, arguments);
}

Value Evaluator::run(const code::ListCall& node, Span span, const FramePtr& frame) {
    const Value object = eval(*node.arguments[0], frame);
    if (is_error(object)) {
        return failed();
    }
    const std::vector<Value>& list = *std::get<ListPtr>(object.v);
    if (node.op == code::ListOp::len) {
        return number(static_cast<double>(list.size()));
    }
    if (node.op == code::ListOp::sum) {
        return sum(list, node.zero, span);
    }
    const Value function = eval(*node.arguments[1], frame);
    if (is_error(function)) {
        return failed();
    }
    const Closure& closure = *std::get<ClosurePtr>(function.v);
    return node.op == code::ListOp::map ? mapped(list, closure, span) : filtered(list, closure, span);
}

Value Evaluator::sum(const std::vector<Value>& list, const Value& zero, Span span) {
    Value total = list.empty() ? zero : list[0];
    for (std::size_t i = 1; i < list.size() && step(span); ++i) {
        if (has_spectra(total) &&
            !takes_spectra(ast::BinaryOp::add, components(total), components(list[i]))) {
            return refuse_spectra(span, "so long a sum");
        }
        total = binary(math_, ast::BinaryOp::add, total, list[i]);
    }
    return stopped_ ? failed() : total;
}

Value Evaluator::mapped(const std::vector<Value>& list, const Closure& function, Span span) {
    auto result = std::make_shared<std::vector<Value>>();
    bool complete = true;
    for (std::size_t i = 0; i < list.size() && step(span); ++i) {
        result->push_back(call(*function.function, function.frame, {list[i]}, span));
        complete = complete && !is_error(result->back());
    }
    return complete && !stopped_ ? Value{ListPtr(std::move(result))} : failed();
}

Value Evaluator::filtered(const std::vector<Value>& list, const Closure& function, Span span) {
    auto result = std::make_shared<std::vector<Value>>();
    for (std::size_t i = 0; i < list.size() && step(span); ++i) {
        const Value keep = call(*function.function, function.frame, {list[i]}, span);
        const auto* truth = std::get_if<BoolValue>(&keep.v);
        if (!truth) {
            return failed();
        }
        if (!truth->v.is_constant()) {
            return depends_on_surface(span, "what `filter` keeps", "the length of a list is known");
        }
        if (truth->v.value != 0) {
            result->push_back(list[i]);
        }
    }
    return stopped_ ? failed() : Value{ListPtr(std::move(result))};
}

Value Evaluator::run(const code::Call& node, Span span, const FramePtr& frame) {
    const Value callee = eval(*node.callee, frame);
    if (is_error(callee)) {
        return failed();
    }
    const Closure& closure = *std::get<ClosurePtr>(callee.v);
    std::vector<Value> arguments;
    arguments.reserve(closure.function->cells.size());
    bool complete = true;
    for (std::size_t i = 0; i < node.arguments.size(); ++i) {
        const CodePtr& given = node.arguments[i];
        arguments.push_back(given ? eval(*given, frame)
                                  : eval(*closure.function->defaults[i], closure.frame));
        complete = complete && !is_error(arguments.back());
    }
    return complete ? call(*closure.function, closure.frame, std::move(arguments), span) : failed();
}

Value Evaluator::run(const code::ImageCall& node, Span span, const FramePtr& frame) {
    const Value image = eval(*node.image, frame), place = eval(*node.uv, frame);
    if (is_error(image) || is_error(place)) {
        return failed();
    }
    const ThingPtr& thing = std::get<ThingPtr>(image.v);
    const Components uv = components(place);
    if (!is_constant(uv)) {
        locate(span);
        const auto channels = math_.builder()->image(thing, {uv[0], uv[1]});
        if (!channels && recording()) {
            cannot_record();
        }
        return channels ? compose(TypeKind::color, *channels) : failed();
    }
    if (images_ == nullptr) {
        report_.report(Diag::not_supported_yet, span, "the content of an image here");
        return failed();
    }
    const auto color = images_->color(thing, uv[0].value, uv[1].value);
    return color ? compose(TypeKind::color, {Scalar{(*color)[0]}, Scalar{(*color)[1]}, Scalar{(*color)[2]}})
                 : failed();
}

/// Both branches of a condition that depends on the surface are evaluated, so a call of the same function in
/// one of them would never end.
bool Evaluator::recurses_by_surface(const FunctionCode& function) const {
    return std::any_of(calls_.begin(), calls_.end(), [&](const Activation& activation) {
        return activation.function == &function && activation.unknown_conditions < unknown_conditions_;
    });
}

Value Evaluator::call(const FunctionCode& function, const FramePtr& frame, std::vector<Value> arguments,
                      Span span) {
    if (calls_.size() >= limits_.call_depth) {
        stop(Diag::calls_too_deep, span, limits_.call_depth);
        return failed();
    }
    if (has_unknowns() && unknown_conditions_ > 0 && recurses_by_surface(function)) {
        report_.report(Diag::surface_recursion, span, function.name);
        stopped_ = true;
        return failed();
    }
    const bool is_written = !tracing() || !calls_.empty(); // else the renderer calls it, per point
    if (is_written) {
        report_.enter_call(span, function.name);
    }
    const FramePtr inner = make_frame(frame, function.cells);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        inner->set(i, std::move(arguments[i]));
    }
    calls_.push_back({&function, unknown_conditions_});
    Value result = eval(*function.result, inner);
    calls_.pop_back();
    if (is_written) {
        report_.leave();
    }
    return result;
}

} // namespace scc::lang
