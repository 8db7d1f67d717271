#include "lang/evaluator.h"
#include "lang/limits.h"
#include "lang/transforms.h"
#include "lang/wording.h"

#include <algorithm>
#include <cmath>

namespace scc::lang {
namespace {

/// Digits that are lost in undoing a transform are those of its condition; half of a double's are left at
/// this one.
constexpr double worst_condition = 1e8;

bool within(const Limits& limits, const Components& parts) {
    bool nonzero = false;
    for (std::size_t i = 0; i < parts.count; ++i) {
        if (!component_within(limits, parts.v[i].value)) {
            return false;
        }
        nonzero = nonzero || parts.v[i].value != 0;
    }
    return nonzero || !limits.nonzero_vector;
}

} // namespace

bool Evaluator::check_field(const Field& field, const Value& value, const Code& code) {
    if (const auto* text = std::get_if<std::string>(&value.v)) {
        const auto& choices = field.choices;
        if (!choices.empty() && std::find(choices.begin(), choices.end(), *text) == choices.end()) {
            report_.report(Diag::unknown_choice, code.span, field.name, to_string(value), choice_rule(field));
            return false;
        }
        return true;
    }
    if (const auto* list = std::get_if<ListPtr>(&value.v)) {
        const auto* written = std::get_if<code::List>(&code.node);
        bool fine = true;
        for (std::size_t i = 0; i < (*list)->size() && step(code.span); ++i) {
            fine = check_field(field, (**list)[i], written ? *written->elements[i] : code) && fine;
        }
        return fine;
    }
    if (const auto* transform = std::get_if<TransformValue>(&value.v)) {
        return check_transform(*transform, code.span);
    }
    return check_number(field, value, code);
}

bool Evaluator::check_number(const Field& field, const Value& value, const Code& code) {
    const Components parts = components(value);
    if (parts.count == 0 || parts.kind == TypeKind::boolean) {
        return true;
    }
    if (recording() && !is_constant(parts)) {
        return require_within(field, parts);
    }
    // Of a vector that is written out, the first component that is wrong.
    const auto* written = std::get_if<code::Tuple>(&code.node);
    const auto place = [&](const auto& is_fine) {
        for (std::size_t i = 0; written && i < parts.count; ++i) {
            if (!is_fine(parts.v[i].value)) {
                return written->elements[i]->span;
            }
        }
        return code.span;
    };
    const auto finite = [](double component) { return std::isfinite(component); };
    const bool is_finite = std::all_of(parts.v.begin(), parts.v.begin() + parts.count,
                                       [&](const Scalar& s) { return finite(s.value); });
    if (!is_finite) {
        report_.report(Diag::not_finite, place(finite), field.name, to_string(value));
        return false;
    }
    if (!within(field.limits, parts)) {
        const auto fits_in = [&](double component) { return component_within(field.limits, component); };
        report_.report(Diag::value_out_of_range, place(fits_in), field.name, to_string(value),
                       rule_of(field));
        return false;
    }
    return true;
}

/// `scale` and `matrix` report what they flatten themselves; joined with `then`, harmless transforms can do
/// so too.
bool Evaluator::check_transform(const TransformValue& transform, Span span) {
    if (!inverse(transform)) {
        report_.report(Diag::no_inverse, span, "");
        return false;
    }
    if (const double stretch = condition(transform); stretch > worst_condition) {
        report_.report(Diag::ill_conditioned_transform, span, std::lround(std::log10(stretch)));
    }
    return true;
}

} // namespace scc::lang
