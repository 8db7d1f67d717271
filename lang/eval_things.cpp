#include "lang/evaluator.h"
#include "lang/imports.h"
#include "lang/rows.h"
#include "lang/wording.h"

#include <algorithm>
#include <utility>

namespace scc::lang {
namespace {

constexpr std::uint32_t highest_thing = 200;

std::uint32_t height_of(const Value& value) {
    const auto* thing = std::get_if<ThingPtr>(&value.v);
    return thing ? (*thing)->height : 0;
}

} // namespace

std::vector<ThingPtr> Evaluator::run(const BodyCode& file, const FramePtr& globals) {
    std::vector<ThingPtr> things;
    bool is_sound = true;
    items(file.items, globals, {nullptr, &things, &is_sound});
    return things;
}

Value Evaluator::run(const code::Construct& node, Span span, const FramePtr& frame) {
    if (tracing() && node.constructor->type != TypeKind::image) { // which is there to be looked up
        report_.report(Diag::shape_per_point, node.name_span, described(node.constructor->type));
        return failed();
    }
    if (recording() && node.constructor->takes_children) {
        cannot_record();
        return failed();
    }
    auto thing = std::make_shared<Thing>();
    thing->constructor = node.constructor;
    thing->name = node.name;
    thing->span = span;
    bool is_sound = node.is_sound;
    report_.enter_thing(thing.get(), std::exchange(siblings_, nullptr));
    body(node.body, frame, {&thing->fields, &thing->children, &is_sound, node.constructor});
    report_.leave();
    for (const Field* field : node.required) {
        if (is_sound && !thing->find(field->name)) {
            report_.report(Diag::missing_field, node.name_span, in_code(node.constructor->name), field->name);
            is_sound = false;
        }
    }
    for (const ThingPtr& child : thing->children) {
        thing->height = std::max(thing->height, child->height + 1);
    }
    for (const FieldValue& field : thing->fields) {
        thing->height = std::max(thing->height, height_of(field.value) + 1);
    }
    if (thing->height > highest_thing) {
        stop(Diag::too_deep, node.name_span, 0);
    }
    return stopped_ || !is_sound ? failed() : Value{ThingPtr(std::move(thing))};
}

void Evaluator::body(const BodyCode& body, const FramePtr& frame, const Target& target) {
    if (body.has_frame) {
        items(body.items, make_frame(frame, body.cells), target);
    } else {
        items(body.items, frame, target);
    }
}

void Evaluator::items(const std::vector<ItemCode>& items, const FramePtr& frame, const Target& target) {
    for (const ItemCode& code : items) {
        std::visit([&](const auto& node) { item(node, frame, target); }, code.node);
    }
}

void Evaluator::item(const FieldCode& item, const FramePtr& frame, const Target& target) {
    Value value = eval(*item.value, frame);
    if (std::holds_alternative<ErrorValue>(value.v) || !check_field(*item.field, value, *item.value)) {
        *target.is_sound = false;
        return;
    }
    if (recording() && !is_recordable(value)) {
        cannot_record();
        return;
    }
    target.fields->push_back({item.field->name, std::move(value), item.name_span, item.value->span});
}

void Evaluator::item(const ChildCode& item, const FramePtr& frame, const Target& target) {
    const auto* outer = std::exchange(siblings_, target.children);
    const Value value = eval(*item.value, frame);
    siblings_ = outer;
    add_child(value, item.value->span, target);
}

/// A list stands for its elements.
void Evaluator::add_child(const Value& value, Span span, const Target& target) {
    if (const auto* list = std::get_if<ListPtr>(&value.v)) {
        for (std::size_t i = 0; i < (*list)->size() && step(span); ++i) {
            add_child((**list)[i], span, target);
        }
    } else if (const auto* thing = std::get_if<ThingPtr>(&value.v)) {
        const TypeKind type = (*thing)->constructor->type;
        if (target.thing != nullptr && type != TypeKind::shape) {
            report_.report(Diag::unexpected_item, span, in_code(target.thing->name), "shapes",
                           "a scene with " + described(type));
            *target.is_sound = false;
            return;
        }
        children_ += count_of(**thing);
        if (children_ > limits_.list_length) {
            stop(Diag::list_too_long, span, limits_.list_length);
            return;
        }
        if (recording()) {
            record_child(**thing);
        }
        target.children->push_back(*thing);
    }
}

void Evaluator::item(const ForCode& item, const FramePtr& frame, const Target& target) {
    const Value range = eval(*item.range, frame);
    *target.is_sound = *target.is_sound && !std::holds_alternative<ErrorValue>(range.v);
    if (recording()) {
        recorded_loop(item, range, frame, target);
        return;
    }
    Value current;
    report_.enter_loop(item.span, item.variable, &current);
    if (!run_recorded(item, range, frame, current, target)) {
        FramePtr inner;
        iterate(range, item.range->span, [&](const Value& value) {
            current = value;
            round(item, value, frame, inner, target);
        });
    }
    report_.leave();
}

/// `inner` is the frame of an earlier round, or null.
void Evaluator::round(const ForCode& item, const Value& value, const FramePtr& frame, FramePtr& inner,
                      const Target& target) {
    if (!inner || inner.use_count() > 1) { // kept by a function value of an earlier round
        inner = make_frame(frame, item.body.cells);
    }
    for (Frame::Cell& cell : inner->cells) {
        cell.ready = false;
    }
    inner->set(0, value);
    items(item.body.items, inner, target);
}

void Evaluator::item(const IfCode& item, const FramePtr& frame, const Target& target) {
    const Value condition = eval(*item.condition, frame);
    const auto* truth = std::get_if<BoolValue>(&condition.v);
    if (truth && !truth->v.is_constant()) {
        cannot_record();
    } else if (truth) {
        body(truth->v.value != 0 ? item.yes : item.no, frame, target);
    } else {
        *target.is_sound = false;
    }
}

void Evaluator::item(const AssertCode& item, const FramePtr& frame, const Target&) {
    const Value condition = eval(*item.condition, frame);
    const auto* truth = std::get_if<BoolValue>(&condition.v);
    if (!truth || (recording() && math_.require(truth->v)) || (!recording() && truth->v.value != 0)) {
        return;
    }
    const Value text = eval(*item.text, frame);
    if (const auto* message = std::get_if<std::string>(&text.v)) {
        report_.report(Diag::assertion_failed, item.condition->span, *message);
    }
}

void Evaluator::item(const PrintCode& item, const FramePtr& frame, const Target&) {
    const Value value = eval(*item.value, frame);
    if (recording()) {
        cannot_record();
        return;
    }
    if (std::holds_alternative<ErrorValue>(value.v)) {
        return;
    }
    const auto* text = std::get_if<std::string>(&value.v);
    prints_.push_back(text ? *text : to_string(value));
    printed_ += prints_.back().size() + 1;
    if (printed_ > limits_.string_length) {
        stop(Diag::string_too_long, item.value->span, limits_.string_length);
    }
}

std::vector<Param> Evaluator::params(const CheckedFile& file, const FramePtr& globals) {
    std::vector<Param> result;
    for (const ParamCode& code : file.params) {
        result.push_back(param(code, globals));
    }
    for (const auto& imported : file.imports) {
        for (Param& inner : params(imported->code, imported->globals)) {
            inner.name = fmt::format("{}.{}", imported->name, inner.name);
            result.push_back(std::move(inner));
        }
    }
    return result;
}

Param Evaluator::param(const ParamCode& code, const FramePtr& globals) {
    Param param{std::string(code.name), code.type, {}, {}, std::nullopt, code.text, code.span};
    param.value = cell(globals, static_cast<std::uint32_t>(code.cell));
    param.default_value = code.default_value ? eval(*code.default_value, globals) : param.value;
    const Components begin = code.begin ? components(eval(*code.begin, globals)) : Components{};
    const Components end = code.end ? components(eval(*code.end, globals)) : Components{};
    if (begin.count == 0 || end.count == 0) {
        return param;
    }
    param.range = {begin.v[0].value, end.v[0].value};
    const auto check = [&](const Value& value, Span span) {
        const Components v = components(value);
        const bool inside = v.v[0].value >= param.range->first && v.v[0].value <= param.range->second;
        if (v.count > 0 && !inside) {
            report_.report(
                Diag::value_out_of_range, span, fmt::format("the param `{}`", code.name), to_string(value),
                fmt::format("its range is {}..{}", to_string(compose(begin)), to_string(compose(end))));
        }
    };
    check(param.value, (*globals->code)[code.cell]->span);
    if (code.default_value) {
        check(param.default_value, code.default_value->span);
    }
    return param;
}

} // namespace scc::lang
