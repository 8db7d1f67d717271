#include "compiler/backends/pov_shape.h"

#include "compiler/backends/pov_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace scc::compiler {

using runtime::Vec3;

namespace {

constexpr double float_rounding = 6e-8;

struct ToPov {
    double scale;
    const std::vector<std::string>& mesh_names;

    std::string at(const Vec3<double>& p) const { return pov_vector(scale * p); }
    std::string size(double x) const { return number(scale * x); }

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
    PovShape operator()(const runtime::Disc<double>& d) const {
        return {"disc",
                {fmt::format("{}, {}, {}, {}", at(d.center), pov_vector(d.normal), size(d.radius),
                             size(d.hole))}};
    }
    // POV-Ray's normal points to where the corners run clockwise.
    PovShape operator()(const runtime::Triangle<double>& t) const {
        const auto& [a, b, c] = t.points;
        if (!t.smooth) {
            return {"triangle", {fmt::format("{}, {}, {}", at(a), at(c), at(b))}};
        }
        const auto sides = normal_sides(t);
        // A smooth_triangle whose normals lie on both sides of its plane is not drawn.
        if (sides[0] == sides[1] && sides[1] == sides[2]) {
            PovShape shape{"smooth_triangle", {}};
            for (const std::size_t i : {0U, 2U, 1U}) {
                shape.lines.push_back(
                    fmt::format("{}, {}{}", at(t.points[i]), pov_vector(t.normals[i]), i == 1 ? "" : ","));
            }
            shape.reversed = sides[0] < 0;
            return shape;
        }
        PovShape shape{"mesh2",
                       {fmt::format("vertex_vectors {{ 3, {}, {}, {} }}", at(a), at(b), at(c)),
                        fmt::format("normal_vectors {{ 3, {}, {}, {} }}", pov_vector(t.normals[0]),
                                    pov_vector(t.normals[1]), pov_vector(t.normals[2])),
                        "face_indices { 1, <0, 2, 1> }"}};
        shape.precision = "corners of the mesh are stored as floats; bound relative to their coordinates";
        shape.bound = float_rounding;
        return shape;
    }
    PovShape operator()(const runtime::Mesh<double>& m) const { return {"object", {mesh_names[m.mesh]}}; }

    static std::array<int, 3> normal_sides(const runtime::Triangle<double>& t) {
        const auto& [a, b, c] = t.points;
        const Vec3<double> front = cross(b - a, c - a);
        std::array<int, 3> sides{};
        for (std::size_t i = 0; i < 3; ++i) {
            sides[i] = dot(front, t.normals[i]) >= 0 ? 1 : -1;
        }
        return sides;
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

void list_vectors(Writer& out, std::string_view name, const std::vector<float>& values, float scale) {
    list(out, name, values.size() / 3, [&](std::size_t i) {
        return fmt::format("<{}, {}, {}>", scale * values[3 * i], scale * values[3 * i + 1],
                           scale * values[3 * i + 2]);
    });
}

void list_faces(Writer& out, std::string_view name, const std::vector<std::uint32_t>& indices) {
    list(out, name, indices.size() / 3, [&](std::size_t i) {
        return fmt::format("<{}, {}, {}>", indices[3 * i], indices[3 * i + 2], indices[3 * i + 1]);
    });
}

} // namespace

PovShape pov_shape(const ir::Shape& shape, double scale, const std::vector<std::string>& mesh_names) {
    return std::visit(ToPov{scale, mesh_names}, shape);
}

void declare_mesh(const ir::Mesh& mesh, const std::string& name, Writer& out) {
    out.line("#declare {} = mesh2 {{", name);
    out.indent();
    list_vectors(out, "vertex_vectors", mesh.positions, static_cast<float>(mesh_scale(mesh)));
    if (!mesh.normals.empty()) {
        list_vectors(out, "normal_vectors", mesh.normals, 1);
    }
    list_faces(out, "face_indices", mesh.indices);
    if (!mesh.normals.empty()) {
        list_faces(out, "normal_indices", mesh.normal_indices);
    }
    out.dedent();
    out.line("}}");
}

} // namespace scc::compiler
