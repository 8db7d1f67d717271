#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scc::lang {

enum class TypeKind {
    error, ///< of what was reported already; fits everywhere, so that one mistake stays one message
    number,
    angle,
    boolean,
    string,
    vec2,
    vec3,
    color,
    transform,
    range,   ///< `0..n`
    surface, ///< what a per-point function sees
    shape,
    material,
    light,
    camera,
    image,
    scene,    ///< what an imported file adds: shapes, lights and cameras
    setting,  ///< `world`, `render`
    method,   ///< `ray`, `raster`
    list,     ///< args[0] is the element
    function, ///< args are the parameters, then the result
};

/// A type of the language, compared by structure.
struct Type {
    TypeKind kind = TypeKind::error;
    std::vector<Type> args;

    Type() = default;
    Type(TypeKind k) : kind(k) {}
    Type(TypeKind k, std::vector<Type> a) : kind(k), args(std::move(a)) {}

    static Type list_of(Type element) { return {TypeKind::list, {std::move(element)}}; }
    static Type function(std::vector<Type> parameters, Type result) {
        parameters.push_back(std::move(result));
        return {TypeKind::function, std::move(parameters)};
    }
    friend bool operator==(const Type&, const Type&) = default;
};

/// As an author writes it: `number`, `[vec3]`, `fn(surface) -> color`.
std::string to_string(const Type& type);
/// With its article, for messages: `a number`, `an angle`, `a list of vec3`.
std::string described(const Type& type);

/// Whether a value of type `actual` may stand where `wanted` is expected; the error type fits everywhere.
bool fits(const Type& wanted, const Type& actual);
/// Of two types that fit each other: what is unknown in one, as the elements of `[]`, is taken from the
/// other.
Type joined(const Type& a, const Type& b);
/// The type with this name, if it is one word.
const TypeKind* named_type(std::string_view name);
std::vector<std::string_view> type_names();

} // namespace scc::lang
