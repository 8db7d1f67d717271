#include "lang/run_report.h"

#include "lang/check.h"

namespace scc::lang {

RunReport::Entry& RunReport::find(Diag kind, Span span) {
    const std::array<std::uint64_t, 4> key{static_cast<std::uint64_t>(kind), span.file, span.begin, span.end};
    const auto [place, inserted] = index_.try_emplace(key, entries_.size());
    if (inserted) {
        entries_.push_back({kind, span, 0, {}, {}, {}});
    }
    return entries_[place->second];
}

void RunReport::remember_loop(Entry& entry) const {
    if (!loops_.empty() && !std::holds_alternative<ErrorValue>(loops_.back().value->v)) {
        const Loop& loop = loops_.back();
        entry.loop = loop.span;
        entry.loop_text = fmt::format("{} = {}", loop.variable, to_string(*loop.value));
    }
}

void RunReport::flush(Diagnostics& diagnostics) {
    for (const Entry& entry : entries_) {
        const auto& [first, second, third] = entry.arguments;
        Diagnostic& diagnostic = diagnostics.report(entry.kind, entry.span, first, second, third);
        const std::string count =
            entry.count > 1 ? fmt::format("the first of {} such values", entry.count) : "";
        if (!entry.loop_text.empty()) {
            diagnostic.note(entry.loop,
                            "in the loop with " + entry.loop_text + (count.empty() ? "" : "; ") + count);
        } else if (!count.empty()) {
            diagnostic.note(entry.span, count);
        }
    }
    entries_.clear();
    index_.clear();
}

} // namespace scc::lang
