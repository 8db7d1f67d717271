#pragma once

#include "runtime/field.h"
#include "runtime/math/vec.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// A round tube between two points, closed by discs where `caps`. The front end makes sure that from != to.
template <class R>
struct Cylinder {
    static constexpr std::string_view name = "cylinder";

    Vec3<R> from{0, 0, 0};
    Vec3<R> to{0, 1, 0};
    R radius = 1;
    bool caps = true;

    static constexpr auto fields() {
        return std::tuple{field("from", &Cylinder::from, Rule::any, "centre of one end"),
                          field("to", &Cylinder::to, Rule::any, "centre of the other end"),
                          field("radius", &Cylinder::radius, Rule::positive, "radius"),
                          field("caps", &Cylinder::caps, Rule::any, "whether discs close the ends")};
    }
};

} // namespace scc::runtime
