#pragma once

#include "runtime/field.h"
#include "runtime/math/vec.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// A flat ring; `hole` is the inner radius. The front end makes sure that hole < radius.
template <class R>
struct Disc {
    static constexpr std::string_view name = "disc";

    Vec3<R> center{0, 0, 0};
    Vec3<R> normal{0, 1, 0};
    R radius = 1;
    R hole = 0;

    static constexpr auto fields() {
        return std::tuple{field("center", &Disc::center, Rule::any, "centre"),
                          field("normal", &Disc::normal, Rule::nonzero_vector, "points to the front side"),
                          field("radius", &Disc::radius, Rule::positive, "outer radius"),
                          field("hole", &Disc::hole, Rule::non_negative, "inner radius")};
    }
};

} // namespace scc::runtime
