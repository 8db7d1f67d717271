#include "compiler/shape_rules.h"

#include "runtime/math/vec.h"
#include "runtime/primitive.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace scc::compiler {

namespace {

using runtime::Vec3;

// One overload per shape, so that a new one is not forgotten.

std::string_view rule(const runtime::Sphere<double>&) {
    return "";
}

std::string_view rule(const runtime::Box<double>& b) {
    return b.min.x < b.max.x && b.min.y < b.max.y && b.min.z < b.max.z
               ? ""
               : "this box is flat or inside out; each component of `min` is less than that of `max`";
}

std::string_view rule(const runtime::Plane<double>&) {
    return "";
}

std::string_view rule(const runtime::Cylinder<double>& c) {
    return c.from == c.to ? "`from` and `to` are the same point; a cylinder has a length" : "";
}

std::string_view rule(const runtime::Cone<double>& c) {
    if (c.from == c.to) {
        return "`from` and `to` are the same point; a cone has a length";
    }
    return c.radius_from > 0 || c.radius_to > 0
               ? ""
               : "both radii are 0; at least one end of a cone has a radius greater than 0";
}

std::string_view rule(const runtime::Disc<double>& d) {
    return d.hole < d.radius ? "" : "the hole is as large as the disc; `hole` is less than `radius`";
}

std::string_view rule(const runtime::Triangle<double>& t) {
    const Vec3<double> a = t.points[1] - t.points[0];
    const Vec3<double> b = t.points[2] - t.points[0];
    // Below, all of the product may be its roundings.
    const double least = std::numeric_limits<double>::epsilon() * length(a) * length(b);
    return length(cross(a, b)) > least ? "" : "the three points lie on a line";
}

std::string_view rule(const runtime::Torus<double>& t) {
    return t.minor <= t.major ? "" : "the tube is thicker than its circle; `minor` is not more than `major`";
}

std::string_view rule(const runtime::Quadric<double>& q) {
    const Vec3<double> none{0, 0, 0};
    return q.squares == none && q.products == none && q.linear == none
               ? "all factors are 0; a quadric has one in `squares`, `products` or `linear` that is not"
               : "";
}

std::string_view rule(const runtime::Mesh<double>&) {
    return "";
}

std::string_view rule(const runtime::Csg<double>&) {
    return "";
}

std::string_view rule(const runtime::Implicit<double>&) {
    return ""; // its container was checked as a shape
}

template <class Shape>
std::string_view gap(const Shape& shape) {
    if constexpr (requires { shape.caps; }) {
        return shape.caps ? "" : "has no caps";
    } else {
        return runtime::is_solid<Shape> ? "" : "has no inside";
    }
}

} // namespace

std::string_view problem(const ir::Shape& shape) {
    return std::visit([](const auto& s) { return rule(s); }, shape);
}

std::string open_part(const ir::Mesh& mesh) {
    using Point = std::array<float, 3>;
    const auto corner = [&](std::size_t i) {
        const float* at = &mesh.positions[std::size_t{3} * mesh.indices[i]];
        return Point{at[0] + 0.0F, at[1] + 0.0F, at[2] + 0.0F}; // no -0
    };
    std::map<Point, std::uint32_t> places;
    std::vector<std::uint32_t> at(mesh.indices.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        at[i] = places.try_emplace(corner(i), static_cast<std::uint32_t>(places.size())).first->second;
    }
    // Each edge once per triangle: from the smaller place to the greater, or back.
    std::unordered_map<std::uint64_t, std::pair<int, std::size_t>> edges; // surplus of one way, some corner
    edges.reserve(at.size() / 2 + 1);
    double volume = 0; // six times
    for (std::size_t i = 0; i + 2 < at.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = at[i + k], b = at[i + (k + 1) % 3];
            if (a != b) {
                auto& edge = edges[std::uint64_t{std::min(a, b)} << 32U | std::max(a, b)];
                edge.first += a < b ? 1 : -1;
                edge.second = i + k;
            }
        }
        const auto vector = [&](std::size_t k) {
            const Point p = corner(i + k);
            return Vec3<double>{p[0], p[1], p[2]} - mesh.box.min;
        };
        volume += dot(vector(0), cross(vector(1), vector(2)));
    }
    std::size_t open = 0, first = at.size();
    for (const auto& [ends, edge] : edges) {
        if (edge.first != 0) {
            ++open;
            first = std::min(first, edge.second);
        }
    }
    if (open > 0) {
        const std::size_t triangle = first / 3 * 3;
        const Point a = corner(first), b = corner(triangle + (first - triangle + 1) % 3);
        return fmt::format("is open, or its triangles face to different sides: along {} edge{}, one from "
                           "({}, {}, {}) to ({}, {}, {})",
                           open, open == 1 ? "" : "s", a[0], a[1], a[2], b[0], b[1], b[2]);
    }
    return volume > 0 ? "" : "encloses nothing: its triangles face inwards";
}

std::string_view open_part(const ir::Shape& shape) {
    return std::visit([](const auto& s) { return gap(s); }, shape);
}

} // namespace scc::compiler
