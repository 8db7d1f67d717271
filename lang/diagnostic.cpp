#include "lang/diagnostic.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace scc::lang {

const std::vector<DiagnosticRow>& diagnostic_rows() {
    static const std::vector<DiagnosticRow> rows = {
#define SCC_DIAGNOSTIC(kind, severity, name, message) {#kind, Severity::severity, name, message},
#include "lang/diagnostics.def"
#undef SCC_DIAGNOSTIC
    };
    return rows;
}

const DiagnosticRow& row(Diag kind) {
    return diagnostic_rows()[static_cast<std::size_t>(kind)];
}

Diagnostic& Diagnostics::make(Diag kind, Span span, std::string message) {
    add({kind, row(kind).severity, span, std::move(message), {}, {}});
    return all_.back();
}

void Diagnostics::add(Diagnostic diagnostic) {
    errors_ += diagnostic.severity == Severity::error ? 1 : 0;
    all_.push_back(std::move(diagnostic));
}

bool Diagnostics::has_errors_within(Span span) const {
    return std::any_of(all_.begin(), all_.end(), [span](const Diagnostic& d) {
        return d.severity == Severity::error && d.span.file == span.file && d.span.begin >= span.begin &&
               d.span.end <= span.end;
    });
}

std::size_t Diagnostics::warning_count() const {
    return static_cast<std::size_t>(std::count_if(
        all_.begin(), all_.end(), [](const Diagnostic& d) { return d.severity == Severity::warning; }));
}

void Diagnostics::promote_warnings() {
    errors_ += warning_count();
    for (Diagnostic& diagnostic : all_) {
        if (diagnostic.severity == Severity::warning) {
            diagnostic.severity = Severity::error;
        }
    }
}

std::vector<Diagnostic> Diagnostics::sorted() const {
    std::vector<std::size_t> order(all_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});

    const auto what = [&](std::size_t i) {
        const Diagnostic& d = all_[i];
        return std::tie(d.span.file, d.span.begin, d.span.end, d.kind, d.message);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return what(a) < what(b); });
    const auto repeats = std::unique(order.begin(), order.end(),
                                     [&](std::size_t a, std::size_t b) { return what(a) == what(b); });
    order.erase(repeats, order.end());

    const auto place = [&](std::size_t i) {
        return std::make_tuple(all_[i].span.file, all_[i].span.begin, i);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
    std::vector<Diagnostic> result;
    result.reserve(order.size());
    for (const std::size_t i : order) {
        result.push_back(all_[i]);
        note_imports(result.back());
    }
    return result;
}

void Diagnostics::imported(FileId file, Span where) {
    std::vector<Span>& places = imports_[file];
    if (std::find(places.begin(), places.end(), where) == places.end()) {
        places.push_back(where);
    }
}

// Not inline: g++ 12 then warns of the moved text's bounds without reason.
Diagnostic& Diagnostic::note(Span where, std::string text) {
    notes.push_back({where, std::move(text)});
    return *this;
}

/// The way to the scene's own file by each file's first import, and the other imports of the file itself.
void Diagnostics::note_imports(Diagnostic& diagnostic) const {
    constexpr std::size_t most_places = 4;
    const auto own = imports_.find(diagnostic.span.file);
    if (own == imports_.end()) {
        return;
    }
    std::size_t length = 0;
    for (auto file = own; file != imports_.end() && length < imports_.size(); ++length) {
        diagnostic.note(file->second.front(), "in the file that is imported here");
        file = imports_.find(file->second.front().file);
    }
    for (std::size_t i = 1; i < std::min(own->second.size(), most_places); ++i) {
        diagnostic.note(own->second[i], "and here");
    }
}

} // namespace scc::lang
