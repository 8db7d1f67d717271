#include "compiler/ir/print.h"

#include "compiler/ir/objects.h"
#include "compiler/ir/traits.h"
#include "compiler/writer.h"

#include <fmt/core.h>

#include <array>
#include <tuple>

namespace scc::compiler::ir {

namespace {

using runtime::Affine;
using runtime::Rgb;
using runtime::Varying;
using runtime::Vec3;

std::string text(double v) {
    return fmt::format("{}", v);
}
std::string text(bool v) {
    return v ? "true" : "false";
}
std::string text(const Vec3<double>& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}
std::string text(const Rgb<double>& c) {
    return fmt::format("rgb({}, {}, {})", c.r, c.g, c.b);
}
std::string text(const runtime::Vec2<double>& v) {
    return fmt::format("({}, {})", v.x, v.y);
}
template <class T, std::size_t N>
std::string text(const std::array<T, N>& list) {
    std::string result;
    for (const T& v : list) {
        result += (result.empty() ? "[" : ", ") + text(v);
    }
    return result + "]";
}
template <class T>
std::string text(const Varying<T>& v, const Scene& scene) {
    if (v.function == runtime::no_function) {
        return text(v.value);
    }
    return fmt::format("fn {} #{}", comment_text(scene.functions[static_cast<std::size_t>(v.function)].name),
                       v.function);
}

void print_function(Writer& out, const Function& function, std::size_t index) {
    out.line("fn {} #{} {{", comment_text(function.name), index);
    out.indent();
    for (std::size_t i = 0; i < function.nodes.size(); ++i) {
        const Node& node = function.nodes[i];
        std::string what;
        switch (node.kind) {
        case Node::Kind::constant:
            what = text(node.constant);
            break;
        case Node::Kind::input:
            what = name(node.input);
            break;
        case Node::Kind::apply:
            what = row(node.op).name;
            for (int k = 0; k < row(node.op).arity; ++k) {
                what += fmt::format(" %{}", node.operands[static_cast<std::size_t>(k)]);
            }
            break;
        case Node::Kind::image:
            what = fmt::format("image {}.{} %{} %{}", quote(Language::cpp, function.images[node.image]->name),
                               "rgb"[node.channel], node.operands[0], node.operands[1]);
            break;
        }
        out.line("%{} = {}", i, what);
    }
    std::string results;
    for (const std::uint32_t result : function.results) {
        results += fmt::format(" %{}", result);
    }
    out.line("return{}", results);
    out.dedent();
    out.line("}}");
}

void print_phong(Writer& out, const runtime::Phong<double>& p, const Scene& scene) {
    const std::pair<const char*, const Varying<Rgb<double>>*> colors[] = {{"ambient", &p.ambient},
                                                                          {"diffuse", &p.diffuse},
                                                                          {"specular", &p.specular},
                                                                          {"emission", &p.emission},
                                                                          {"reflect", &p.reflect}};
    for (const auto& [field, value] : colors) {
        out.line("{} = {}", field, text(*value, scene));
    }
    out.line("shininess = {}", text(p.shininess, scene));
    if (p.bump != runtime::no_function) {
        out.line("bump = {}", text(Varying<double>{0, p.bump}, scene));
    }
    if (lets_through(p)) {
        out.line("transmit = {}, ior = {}{}", text(p.transmit, scene), p.ior, p.fresnel ? ", fresnel" : "");
    }
}

void print_material(Writer& out, const Material& material, const Scene& scene) {
    out.line("material {} {{", quote(Language::cpp, material.name));
    out.indent();
    print_phong(out, material.phong, scene);
    for (const runtime::Phong<double>& band : material.bands) {
        out.raw_line("band");
        print_phong(out, band, scene);
    }
    out.dedent();
    out.line("}}");
}

/// A solid's tree, whose members are numbered.
std::string tree_text(const Scene& scene, std::size_t at) {
    const CsgNode& node = scene.csg_nodes[at];
    if (node.op == runtime::CsgOp::member) {
        return fmt::format("#{}", node.member);
    }
    std::string operands;
    for (std::size_t child = at + 1; child < at + node.size; child += scene.csg_nodes[child].size) {
        operands += (operands.empty() ? "" : ", ") + tree_text(scene, child);
    }
    return fmt::format("{}({})", csg_word(node.op), operands);
}

template <class Shape>
std::string shape_text(const Shape& shape, const Scene& scene) {
    if constexpr (requires { Shape::fields(); }) {
        std::string fields;
        const auto add = [&](const auto& field) {
            if (field.present == nullptr || shape.*field.present) {
                fields += fmt::format("{}{} = {}", fields.empty() ? "" : ", ", field.name,
                                      text(shape.*field.member));
            }
        };
        std::apply([&](const auto&... field) { (add(field), ...); }, Shape::fields());
        return fmt::format("{} {{ {} }}", Shape::name, fields);
    } else if constexpr (std::is_same_v<Shape, runtime::Csg<double>>) {
        return tree_text(scene, shape.root);
    } else if constexpr (std::is_same_v<Shape, runtime::Implicit<double>>) {
        const std::string within =
            shape.within.visit([&](const auto& container) { return shape_text(container, scene); });
        return fmt::format("{} {{ field = {}, within = {} }}", Shape::name,
                           text(runtime::Varying<double>{0, shape.field}, scene), within);
    } else {
        return fmt::format("{} {{ {} }}", Shape::name, quote(Language::cpp, scene.meshes[shape.mesh].name));
    }
}

void print_object(Writer& out, const std::string& heading, const Object& object, const Scene& scene) {
    out.line("{} {} {{", heading, quote(Language::cpp, object.path));
    out.indent();
    out.raw_line(std::visit([&](const auto& shape) { return shape_text(shape, scene); }, object.shape));
    if (!(object.world_from_object == Affine<double>{})) {
        for (const auto& r : object.world_from_object.m) {
            out.line("| {} {} {} {} |", r[0], r[1], r[2], r[3]);
        }
    }
    const std::string front = quote(Language::cpp, scene.materials[object.sides.front].name);
    if (object.sides.front == object.sides.back) {
        out.line("material = {}", front);
    } else {
        out.line("front = {}, back = {}", front,
                 quote(Language::cpp, scene.materials[object.sides.back].name));
    }
    out.dedent();
    out.line("}}");
}

std::string point_text(const runtime::PointLight<double>& l) {
    return fmt::format("position = {}, diffuse = {}, specular = {}, attenuation = ({}, {}, {})",
                       text(l.position), text(l.diffuse), text(l.specular), l.kc, l.kl, l.kq);
}
std::string light_text(const runtime::PointLight<double>& l) {
    return "point " + point_text(l);
}
std::string light_text(const runtime::SpotLight<double>& l) {
    return fmt::format("spot {}, axis = {}, cos_inner = {}, cos_outer = {}, exponent = {}", point_text(l),
                       text(l.axis), l.cos_inner, l.cos_outer, l.exponent);
}
std::string light_text(const runtime::RectangleLight<double>& l) {
    return fmt::format("rectangle {}, edge_u = {}, edge_v = {}, samples = ({}, {})", point_text(l),
                       text(l.edge_u), text(l.edge_v), l.nu, l.nv);
}
std::string light_text(const runtime::DirectionalLight<double>& l) {
    return fmt::format("directional to_light = {}, diffuse = {}, specular = {}", text(l.to_light),
                       text(l.diffuse), text(l.specular));
}

} // namespace

std::string print(const Scene& scene) {
    Writer out(2);
    out.line("scene {}", quote(Language::cpp, scene.name));
    const runtime::RenderSettings& s = scene.settings;
    out.line("picture {} x {}, {} samples, depth {}, shadows {}", s.width, s.height, s.samples, s.depth,
             text(s.shadows));
    if (s.point != runtime::PixelPoint::center || !is_plain_grid(s)) {
        out.line("pixels at {}, sampler {}, filter {}, adaptive {}",
                 word(runtime::pixel_point_names, s.point), word(runtime::sampler_names, s.sampler),
                 word(runtime::filter_names, s.filter), s.adaptive);
    }
    if (s.origin != decltype(s.origin){}) {
        out.line("coordinates from ({}, {}, {})", s.origin[0], s.origin[1], s.origin[2]);
    }
    const runtime::Camera<double>& c = scene.camera;
    out.line("camera {} eye = {}, u = {}, v = {}, n = {}, half_height = {}, shift = ({}, {})",
             word(runtime::projection_names, c.projection), text(c.eye), text(c.u), text(c.v), text(c.n),
             c.half_height, c.shift_x, c.shift_y);
    if (c.projection == runtime::Projection::spherical) {
        out.line("half_width = {}", c.half_width);
    }
    if (c.lens_radius > 0) {
        out.line("lens radius = {}, focus = {}", c.lens_radius, c.focus);
    }
    out.line("ambient = {}", text(scene.ambient));
    out.line("background = {}", text(scene.background));
    for (const runtime::BandGroup<double>& band : scene.bands) {
        out.line("band ambient = {}, background = {}, to Rec.709 = [{}, {}, {}]", text(band.ambient),
                 text(band.background), text(band.red), text(band.green), text(band.blue));
    }
    std::string needs;
    for (const std::string& feature : feature_names(scene.traits)) {
        needs += (needs.empty() ? " " : ", ") + feature;
    }
    out.line("needs{}", needs);
    for (const Light& light : scene.lights) {
        out.line("light {} {}", quote(Language::cpp, light.name),
                 std::visit([](const auto& l) { return light_text(l); }, light.light));
        for (const LightColors& band : light.bands) {
            out.line("  band diffuse = {}, specular = {}", text(band.diffuse), text(band.specular));
        }
    }
    for (std::size_t i = 0; i < scene.functions.size(); ++i) {
        print_function(out, scene.functions[i], i);
    }
    for (const Mesh& mesh : scene.meshes) {
        out.line("mesh {} {} vertices, {} normals, {} triangles", quote(Language::cpp, mesh.name),
                 mesh.positions.size() / 3, mesh.normals.size() / 3, mesh.indices.size() / 3);
    }
    for (const Material& material : scene.materials) {
        print_material(out, material, scene);
    }
    for (std::size_t i = 0; i < scene.members.size(); ++i) {
        print_object(out, fmt::format("member #{}", i), scene.members[i], scene);
    }
    for_each_object(scene, [&](const Object& object) { print_object(out, "object", object, scene); });
    return out.take();
}

} // namespace scc::compiler::ir
