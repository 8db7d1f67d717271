#include "lang/type.h"

#include <array>

namespace scc::lang {
namespace {

struct NamedKind {
    std::string_view name;
    TypeKind kind;
};

constexpr std::array named_kinds{
    NamedKind{"number", TypeKind::number}, NamedKind{"angle", TypeKind::angle},
    NamedKind{"bool", TypeKind::boolean},  NamedKind{"string", TypeKind::string},
    NamedKind{"vec2", TypeKind::vec2},     NamedKind{"vec3", TypeKind::vec3},
    NamedKind{"color", TypeKind::color},   NamedKind{"transform", TypeKind::transform},
    NamedKind{"range", TypeKind::range},   NamedKind{"surface", TypeKind::surface},
    NamedKind{"shape", TypeKind::shape},   NamedKind{"material", TypeKind::material},
    NamedKind{"light", TypeKind::light},   NamedKind{"camera", TypeKind::camera},
    NamedKind{"image", TypeKind::image},   NamedKind{"setting", TypeKind::setting},
    NamedKind{"method", TypeKind::method}, NamedKind{"scene", TypeKind::scene},
};

std::string_view name_of(TypeKind kind) {
    for (const NamedKind& row : named_kinds) {
        if (row.kind == kind) {
            return row.name;
        }
    }
    return "error";
}

bool starts_with_vowel(std::string_view word) {
    return std::string_view("aeiou").find(word.front()) != std::string_view::npos;
}

} // namespace

std::string to_string(const Type& type) {
    if (type.kind == TypeKind::list) {
        return "[" + to_string(type.args[0]) + "]";
    }
    if (type.kind == TypeKind::function) {
        std::string text = "fn(";
        for (std::size_t i = 0; i + 1 < type.args.size(); ++i) {
            text += (i > 0 ? ", " : "") + to_string(type.args[i]);
        }
        return text + ") -> " + to_string(type.args.back());
    }
    return std::string(name_of(type.kind));
}

std::string described(const Type& type) {
    if (type.kind == TypeKind::list) {
        return type.args[0].kind == TypeKind::error ? "a list" : "a list of " + to_string(type.args[0]);
    }
    if (type.kind == TypeKind::function) {
        return "a function `" + to_string(type) + "`";
    }
    std::string name = to_string(type);
    return (starts_with_vowel(name) ? "an " : "a ") + name;
}

bool fits(const Type& wanted, const Type& actual) {
    if (wanted.kind == TypeKind::error || actual.kind == TypeKind::error) {
        return true;
    }
    if (wanted.kind != actual.kind || wanted.args.size() != actual.args.size()) {
        return false;
    }
    for (std::size_t i = 0; i < wanted.args.size(); ++i) {
        if (!fits(wanted.args[i], actual.args[i])) {
            return false;
        }
    }
    return true;
}

Type joined(const Type& a, const Type& b) {
    if (a.kind == TypeKind::error) {
        return b;
    }
    Type result = a;
    for (std::size_t i = 0; i < a.args.size() && b.kind == a.kind; ++i) {
        result.args[i] = joined(a.args[i], b.args[i]);
    }
    return result;
}

const TypeKind* named_type(std::string_view name) {
    for (const NamedKind& row : named_kinds) {
        if (row.name == name) {
            return &row.kind;
        }
    }
    return nullptr;
}

std::vector<std::string_view> type_names() {
    std::vector<std::string_view> names;
    for (const NamedKind& row : named_kinds) {
        names.push_back(row.name);
    }
    return names;
}

} // namespace scc::lang
