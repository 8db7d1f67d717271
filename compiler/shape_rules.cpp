#include "compiler/shape_rules.h"

#include "runtime/math/vec.h"
#include "runtime/primitive.h"

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
    return length(cross(a, b)) > 1e-14 * length(a) * length(b) ? "" : "the three points lie on a line";
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

std::string_view open_part(const ir::Shape& shape) {
    return std::visit([](const auto& s) { return gap(s); }, shape);
}

} // namespace scc::compiler
