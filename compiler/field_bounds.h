#pragma once

#include "compiler/ir/function.h"
#include "runtime/shapes/container.h"

#include <optional>
#include <string>

namespace scc::compiler {

/// An operation of a field that may have no finite value.
struct Unbounded {
    lang::Span place;
    std::string what; ///< "this divides by 0"
};

/// The first operation that has no finite value at some point of the container, as far as intervals over ever
/// smaller boxes can tell. What a settled condition leaves out does not count.
std::optional<Unbounded> find_unbounded(const ir::Function& field,
                                        const runtime::Container<double>& container);

/// How steep a field is in a box.
struct Steepness {
    double bound = 0; ///< of the gradient's length, wherever that has one
    bool elsewhere =
        false;            ///< it has none in places, as `length` at the origin, but the field is not 0 there
    bool at_zero = false; ///< it has none where the field may be 0
};
Steepness gradient_bound(const ir::Function& field, const runtime::Bounds<double>& box);

} // namespace scc::compiler
