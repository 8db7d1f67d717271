#pragma once

#include "lang/type.h"
#include "lang/value.h"

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The form in which the compiler tells the front end what can be constructed. `lang` knows no particular
/// shape.
namespace scc::lang {

/// Legal values of a number, of an angle in radians, or of every component of a vector or colour.
struct Limits {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool min_excluded = false;
    bool integer = false;
    bool square = false; ///< a square number (samples per pixel)
    bool nonzero_vector = false;
    std::string_view rule{}; ///< in words: "a radius is greater than 0"
};

struct Field {
    std::string_view name{};
    Type type{};
    std::optional<Value> default_value{}; ///< none: required, or optional without a default
    bool required = false;
    bool per_point = false; ///< a function of a surface with this result may stand here
    bool asset = false;     ///< a string that names a file, relative to the scene
    Limits limits{};
    std::vector<std::string_view> choices{}; ///< of a string; empty: any
    bool supported = true;                   ///< false: known to the language, not built yet
    std::string_view doc{};
};

struct Constructor {
    std::string_view name{};
    TypeKind type = TypeKind::error; ///< what it makes
    std::vector<Field> fields{};
    bool takes_children = false; ///< group and the CSG operators
    bool supported = true;
    std::string_view doc{};

    const Field* find(std::string_view field) const;
};

struct Schema {
    std::vector<Constructor> constructors;
    std::string_view group{}; ///< the constructor that holds the shapes of an imported file; empty: none does

    const Constructor* find(std::string_view name) const;
};

} // namespace scc::lang
