#pragma once

#include "runtime/field.h"
#include "runtime/math/vec.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// dot(normalize(normal), p) = offset; unbounded.
template <class R>
struct Plane {
    static constexpr std::string_view name = "plane";

    Vec3<R> normal{0, 1, 0};
    R offset = 0;

    static constexpr auto fields() {
        return std::tuple{field("normal", &Plane::normal, Rule::nonzero_vector, "points to the front side"),
                          field("offset", &Plane::offset, Rule::any, "distance from the origin along the normal")};
    }
};

} // namespace scc::runtime
