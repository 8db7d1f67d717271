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

/// Collects what goes wrong while a scene is evaluated, with the loops, calls and things that it happened in.
/// A place that fails again and again, as in a loop, is reported once: its first failure, and how many there
/// were.
class RunReport {
public:
    template <class... Args>
    void report(Diag kind, Span span, const Args&... args) {
        if (rehearsal_ != nullptr) {
            *rehearsal_ = true;
            return;
        }
        Entry& entry = find(kind, span);
        if (entry.count++ == 0) {
            entry.arguments = {fmt::format("{}", args)...};
            entry.notes = surroundings(kind);
        }
    }

    /// `value` is read when something is reported, and outlives the loop; it is ErrorValue before the first
    /// round.
    void enter_loop(Span span, std::string_view variable, const Value* value) {
        contexts_.push_back({.kind = Kind::loop, .span = span, .name = variable, .value = value});
    }
    void enter_call(Span span, std::string_view function) {
        contexts_.push_back({.kind = Kind::call, .span = span, .name = function});
    }
    /// `siblings` are the things before it that it will stand beside, if any are known.
    void enter_thing(const Thing* thing, const std::vector<ThingPtr>* siblings) {
        contexts_.push_back({.kind = Kind::thing, .span = thing->span, .thing = thing, .siblings = siblings});
    }
    /// What is evaluated now belongs where there were only `depth` contexts, whoever asks for it first.
    void enter_definition(std::size_t depth) {
        contexts_.push_back({.kind = Kind::definition, .depth = depth});
    }
    void leave() { contexts_.pop_back(); }
    std::size_t depth() const { return contexts_.size(); }

    /// While something is evaluated to find out about it, reports only set this; null ends that.
    bool* rehearse(bool* reported) { return std::exchange(rehearsal_, reported); }

    /// Hands everything over, in the order in which it happened first.
    void flush(Diagnostics& diagnostics);

private:
    enum class Kind { loop, call, thing, definition };
    struct Context {
        Kind kind;
        Span span{};
        std::string_view name{};
        const Value* value = nullptr;
        const Thing* thing = nullptr;
        const std::vector<ThingPtr>* siblings = nullptr;
        std::size_t depth = 0;
    };
    struct Entry {
        Diag kind{};
        Span span;
        std::uint64_t count = 0;
        std::array<std::string, 3> arguments;
        std::vector<Note> notes;
    };
    Entry& find(Diag kind, Span span);
    std::vector<Context> around() const;
    std::vector<Note> surroundings(Diag kind) const;

    std::vector<Entry> entries_;
    std::map<std::array<std::uint64_t, 4>, std::size_t> index_;
    std::vector<Context> contexts_;
    bool* rehearsal_ = nullptr;
};

} // namespace scc::lang
