#include "compiler/backends/surface_distance.h"

#include "compiler/bounds.h"
#include "compiler/ir/objects.h"
#include "runtime/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace scc::compiler {

using runtime::Affine;
using runtime::Bounds;
using runtime::Vec3;
using Point = Vec3<double>;

namespace {

double clamped(double x, double low, double high) {
    return std::min(std::max(x, low), high);
}

double segment_distance(const Point& p, const Point& a, const Point& b) {
    const Point along = b - a;
    const double t = clamped(dot(p - a, along) / dot(along, along), 0, 1);
    return length(p - a - t * along);
}

double triangle_distance(const Point& p, const std::array<Point, 3>& corners) {
    const auto& [a, b, c] = corners;
    const Point normal = cross(b - a, c - a);
    const auto left_of = [&](const Point& from, const Point& to) {
        return dot(cross(to - from, p - from), normal) >= 0;
    };
    if (left_of(a, b) && left_of(b, c) && left_of(c, a)) {
        return std::abs(dot(p - a, normal)) / length(normal);
    }
    return std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
}

/// How little the map can shrink a length: the smallest singular value, from the closed form for the
/// eigenvalues of the symmetric matrix m^T m.
double least_stretch(const Affine<double>& a) {
    double s[3][3] = {};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k) {
                s[i][j] += a.m[k][i] * a.m[k][j];
            }
        }
    }
    const double mean = (s[0][0] + s[1][1] + s[2][2]) / 3;
    const double off = s[0][1] * s[0][1] + s[0][2] * s[0][2] + s[1][2] * s[1][2];
    double spread = 2 * off;
    for (int i = 0; i < 3; ++i) {
        spread += (s[i][i] - mean) * (s[i][i] - mean);
    }
    const double p = std::sqrt(spread / 6);
    if (!(p > 1e-14 * mean)) {
        return std::sqrt(mean);
    }
    Affine<double> b;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            b.m[i][j] = (s[i][j] - (i == j ? mean : 0)) / p;
        }
    }
    const double angle = std::acos(clamped(determinant(b) / 2, -1, 1)) / 3;
    const double smallest = mean + 2 * p * std::cos(angle + 2.0943951023931953);
    return std::sqrt(std::max(0.0, smallest - 1e-12 * mean));
}

/// Distances in the world, per shape.
struct Measure {
    const ir::Scene& scene;
    const Affine<double>& world_from_object;
    const Point& point;
    DistanceRange range{INFINITY, 0};

    Point in_object() const { return transform_point(inverse(world_from_object), point); }

    void include_corner(const Point& corner) {
        range.far = std::max(range.far, length(transform_point(world_from_object, corner) - point));
    }
    void include_box(const Bounds<double>& b) {
        for (int i = 0; i < 8; ++i) {
            include_corner({i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z});
        }
    }
    /// A distance that was measured in object space.
    void include_distance(double object_distance) {
        range.near = std::min(range.near, object_distance * least_stretch(world_from_object));
    }
    void include_triangle(const std::array<Point, 3>& corners) {
        std::array<Point, 3> moved;
        for (std::size_t i = 0; i < 3; ++i) {
            include_corner(corners[i]);
            moved[i] = transform_point(world_from_object, corners[i]);
        }
        range.near = std::min(range.near, triangle_distance(point, moved));
    }

    void operator()(const runtime::Sphere<double>& s) {
        include_box(s.bounds());
        include_distance(std::abs(length(in_object() - s.center) - s.radius));
    }
    void operator()(const runtime::Box<double>& box) {
        const Point low = box.min, high = box.max;
        const auto corner = [&](int i) {
            return Point{i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
        };
        static constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
        for (const auto& face : faces) {
            include_triangle({corner(face[0]), corner(face[1]), corner(face[2])});
            include_triangle({corner(face[0]), corner(face[2]), corner(face[3])});
        }
    }
    void operator()(const runtime::Plane<double>& plane) {
        const Affine<double> object_from_world = inverse(world_from_object);
        const Point n = normalize(plane.normal);
        const double distance = std::abs(dot(n, transform_point(object_from_world, point)) - plane.offset);
        range = {std::min(range.near, distance / length(transform_normal(object_from_world, n))), INFINITY};
    }
    void operator()(const runtime::Cylinder<double>& c) {
        include_box(c.bounds());
        const Point p = in_object() - c.from;
        const double height = length(c.to - c.from);
        const double along = dot(p, c.to - c.from) / height;
        const double across = length(p - (c.to - c.from) * (along / height));
        const double beyond = std::max({0.0, -along, along - height});
        include_distance(std::hypot(across - c.radius, beyond));
        if (c.caps) {
            const double outside = std::max(0.0, across - c.radius);
            include_distance(std::min(std::hypot(outside, along), std::hypot(outside, along - height)));
        }
    }
    void operator()(const runtime::Cone<double>& c) {
        include_box(c.bounds());
        // In the half plane through the axis the side is a line, and so is each cap.
        const Point p = in_object() - c.from;
        const double height = length(c.to - c.from);
        const double along = dot(p, c.to - c.from) / height;
        const double across = length(p - (c.to - c.from) * (along / height));
        const Point here{across, along, 0}, low{c.radius_from, 0, 0}, high{c.radius_to, height, 0};
        include_distance(segment_distance(here, low, high));
        if (c.caps) {
            include_distance(std::min(std::hypot(std::max(0.0, across - c.radius_from), along),
                                      std::hypot(std::max(0.0, across - c.radius_to), along - height)));
        }
    }
    void operator()(const runtime::Disc<double>& d) {
        include_box(d.bounds());
        const Point p = in_object() - d.center;
        const Point n = normalize(d.normal);
        const double height = dot(p, n);
        const double across = length(p - height * n);
        include_distance(std::hypot(height, across - clamped(across, d.hole, d.radius)));
    }
    void operator()(const runtime::Torus<double>& t) {
        include_box(t.bounds());
        const Point p = in_object() - t.center;
        const double height = dot(p, t.axis);
        const double across = length(p - height * t.axis);
        include_distance(std::abs(std::hypot(across - t.major, height) - t.minor));
    }
    void operator()(const runtime::Quadric<double>&) { range = {0, INFINITY}; }
    void operator()(const runtime::Implicit<double>& i) { // anywhere in the container
        include_box(i.bounds());
        range.near = 0;
    }
    void operator()(const runtime::Triangle<double>& t) { include_triangle(t.points); }
    /// No nearer than the nearest of its members, no farther than its box.
    void operator()(const runtime::Csg<double>& solid) {
        ir::for_each_csg_node(scene, solid, [&](const ir::CsgNode& node) {
            if (node.op == runtime::CsgOp::member) {
                const ir::Object& member = scene.members[node.member];
                Measure measure{scene, member.world_from_object, point};
                std::visit([&](const auto& shape) { measure(shape); }, member.shape);
                range.near = std::min(range.near, measure.range.near);
            }
        });
        include_box(solid_bounds(scene, solid.root));
    }
    void operator()(const runtime::Mesh<double>& m) {
        const ir::Mesh& mesh = scene.meshes[m.mesh];
        const auto vertex = [&](std::size_t i) {
            const std::size_t at = 3 * std::size_t{mesh.indices[i]};
            return Point{mesh.positions[at], mesh.positions[at + 1], mesh.positions[at + 2]};
        };
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            include_triangle({vertex(i), vertex(i + 1), vertex(i + 2)});
        }
    }
};

} // namespace

DistanceRange surface_distances(const ir::Scene& scene, const Point& point) {
    DistanceRange range{INFINITY, 0};
    ir::for_each_shape(scene, [&](const auto& shape, const Affine<double>& place, const runtime::Sides&) {
        Measure measure{scene, place, point, range};
        measure(shape);
        range = measure.range;
    });
    // A little more, for the rounding on the way.
    return range.near <= range.far ? DistanceRange{range.near * (1 - 1e-9), range.far * (1 + 1e-9)}
                                   : DistanceRange{0, 1};
}

} // namespace scc::compiler
