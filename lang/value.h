#pragma once

#include "lang/ast.h"
#include "lang/source.h"
#include "lang/spectrum.h"
#include "lang/type.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace scc::lang {

struct Constructor;

/// A number that is known now, or a node of the per-point function that is being traced (see SymbolBuilder).
struct Scalar {
    static constexpr std::uint32_t constant = std::numeric_limits<std::uint32_t>::max();

    double value = 0;
    std::uint32_t symbol = constant;

    bool is_constant() const { return symbol == constant; }
    friend bool operator==(const Scalar&, const Scalar&) = default;
};

struct ThingRows;
struct Closure; // a function with the bindings it saw; private to the evaluator
struct Thing;
struct Value;
using ThingPtr = std::shared_ptr<const Thing>;
using ClosurePtr = std::shared_ptr<const Closure>;
using ListPtr = std::shared_ptr<const std::vector<Value>>;

struct ErrorValue {};
struct NumberValue {
    Scalar v;
};
struct AngleValue {
    Scalar radians;
};
struct BoolValue {
    Scalar v; ///< 1 or 0
};
struct Vec2Value {
    std::array<Scalar, 2> v;
};
struct Vec3Value {
    std::array<Scalar, 3> v;
};
/// A part of a colour: a spectrum as often as the factor says.
struct SpectralTerm {
    std::shared_ptr<const Spectrum> spectrum;
    Scalar factor;
};
/// Null where a colour has no spectrum. What is known stands in one term, whose factor is 1.
using SpectralPart = std::shared_ptr<const std::vector<SpectralTerm>>;
/// The sum of a plain colour and spectra.
struct ColorValue {
    std::array<Scalar, 3> v; ///< linear light, Rec.709 primaries
    SpectralPart spectral{};
};
/// An affine map of column vectors: x' = m[row][0..2] . x + m[row][3].
struct TransformValue {
    std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
};
struct RangeValue {
    double begin = 0, end = 0; ///< the end is excluded
};
struct SurfaceValue {}; ///< the argument of a per-point function while it is traced

/// What an expression evaluates to.
struct Value {
    std::variant<ErrorValue, NumberValue, AngleValue, BoolValue, std::string, Vec2Value, Vec3Value,
                 ColorValue, TransformValue, RangeValue, SurfaceValue, ListPtr, ClosurePtr, ThingPtr>
        v;
};

/// A field as the author set it.
struct FieldValue {
    std::string_view name; ///< of the schema's row
    Value value;
    Span name_span;
    Span value_span;
};

/// A built constructor: `sphere { radius = 1 }`. Immutable, shared between all places that use it.
struct Thing {
    const Constructor* constructor = nullptr;
    std::vector<FieldValue> fields;        ///< as written; defaults are in the schema
    std::vector<ThingPtr> children;        ///< items of a group, in order
    std::string name;                      ///< of the `let` or `fn` that made it, else empty
    Span span;                             ///< of the constructor expression
    std::uint32_t height = 1;              ///< things that stand within each other, at most
    std::shared_ptr<const ThingRows> rows; ///< of a thing that stands for many (see rows.h); else null

    const FieldValue* find(std::string_view field) const;
    /// The author's value, else the schema's default; null for an optional field that was not set.
    const Value* get(std::string_view field) const;
};

/// Receives the operations of a per-point function while the evaluator runs it on unknowns. Operands and
/// results are scalars; vectors and colours have been taken apart.
class SymbolBuilder {
public:
    virtual ~SymbolBuilder() = default;
    virtual std::uint32_t constant(double value) = 0;
    /// `name` is one of: p.x p.y p.z world.x world.y world.z n.x n.y n.z uv.x uv.y
    virtual std::uint32_t input(std::string_view name) = 0;
    /// `op` is the operator's name as in the runtime's operator table (add, mod, floor, select, ...).
    virtual std::uint32_t apply(std::string_view op, const std::vector<std::uint32_t>& operands) = 0;
    /// The channels of an `image { }` at (u, v), if the builder can express that. A failure to read it is
    /// reported by the builder.
    virtual std::optional<std::array<Scalar, 3>> image(const ThingPtr& /*image*/,
                                                       const std::array<Scalar, 2>& /*uv*/) {
        return std::nullopt;
    }
    /// Where the operations that follow were written.
    virtual void locate(Span /*span*/) {}

    /// Whether what is required of unknown values matters; per-point functions go on with whatever comes out.
    virtual bool has_requirements() const { return false; }
    /// Where the condition is 0, something has to be reported.
    virtual void require(std::uint32_t /*condition*/) {}
    /// The element of a list of numbers that an unknown whole number chooses, if the builder can express
    /// that.
    virtual std::optional<std::uint32_t> lookup(std::vector<double> /*list*/, std::uint32_t /*index*/) {
        return std::nullopt;
    }
    /// What follows, up to `leave`, counts only where the condition holds (or where it does not).
    virtual void enter(std::uint32_t /*condition*/, bool /*holds*/) {}
    virtual void leave() {}
};

} // namespace scc::lang
