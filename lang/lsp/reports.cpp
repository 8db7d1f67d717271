#include "lang/lsp/reports.h"

#include "lang/fixes.h"

#include <fmt/core.h>

#include <algorithm>

namespace scc::lang::lsp {
namespace {

constexpr FileId scene_file = 0;

int severity_of(Severity severity) {
    switch (severity) {
    case Severity::error:
        return 1;
    case Severity::warning:
        return 2;
    case Severity::note:
        return 3;
    }
    return 1;
}

class Report {
public:
    Report(Document& document, DiagnosticStyle style)
        : document_(document), sources_(document.checked->sources), style_(style) {}

    Json json(const Diagnostic& diagnostic) const {
        std::string message = diagnostic.message;
        if (diagnostic.span.file != scene_file) {
            message = place_in_words(diagnostic.span) + message;
        }
        Json related = Json::array();
        for (const Note& note : diagnostic.notes) {
            if (style_.related && sources_.contains(note.span.file)) {
                related.push_back({{"location", location(note.span)}, {"message", note.text}});
            } else {
                message += fmt::format("\nnote: {}{}", place_in_words(note.span), note.text);
            }
        }
        Json result{{"range", document_.range(span_here(diagnostic.span))},
                    {"severity", severity_of(diagnostic.severity)},
                    {"code", row(diagnostic.kind).name},
                    {"source", "scc"},
                    {"message", message}};
        if (!related.empty()) {
            result["relatedInformation"] = std::move(related);
        }
        return result;
    }

    /// What is wrong elsewhere is shown at the top of the document.
    static Span span_here(Span span) { return span.file == scene_file ? span : Span{scene_file, 0, 0}; }

private:
    std::string place_in_words(Span span) const {
        if (!sources_.contains(span.file)) {
            return "";
        }
        const SourceFile& file = sources_.file(span.file);
        const Position position = file.position(span.begin);
        return fmt::format("{}:{}:{}: ", file.path(), position.line, position.column);
    }
    Json location(Span span) const {
        if (span.file == scene_file) {
            return {{"uri", document_.uri()}, {"range", document_.range(span)}};
        }
        const SourceFile& file = sources_.file(span.file);
        const Positions positions(file.text(), document_.encoding());
        return {{"uri", uri_of(file.path())}, {"range", range_in(positions, span.begin, span.end)}};
    }

    Document& document_;
    const SourceSet& sources_;
    DiagnosticStyle style_;
};

/// Editors grow slow with more, and nobody reads them; `scc check` prints all.
constexpr std::size_t most_published = 1000;

std::vector<const Diagnostic*> gravest_first(const std::vector<Diagnostic>& diagnostics) {
    std::vector<const Diagnostic*> sorted;
    for (const Diagnostic& diagnostic : diagnostics) {
        sorted.push_back(&diagnostic);
    }
    if (sorted.size() > most_published) {
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](const Diagnostic* a, const Diagnostic* b) { return a->severity > b->severity; });
    }
    return sorted;
}

Json edit(Document& document, const std::vector<Fix>& fixes) {
    Json edits = Json::array();
    for (const Fix& fix : fixes) {
        edits.push_back({{"range", document.range(fix.span)}, {"newText", fix.replacement}});
    }
    return {{"changes", {{document.uri(), std::move(edits)}}}};
}

std::string title_of(const Fix& fix, std::string_view text) {
    const std::string_view old = text.substr(fix.span.begin, fix.span.end - fix.span.begin);
    if (fix.replacement.empty()) {
        return fmt::format("remove `{}`", old);
    }
    return old.empty() ? fmt::format("insert `{}`", fix.replacement)
                       : fmt::format("replace `{}` by `{}`", old, fix.replacement);
}

} // namespace

Json published(Document& document, DiagnosticStyle style) {
    const Report report(document, style);
    const std::vector<const Diagnostic*> all = gravest_first(document.checked->diagnostics);
    Json list = Json::array();
    for (std::size_t i = 0; i < std::min(all.size(), most_published); ++i) {
        list.push_back(report.json(*all[i]));
    }
    if (all.size() > most_published) {
        list.push_back({{"range", document.range(0, 0)},
                        {"severity", severity_of(Severity::note)},
                        {"source", "scc"},
                        {"message", fmt::format("{} more are not shown", all.size() - most_published)}});
    }
    return {{"uri", document.uri()}, {"version", document.version()}, {"diagnostics", std::move(list)}};
}

Json code_actions(Document& document, std::uint32_t begin, std::uint32_t end, DiagnosticStyle style) {
    const Report report(document, style);
    Json actions = Json::array();
    for (const Diagnostic& diagnostic : document.checked->diagnostics) {
        const Span span = Report::span_here(diagnostic.span);
        const bool has_fix = diagnostic.fix && diagnostic.fix->span.file == scene_file;
        if (has_fix && span.begin <= end && begin <= span.end) {
            actions.push_back({{"title", title_of(*diagnostic.fix, document.text())},
                               {"kind", "quickfix"},
                               {"isPreferred", true},
                               {"diagnostics", {report.json(diagnostic)}},
                               {"edit", edit(document, {*diagnostic.fix})}});
        }
    }
    const std::vector<Fix> all = fixes_for(scene_file, document.checked->diagnostics);
    if (!all.empty()) {
        actions.push_back({{"title", fmt::format("make all fixes of this file ({})", all.size())},
                           {"kind", "source.fixAll"},
                           {"edit", edit(document, all)}});
    }
    return actions;
}

} // namespace scc::lang::lsp
