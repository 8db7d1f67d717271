#pragma once

#include "lang/diagnostic.h"
#include "lang/source.h"
#include "lang/value.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scc::lang {

/// Collects what goes wrong while a scene is evaluated. A place that fails again and again, as in a loop, is
/// reported once, with the loop's value at its first failure and the number of failures.
class RunReport {
public:
    template <class... Args>
    void report(Diag kind, Span span, const Args&... args) {
        Entry& entry = find(kind, span);
        if (entry.count++ == 0) {
            entry.arguments = {fmt::format("{}", args)...};
            remember_loop(entry);
        }
        failed_ = failed_ || row(kind).severity == Severity::error;
    }

    /// `value` is read when something is reported, and outlives the loop; it is ErrorValue before the first
    /// round.
    void enter_loop(Span span, std::string_view variable, const Value* value) {
        loops_.push_back({span, variable, value});
    }
    void leave_loop() { loops_.pop_back(); }

    bool failed() const { return failed_; }
    /// Hands everything over, in the order in which it happened first.
    void flush(Diagnostics& diagnostics);

private:
    struct Loop {
        Span span;
        std::string_view variable;
        const Value* value;
    };
    struct Entry {
        Diag kind{};
        Span span;
        std::uint64_t count = 0;
        std::array<std::string, 3> arguments;
        Span loop;
        std::string loop_text; ///< `i = 4117`; empty: not in a loop
    };
    Entry& find(Diag kind, Span span);
    void remember_loop(Entry& entry) const;

    std::vector<Entry> entries_;
    std::map<std::array<std::uint64_t, 4>, std::size_t> index_;
    std::vector<Loop> loops_;
    bool failed_ = false;
};

} // namespace scc::lang
