#include "lang/fixes.h"

#include <algorithm>

namespace scc::lang {
namespace {

/// Insertions at one place touch each other too: nobody knows which comes first.
bool touch(const Fix& a, const Fix& b) {
    const bool same_place = a.span.begin == b.span.begin;
    return same_place || (a.span.begin < b.span.end && b.span.begin < a.span.end);
}

} // namespace

std::vector<Fix> fixes_for(FileId file, const std::vector<Diagnostic>& diagnostics) {
    std::vector<Fix> fixes;
    for (const Diagnostic& diagnostic : diagnostics) {
        if (diagnostic.fix && diagnostic.fix->span.file == file) {
            fixes.push_back(*diagnostic.fix);
        }
    }
    std::stable_sort(fixes.begin(), fixes.end(),
                     [](const Fix& a, const Fix& b) { return a.span.begin < b.span.begin; });
    std::vector<Fix> chosen;
    for (Fix& fix : fixes) {
        if (chosen.empty() || !touch(chosen.back(), fix)) {
            chosen.push_back(std::move(fix));
        }
    }
    return chosen;
}

std::string with_fixes(std::string_view text, const std::vector<Fix>& fixes) {
    std::string result;
    std::size_t done = 0;
    for (const Fix& fix : fixes) {
        result += text.substr(done, fix.span.begin - done);
        result += fix.replacement;
        done = fix.span.end;
    }
    result += text.substr(done);
    return result;
}

} // namespace scc::lang
