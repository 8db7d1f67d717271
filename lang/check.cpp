#include "lang/check.h"

#include "lang/checker.h"
#include "lang/evaluator.h"
#include "lang/frame.h"
#include "lang/imports.h"

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

FramePtr frame_of(const CheckedFile& file, const FramePtr& outer, Storage& storage) {
    FramePtr frame = std::make_shared<Frame>(outer, file.body.cells, &storage.captured, 0);
    for (const auto& imported : file.imports) {
        imported->globals = frame_of(imported->code, frame, storage);
    }
    return frame;
}

} // namespace

Module check(std::shared_ptr<const ast::File> file, const Schema& schema,
             const std::vector<Definition>& definitions, SourceSet& sources, Diagnostics& diagnostics,
             const EvaluationLimits& limits, Importer* importer, std::optional<std::int64_t> frame,
             ImageSource* images) {
    ImportSession session;
    session.importer = importer;
    const FileId id = file->file;
    if (importer) {
        const std::string& path = sources.file(id).path();
        session.open.push_back({importer->identity(path), path, {}});
    }
    const auto storage = std::make_shared<Storage>();
    storage->file = std::move(file);
    storage->code = Checker(schema, sources, diagnostics, limits, session).run(*storage->file, definitions);
    Module module;
    module.storage = storage;
    RunReport report;
    Evaluator evaluator(limits, report, nullptr, images);
    const FramePtr globals = frame_of(storage->code, nullptr, *storage);
    for (const auto& [identity, tree] : session.trees) {
        module.imports.push_back(tree.file);
    }
    module.frames = evaluator.frames(storage->code, globals, frame);
    module.params = evaluator.params(storage->code, globals);
    evaluator.imports(storage->code);
    module.items = evaluator.run(storage->code.body, globals);
    module.prints = evaluator.take_prints();
    report.flush(diagnostics);
    return module;
}

SymbolIndex find_symbols(const ast::File& file, const Schema& schema, SourceSet& sources) {
    Diagnostics ignored;
    ImportSession session;
    SymbolIndex symbols;
    Checker(schema, sources, ignored, {}, session, &symbols).run(file, {});
    return symbols;
}

std::optional<std::string> evaluate_name(std::shared_ptr<const ast::File> file, Span name,
                                         const Schema& schema, SourceSet& sources,
                                         const EvaluationLimits& limits) {
    Diagnostics ignored;
    ImportSession session;
    Storage storage{std::move(file), {}, {}};
    storage.code = Checker(schema, sources, ignored, limits, session).run(*storage.file, {});
    const auto& names = storage.code.cells;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        return std::nullopt;
    }
    RunReport report;
    Evaluator evaluator(limits, report);
    const FramePtr globals = frame_of(storage.code, nullptr, storage);
    const Value value = evaluator.cell(globals, static_cast<std::uint32_t>(found - names.begin()));
    const bool is_plain = !std::holds_alternative<ErrorValue>(value.v) &&
                          !std::holds_alternative<ClosurePtr>(value.v) &&
                          !std::holds_alternative<ThingPtr>(value.v);
    return is_plain ? std::optional(to_string(value)) : std::nullopt;
}

namespace {

Components trace_with(const Value& argument, const ClosurePtr& function, SymbolBuilder& builder,
                      Diagnostics& diagnostics, ImageSource* images) {
    RunReport report;
    Evaluator evaluator({}, report, &builder, images);
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
    return parts;
}

std::vector<Scalar> scalars(const Components& parts) {
    return {parts.v.begin(), parts.v.begin() + parts.count};
}

template <class Vector>
Vector inputs(SymbolBuilder& builder) {
    constexpr std::array<std::string_view, 3> names{"p.x", "p.y", "p.z"};
    Vector vector;
    for (std::size_t i = 0; i < vector.v.size(); ++i) {
        vector.v[i] = {0, builder.input(names[i])};
    }
    return vector;
}

} // namespace

Components trace(const ClosurePtr& function, SymbolBuilder& builder, Diagnostics& diagnostics,
                 ImageSource* images) {
    return trace_with({SurfaceValue{}}, function, builder, diagnostics, images);
}

std::vector<Scalar> trace_at_point(const ClosurePtr& function, SymbolBuilder& builder,
                                   Diagnostics& diagnostics, ImageSource* images) {
    return scalars(trace_with({inputs<Vec3Value>(builder)}, function, builder, diagnostics, images));
}

std::vector<Scalar> trace_at_pair(const ClosurePtr& function, SymbolBuilder& builder,
                                  Diagnostics& diagnostics, ImageSource* images) {
    return scalars(trace_with({inputs<Vec2Value>(builder)}, function, builder, diagnostics, images));
}

std::string_view name_of(const Closure& function) {
    return function.function->name;
}

Span span_of(const Closure& function) {
    return function.function->span;
}

} // namespace scc::lang
