#pragma once

#include "lang/rows.h"
#include "lang/test/toy_schema.h"

#include <string>
#include <vector>

namespace scc::lang::test {

inline void dump(std::string& out, const Thing& thing);
inline void dump(std::string& out, const std::vector<ThingPtr>& things);

inline void dump(std::string& out, const Value& value) {
    if (const auto* thing = std::get_if<ThingPtr>(&value.v)) {
        dump(out, **thing);
    } else if (const auto* list = std::get_if<ListPtr>(&value.v)) {
        for (const Value& element : **list) {
            dump(out, element);
        }
    } else if (const Components parts = components(value); parts.count > 0) {
        for (std::size_t i = 0; i < parts.count; ++i) {
            out += fmt::format(" {:a}", parts.v[i].value); // every bit
        }
    } else {
        out += " " + to_string(value);
    }
}

inline void dump(std::string& out, const Thing& thing) {
    out += fmt::format("{} {} {}:{}", thing.constructor->name, thing.name, thing.span.begin, thing.span.end);
    for (const FieldValue& field : thing.fields) {
        out += fmt::format(" {}=", field.name);
        dump(out, field.value);
    }
    out += "\n";
    dump(out, thing.children);
}

inline void dump(std::string& out, const std::vector<ThingPtr>& things) {
    for (const ThingPtr& thing : things) {
        for (std::size_t i = 0; i < count_of(*thing); ++i) {
            const std::size_t in_round = thing->rows ? thing->rows->things.size() : 1;
            dump(out, thing->rows ? *thing->rows->thing(i % in_round, i / in_round) : *thing);
        }
    }
}

/// All things, those of rows one by one, and all messages.
inline std::string outcome(const Scene& scene) {
    std::string out;
    dump(out, scene.module.items);
    return out + scene.messages();
}

} // namespace scc::lang::test
