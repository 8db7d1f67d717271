#pragma once

#include "lang/value.h"

#include <cstddef>
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
    random,
    noise,
};
inline constexpr std::size_t scalar_op_count = static_cast<std::size_t>(ScalarOp::noise) + 1;

std::string_view name_of(ScalarOp op);
/// The one of this name, which there is.
ScalarOp scalar_op(std::string_view name);
int arity(ScalarOp op);

/// Computes with scalars: known ones are folded, the others go to the builder.
class ScalarMath {
public:
    /// Without a builder every scalar has to be known.
    explicit ScalarMath(SymbolBuilder* builder = nullptr) : builder_(builder) {}

    Scalar apply(ScalarOp op, const Scalar& a);
    Scalar apply(ScalarOp op, const Scalar& a, const Scalar& b);
    Scalar apply(ScalarOp op, const Scalar& a, const Scalar& b, const Scalar& c);
    /// `condition` is 1 or 0.
    Scalar select(const Scalar& condition, const Scalar& yes, const Scalar& no);

    /// Says that this has to hold, as far as it is unknown (see SymbolBuilder::require). Gives false if it is
    /// known not to.
    bool require(ScalarOp op, const Scalar& a, const Scalar& b);
    bool require(const Scalar& condition);

    SymbolBuilder* builder() const { return builder_; }

private:
    std::uint32_t symbol(const Scalar& scalar);

    SymbolBuilder* builder_;
};

} // namespace scc::lang
