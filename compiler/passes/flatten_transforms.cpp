#include "compiler/ir/objects.h"
#include "compiler/passes/passes.h"
#include "runtime/math/affine.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Vec3;

// The factor by which the map scales all lengths, if it is a similarity (rotation, mirror, one scale,
// translation). The tolerance is a few roundings of a product of rotation matrices; what it lets pass moves a
// surface by less than the rounding of its own coordinates.
std::optional<double> similarity(const Affine<double>& a) {
    const auto column = [&](int i) { return Vec3<double>{a.m[0][i], a.m[1][i], a.m[2][i]}; };
    const Vec3<double> x = column(0);
    const Vec3<double> y = column(1);
    const Vec3<double> z = column(2);
    const double scale2 = dot(x, x);
    const double tolerance = 4e-15 * scale2;
    const bool equal = std::abs(dot(y, y) - scale2) <= tolerance && std::abs(dot(z, z) - scale2) <= tolerance;
    const bool orthogonal = std::abs(dot(x, y)) <= tolerance && std::abs(dot(y, z)) <= tolerance &&
                            std::abs(dot(z, x)) <= tolerance;
    return equal && orthogonal ? std::optional(std::sqrt(scale2)) : std::nullopt;
}

bool keeps_axes(const Affine<double>& a) {
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            if (row != column && a.m[row][column] != 0) {
                return false;
            }
        }
    }
    return true;
}

// One overload per shape: writes the shape in world coordinates, or returns false where its form does not
// allow that.

bool flatten(runtime::Sphere<double>& s, const Affine<double>& a) {
    const auto scale = similarity(a);
    if (scale) {
        s = {transform_point(a, s.center), s.radius * *scale};
    }
    return scale.has_value();
}

bool flatten(runtime::Box<double>& b, const Affine<double>& a) {
    if (!keeps_axes(a)) {
        return false;
    }
    const Vec3<double> p = transform_point(a, b.min);
    const Vec3<double> q = transform_point(a, b.max);
    b = {{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
         {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}};
    return true;
}

bool flatten(runtime::Plane<double>& plane, const Affine<double>& a) {
    const Vec3<double> normal = transform_normal(inverse(a), plane.normal);
    const double size = length(normal);
    plane = {normal / size, (plane.offset + dot(normal, translation_of(a))) / size};
    return true;
}

bool flatten(runtime::Cylinder<double>& c, const Affine<double>& a) {
    const auto scale = similarity(a);
    if (scale) {
        c = {transform_point(a, c.from), transform_point(a, c.to), c.radius * *scale, c.caps};
    }
    return scale.has_value();
}

bool flatten(runtime::Cone<double>& c, const Affine<double>& a) {
    const auto scale = similarity(a);
    if (scale) {
        c = {transform_point(a, c.from), transform_point(a, c.to), c.radius_from * *scale,
             c.radius_to * *scale, c.caps};
    }
    return scale.has_value();
}

bool flatten(runtime::Disc<double>& d, const Affine<double>& a) {
    const auto scale = similarity(a);
    if (scale) {
        d = {transform_point(a, d.center), normalize(transform_normal(inverse(a), d.normal)),
             d.radius * *scale, d.hole * *scale};
    }
    return scale.has_value();
}

bool flatten(runtime::Torus<double>& t, const Affine<double>& a) {
    const auto scale = similarity(a);
    if (scale) {
        t = {transform_point(a, t.center), normalize(transform_normal(inverse(a), t.axis)), t.major * *scale,
             t.minor * *scale};
    }
    return scale.has_value();
}

bool flatten(runtime::Triangle<double>& t, const Affine<double>& a) {
    // Interpolated normals keep their directions only under a similarity, since they are normalised at the
    // corners.
    if (t.smooth && !similarity(a)) {
        return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        t.points[i] = transform_point(a, t.points[i]);
        t.normals[i] = t.smooth ? normalize(transform_normal(inverse(a), t.normals[i])) : t.normals[i];
    }
    if (determinant(a) < 0) { // a mirror turns the order of the corners round; the front stays the front
        std::swap(t.points[1], t.points[2]);
        std::swap(t.normals[1], t.normals[2]);
        std::swap(t.uvs[1], t.uvs[2]);
    }
    return true;
}

bool flatten(runtime::Mesh<double>&, const Affine<double>&) {
    return false; // stored once, placed many times
}

bool flatten(runtime::Csg<double>&, const Affine<double>&) {
    return false; // always in world coordinates
}

bool flatten(runtime::Quadric<double>&, const Affine<double>&) {
    return false; // its factors would lose digits far from the origin
}

bool flatten(runtime::Implicit<double>&, const Affine<double>&) {
    return false; // the field is a function of the object's own coordinates
}

// A function of the object's own coordinates, or of those on its surface, needs them at run time.
bool reads_object_space(const ir::Scene& scene, std::uint32_t material) {
    return ir::material_reads(scene, material, ir::Input::p_x, ir::Input::p_z) ||
           ir::material_reads(scene, material, ir::Input::uv_x, ir::Input::uv_y);
}

/// Whether a form allows it depends on the transform, and on what all shapes of a column have in common.
void flatten(ir::ObjectColumn& column, const ir::Scene& scene) {
    const Affine<double> place = column.world_from_object;
    const auto reads_object = [&](const runtime::Sides& sides) {
        return reads_object_space(scene, sides.front) || reads_object_space(scene, sides.back);
    };
    if (place == Affine<double>{} || std::any_of(column.sides.begin(), column.sides.end(), reads_object)) {
        return;
    }
    std::visit(
        [&](auto& shapes) {
            for (auto& shape : shapes) {
                if (flatten(shape, place)) {
                    column.world_from_object = {};
                }
            }
        },
        column.shapes);
}

void flatten(ir::Object& object, const ir::Scene& scene) {
    if (object.world_from_object == Affine<double>{} || reads_object_space(scene, object.sides.front) ||
        reads_object_space(scene, object.sides.back)) {
        return;
    }
    if (std::visit([&](auto& shape) { return flatten(shape, object.world_from_object); }, object.shape)) {
        object.world_from_object = {};
    }
}

} // namespace

void flatten_transforms(ir::Scene& scene) {
    for (ir::Object& object : scene.objects) {
        flatten(object, scene);
    }
    for (ir::Object& member : scene.members) {
        flatten(member, scene);
    }
    for (ir::ObjectArray& array : scene.arrays) {
        for (ir::ObjectColumn& column : array.columns) {
            flatten(column, scene);
        }
    }
}

} // namespace scc::compiler
