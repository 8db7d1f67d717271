#pragma once

#include "lang/value.h"

#include <string_view>

namespace scc::lang {

/// The operations that a per-point function can be made of.
enum class ScalarOp {
    neg,
    add,
    sub,
    mul,
    div,
    mod,
    pow,
    min,
    max,
    abs,
    floor,
    ceil,
    sqrt,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan2,
    exp,
    log,
    eq,
    ne,
    lt,
    le,
    gt,
    ge,
    logical_and,
    logical_or,
    logical_not,
    select,
};

std::string_view name_of(ScalarOp op);

/// Computes with scalars: known ones are folded, the others go to the builder.
class ScalarMath {
public:
    /// Without a builder every scalar has to be known.
    explicit ScalarMath(SymbolBuilder* builder = nullptr) : builder_(builder) {}

    Scalar apply(ScalarOp op, const Scalar& a);
    Scalar apply(ScalarOp op, const Scalar& a, const Scalar& b);
    /// `condition` is 1 or 0.
    Scalar select(const Scalar& condition, const Scalar& yes, const Scalar& no);

    SymbolBuilder* builder() const { return builder_; }

private:
    std::uint32_t symbol(const Scalar& scalar);

    SymbolBuilder* builder_;
};

} // namespace scc::lang
