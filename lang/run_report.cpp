#include "lang/run_report.h"

#include "lang/check.h"
#include "lang/rows.h"
#include "lang/schema.h"

#include <algorithm>

namespace scc::lang {
namespace {

/// Of deep recursion the innermost calls and the outermost one are told.
constexpr std::size_t most_calls = 4;

/// A limit is exceeded by all of the scene, not by the call that happened to be the last.
bool is_limit(Diag kind) {
    return kind == Diag::steps_exceeded || kind == Diag::calls_too_deep || kind == Diag::too_deep;
}

std::string own_name(const Thing& thing) {
    const FieldValue* field = thing.find("name");
    const auto* name = field ? std::get_if<std::string>(&field->value.v) : nullptr;
    if (name && !name->empty()) {
        return *name;
    }
    return thing.name.empty() ? std::string(thing.constructor->name) : thing.name;
}

std::size_t count_if_named(const Thing& thing, const std::string& name) {
    if (!thing.rows) {
        return thing.constructor->type == TypeKind::shape && own_name(thing) == name ? 1 : 0;
    }
    std::size_t in_round = 0;
    for (const ThingPtr& one : thing.rows->things) {
        in_round += count_if_named(*one, name);
    }
    return in_round * thing.rows->count;
}

/// The thing's part of a path, numbered from the second of its name on.
std::string numbered_name(const Thing& thing, const std::vector<ThingPtr>* siblings) {
    const std::string name = own_name(thing);
    if (!siblings) {
        return name;
    }
    std::size_t same = 0;
    for (const ThingPtr& sibling : *siblings) {
        same += count_if_named(*sibling, name);
    }
    return same == 0 ? name : fmt::format("{}[{}]", name, same);
}

} // namespace

RunReport::Entry& RunReport::find(Diag kind, Span span) {
    const std::array<std::uint64_t, 4> key{static_cast<std::uint64_t>(kind), span.file, span.begin, span.end};
    const auto [place, inserted] = index_.try_emplace(key, entries_.size());
    if (inserted) {
        entries_.push_back({kind, span, 0, {}, {}});
    }
    return entries_[place->second];
}

/// From the innermost outwards.
std::vector<RunReport::Context> RunReport::around() const {
    std::vector<Context> found;
    for (std::size_t i = contexts_.size(); i > 0;) {
        const Context& context = contexts_[--i];
        if (context.kind == Kind::definition) {
            i = std::min(i, context.depth);
        } else {
            found.push_back(context);
        }
    }
    return found;
}

std::vector<Note> RunReport::surroundings(Diag kind) const {
    const std::vector<Context> contexts = around();
    const auto is_call = [](const Context& context) { return context.kind == Kind::call; };
    const auto calls = static_cast<std::size_t>(std::count_if(contexts.begin(), contexts.end(), is_call));
    std::vector<Note> notes;
    std::size_t call = 0;
    std::string path;
    Span outermost;
    for (const Context& context : contexts) {
        if (context.kind == Kind::loop && !std::holds_alternative<ErrorValue>(context.value->v)) {
            notes.push_back({context.span, fmt::format("in the loop with {} = {}", context.name,
                                                       to_string(*context.value))});
        } else if (is_call(context) && !is_limit(kind)) {
            ++call;
            const bool is_told = call < most_calls || call == calls;
            if (is_told) {
                const std::size_t left_out = call == calls && calls > most_calls ? calls - most_calls : 0;
                notes.push_back(
                    {context.span,
                     (context.name.empty() ? "in the call of this function"
                                           : fmt::format("in the call of `{}`", context.name)) +
                         (left_out > 0 ? fmt::format(", {} calls further out", left_out + 1) : "")});
            }
        } else if (context.kind == Kind::thing && context.thing->constructor->type == TypeKind::shape) {
            path = numbered_name(*context.thing, context.siblings) + (path.empty() ? "" : "/") + path;
            outermost = context.span;
        }
    }
    if (path.find('/') != std::string::npos) {
        notes.push_back({outermost, fmt::format("in `{}`", path)});
    }
    return notes;
}

void RunReport::flush(Diagnostics& diagnostics) {
    for (Entry& entry : entries_) {
        const auto& [first, second, third] = entry.arguments;
        Diagnostic& diagnostic = diagnostics.report(entry.kind, entry.span, first, second, third);
        if (entry.count > 1) {
            const std::string count = fmt::format("the first of {} such values", entry.count);
            if (entry.notes.empty()) {
                entry.notes.push_back({entry.span, count});
            } else {
                entry.notes.front().text += "; " + count;
            }
        }
        diagnostic.notes = std::move(entry.notes);
    }
    entries_.clear();
    index_.clear();
}

} // namespace scc::lang
