#pragma once

#include "lang/nearest.h"
#include "lang/source.h"

#include <fmt/core.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scc::lang {

enum class Severity { note, warning, error };

/// Every diagnostic that scc can report about a scene; the rows are in diagnostics.def.
enum class Diag {
#define SCC_DIAGNOSTIC(kind, severity, name, message) kind,
#include "lang/diagnostics.def"
#undef SCC_DIAGNOSTIC
};

struct DiagnosticRow {
    std::string_view kind; ///< the enumerator's spelling
    Severity severity;
    std::string_view name; ///< as printed in brackets
    std::string_view message;
};

const DiagnosticRow& row(Diag kind);
/// All rows, in the order of the enumerators.
const std::vector<DiagnosticRow>& diagnostic_rows();

/// A place that helps to understand a diagnostic.
struct Note {
    Span span;
    std::string text;
};

/// Text to write over a range (an empty range inserts) that mends the mistake.
struct Fix {
    Span span;
    std::string replacement;
};

struct Diagnostic {
    Diag kind;
    Severity severity;
    Span span;
    std::string message;
    std::vector<Note> notes;
    std::optional<Fix> fix;

    Diagnostic& note(Span where, std::string text);
    Diagnostic& suggest(Span where, std::string replacement) {
        fix = Fix{where, std::move(replacement)};
        return *this;
    }
};

/// Collects what a run has to say about the scene; nothing is thrown.
class Diagnostics {
public:
    /// Adds a diagnostic, its message made of the row's text and the arguments. The reference stays valid
    /// until the next report.
    template <class... Args>
    Diagnostic& report(Diag kind, Span span, const Args&... args) {
        return make(kind, span, fmt::format(fmt::runtime(row(kind).message), args...));
    }

    void add(Diagnostic diagnostic);
    /// What is said of `file` is followed by the places where it is imported.
    void imported(FileId file, Span where);

    std::size_t count() const { return all_.size(); }
    bool has_errors() const { return errors_ > 0; }
    std::size_t error_count() const { return errors_; }
    bool has_errors_within(Span span) const;
    std::size_t warning_count() const;
    /// `--strict`: every warning becomes an error.
    void promote_warnings();
    /// By file, then position; what was reported first comes first at equal positions. Exact repeats are
    /// dropped.
    std::vector<Diagnostic> sorted() const;

private:
    Diagnostic& make(Diag kind, Span span, std::string message);

    std::vector<Diagnostic> all_;
    std::size_t errors_ = 0;
    std::map<FileId, std::vector<Span>> imports_; ///< of a file, where
    void note_imports(Diagnostic& diagnostic) const;
};

/// Clang's layout: `file:line:col: severity: message [name]`, the source line, the range, the replacement,
/// the notes.
std::string render_text(const SourceSet& sources, const Diagnostic& diagnostic, bool color);

} // namespace scc::lang
