#include "lang/schema.h"

#include "lang/check.h"
#include "lang/components.h"
#include "lang/wording.h"

#include <cmath>

namespace scc::lang {

std::string rule_of(const Field& field) {
    const Limits& limits = field.limits;
    if (!limits.rule.empty()) {
        return std::string(limits.rule);
    }
    const bool has_kind = limits.nonzero_vector || limits.square || limits.integer;
    if (!has_kind && !std::isfinite(limits.min) && !std::isfinite(limits.max)) {
        return "";
    }
    const TypeKind kind = field.type.kind == TypeKind::angle ? TypeKind::angle : TypeKind::number;
    const auto text = [kind](double value) { return to_string(compose(kind, {Scalar{value}})); };
    std::string rule = in_code(field.name) + " is " +
                       (limits.nonzero_vector ? "not the zero vector"
                        : limits.square       ? "a square number"
                        : limits.integer      ? "a whole number"
                                              : "");
    const char* joint = rule.ends_with(' ') ? "" : ", ";
    if (std::isfinite(limits.min)) {
        rule += joint + std::string(limits.min_excluded ? "greater than " : "at least ") + text(limits.min);
        joint = " and ";
    }
    return std::isfinite(limits.max) ? rule + joint + "at most " + text(limits.max) : rule;
}

const Field* Constructor::find(std::string_view field) const {
    for (const Field& row : fields) {
        if (row.name == field) {
            return &row;
        }
    }
    return nullptr;
}

const Constructor* Schema::find(std::string_view name) const {
    for (const Constructor& row : constructors) {
        if (row.name == name) {
            return &row;
        }
    }
    return nullptr;
}

} // namespace scc::lang
