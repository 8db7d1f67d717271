#pragma once

#include "lang/check.h"
#include "lang/test/toy_schema.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang::test {

/// Writes down every operation: `mul(p.x, 2)`.
class Recorder final : public SymbolBuilder {
public:
    std::uint32_t constant(double value) override { return add(fmt::format("{}", value)); }
    std::uint32_t input(std::string_view name) override { return add(std::string(name)); }
    std::uint32_t apply(std::string_view op, const std::vector<std::uint32_t>& operands) override {
        std::string text = std::string(op) + "(";
        for (std::size_t i = 0; i < operands.size(); ++i) {
            text += (i > 0 ? ", " : "") + nodes_[operands[i]];
        }
        return add(text + ")");
    }
    std::string text(const Scalar& scalar) const {
        return scalar.is_constant() ? fmt::format("{}", scalar.value) : nodes_[scalar.symbol];
    }

private:
    std::uint32_t add(std::string node) {
        nodes_.push_back(std::move(node));
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }

    std::vector<std::string> nodes_;
};

/// Traces every function that stands in a field of `thing` or of what it holds; one line per result.
inline std::string trace_thing(const Thing& thing, Diagnostics& diagnostics) {
    std::string text;
    for (const FieldValue& field : thing.fields) {
        if (const auto* inner = std::get_if<ThingPtr>(&field.value.v)) {
            text += trace_thing(**inner, diagnostics);
        } else if (const auto* function = std::get_if<ClosurePtr>(&field.value.v)) {
            Recorder recorder;
            const Components parts = trace(*function, recorder, diagnostics);
            for (const Scalar& scalar : std::span(parts.v).first(parts.count)) {
                text += recorder.text(scalar) + "\n";
            }
        }
    }
    return text;
}

inline std::string trace_all(Scene& scene) {
    std::string text;
    for (const ThingPtr& item : scene.module.items) {
        text += trace_thing(*item, scene.diagnostics);
    }
    return text;
}

/// The trace of one function of a surface `s` with a number as result, after some definitions; the messages
/// if there are any.
inline std::string traced(std::string_view expression, std::string_view definitions = "",
                          std::string_view field = "gloss") {
    Scene scene(fmt::format("{}\nball {{ material = paint {{ {} = fn(s: surface) = {} }} }}", definitions,
                            field, expression));
    const std::string text = trace_all(scene);
    const std::string messages = scene.messages();
    return messages.empty() ? text : messages;
}

} // namespace scc::lang::test
