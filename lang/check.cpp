#include "lang/check.h"

#include "lang/checker.h"
#include "lang/evaluator.h"
#include "lang/frame.h"

#include <algorithm>
#include <cmath>

namespace scc::lang {
namespace {

/// What the values of a module refer to.
struct Storage {
    std::shared_ptr<const ast::File> file;
    CheckedFile code;
    CapturedFrames captured;
};

} // namespace

Module check(std::shared_ptr<const ast::File> file, const Schema& schema,
             const std::vector<Definition>& definitions, SourceSet& sources, Diagnostics& diagnostics,
             const EvaluationLimits& limits) {
    const auto storage = std::make_shared<Storage>();
    storage->file = std::move(file);
    storage->code = Checker(schema, sources, diagnostics, limits).run(*storage->file, definitions);
    Module module;
    module.storage = storage;
    RunReport report;
    Evaluator evaluator(limits, report);
    const BodyCode& body = storage->code.body;
    const FramePtr globals = std::make_shared<Frame>(nullptr, body.cells, &storage->captured, 0);
    module.params = evaluator.params(storage->code.params, globals);
    module.items = evaluator.run(body, globals);
    module.prints = evaluator.take_prints();
    report.flush(diagnostics);
    return module;
}

SymbolIndex find_symbols(const ast::File& file, const Schema& schema, SourceSet& sources) {
    Diagnostics ignored;
    SymbolIndex symbols;
    Checker(schema, sources, ignored, {}, &symbols).run(file, {});
    return symbols;
}

std::optional<std::string> evaluate_name(std::shared_ptr<const ast::File> file, Span name,
                                         const Schema& schema, SourceSet& sources,
                                         const EvaluationLimits& limits) {
    Diagnostics ignored;
    Storage storage{std::move(file), {}, {}};
    storage.code = Checker(schema, sources, ignored, limits).run(*storage.file, {});
    const auto& names = storage.code.cells;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        return std::nullopt;
    }
    RunReport report;
    Evaluator evaluator(limits, report);
    const FramePtr globals = std::make_shared<Frame>(nullptr, storage.code.body.cells, &storage.captured, 0);
    const Value value = evaluator.cell(globals, static_cast<std::uint32_t>(found - names.begin()));
    const bool is_plain = !std::holds_alternative<ErrorValue>(value.v) &&
                          !std::holds_alternative<ClosurePtr>(value.v) &&
                          !std::holds_alternative<ThingPtr>(value.v);
    return is_plain ? std::optional(to_string(value)) : std::nullopt;
}

std::vector<Scalar> trace(const ClosurePtr& function, SymbolBuilder& builder, Diagnostics& diagnostics) {
    RunReport report;
    Evaluator evaluator({}, report, &builder);
    const Span span = span_of(*function);
    const Value result = evaluator.call(*function->function, function->frame, {{SurfaceValue{}}}, span);
    const Components parts = components(result);
    for (std::size_t i = 0; i < parts.count; ++i) {
        if (parts.v[i].is_constant() && !std::isfinite(parts.v[i].value)) {
            report.report(Diag::not_finite, span, "the result of this function",
                          to_string(number(parts.v[i])));
        }
    }
    report.flush(diagnostics);
    return {parts.v.begin(), parts.v.begin() + parts.count};
}

std::string_view name_of(const Closure& function) {
    return function.function->name;
}

Span span_of(const Closure& function) {
    return function.function->span;
}

} // namespace scc::lang
