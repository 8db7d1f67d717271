#include "lang/check.h"

#include "lang/checker.h"
#include "lang/evaluator.h"
#include "lang/frame.h"

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

namespace {

std::vector<Scalar> trace_with(const Value& argument, const ClosurePtr& function, SymbolBuilder& builder,
                               Diagnostics& diagnostics) {
    RunReport report;
    Evaluator evaluator({}, report, &builder);
    const Span span = span_of(*function);
    const Value result = evaluator.call(*function->function, function->frame, {argument}, span);
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

} // namespace

std::vector<Scalar> trace(const ClosurePtr& function, SymbolBuilder& builder, Diagnostics& diagnostics) {
    return trace_with({SurfaceValue{}}, function, builder, diagnostics);
}

std::vector<Scalar> trace_at_point(const ClosurePtr& function, SymbolBuilder& builder,
                                   Diagnostics& diagnostics) {
    Vec3Value point;
    constexpr std::array<std::string_view, 3> names{"p.x", "p.y", "p.z"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        point.v[i] = {0, builder.input(names[i])};
    }
    return trace_with({point}, function, builder, diagnostics);
}

std::string_view name_of(const Closure& function) {
    return function.function->name;
}

Span span_of(const Closure& function) {
    return function.function->span;
}

} // namespace scc::lang
