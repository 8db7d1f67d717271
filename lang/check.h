#pragma once

#include "lang/ast.h"
#include "lang/components.h"
#include "lang/diagnostic.h"
#include "lang/image_source.h"
#include "lang/importer.h"
#include "lang/schema.h"
#include "lang/source.h"
#include "lang/value.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scc::lang {

/// One `-D name=value` of the command line.
struct Definition {
    std::string name;
    std::string value;
};

/// A `param` as `scc params` lists it.
struct Param {
    std::string name;
    Type type;
    Value default_value;
    Value value; ///< in force
    std::optional<std::pair<double, double>> range;
    std::string text;
    Span span;
};

/// The pictures of an animation, and the one that the scene was evaluated for.
struct Frames {
    std::int64_t begin = 0;
    std::int64_t end = 1; ///< excluded
    double rate = 24;     ///< frames per second
    std::int64_t chosen = 0;
};

/// What bounds a run on hostile input; exceeding one is a clear error.
struct EvaluationLimits {
    std::uint64_t steps = 50'000'000; ///< expressions evaluated
    std::uint32_t call_depth = 500;
    std::uint64_t list_length = 20'000'000;
    std::uint64_t string_length = 1'000'000;
    std::size_t imports = 1000;
    std::size_t import_depth = 32;
    std::uint64_t recorded_rounds =
        32; ///< from here on it is tried to record a loop's body and to run all rounds at once
};

/// A scene file after checking and evaluation: the things on its top level, in order. Keeps the syntax trees
/// alive that its closures refer to.
struct Module {
    std::vector<ThingPtr> items;
    std::vector<Param> params;       ///< those of imports too, as `name.param`
    std::optional<Frames> frames;    ///< nothing: a single picture
    std::vector<FileId> imports;     ///< every file that was imported, once
    std::vector<std::string> prints; ///< what `print` said, in order
    std::shared_ptr<const void> storage;
};

/// Types every expression of the file against the schema and evaluates what is right, reporting all errors.
/// After errors, those of the parser too, the module holds the things that have no mistake in them. A `-D`
/// that names no `param` is reported at no place (Span{}) as unknown-param. Without an importer nothing can
/// be imported, without images none has a content. `frame` is the one to evaluate an animated scene for, else
/// its first.
Module check(std::shared_ptr<const ast::File> file, const Schema& schema,
             const std::vector<Definition>& definitions, SourceSet& sources, Diagnostics& diagnostics,
             const EvaluationLimits& limits = {}, Importer* importer = nullptr,
             std::optional<std::int64_t> frame = {}, ImageSource* images = nullptr);

/// Runs a per-point function on an unknown surface and hands every operation to the builder. Returns the
/// number's, colour's or vector's components; constant where the function does not depend on the
/// surface. What a per-point function may not do (recursion, shapes, unknown loop bounds) is reported, and
/// the result is empty.
Components trace(const ClosurePtr& function, SymbolBuilder& builder, Diagnostics& diagnostics,
                 ImageSource* images = nullptr);
/// The same for a function of a point, which is the builder's p.x p.y p.z.
std::vector<Scalar> trace_at_point(const ClosurePtr& function, SymbolBuilder& builder,
                                   Diagnostics& diagnostics, ImageSource* images = nullptr);
/// The same for a function of two numbers, which are the builder's p.x p.y.
std::vector<Scalar> trace_at_pair(const ClosurePtr& function, SymbolBuilder& builder,
                                  Diagnostics& diagnostics, ImageSource* images = nullptr);

/// The name of the `fn` or `let` that a function value came from; empty for a lambda.
std::string_view name_of(const Closure& function);
/// Where the function was written.
Span span_of(const Closure& function);

/// As the language writes it, numbers round-trip: `(1, 0.5, 0)`, `rgb(1, 1, 1)`, `30deg`, `"text"`.
std::string to_string(const Value& value);

} // namespace scc::lang
