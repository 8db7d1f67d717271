#include "lang/components.h"

#include <algorithm>

namespace scc::lang {
namespace {

bool is_componentwise(TypeKind kind) {
    return kind == TypeKind::number || kind == TypeKind::vec2 || kind == TypeKind::vec3 ||
           kind == TypeKind::color;
}

ScalarOp scalar_op(ast::BinaryOp op) {
    switch (op) {
    case ast::BinaryOp::add:
        return ScalarOp::add;
    case ast::BinaryOp::sub:
        return ScalarOp::sub;
    case ast::BinaryOp::mul:
        return ScalarOp::mul;
    case ast::BinaryOp::div:
        return ScalarOp::div;
    case ast::BinaryOp::mod:
        return ScalarOp::mod;
    case ast::BinaryOp::pow:
        return ScalarOp::pow;
    case ast::BinaryOp::lt:
        return ScalarOp::lt;
    case ast::BinaryOp::le:
        return ScalarOp::le;
    case ast::BinaryOp::gt:
        return ScalarOp::gt;
    case ast::BinaryOp::ge:
        return ScalarOp::ge;
    case ast::BinaryOp::ne:
        return ScalarOp::ne;
    default:
        return ScalarOp::eq;
    }
}

Value equality(ScalarMath& math, bool equal, const Value& left, const Value& right) {
    if (const auto* text = std::get_if<std::string>(&left.v)) {
        return boolean({(*text == std::get<std::string>(right.v)) == equal ? 1.0 : 0.0});
    }
    const Components a = components(left);
    const Components b = components(right);
    const ScalarOp op = equal ? ScalarOp::eq : ScalarOp::ne;
    Scalar result = math.apply(op, a[0], b[0]);
    for (std::size_t i = 1; i < a.count; ++i) {
        result = math.apply(equal ? ScalarOp::logical_and : ScalarOp::logical_or, result,
                            math.apply(op, a[i], b[i]));
    }
    return boolean(result);
}

// ---- colours that have spectra --------------------------------------------------------------------------

using Terms = std::vector<SpectralTerm>;

/// More terms than this are never needed by a scene, and each product of two colours multiplies their
/// numbers.
constexpr std::size_t most_terms = 64;

const Terms& terms_of(const Components& color) {
    static const Terms none;
    return color.spectral ? *color.spectral : none;
}

/// What is known becomes one term.
SpectralPart joined(const Terms& terms) {
    auto result = std::make_shared<Terms>();
    Spectrum known{};
    bool any_known = false;
    for (const SpectralTerm& term : terms) {
        if (!term.factor.is_constant()) {
            result->push_back(term);
            continue;
        }
        any_known = true;
        for (std::size_t i = 0; i < spectrum_size; ++i) {
            known[i] += term.factor.value * (*term.spectrum)[i];
        }
    }
    if (any_known) {
        result->push_back({std::make_shared<const Spectrum>(known), {1}});
    }
    return result;
}

Value with_spectra(const Value& plain, const Terms& terms) {
    return {ColorValue{std::get<ColorValue>(plain.v).v, joined(terms)}};
}

/// As terms, too.
Terms plain_terms(const Components& color) {
    Terms terms;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!color.v[k].is_constant() || color.v[k].value != 0) {
            terms.push_back({std::make_shared<const Spectrum>(rec709_reflectances()[k]), color.v[k]});
        }
    }
    return terms;
}

void add_products(ScalarMath& math, const Terms& a, const Terms& b, Terms& sum) {
    for (const SpectralTerm& s : a) {
        for (const SpectralTerm& t : b) {
            Spectrum product{};
            for (std::size_t i = 0; i < spectrum_size; ++i) {
                product[i] = (*s.spectrum)[i] * (*t.spectrum)[i];
            }
            sum.push_back(
                {std::make_shared<const Spectrum>(product), math.apply(ScalarOp::mul, s.factor, t.factor)});
        }
    }
}

/// Plain colours multiply component by component, all else sample by sample.
Terms product_terms(ScalarMath& math, const Components& a, const Components& b) {
    Terms sum;
    add_products(math, terms_of(a), terms_of(b), sum);
    add_products(math, terms_of(a), plain_terms(b), sum);
    add_products(math, plain_terms(a), terms_of(b), sum);
    return sum;
}

Terms scaled(ScalarMath& math, ScalarOp op, const Terms& terms, const Scalar& by) {
    Terms result = terms;
    for (SpectralTerm& term : result) {
        term.factor = math.apply(op, term.factor, by);
    }
    return result;
}

Terms spectral_each(ScalarMath& math, ScalarOp op, const Components& a, const Components& b) {
    if (a.count == 1) {
        return scaled(math, op, terms_of(b), a.v[0]);
    }
    if (b.count == 1) {
        return scaled(math, op, terms_of(a), b.v[0]);
    }
    if (op == ScalarOp::mul) {
        return product_terms(math, a, b);
    }
    Terms sum = terms_of(a);
    for (const SpectralTerm& term : terms_of(b)) {
        sum.push_back({term.spectrum, math.apply(op, {0}, term.factor)});
    }
    return sum;
}

} // namespace

bool takes_spectra(ast::BinaryOp op, const Components& a, const Components& b) {
    switch (op) {
    case ast::BinaryOp::add:
    case ast::BinaryOp::sub:
        return terms_of(a).size() + terms_of(b).size() <= most_terms;
    case ast::BinaryOp::mul:
        return (terms_of(a).size() + 3) * (terms_of(b).size() + 3) <= most_terms || a.count == 1 ||
               b.count == 1;
    case ast::BinaryOp::div:
        return b.count == 1;
    default:
        return false;
    }
}

Spectrum spectrum_of(const Components& color) {
    Terms terms = plain_terms(color);
    terms.insert(terms.end(), terms_of(color).begin(), terms_of(color).end());
    return terms.empty() ? Spectrum{} : *joined(terms)->front().spectrum;
}

Components xyz_of(ScalarMath& math, const Components& color) {
    Components result = transformed(math, xyz_from_rec709, color);
    for (const SpectralTerm& term : terms_of(color)) {
        const Triple light = xyz_of_light(*term.spectrum);
        for (std::size_t k = 0; k < 3; ++k) {
            result.v[k] =
                math.apply(ScalarOp::add, result.v[k], math.apply(ScalarOp::mul, term.factor, {light[k]}));
        }
    }
    return result;
}

Components components(const Value& value) {
    if (const auto* n = std::get_if<NumberValue>(&value.v)) {
        return {TypeKind::number, 1, {n->v}};
    }
    if (const auto* a = std::get_if<AngleValue>(&value.v)) {
        return {TypeKind::angle, 1, {a->radians}};
    }
    if (const auto* b = std::get_if<BoolValue>(&value.v)) {
        return {TypeKind::boolean, 1, {b->v}};
    }
    if (const auto* p = std::get_if<Vec2Value>(&value.v)) {
        return {TypeKind::vec2, 2, {p->v[0], p->v[1]}};
    }
    if (const auto* p = std::get_if<Vec3Value>(&value.v)) {
        return {TypeKind::vec3, 3, p->v};
    }
    if (const auto* c = std::get_if<ColorValue>(&value.v)) {
        return {TypeKind::color, 3, c->v, c->spectral};
    }
    return {};
}

Value compose(TypeKind kind, const std::array<Scalar, 3>& v) {
    switch (kind) {
    case TypeKind::number:
        return {NumberValue{v[0]}};
    case TypeKind::angle:
        return {AngleValue{v[0]}};
    case TypeKind::boolean:
        return {BoolValue{v[0]}};
    case TypeKind::vec2:
        return {Vec2Value{{v[0], v[1]}}};
    case TypeKind::vec3:
        return {Vec3Value{v}};
    case TypeKind::color:
        return {ColorValue{v}};
    default:
        return {ErrorValue{}};
    }
}

Value compose(const Components& parts) {
    return parts.spectral ? Value{ColorValue{parts.v, parts.spectral}} : compose(parts.kind, parts.v);
}

Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a, const Components& b) {
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < std::max(a.count, b.count); ++i) {
        v[i] = math.apply(op, a[i], b[i]);
    }
    const Value plain = compose(kind, v);
    return a.spectral || b.spectral ? with_spectra(plain, spectral_each(math, op, a, b)) : plain;
}

Value each(ScalarMath& math, ScalarOp op, TypeKind kind, const Components& a) {
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < a.count; ++i) {
        v[i] = math.apply(op, a[i]);
    }
    const Value plain = compose(kind, v);
    return a.spectral ? with_spectra(plain, scaled(math, ScalarOp::mul, *a.spectral, {-1})) : plain;
}

Value select(ScalarMath& math, const Scalar& condition, const Components& yes, const Components& no) {
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < yes.count; ++i) {
        v[i] = math.select(condition, yes[i], no[i]);
    }
    const Value plain = compose(yes.kind, v);
    if (!yes.spectral && !no.spectral) {
        return plain;
    }
    Terms terms;
    for (const SpectralTerm& term : terms_of(yes)) {
        terms.push_back({term.spectrum, math.select(condition, term.factor, {0})});
    }
    for (const SpectralTerm& term : terms_of(no)) {
        terms.push_back({term.spectrum, math.select(condition, {0}, term.factor)});
    }
    return with_spectra(plain, terms);
}

TypeKind arithmetic_result(ast::BinaryOp op, TypeKind left, TypeKind right) {
    const bool same = left == right;
    const bool both_angles = same && left == TypeKind::angle;
    switch (op) {
    case ast::BinaryOp::add:
    case ast::BinaryOp::sub:
        return same && (is_componentwise(left) || both_angles) ? left : TypeKind::error;
    case ast::BinaryOp::mul:
        if (same) {
            return is_componentwise(left) ? left : TypeKind::error;
        }
        if (left == TypeKind::number) {
            return is_componentwise(right) || right == TypeKind::angle ? right : TypeKind::error;
        }
        return arithmetic_result(ast::BinaryOp::div, left, right);
    case ast::BinaryOp::div:
        if (both_angles) {
            return TypeKind::number;
        }
        return (same || right == TypeKind::number) && (is_componentwise(left) || left == TypeKind::angle)
                   ? left
                   : TypeKind::error;
    case ast::BinaryOp::mod:
        return both_angles || (same && left == TypeKind::number) ? left : TypeKind::error;
    case ast::BinaryOp::pow:
        return same && left == TypeKind::number ? left : TypeKind::error;
    default:
        return TypeKind::error;
    }
}

Value binary(ScalarMath& math, ast::BinaryOp op, const Value& left, const Value& right) {
    if (op == ast::BinaryOp::eq || op == ast::BinaryOp::ne) {
        return equality(math, op == ast::BinaryOp::eq, left, right);
    }
    const Components a = components(left);
    const Components b = components(right);
    const TypeKind kind = arithmetic_result(op, a.kind, b.kind);
    return each(math, scalar_op(op), kind == TypeKind::error ? TypeKind::boolean : kind, a, b);
}

Scalar dot(ScalarMath& math, const Components& a, const Components& b) {
    Scalar sum = math.apply(ScalarOp::mul, a[0], b[0]);
    for (std::size_t i = 1; i < a.count; ++i) {
        sum = math.apply(ScalarOp::add, sum, math.apply(ScalarOp::mul, a[i], b[i]));
    }
    return sum;
}

Components transformed(ScalarMath& math, const std::array<Triple, 3>& matrix, const Components& v) {
    Components result{TypeKind::vec3, 3, {}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Triple& row = matrix[i];
        const Components weights{TypeKind::vec3, 3, {Scalar{row[0]}, Scalar{row[1]}, Scalar{row[2]}}};
        result.v[i] = dot(math, weights, v);
    }
    return result;
}

Components cross(ScalarMath& math, const Components& a, const Components& b) {
    Components result{TypeKind::vec3, 3, {}};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        const Scalar plus = math.apply(ScalarOp::mul, a[j], b[k]);
        result.v[i] = math.apply(ScalarOp::sub, plus, math.apply(ScalarOp::mul, a[k], b[j]));
    }
    return result;
}

bool is_constant(const Components& parts) {
    return std::all_of(parts.v.begin(), parts.v.begin() + parts.count,
                       [](const Scalar& s) { return s.is_constant(); }) &&
           std::all_of(terms_of(parts).begin(), terms_of(parts).end(),
                       [](const SpectralTerm& term) { return term.factor.is_constant(); });
}

} // namespace scc::lang
