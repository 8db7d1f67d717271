#include "lang/builtins.h"

#include "lang/check.h"
#include "lang/colorimetry.h"
#include "lang/components.h"
#include "lang/spectrum.h"
#include "lang/transforms.h"
#include "lang/wording.h"

#include <algorithm>
#include <array>
#include <cmath>
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

Value xyz(BuiltinRun& run, const Arguments& a) {
    const Components v{
        TypeKind::vec3, 3, {components(a[0]).v[0], components(a[1]).v[0], components(a[2]).v[0]}};
    return compose(TypeKind::color, transformed(run.math, rec709_from_xyz, v).v);
}

Value blackbody(BuiltinRun& run, const Arguments& a) {
    const double kelvin = components(a[0]).v[0].value;
    if (!(kelvin > 0) || !std::isfinite(kelvin)) {
        run.report.report(Diag::value_out_of_range, run.span, "the temperature", to_string(a[0]),
                          "a temperature is in kelvin and greater than 0");
        return {ErrorValue{}};
    }
    const Triple v = blackbody_xyz(kelvin);
    return xyz(run, {number(v[0]), number(v[1]), number(v[2])});
}

Value spectral(const Spectrum& spectrum) {
    const SpectralTerm term{std::make_shared<const Spectrum>(spectrum), {1}};
    return {ColorValue{{}, std::make_shared<const std::vector<SpectralTerm>>(1, term)}};
}

/// Its area, and so the light's brightness, is as exact as its width.
void check_line(BuiltinRun& run, double from, double to) {
    constexpr double fewest_steps = 1 << 13; // to within 1e-4
    const double steps = (to - from) / (std::nextafter(to, std::numeric_limits<double>::infinity()) - to);
    if (steps < fewest_steps) {
        run.report.report(Diag::narrow_line, run.span, to_string(number(from)), to_string(number(to)),
                          fmt::format("{:.0f}", steps));
    }
}

/// The points of a spectrum, or nothing after a report.
std::vector<std::array<double, 2>> spectrum_points(BuiltinRun& run, const std::vector<Value>& list) {
    constexpr double largest_value = 1e30; // sums with light still are numbers, in float too
    std::vector<std::array<double, 2>> points;
    const auto refuse = [&](const std::string& why) {
        run.report.report(Diag::bad_spectrum, run.span, why);
        return std::vector<std::array<double, 2>>{};
    };
    if (list.empty()) {
        return refuse("this spectrum has no points; a point is (wavelength in nm, value)");
    }
    for (const Value& element : list) {
        const Components point = components(element);
        const double nm = point.v[0].value;
        if (!(nm > 0) || !std::isfinite(nm) || !(std::abs(point.v[1].value) <= largest_value)) {
            return refuse(
                fmt::format("this spectrum has the point {}; a wavelength is in nm and greater than "
                            "0, and a value at most 1e30",
                            to_string(element)));
        }
        if (!points.empty() && nm <= points.back()[0]) {
            return refuse(fmt::format("in this spectrum {} nm comes after {} nm; wavelengths ascend",
                                      to_string(number(nm)), to_string(number(points.back()[0]))));
        }
        if (!points.empty()) {
            check_line(run, points.back()[0], nm);
        }
        points.push_back({nm, point.v[1].value});
    }
    return points;
}

Value spectrum(BuiltinRun& run, const Arguments& a) {
    const auto points = spectrum_points(run, *std::get<ListPtr>(a[0].v));
    return points.empty() ? Value{ErrorValue{}} : spectral(sampled(points));
}

Value unknown_name(BuiltinRun& run, std::string_view what, const Value& name,
                   const std::vector<std::string_view>& known) {
    std::vector<std::string> words;
    for (const std::string_view word : known) {
        words.push_back(fmt::format("\"{}\"", word));
    }
    run.report.report(Diag::unknown_choice, run.span, what, to_string(name),
                      "the choices are " + alternatives(words));
    return {ErrorValue{}};
}

Value metal(BuiltinRun& run, const Arguments& a) {
    const auto reflectance = metal_reflectance(std::get<std::string>(a[0].v));
    return reflectance ? spectral(*reflectance) : unknown_name(run, "the metal", a[0], metal_names());
}

Value illuminant(BuiltinRun& run, const Arguments& a) {
    const Spectrum* light = find_illuminant(std::get<std::string>(a[0].v));
    return light != nullptr ? spectral(*light)
                            : unknown_name(run, "the illuminant", a[0], illuminant_names());
}

Value luminance(BuiltinRun& run, const Arguments& a) {
    return number(xyz_of(run.math, components(a[0])).v[1]);
}

Value chromaticity(BuiltinRun& run, const Arguments& a) {
    const Components v = xyz_of(run.math, components(a[0]));
    const Scalar sum = run.math.apply(ScalarOp::add, run.math.apply(ScalarOp::add, v.v[0], v.v[1]), v.v[2]);
    if (sum.is_constant() && sum.value == 0) {
        run.report.report(Diag::division_by_zero, run.span);
        return {ErrorValue{}};
    }
    run.math.require(ScalarOp::ne, sum, {0});
    return each(run.math, ScalarOp::div, TypeKind::vec2, Components{TypeKind::vec2, 2, v.v},
                Components{TypeKind::number, 1, {sum}});
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
        overload.takes_spectra = true;
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

/// What colours with spectra go into as well.
std::vector<Overload> seen(std::vector<Overload> overloads) {
    for (Overload& overload : overloads) {
        overload.takes_spectra = true;
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

/// One list of names for each number of parameters.
using Names = std::vector<std::vector<std::string_view>>;

Builtin row(std::string_view name, const Names& names, std::string_view doc, std::string_view example,
            std::vector<Overload> overloads) {
    for (Overload& overload : overloads) {
        const auto same_length = [&](const auto& list) { return list.size() == overload.parameters.size(); };
        overload.names = *std::find_if(names.begin(), names.end(), same_length);
    }
    return {name, std::move(overloads), doc, example};
}

std::vector<Builtin> make_table() {
    const auto vectors = {K::vec2, K::vec3};
    const auto rounded = {K::number, K::vec2, K::vec3, K::color};
    const auto ordered = {K::number, K::angle, K::vec2, K::vec3, K::color};
    const auto n = {K::number};
    const Names x{{"x"}};
    const Names angle{{"angle"}};
    const Names pair{{"a", "b"}};
    return {
        row("abs", x, "without its sign; of a vector or colour, component by component", "abs(-2)",
            same(ordered, 1, unary<ScalarOp::abs>)),
        row("floor", x, "the largest whole number that is not greater", "floor(-1.5)",
            same(rounded, 1, unary<ScalarOp::floor>)),
        row("ceil", x, "the smallest whole number that is not less", "ceil(1.2)",
            same(rounded, 1, unary<ScalarOp::ceil>)),
        row("sqrt", x, "the square root", "sqrt(2)", same(n, 1, unary<ScalarOp::sqrt>)),
        row("exp", x, "e to the power of x", "exp(1)", same(n, 1, unary<ScalarOp::exp>)),
        row("log", x, "the natural logarithm", "log(10)", same(n, 1, unary<ScalarOp::log>)),
        row("sin", angle, "the sine; of a plain number, which is in radians", "sin(30deg)",
            to_number({K::angle, K::number}, 1, unary<ScalarOp::sin, K::number>)),
        row("cos", angle, "the cosine; of a plain number, which is in radians", "cos(60deg)",
            to_number({K::angle, K::number}, 1, unary<ScalarOp::cos, K::number>)),
        row("tan", angle, "the tangent; of a plain number, which is in radians", "tan(45deg)",
            to_number({K::angle, K::number}, 1, unary<ScalarOp::tan, K::number>)),
        row("asin", x, "the angle from -90deg to 90deg that has this sine", "asin(0.5)",
            to_angle(1, unary<ScalarOp::asin, K::angle>)),
        row("acos", x, "the angle from 0 to 180deg that has this cosine", "acos(0.5)",
            to_angle(1, unary<ScalarOp::acos, K::angle>)),
        row("atan2", {{"y", "x"}}, "the angle of the direction (x, y), from -180deg to 180deg",
            "atan2(1, -1)", to_angle(2, pairwise<ScalarOp::atan2, K::angle>)),
        row("min", pair, "the smaller one, component by component", "min((1, 5), (2, 3))",
            same(ordered, 2, pairwise<ScalarOp::min>)),
        row("max", pair, "the greater one, component by component", "max(1, 2)",
            same(ordered, 2, pairwise<ScalarOp::max>)),
        row("pow", {{"x", "exponent"}}, "x to the power of the exponent, as `x ^ exponent`", "pow(2, 10)",
            same(n, 2, pairwise<ScalarOp::pow>)),
        row("mod", {{"x", "divisor"}}, "the remainder with the sign of the divisor, as `x % divisor`",
            "mod(-1, 3)", same({K::number, K::angle}, 2, modulo)),
        row("clamp", {{"x", "low", "high"}}, "the nearest value from `low` to `high`", "clamp(7, 0, 5)",
            clamps()),
        row("mix", {{"a", "b", "t"}}, "a (1 - t) + b t", "mix(rgb(1, 0, 0), rgb(0, 0, 1), 0.25)", mixes()),
        row("dot", pair, "the scalar product", "dot((1, 2, 3), (4, 5, 6))",
            to_number(vectors, 2, dot_product)),
        row("length", {{"v"}}, "the Euclidean length of a vector; a list has `len`", "length((3, 4))",
            to_number(vectors, 1, length)),
        row("normalize", {{"v"}}, "the vector of length 1 in this direction", "normalize((0, 3, 4))",
            same(vectors, 1, normalize)),
        row("cross", pair, "the vector product", "cross((1, 0, 0), (0, 1, 0))",
            same({K::vec3}, 2, cross_product)),
        row("random", {{"i"}, {"i", "j"}, {"i", "j", "k"}},
            "a number from 0 up to 1 that depends on the arguments alone, the same on every machine",
            "random(1, 2)", randoms()),
        row("noise", {{"p"}}, "smooth value noise from 0 up to 1 of a point in one, two or three dimensions",
            "noise((0.5, 0.25, 0))", to_number({K::number, K::vec2, K::vec3}, 1, noise)),
        row("rgb", {{"r", "g", "b"}}, "a colour in linear light, Rec.709 primaries", "rgb(1, 0.5, 0)",
            {{{K::number, K::number, K::number}, K::color, rgb}}),
        row("srgb", {{"r", "g", "b"}},
            "a colour in display-encoded values from 0 to 1 (IEC 61966-2-1), as a colour picker shows them",
            "srgb(0.5, 0.5, 0.5)", {{{K::number, K::number, K::number}, K::color, srgb}}),
        row("xyz", {{"x", "y", "z"}},
            "a colour from CIE 1931 tristimulus values; one that Rec.709 cannot show has negative parts",
            "xyz(0.9505, 1, 1.089)", {{{K::number, K::number, K::number}, K::color, xyz}}),
        row("blackbody", {{"kelvin"}},
            "the colour of a black body of this temperature, scaled to the luminance 1; where Rec.709 cannot "
            "show it, with negative parts, which `max(blackbody(1500), rgb(0, 0, 0))` cuts off",
            "blackbody(6500)", {{{K::number}, K::color, blackbody, true}}),
        row("spectrum", {{"points"}},
            "a colour by its spectrum, for lights and materials: pairs of a wavelength in nm and a value, "
            "with straight lines between them and level outside; a light that is 1 everywhere has the "
            "luminance 1",
            "spectrum([(400, 0.1), (550, 0.8), (700, 0.2)])",
            {{{Type::list_of(K::vec2)}, K::color, spectrum, true}}),
        row("metal", {{"name"}},
            "what a polished metal mirrors, as a spectrum from its measured refractive index: \"aluminium\", "
            "\"chromium\", \"copper\", \"gold\", \"iron\" or \"silver\"",
            "metal(\"gold\")", {{{K::string}, K::color, metal, true}}),
        row("illuminant", {{"name"}},
            "the spectrum of a CIE standard illuminant, scaled to the luminance 1: \"a\", \"d65\" or \"e\"; "
            "times the colour of a surface, what that looks like under it",
            "illuminant(\"d65\")", {{{K::string}, K::color, illuminant, true}}),
        row("luminance", {{"c"}},
            "the luminance Y of a colour; 1 of rgb(1, 1, 1). A spectrum counts as that of a light",
            "luminance(rgb(1, 0, 0))", seen({{{K::color}, K::number, luminance}})),
        row("chromaticity", {{"c"}},
            "the CIE 1931 chromaticity (x, y) of a colour. A spectrum counts as that of a light",
            "chromaticity(rgb(1, 1, 1))", seen({{{K::color}, K::vec2, chromaticity}})),
        row("translate", {{"offset"}, {"x", "y", "z"}}, "moves by an offset", "translate(1, 2, 3)",
            transforms({{K::vec3}, {K::number, K::number, K::number}}, translate)),
        row("scale", {{"factor"}, {"x", "y", "z"}},
            "stretches about the origin, the same in all directions or by one factor for each axis",
            "scale(2, 1, 1)", transforms({{K::number}, {K::number, K::number, K::number}, {K::vec3}}, scale)),
        row("rotate_x", angle, "turns about the x axis, right-handed", "rotate_x(90deg)",
            transforms({{K::angle}}, rotate_about<0>)),
        row("rotate_y", angle, "turns about the y axis, right-handed", "rotate_y(90deg)",
            transforms({{K::angle}}, rotate_about<1>)),
        row("rotate_z", angle, "turns about the z axis, right-handed", "rotate_z(90deg)",
            transforms({{K::angle}}, rotate_about<2>)),
        row("rotate", {{"axis", "angle"}}, "turns about an axis through the origin, right-handed",
            "rotate((1, 1, 1), 120deg)", transforms({{K::vec3, K::angle}}, rotate)),
        row("look_at", {{"eye", "target", "up"}},
            "the view transform: the eye goes to the origin, the target to the negative z axis",
            "look_at((0, 0, 5), (0, 0, 0), (0, 1, 0))",
            transforms({{K::vec3, K::vec3, K::vec3}}, look_at_view)),
        row("matrix", {{"m"}},
            "a transform from 16 numbers, row by row, for column vectors; the last row is 0, 0, 0, 1",
            "matrix([1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])",
            transforms({{Type::list_of(K::number)}}, matrix)),
        row("inverse", {{"t"}}, "undoes a transform", "inverse(translate(1, 2, 3) then scale(2))",
            transforms({{K::transform}}, inverse_of)),
    };
}

const std::vector<Builtin>& table() {
    static const std::vector<Builtin> rows = make_table();
    return rows;
}

constexpr std::array<std::string_view, 4> list_functions{"map", "filter", "sum", "len"};
constexpr std::array<std::string_view, 2> statements{"assert", "print"};

/// Of what the checker types by itself; T and U stand for any type.
std::vector<FunctionDoc> other_docs() {
    return {
        {"map",
         {"map(list: [T], function: fn(T) -> U) -> [U]"},
         "what the function makes of each element",
         "map([1, 2, 3], fn(x: number) = x * x)"},
        {"filter",
         {"filter(list: [T], keep: fn(T) -> bool) -> [T]"},
         "the elements for which the function gives `true`, in their order",
         "filter([1, 2, 3, 4], fn(x: number) = x % 2 == 0)"},
        {"sum",
         {"sum(list: [number]) -> number", "sum(list: [angle]) -> angle", "sum(list: [vec2]) -> vec2",
          "sum(list: [vec3]) -> vec3", "sum(list: [color]) -> color"},
         "all elements added up; 0 of an empty list",
         "sum([1, 2, 3])"},
        {"len", {"len(list: [T]) -> number"}, "how many elements a list has", "len([5, 6, 7])"},
        {"assert",
         {"assert(condition: bool, text: string)"},
         "a statement: where the condition does not hold, the text is reported as an error",
         "assert(len([1, 2]) == 2, \"two elements\")"},
        {"print",
         {"print(value: T)"},
         "a statement: says the value on standard error while the scene is compiled",
         "print(sqrt(2))"},
    };
}

std::string signature(std::string_view name, const Overload& overload) {
    std::string text(name);
    for (std::size_t i = 0; i < overload.parameters.size(); ++i) {
        text += i == 0 ? "(" : ", ";
        text += fmt::format("{}: {}", overload.names[i], to_string(overload.parameters[i]));
    }
    return text + ") -> " + to_string(overload.result);
}
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

const std::vector<FunctionDoc>& function_docs() {
    static const std::vector<FunctionDoc> docs = [] {
        std::vector<FunctionDoc> all;
        for (const Builtin& builtin : table()) {
            FunctionDoc& doc = all.emplace_back(FunctionDoc{builtin.name, {}, builtin.doc, builtin.example});
            for (const Overload& overload : builtin.overloads) {
                doc.signatures.push_back(signature(builtin.name, overload));
            }
        }
        const std::vector<FunctionDoc> others = other_docs();
        all.insert(all.end(), others.begin(), others.end());
        return all;
    }();
    return docs;
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

} // namespace scc::lang
