#pragma once

#include "runtime/field.h"
#include "runtime/math/vec.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

template <class R>
struct Sphere {
    static constexpr std::string_view name = "sphere";

    Vec3<R> center{0, 0, 0};
    R radius = 1;

    static constexpr auto fields() {
        return std::tuple{field("center", &Sphere::center, Rule::any, "centre"),
                          field("radius", &Sphere::radius, Rule::positive, "radius")};
    }
};

} // namespace scc::runtime
