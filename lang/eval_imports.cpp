#include "lang/evaluator.h"
#include "lang/imports.h"
#include "lang/rows.h"

#include <algorithm>

namespace scc::lang {
namespace {

/// As others see it: under the name of the import. A light or camera that has no name gets its kind's.
ThingPtr renamed(const ThingPtr& thing, std::string_view import) {
    auto copy = std::make_shared<Thing>(*thing);
    copy->name = fmt::format("{}/{}", import, copy->name.empty() ? thing->constructor->name : copy->name);
    return copy;
}

} // namespace

void Evaluator::imports(const CheckedFile& file) {
    for (const auto& imported : file.imports) {
        imports(imported->code);
        imported->scene = scene_of(*imported, run(imported->code.body, imported->globals));
    }
}

/// The shapes within a group, so that they share a part of their paths; lights and cameras beside it. What is
/// set for the whole picture stays behind.
Value Evaluator::scene_of(const ImportedFile& file, std::vector<ThingPtr> things) const {
    auto scene = std::make_shared<std::vector<Value>>();
    auto group = std::make_shared<Thing>();
    group->constructor = file.group;
    group->name = file.name;
    group->span = file.span;
    for (const ThingPtr& thing : things) {
        const TypeKind type = thing->constructor->type;
        const bool is_grouped = type == TypeKind::shape && file.group != nullptr;
        if (type == TypeKind::light || type == TypeKind::camera) {
            scene->push_back({renamed(thing, file.name)});
        } else if (type == TypeKind::shape && !is_grouped) {
            scene->push_back({thing});
        } else if (is_grouped) {
            group->height = std::max(group->height, thing->height + 1);
            group->children.push_back(thing);
        }
    }
    if (!group->children.empty()) {
        scene->insert(scene->begin(), {ThingPtr(std::move(group))});
    }
    return {ListPtr(std::move(scene))};
}

Value Evaluator::run(const code::Imported& node, Span, const FramePtr&) {
    return eval(*node.value, node.file->globals);
}

Value Evaluator::run(const code::ImportedScene& node, Span, const FramePtr&) {
    if (tracing()) {
        return failed();
    }
    if (recording()) {
        cannot_record();
        return failed();
    }
    return node.file->scene;
}

Value Evaluator::run(const code::Given& node, Span, const FramePtr& frame) {
    return eval(*node.value, frame->parent);
}

} // namespace scc::lang
