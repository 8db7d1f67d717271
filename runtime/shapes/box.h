#pragma once

#include "runtime/field.h"
#include "runtime/math/vec.h"

#include <string_view>
#include <tuple>

namespace scc::runtime {

/// Axis-aligned. The front end makes sure that min < max in every axis.
template <class R>
struct Box {
    static constexpr std::string_view name = "box";

    Vec3<R> min{-1, -1, -1};
    Vec3<R> max{1, 1, 1};

    static constexpr auto fields() {
        return std::tuple{field("min", &Box::min, Rule::any, "the corner with the smallest coordinates"),
                          field("max", &Box::max, Rule::any, "the corner with the largest coordinates")};
    }
};

} // namespace scc::runtime
