#include "compiler/backends/pov_shape.h"

#include "compiler/backends/pov_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace scc::compiler {

using runtime::Vec3;

namespace {

constexpr double float_rounding = 6e-8;

struct ToPov {
    const Placement& placement;
    const std::vector<std::string>& mesh_names;
    const PovField& field;

    std::string at(const Vec3<double>& p) const { return pov_vector(placement.shape_scale * p); }
    std::string size(double x) const { return number(placement.shape_scale * x); }

    PovShape operator()(const runtime::Sphere<double>& s) const {
        return {"sphere", {fmt::format("{}, {}", at(s.center), size(s.radius))}};
    }
    PovShape operator()(const runtime::Box<double>& b) const {
        return {"box", {fmt::format("{}, {}", at(b.min), at(b.max))}};
    }
    PovShape operator()(const runtime::Plane<double>& p) const {
        return {"plane", {fmt::format("{}, {}", pov_vector(p.normal), size(p.offset))}};
    }
    PovShape operator()(const runtime::Cylinder<double>& c) const {
        return {"cylinder",
                {fmt::format("{}, {}, {}{}", at(c.from), at(c.to), size(c.radius), c.caps ? "" : " open")}};
    }
    PovShape operator()(const runtime::Cone<double>& c) const {
        return {"cone",
                {fmt::format("{}, {}, {}, {}{}", at(c.from), size(c.radius_from), at(c.to), size(c.radius_to),
                             c.caps ? "" : " open")}};
    }
    PovShape operator()(const runtime::Disc<double>& d) const {
        return {"disc",
                {fmt::format("{}, {}, {}, {}", at(d.center), pov_vector(d.normal), size(d.radius),
                             size(d.hole))}};
    }
    /// POV-Ray's lies about the y axis; `sturm` finds its roots by Sturm's theorem rather than by a formula.
    PovShape operator()(const runtime::Torus<double>& t) const {
        return {"torus",
                {fmt::format("{}, {} sturm", size(t.major), size(t.minor)), pov_transform(standing(t.axis)),
                 fmt::format("translate {}", at(t.center))}};
    }
    /// A rotation of the y axis to a unit vector.
    static runtime::Affine<double> standing(const Vec3<double>& y) {
        const Vec3<double> x =
            normalize(cross(y, std::abs(y.z) < 0.5 ? Vec3<double>{0, 0, 1} : Vec3<double>{1, 0, 0}));
        const Vec3<double> z = cross(x, y);
        return {{{x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}}};
    }
    PovShape operator()(const runtime::Quadric<double>& q) const {
        const double k = placement.shape_scale;
        const double unit = unit_of(q, k);
        const auto scaled = [&](const Vec3<double>& v, double by) { return pov_vector(unit * by * v); };
        // The products in the order xy, xz, yz.
        return {"quadric",
                {fmt::format("{}, {}, {}, {}", scaled(q.squares, 1),
                             scaled({q.products.x, q.products.z, q.products.y}, 1), scaled(q.linear, k),
                             number(unit * q.constant * k * k))}};
    }
    /// A factor for all numbers. POV-Ray's bounding boxes of hyperboloids in intersections, which it sees
    /// from their middle, take the constant for -1.
    static double unit_of(const runtime::Quadric<double>& q, double k) {
        double constant = q.constant;
        for (const auto& [square, linear] :
             {std::pair{q.squares.x, q.linear.x}, {q.squares.y, q.linear.y}, {q.squares.z, q.linear.z}}) {
            constant -= square == 0 ? 0 : linear * linear / (4 * square);
        }
        const double unit = -1 / (constant * k * k);
        return constant < 0 && std::isfinite(unit) ? unit : 1;
    }
    PovShape operator()(const runtime::Triangle<double>& t) const { return t.smooth ? smooth(t) : flat(t); }
    PovShape operator()(const runtime::Csg<double>&) const { return {}; } // written by its members
    PovShape operator()(const runtime::Mesh<double>& m) const { return {"object", {mesh_names[m.mesh]}}; }

    /// POV-Ray knows spheres and boxes as containers; what others hold is cut out of a box around them.
    PovShape operator()(const runtime::Implicit<double>& i) const {
        using Kind = runtime::Container<double>::Kind;
        const PovShape container = i.within.visit([&](const auto& shape) { return (*this)(shape); });
        const runtime::Bounds<double> box = pov_field_box(i.within);
        const bool is_cut = i.within.kind == Kind::cylinder || i.within.kind == Kind::cone;
        const std::string around = is_cut ? fmt::format("box {{ {}, {} }}", at(box.min), at(box.max))
                                          : fmt::format("{} {{ {} }}", container.keyword, container.lines[0]);
        const double k = placement.shape_scale;
        const std::string point = k == 1 ? "x, y, z" : fmt::format("x/{0}, y/{0}, z/{0}", number(k));
        const double size = largest_component(box.max - box.min);
        const double slope = field.steepest_slope > 0 ? field.steepest_slope : 1;
        std::vector<std::string> lines{
            fmt::format("function {{ {}({}) }}", field.function, point),
            fmt::format("contained_by {{ {} }}", around),
            fmt::format("max_gradient {}", number(slope / k)),
            fmt::format("accuracy {}", number(size * k * pov_isosurface_accuracy)),
            // Else a ray that starts on the surface finds that point alone, and is blocked by nothing behind
            // it.
            "all_intersections",
        };
        if (!is_cut) {
            return {"isosurface", lines};
        }
        lines.insert(lines.begin(), "isosurface {");
        lines.emplace_back("}");
        lines.push_back(fmt::format("{} {{ {} }}", container.keyword, container.lines[0]));
        return {"intersection", lines};
    }

    /// Written where it will stand: POV-Ray reorders the corners when it transforms a triangle, and may turn
    /// its sides over.
    PovShape flat(const runtime::Triangle<double>& t) const {
        const auto moved = [&](const Vec3<double>& p) {
            return pov_vector(transform_point(placement.transform, placement.shape_scale * p));
        };
        const auto& [a, b, c] = t.points;
        // POV-Ray's normal points to where the corners run clockwise. Our normal is the transformed one,
        // which a mirror image keeps on its side of the object.
        const bool mirrored = determinant(placement.transform) < 0;
        PovShape shape{
            "triangle",
            {fmt::format("{}, {}, {}", moved(a), moved(mirrored ? b : c), moved(mirrored ? c : b))}};
        shape.placed = true;
        return shape;
    }

    PovShape smooth(const runtime::Triangle<double>& t) const {
        const auto& [a, b, c] = t.points;
        const Vec3<double> front = cross(b - a, c - a);
        const auto side = [&](std::size_t corner) { return dot(front, t.normals[corner]) >= 0; };
        // A smooth_triangle whose normals lie on both sides of its plane is not drawn.
        if (side(0) != side(1) || side(1) != side(2)) {
            return smooth_mesh(t);
        }
        PovShape shape{"smooth_triangle", {}};
        for (const std::size_t i : {0U, 1U, 2U}) {
            shape.lines.push_back(
                fmt::format("{}, {}{}", at(t.points[i]), pov_vector(t.normals[i]), i == 2 ? "" : ","));
        }
        shape.reversed = !side(0);
        return shape;
    }

    PovShape smooth_mesh(const runtime::Triangle<double>& t) const {
        const auto& [a, b, c] = t.points;
        const auto& [m, n, o] = t.normals;
        PovShape shape{
            "mesh2",
            {fmt::format("vertex_vectors {{ 3, {}, {}, {} }}", at(a), at(b), at(c)),
             fmt::format("normal_vectors {{ 3, {}, {}, {} }}", pov_vector(m), pov_vector(n), pov_vector(o)),
             "face_indices { 1, <0, 2, 1> }"}};
        shape.precision = "corners of the mesh are stored as floats; bound relative to their coordinates";
        shape.bound = float_rounding;
        return shape;
    }
};

/// `name { count, <..>, <..>, ... }`, as many to a line as fit.
template <class Item>
void list(Writer& out, std::string_view name, std::size_t count, Item item) {
    out.line("{} {{", name);
    out.indent();
    std::string line = fmt::format("{}", count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string text = item(i);
        line += ',';
        if (line.size() + text.size() > 98) {
            out.raw_line(line);
            line = text;
        } else {
            line += ' ' + text;
        }
    }
    out.raw_line(line);
    out.dedent();
    out.line("}}");
}

void list_vectors(Writer& out, std::string_view name, std::span<const float> values, float scale) {
    list(out, name, values.size() / 3, [&](std::size_t i) {
        return fmt::format("<{}, {}, {}>", scale * values[3 * i], scale * values[3 * i + 1],
                           scale * values[3 * i + 2]);
    });
}

void list_faces(Writer& out, std::string_view name, std::span<const std::uint32_t> indices) {
    list(out, name, indices.size() / 3, [&](std::size_t i) {
        return fmt::format("<{}, {}, {}>", indices[3 * i], indices[3 * i + 2], indices[3 * i + 1]);
    });
}

} // namespace

PovShape pov_shape(const ir::Shape& shape, const Placement& placement,
                   const std::vector<std::string>& mesh_names, const PovField& field) {
    return std::visit(ToPov{placement, mesh_names, field}, shape);
}

runtime::Bounds<double> pov_field_box(const runtime::Container<double>& container) {
    runtime::Bounds<double> box = container.bounds();
    if (container.kind == runtime::Container<double>::Kind::cylinder ||
        container.kind == runtime::Container<double>::Kind::cone) {
        // Faces that coincide with the container's would be drawn at random.
        const Vec3<double> margin = (box.max - box.min) * 1e-3;
        box = {box.min - margin, box.max + margin};
    }
    return box;
}

void declare_mesh(const ir::Mesh& mesh, const std::string& name, bool with_uvs, bool is_solid, Writer& out) {
    out.line("#declare {} = mesh2 {{", name);
    out.indent();
    list_vectors(out, "vertex_vectors", mesh.positions, static_cast<float>(mesh_scale(mesh)));
    if (!mesh.normals.empty()) {
        list_vectors(out, "normal_vectors", mesh.normals, 1);
    }
    const bool has_uvs = with_uvs && !mesh.uvs.empty();
    if (has_uvs) {
        list(out, "uv_vectors", mesh.uvs.size() / 2,
             [&](std::size_t i) { return fmt::format("<{}, {}>", mesh.uvs[2 * i], mesh.uvs[2 * i + 1]); });
    }
    list_faces(out, "face_indices", mesh.indices);
    if (!mesh.normals.empty()) {
        list_faces(out, "normal_indices", mesh.normal_indices);
    }
    if (has_uvs) {
        list_faces(out, "uv_indices", mesh.uv_indices);
    }
    if (is_solid) {
        out.line("inside_vector <0.4837, 0.7512, -0.4493> // along which edges are rare");
    }
    out.dedent();
    out.line("}}");
}

} // namespace scc::compiler
