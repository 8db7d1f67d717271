#include "lang/value.h"

#include "lang/check.h"
#include "lang/components.h"
#include "lang/schema.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace scc::lang {
namespace {

/// Longer texts end in dots: lists can share their elements, so a few lines of a scene could print without
/// end.
constexpr std::size_t longest_text = 1'000'000;

/// Without the signs of zero and of what is not a number, which mean nothing to an author.
std::string number_text(double value) {
    const bool plain = value == 0 || std::isnan(value);
    return fmt::format("{}", plain ? std::abs(value) : value);
}

std::string scalar_text(const Scalar& scalar) {
    return scalar.is_constant() ? number_text(scalar.value) : "unknown";
}

template <std::size_t N>
std::string tuple_text(const std::array<Scalar, N>& v) {
    std::string text;
    for (const Scalar& component : v) {
        text += (text.empty() ? "(" : ", ") + scalar_text(component);
    }
    return text + ")";
}

/// In degrees or radians, whichever is shorter of what reads back as the same angle.
std::string angle_text(const Scalar& angle) {
    if (!angle.is_constant()) {
        return "unknown";
    }
    const std::string radians = number_text(angle.value) + "rad";
    for (int digits = 15; digits <= 17; ++digits) {
        const std::string text = fmt::format("{:.{}g}", angle.value * 180 / std::numbers::pi, digits);
        const double degrees = std::strtod(text.c_str(), nullptr);
        const std::string written = number_text(degrees) + "deg";
        if (degrees * std::numbers::pi / 180 == angle.value && written.size() <= radians.size()) {
            return written;
        }
    }
    return radians;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (char c : text) {
        switch (c) {
        case '\n':
            result += "\\n";
            break;
        case '\t':
            result += "\\t";
            break;
        case '"':
        case '\\':
            result += '\\';
            [[fallthrough]];
        default:
            result += c;
        }
    }
    return result + "\"";
}

std::string matrix_text(const TransformValue& transform) {
    std::string text = "matrix([";
    for (const auto& row : transform.m) {
        for (double element : row) {
            text += number_text(element) + ", ";
        }
    }
    return text + "0, 0, 0, 1])";
}

/// Of a spectrum, the colour that a light with it has.
std::string color_text(const ColorValue& color) {
    std::string text = "rgb" + tuple_text(color.v);
    if (!color.spectral) {
        return text;
    }
    ScalarMath math;
    const Components parts = components({color});
    if (!is_constant(parts)) {
        return text + " + spectra";
    }
    return "spectrum of " + ("rgb" + tuple_text(transformed(math, rec709_from_xyz, xyz_of(math, parts)).v));
}

struct Printer {
    std::string& out;

    void operator()(const ErrorValue&) const { out += "error"; }
    void operator()(const NumberValue& n) const { out += scalar_text(n.v); }
    void operator()(const AngleValue& a) const { out += angle_text(a.radians); }
    void operator()(const BoolValue& b) const {
        out += !b.v.is_constant() ? "unknown" : b.v.value != 0 ? "true" : "false";
    }
    void operator()(const std::string& text) const { out += quoted(text); }
    void operator()(const Vec2Value& v) const { out += tuple_text(v.v); }
    void operator()(const Vec3Value& v) const { out += tuple_text(v.v); }
    void operator()(const ColorValue& c) const { out += color_text(c); }
    void operator()(const TransformValue& t) const { out += matrix_text(t); }
    void operator()(const RangeValue& r) const { out += number_text(r.begin) + ".." + number_text(r.end); }
    void operator()(const SurfaceValue&) const { out += "surface"; }
    void operator()(const ListPtr& list) const {
        out += "[";
        for (std::size_t i = 0; i < list->size() && out.size() <= longest_text; ++i) {
            out += i > 0 ? ", " : "";
            std::visit(*this, (*list)[i].v);
        }
        out += "]";
    }
    void operator()(const ClosurePtr& closure) const {
        const std::string_view name = name_of(*closure);
        out += name.empty() ? "fn" : name;
    }
    void operator()(const ThingPtr& thing) const {
        out += thing->constructor->name;
        out += " { }";
    }
};

} // namespace

std::string to_string(const Value& value) {
    std::string text;
    std::visit(Printer{text}, value.v);
    if (text.size() > longest_text) {
        text.resize(longest_text);
        text += "...";
    }
    return text;
}

const FieldValue* Thing::find(std::string_view field) const {
    for (const FieldValue& value : fields) {
        if (value.name == field) {
            return &value;
        }
    }
    return nullptr;
}

const Value* Thing::get(std::string_view field) const {
    if (const FieldValue* value = find(field)) {
        return &value->value;
    }
    const Field* row = constructor->find(field);
    return row && row->default_value ? &*row->default_value : nullptr;
}

} // namespace scc::lang
