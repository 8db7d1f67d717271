#include "lang/builtins.h"

#include "lang/components.h"
#include "lang/transforms.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace scc::lang {
namespace {

using Arguments = std::vector<Value>;

/// Component by component; a result of kind error stands for the kind of the first argument.
template <ScalarOp op, TypeKind result = TypeKind::error>
Value unary(BuiltinRun& run, const Arguments& a) {
    const Components x = components(a[0]);
    return each(run.math, op, result == TypeKind::error ? x.kind : result, x);
}

template <ScalarOp op, TypeKind result = TypeKind::error>
Value pairwise(BuiltinRun& run, const Arguments& a) {
    const Components x = components(a[0]);
    return each(run.math, op, result == TypeKind::error ? x.kind : result, x, components(a[1]));
}

Value clamp(BuiltinRun& run, const Arguments& a) {
    const Components x = components(a[0]);
    const Value raised = each(run.math, ScalarOp::max, x.kind, x, components(a[1]));
    return each(run.math, ScalarOp::min, x.kind, components(raised), components(a[2]));
}

/// a (1 - t) + b t, which is exactly a and b at the ends.
Value mix(BuiltinRun& run, const Arguments& a) {
    const Components t = components(a[2]);
    const Components rest{TypeKind::number, 1, {run.math.apply(ScalarOp::sub, {1}, t.v[0])}};
    const TypeKind kind = components(a[0]).kind;
    const Value from = each(run.math, ScalarOp::mul, kind, components(a[0]), rest);
    const Value to = each(run.math, ScalarOp::mul, kind, components(a[1]), t);
    return each(run.math, ScalarOp::add, kind, components(from), components(to));
}

Value modulo(BuiltinRun& run, const Arguments& a) {
    const Components divisor = components(a[1]);
    if (divisor.v[0].is_constant() && divisor.v[0].value == 0) {
        run.report.report(Diag::division_by_zero, run.span);
        return {ErrorValue{}};
    }
    run.math.require(ScalarOp::ne, divisor.v[0], {0});
    return pairwise<ScalarOp::mod>(run, a);
}

Value dot_product(BuiltinRun& run, const Arguments& a) {
    return number(dot(run.math, components(a[0]), components(a[1])));
}

Value cross_product(BuiltinRun& run, const Arguments& a) {
    return compose(cross(run.math, components(a[0]), components(a[1])));
}

Scalar length_of(ScalarMath& math, const Components& v) {
    return math.apply(ScalarOp::sqrt, dot(math, v, v));
}

Value length(BuiltinRun& run, const Arguments& a) {
    return number(length_of(run.math, components(a[0])));
}

Value normalize(BuiltinRun& run, const Arguments& a) {
    const Components v = components(a[0]);
    const Components size{TypeKind::number, 1, {length_of(run.math, v)}};
    if (is_constant(v) && size.v[0].value == 0) {
        run.report.report(Diag::zero_vector, run.span, "`normalize`");
        return {ErrorValue{}};
    }
    run.math.require(ScalarOp::ne, size.v[0], {0});
    return each(run.math, ScalarOp::div, v.kind, v, size);
}

/// One to three numbers; those that are missing are 0.
Value random(BuiltinRun& run, const Arguments& a) {
    std::array<Scalar, 3> v{};
    for (std::size_t i = 0; i < a.size(); ++i) {
        v[i] = components(a[i]).v[0];
    }
    return number(run.math.apply(ScalarOp::random, v[0], v[1], v[2]));
}

/// Of a point in one, two or three dimensions.
Value noise(BuiltinRun& run, const Arguments& a) {
    const Components p = components(a[0]);
    return number(run.math.apply(ScalarOp::noise, p.v[0], p.v[1], p.v[2]));
}

Value rgb(BuiltinRun&, const Arguments& a) {
    return compose(TypeKind::color, {components(a[0]).v[0], components(a[1]).v[0], components(a[2]).v[0]});
}

/// IEC 61966-2-1: display-encoded to linear.
Scalar decode_srgb(ScalarMath& math, const Scalar& encoded) {
    const Scalar linear = math.apply(ScalarOp::div, encoded, {12.92});
    const Scalar base = math.apply(ScalarOp::div, math.apply(ScalarOp::add, encoded, {0.055}), {1.055});
    const Scalar curve = math.apply(ScalarOp::pow, base, {2.4});
    return math.select(math.apply(ScalarOp::le, encoded, {0.04045}), linear, curve);
}

Value srgb(BuiltinRun& run, const Arguments& a) {
    std::array<Scalar, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
        v[i] = decode_srgb(run.math, components(a[i]).v[0]);
    }
    return compose(TypeKind::color, v);
}

// ---- transforms: all their arguments are known ------------------------------------------------------------

Point point(const Value& value) {
    const Components p = components(value);
    return {p[0].value, p[1].value, p[2].value};
}

Point point(const Arguments& a) {
    return a.size() == 1
               ? point(a[0])
               : Point{components(a[0]).v[0].value, components(a[1]).v[0].value, components(a[2]).v[0].value};
}

Value invertible(BuiltinRun& run, const TransformValue& transform) {
    if (!inverse(transform)) {
        run.report.report(Diag::no_inverse, run.span, "");
        return {ErrorValue{}};
    }
    return {transform};
}

Value translate(BuiltinRun&, const Arguments& a) {
    return {translation(point(a))};
}
Value scale(BuiltinRun& run, const Arguments& a) {
    return invertible(run, scaling(point(a)));
}

template <std::size_t axis>
Value rotate_about(BuiltinRun&, const Arguments& a) {
    Point direction{};
    direction[axis] = 1;
    return {rotation(direction, components(a[0]).v[0].value)};
}

Value rotate(BuiltinRun& run, const Arguments& a) {
    const Components axis = components(a[0]);
    const double size = length_of(run.math, axis).value;
    if (size == 0) {
        run.report.report(Diag::zero_vector, run.span, "`rotate`");
        return {ErrorValue{}};
    }
    const Point p = point(a[0]);
    return {rotation({p[0] / size, p[1] / size, p[2] / size}, components(a[1]).v[0].value)};
}

Value look_at_view(BuiltinRun& run, const Arguments& a) {
    if (const auto view = look_at(point(a[0]), point(a[1]), point(a[2]))) {
        return {*view};
    }
    run.report.report(Diag::no_inverse, run.span, "; the eye is the target, or `up` points along the view");
    return {ErrorValue{}};
}

Value matrix(BuiltinRun& run, const Arguments& a) {
    const ListPtr& list = std::get<ListPtr>(a[0].v);
    if (list->size() != 16) {
        run.report.report(
            Diag::bad_matrix, run.span,
            fmt::format("this matrix has {} numbers; a matrix has 16, row by row", list->size()));
        return {ErrorValue{}};
    }
    std::array<double, 16> m{};
    std::transform(list->begin(), list->end(), m.begin(),
                   [](const Value& value) { return components(value).v[0].value; });
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
        run.report.report(Diag::bad_matrix, run.span,
                          "the last row of this matrix is not 0, 0, 0, 1; it moves points to infinity");
        return {ErrorValue{}};
    }
    TransformValue result{};
    for (std::size_t i = 0; i < 12; ++i) {
        result.m[i / 4][i % 4] = m[i];
    }
    return invertible(run, result);
}

Value inverse_of(BuiltinRun& run, const Arguments& a) {
    if (const auto undone = inverse(std::get<TransformValue>(a[0].v))) {
        return {*undone};
    }
    run.report.report(Diag::no_inverse, run.span, "");
    return {ErrorValue{}};
}

// ---- the table ------------------------------------------------------------------------------------------

using K = TypeKind;
using Run = Value (*)(BuiltinRun&, const Arguments&);

/// One overload per kind, each from that kind `count` times to that kind.
std::vector<Overload> same(std::initializer_list<K> kinds, std::size_t count, Run run) {
    std::vector<Overload> overloads;
    for (K kind : kinds) {
        overloads.push_back({std::vector<Type>(count, Type(kind)), kind, run});
    }
    return overloads;
}

std::vector<Overload> to_number(std::initializer_list<K> kinds, std::size_t count, Run run) {
    std::vector<Overload> overloads = same(kinds, count, run);
    for (Overload& overload : overloads) {
        overload.result = K::number;
    }
    return overloads;
}

std::vector<Overload> to_angle(std::size_t count, Run run) {
    return {{std::vector<Type>(count, Type(K::number)), K::angle, run}};
}

std::vector<Overload> mixes() {
    std::vector<Overload> overloads = same({K::number, K::angle, K::vec2, K::vec3, K::color}, 2, mix);
    for (Overload& overload : overloads) {
        overload.parameters.push_back(K::number);
    }
    return overloads;
}

std::vector<Overload> clamps() {
    std::vector<Overload> overloads = same({K::number, K::angle, K::vec2, K::vec3, K::color}, 3, clamp);
    for (K kind : {K::vec2, K::vec3, K::color}) {
        overloads.push_back({{kind, K::number, K::number}, kind, clamp});
    }
    return overloads;
}

std::vector<Overload> transforms(std::vector<std::vector<Type>> parameters, Run run) {
    std::vector<Overload> overloads;
    for (std::vector<Type>& list : parameters) {
        overloads.push_back({std::move(list), K::transform, run, true});
    }
    return overloads;
}

std::vector<Overload> randoms() {
    std::vector<Overload> overloads;
    for (std::size_t count = 1; count <= 3; ++count) {
        overloads.push_back({std::vector<Type>(count, Type(K::number)), K::number, random});
    }
    return overloads;
}

std::vector<Builtin> make_table() {
    const auto vectors = {K::vec2, K::vec3};
    const auto rounded = {K::number, K::vec2, K::vec3, K::color};
    const auto ordered = {K::number, K::angle, K::vec2, K::vec3, K::color};
    const auto n = {K::number};
    return {
        {"abs", same(ordered, 1, unary<ScalarOp::abs>)},
        {"floor", same(rounded, 1, unary<ScalarOp::floor>)},
        {"ceil", same(rounded, 1, unary<ScalarOp::ceil>)},
        {"sqrt", same(n, 1, unary<ScalarOp::sqrt>)},
        {"exp", same(n, 1, unary<ScalarOp::exp>)},
        {"log", same(n, 1, unary<ScalarOp::log>)},
        {"sin", to_number({K::angle, K::number}, 1, unary<ScalarOp::sin, K::number>)},
        {"cos", to_number({K::angle, K::number}, 1, unary<ScalarOp::cos, K::number>)},
        {"tan", to_number({K::angle, K::number}, 1, unary<ScalarOp::tan, K::number>)},
        {"asin", to_angle(1, unary<ScalarOp::asin, K::angle>)},
        {"acos", to_angle(1, unary<ScalarOp::acos, K::angle>)},
        {"atan2", to_angle(2, pairwise<ScalarOp::atan2, K::angle>)},
        {"min", same(ordered, 2, pairwise<ScalarOp::min>)},
        {"max", same(ordered, 2, pairwise<ScalarOp::max>)},
        {"pow", same(n, 2, pairwise<ScalarOp::pow>)},
        {"mod", same({K::number, K::angle}, 2, modulo)},
        {"clamp", clamps()},
        {"mix", mixes()},
        {"dot", to_number(vectors, 2, dot_product)},
        {"length", to_number(vectors, 1, length)},
        {"normalize", same(vectors, 1, normalize)},
        {"cross", same({K::vec3}, 2, cross_product)},
        {"random", randoms()},
        {"noise", to_number({K::number, K::vec2, K::vec3}, 1, noise)},
        {"rgb", {{{K::number, K::number, K::number}, K::color, rgb}}},
        {"srgb", {{{K::number, K::number, K::number}, K::color, srgb}}},
        {"translate", transforms({{K::vec3}, {K::number, K::number, K::number}}, translate)},
        {"scale", transforms({{K::number}, {K::number, K::number, K::number}, {K::vec3}}, scale)},
        {"rotate_x", transforms({{K::angle}}, rotate_about<0>)},
        {"rotate_y", transforms({{K::angle}}, rotate_about<1>)},
        {"rotate_z", transforms({{K::angle}}, rotate_about<2>)},
        {"rotate", transforms({{K::vec3, K::angle}}, rotate)},
        {"look_at", transforms({{K::vec3, K::vec3, K::vec3}}, look_at_view)},
        {"matrix", transforms({{Type::list_of(K::number)}}, matrix)},
        {"inverse", transforms({{K::transform}}, inverse_of)},
    };
}

const std::vector<Builtin>& table() {
    static const std::vector<Builtin> rows = make_table();
    return rows;
}

constexpr std::array<std::string_view, 4> list_functions{"map", "filter", "sum", "len"};
constexpr std::array<std::string_view, 2> statements{"assert", "print"};
constexpr std::array<std::string_view, 8> unsupported{"xyz",   "blackbody",    "spectrum",  "metal",
                                                      "frame", "chromaticity", "luminance", "time"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

const Builtin* find_builtin(std::string_view name) {
    static const auto index = [] {
        std::unordered_map<std::string_view, const Builtin*> rows;
        for (const Builtin& row : table()) {
            rows.emplace(row.name, &row);
        }
        return rows;
    }();
    const auto found = index.find(name);
    return found == index.end() ? nullptr : found->second;
}

const std::vector<std::string_view>& function_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> all(list_functions.begin(), list_functions.end());
        all.insert(all.end(), statements.begin(), statements.end());
        for (const Builtin& row : table()) {
            all.push_back(row.name);
        }
        return all;
    }();
    return names;
}

bool is_list_function(std::string_view name) {
    return contains(list_functions, name);
}
bool is_statement(std::string_view name) {
    return contains(statements, name);
}
bool is_unsupported_name(std::string_view name) {
    return contains(unsupported, name);
}

} // namespace scc::lang
