#pragma once

#include "runtime/field.h"
#include "runtime/math/vec.h"

#include <array>
#include <string_view>
#include <tuple>

namespace scc::runtime {

/// The front side is the one from which the points run counter-clockwise. With `smooth`, the vertex normals are
/// interpolated for shading. The front end makes sure that the points do not lie on a line.
template <class R>
struct Triangle {
    static constexpr std::string_view name = "triangle";

    std::array<Vec3<R>, 3> points{};
    std::array<Vec3<R>, 3> normals{};
    bool smooth = false;

    static constexpr auto fields() {
        return std::tuple{
            required_field("points", &Triangle::points, Rule::any, "the three corners"),
            optional_field("normals", &Triangle::normals, &Triangle::smooth, Rule::nonzero_vector,
                           "normals at the corners, interpolated for shading")};
    }
};

} // namespace scc::runtime
