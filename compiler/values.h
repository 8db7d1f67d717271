#pragma once

#include "lang/value.h"
#include "runtime/math/affine.h"
#include "runtime/math/vec.h"

#include <string>
#include <string_view>
#include <variant>

/// Values of checked things as the runtime's types. The checker has made sure of the types.
namespace scc::compiler {

inline double to_number(const lang::Value& value) {
    return std::get<lang::NumberValue>(value.v).v.value;
}
inline double to_radians(const lang::Value& value) {
    return std::get<lang::AngleValue>(value.v).radians.value;
}
inline bool to_bool(const lang::Value& value) {
    return std::get<lang::BoolValue>(value.v).v.value != 0;
}
inline const std::string& to_text(const lang::Value& value) {
    return std::get<std::string>(value.v);
}
inline runtime::Vec3<double> to_vec3(const lang::Value& value) {
    const auto& v = std::get<lang::Vec3Value>(value.v).v;
    return {v[0].value, v[1].value, v[2].value};
}
/// Of length 1; the vector may be so small or large that its square is no number.
inline runtime::Vec3<double> to_direction(const runtime::Vec3<double>& v) {
    const double squared = dot(v, v);
    const bool is_ordinary = squared > 1e-280 && squared < 1e280;
    return normalize(is_ordinary ? v : v * (1 / largest_component(absolute(v))));
}
inline runtime::Rgb<double> to_rgb(const lang::Value& value) {
    const auto& v = std::get<lang::ColorValue>(value.v).v;
    return {v[0].value, v[1].value, v[2].value};
}
inline runtime::Affine<double> to_affine(const lang::Value& value) {
    runtime::Affine<double> result;
    const auto& m = std::get<lang::TransformValue>(value.v).m;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            result.m[row][column] = m[row][column];
        }
    }
    return result;
}
inline const lang::ThingPtr& to_thing(const lang::Value& value) {
    return std::get<lang::ThingPtr>(value.v);
}

/// The author's range of a field, else that of the whole thing.
inline lang::Span place_of(const lang::Thing& thing, std::string_view field) {
    const lang::FieldValue* value = thing.find(field);
    return value != nullptr ? value->value_span : thing.span;
}

} // namespace scc::compiler
