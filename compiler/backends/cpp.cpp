#include "compiler/backends/cpp.h"

#include "compiler/backends/tables.h"
#include "compiler/ir/traits.h"
#include "compiler/writer.h"
#include "runtime/accel/build.h"

#include <fmt/core.h>

#include <cstring>
#include <type_traits>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Bare;
using runtime::Placed;
using runtime::Rgb;
using runtime::Varying;
using runtime::Vec3;

/// Tables with more rows than this go into the blob: literals would cost more to compile than they could
/// save.
constexpr std::size_t most_literals = 64;

// ---- values as braced C++ initialisers -----------------------------------------------------------------

std::string literal(double v) {
    return number(v);
}
std::string literal(float v) {
    return number(static_cast<double>(v));
}
std::string literal(bool v) {
    return v ? "true" : "false";
}
template <class R>
std::string literal(const Vec3<R>& v) {
    return fmt::format("{{{}, {}, {}}}", literal(v.x), literal(v.y), literal(v.z));
}
template <class R>
std::string literal(const Rgb<R>& c) {
    return fmt::format("{{{}, {}, {}}}", literal(c.r), literal(c.g), literal(c.b));
}
template <class T, std::size_t N>
std::string literal(const std::array<T, N>& list) {
    std::string rows;
    for (const T& entry : list) {
        rows += (rows.empty() ? "" : ", ") + literal(entry);
    }
    return "{{" + rows + "}}";
}
template <class T>
std::string literal(const Varying<T>& v) {
    return fmt::format("{{{}, {}}}", literal(v.value), v.function);
}
std::string literal(const runtime::Tag& tag) {
    return fmt::format("{{{}, {{{}, {}}}}}", tag.id, tag.sides.front, tag.sides.back);
}
template <class R>
std::string literal(const Affine<R>& a) {
    std::string rows;
    for (const auto& r : a.m) {
        rows += fmt::format("{}{{{}, {}, {}, {}}}", rows.empty() ? "" : ", ", literal(r[0]), literal(r[1]),
                            literal(r[2]), literal(r[3]));
    }
    return "{{" + rows + "}}";
}
template <class R>
std::string literal(const runtime::Phong<R>& p) {
    return fmt::format("{{{}, {}, {}, {}, {}, {}}}", literal(p.ambient), literal(p.diffuse),
                       literal(p.specular), literal(p.emission), literal(p.reflect), literal(p.shininess));
}
template <class R>
std::string literal(const runtime::PointLight<R>& l) {
    return fmt::format("{{{}, {}, {}, {}, {}, {}}}", literal(l.position), literal(l.diffuse),
                       literal(l.specular), literal(l.kc), literal(l.kl), literal(l.kq));
}
template <class R>
std::string literal(const runtime::DirectionalLight<R>& l) {
    return fmt::format("{{{}, {}, {}}}", literal(l.to_light), literal(l.diffuse), literal(l.specular));
}
template <class R>
std::string literal(const runtime::Mesh<R>& mesh) {
    return fmt::format("{{{}}}", mesh.mesh);
}
// Members stand in the order of fields(), an optional one's flag right after it (see runtime/field.h).
template <class Shape>
std::string literal(const Shape& shape) requires requires {
    Shape::fields();
}
{
    std::string members;
    const auto add = [&](const auto& field) {
        members += (members.empty() ? "" : ", ") + literal(shape.*field.member);
        if (field.present != nullptr) {
            members += ", " + literal(shape.*field.present);
        }
    };
    std::apply([&](const auto&... field) { (add(field), ...); }, Shape::fields());
    return "{" + members + "}";
}
template <class Shape>
std::string literal(const Bare<Shape>& primitive) {
    return fmt::format("{{{}, {}}}", literal(primitive.shape), literal(primitive.tag));
}
template <class Shape, class R>
std::string literal(const Placed<Shape, R>& primitive) {
    return fmt::format("{{{}, {}, {}, {}}}", literal(primitive.shape), literal(primitive.world_from_object),
                       literal(primitive.object_from_world), literal(primitive.tag));
}

// ---- names of types ------------------------------------------------------------------------------------

// `sphere` describes `Sphere<R>`: the class has the constructor's name with a capital.
std::string class_name(std::string_view constructor) {
    std::string name(constructor);
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    return name + "<R>";
}
template <class Shape>
std::string type_name(const Bare<Shape>*) {
    return fmt::format("Bare<{}>", class_name(Shape::name));
}
template <class Shape, class R>
std::string type_name(const Placed<Shape, R>*) {
    return fmt::format("Placed<{}, R>", class_name(Shape::name));
}
template <class Shape>
std::string table_name(const Bare<Shape>*) {
    return fmt::format("bare_{}", Shape::name);
}
template <class Shape, class R>
std::string table_name(const Placed<Shape, R>*) {
    return fmt::format("placed_{}", Shape::name);
}

// ---- the program -----------------------------------------------------------------------------------------

template <class R>
class Emitter {
public:
    Emitter(const ir::Scene& scene, Precision precision, const std::string& blob_name)
        : scene_(scene), precision_(precision), blob_name_(blob_name) {}

    CppProgram emit();

private:
    /// A static table of the scene type; large ones go to the blob.
    template <class T>
    void table(const std::string& type, const std::string& name, const std::vector<T>& rows);
    void traits();
    void primitives();
    void functions(std::size_t results, const char* result_type, const char* name);
    void scene_type();
    void main_function();
    std::vector<std::string> mesh_rows();
    /// Appends an array to the blob, aligned; returns an expression for its first element.
    template <class T>
    std::string in_blob(const char* type, const T* data, std::size_t count);

    const ir::Scene& scene_;
    Precision precision_;
    std::string blob_name_;
    std::string blob_;
    std::vector<std::string> blob_tables_; // definitions that follow the scene type
    Writer out_;
};

template <class R>
template <class T>
std::string Emitter<R>::in_blob(const char* type, const T* data, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count == 0) {
        return "nullptr";
    }
    blob_.resize((blob_.size() + 63) / 64 * 64);
    const std::size_t offset = blob_.size();
    blob_.resize(offset + count * sizeof(T));
    std::memcpy(&blob_[offset], data, count * sizeof(T));
    return fmt::format("reinterpret_cast<const {}*>(scene_blob + {})", type, offset);
}

template <class R>
template <class T>
void Emitter<R>::table(const std::string& type, const std::string& name, const std::vector<T>& rows) {
    if (rows.size() > most_literals) {
        out_.line("static const std::span<const {}> {};", type, name);
        blob_tables_.push_back(fmt::format("const std::span<const {}> Scene::{}{{{}, {}}};", type, name,
                                           in_blob(type.c_str(), rows.data(), rows.size()), rows.size()));
        return;
    }
    out_.line("static constexpr std::array<{}, {}> {}{{{{", type, rows.size(), name);
    out_.indent();
    for (const T& entry : rows) {
        out_.raw_line(literal(entry) + ",");
    }
    out_.dedent();
    out_.raw_line("}};");
}

template <class R>
void Emitter<R>::traits() {
    const runtime::SceneTraits& t = scene_.traits;
    std::string flags;
    for (const ir::TraitFlag& flag : ir::trait_flags) {
        flags += t.*flag.member ? fmt::format(", .{} = true", flag.name) : "";
    }
    out_.line("static constexpr SceneTraits traits{{.bare_shapes = {:#x}, .placed_shapes = {:#x}{}}};",
              t.bare_shapes, t.placed_shapes, flags);
}

template <class R>
void Emitter<R>::primitives() {
    runtime::PrimitiveTables<R> tables;
    for_each_primitive<R>(scene_, [&]<class Primitive>(const Primitive& primitive) {
        std::get<std::vector<Primitive>>(tables.tables).push_back(primitive);
    });
    out_.raw_line("using SceneBase<R>::primitives;");
    const auto emit_table = [&]<class Primitive>(const std::vector<Primitive>& rows) {
        if (rows.empty()) {
            return;
        }
        const Primitive* tag = nullptr;
        table(type_name(tag), table_name(tag), rows);
        out_.line("static constexpr const auto& primitives(Of<{}>) {{ return {}; }}", type_name(tag),
                  table_name(tag));
    };
    std::apply([&](const auto&... rows) { (emit_table(rows), ...); }, tables.tables);
}

std::string input_spelling(ir::Input input) {
    return "s." + std::string(ir::name(input));
}

std::string node_spelling(const ir::Node& node) {
    switch (node.kind) {
    case ir::Node::Kind::constant:
        return fmt::format("L(R({}))", number(node.constant));
    case ir::Node::Kind::input:
        return input_spelling(node.input);
    case ir::Node::Kind::apply:
        break;
    }
    const auto operand = [&](std::size_t i) { return fmt::format("v{}", node.operands[i]); };
    return fmt::format(fmt::runtime(ir::row(node.op).cpp), operand(0), operand(1), operand(2));
}

template <class R>
void Emitter<R>::functions(std::size_t results, const char* result_type, const char* name) {
    const auto matches = [&](const ir::Function& f) { return f.results.size() == results; };
    if (std::none_of(scene_.functions.begin(), scene_.functions.end(), matches)) {
        return;
    }
    out_.raw_line("template <class L>");
    out_.line("static {} {}(std::int32_t index, const SurfacePoint<L>& s) {{", result_type, name);
    out_.indent();
    out_.raw_line("switch (index) {");
    for (std::size_t i = 0; i < scene_.functions.size(); ++i) {
        const ir::Function& function = scene_.functions[i];
        if (!matches(function)) {
            continue;
        }
        out_.line("case {}: {{ // {}", i, comment_text(function.name));
        out_.indent();
        for (std::size_t k = 0; k < function.nodes.size(); ++k) {
            out_.line("const L v{} = {};", k, node_spelling(function.nodes[k]));
        }
        std::string returned;
        for (const std::uint32_t result : function.results) {
            returned += fmt::format("{}v{}", returned.empty() ? "" : ", ", result);
        }
        out_.line("return {{{}}};", returned);
        out_.dedent();
        out_.raw_line("}");
    }
    out_.raw_line("default: return {};");
    out_.raw_line("}");
    out_.dedent();
    out_.raw_line("}");
}

template <class R>
void Emitter<R>::scene_type() {
    const char* real = precision_ == Precision::single ? "float" : "double";
    out_.line("struct Scene : SceneBase<{}> {{", real);
    out_.indent();
    out_.line("using R = {};", real);
    traits();
    primitives();
    table("Phong<R>", "materials", materials_of<R>(scene_));
    if (scene_.traits.point_lights) {
        table("PointLight<R>", "point_lights", lights_of<runtime::PointLight, R>(scene_));
    }
    if (scene_.traits.directional_lights) {
        table("DirectionalLight<R>", "directional_lights", lights_of<runtime::DirectionalLight, R>(scene_));
    }
    const auto camera = convert(scene_.camera, R{});
    out_.line("static constexpr Camera<R> camera{{Projection::{}, {}, {}, {}, {}, {}, {}, {}}};",
              camera.projection == runtime::Projection::perspective ? "perspective" : "orthographic",
              literal(camera.eye), literal(camera.u), literal(camera.v), literal(camera.n),
              literal(camera.half_height), literal(camera.shift_x), literal(camera.shift_y));
    out_.line("static constexpr Rgb<R> ambient{};", literal(convert(scene_.ambient, R{})));
    out_.line("static constexpr Rgb<R> background{};", literal(convert(scene_.background, R{})));
    functions(3, "Rgb<L>", "color_function");
    functions(1, "L", "number_function");
    if (!scene_.meshes.empty()) {
        out_.raw_line("std::vector<MeshData> meshes;");
    }
    if (scene_.traits.accelerator) {
        out_.raw_line("Accelerator accelerator;");
    }
    out_.dedent();
    out_.raw_line("};");
}

template <class R>
std::vector<std::string> Emitter<R>::mesh_rows() {
    std::vector<std::string> rows;
    for (const ir::Mesh& mesh : scene_.meshes) {
        const runtime::MeshStorage storage =
            runtime::build_mesh(mesh.positions, mesh.indices, mesh.normals, mesh.normal_indices);
        const runtime::MeshData data = storage.data();
        const std::size_t normal_indices = data.normals != nullptr ? storage.normal_indices.size() : 0;
        const std::size_t normals = data.normals != nullptr ? storage.normals.size() : 0;
        const auto corner = [](const float(&v)[3]) {
            return fmt::format("{{{}, {}, {}}}", literal(v[0]), literal(v[1]), literal(v[2]));
        };
        rows.push_back(fmt::format(
            "{{{}, {}, {}, {}, {}, {}, {}, {}, {}}}", in_blob("BvhNode", data.nodes, storage.nodes.size()),
            in_blob("float", data.triangles, storage.triangles.size()),
            in_blob("float", data.normals, normals),
            in_blob("std::uint32_t", data.normal_indices, normal_indices), data.node_count,
            data.triangle_count, data.normal_count, corner(data.min), corner(data.max)));
    }
    return rows;
}

template <class R>
void Emitter<R>::main_function() {
    out_.raw_line("RenderResult draw(const RenderRequest& request, Image& image) {");
    out_.indent();
    out_.raw_line("Scene scene;");
    for (const std::string& mesh : mesh_rows()) {
        out_.line("scene.meshes.push_back({});", mesh);
    }
    out_.raw_line("prepare(scene);");
    out_.raw_line("return render(scene, request, image);");
    out_.dedent();
    out_.raw_line("}");
    out_.blank();
    out_.raw_line("} // namespace");
    out_.blank();
    out_.raw_line("int main(int argc, char** argv) {");
    out_.indent();
    std::string features;
    for (const std::string& feature : ir::feature_names(scene_.traits)) {
        features += quote(Language::cpp, feature) + ", ";
    }
    out_.line("static constexpr const char* features[] = {{{}nullptr}};", features);
    const runtime::RenderSettings& s = scene_.settings;
    out_.line("return scc::host::run_program({{{}, \"{}\", scc::host::compiled_isa, features, {{{}, {}, {}, "
              "{}, {}}}, draw}}, argc, argv);",
              quote(Language::cpp, scene_.name), name_of(precision_), s.width, s.height, s.samples_per_axis,
              s.depth, literal(s.shadows));
    out_.dedent();
    out_.raw_line("}");
}

template <class R>
CppProgram Emitter<R>::emit() {
    // The scene type is written first, since it fills the blob that is declared before it.
    scene_type();
    std::string type = out_.take();
    out_ = Writer();
    main_function();
    std::string rest = out_.take();

    out_ = Writer();
    out_.raw_line("#include \"runtime/accel/build.h\"");
    out_.raw_line("#include \"runtime/host/program.h\"");
    out_.raw_line("#include \"runtime/render.h\"");
    out_.blank();
    out_.raw_line("#include <array>");
    out_.raw_line("#include <cstdint>");
    out_.raw_line("#include <span>");
    out_.raw_line("#include <vector>");
    out_.blank();
    if (!blob_.empty()) {
        out_.line("asm(\".section .rodata\\n.balign 64\\nscene_blob:\\n.incbin \\\"{}\\\"\\n.text\\n\");",
                  blob_name_);
        out_.raw_line("extern \"C\" const unsigned char scene_blob[];");
        out_.blank();
    }
    out_.raw_line("namespace {");
    out_.blank();
    out_.raw_line("using namespace scc::runtime;");
    out_.blank();
    std::string source = out_.take() + type;
    for (const std::string& definition : blob_tables_) {
        source += definition + "\n";
    }
    return {source + "\n" + rest, std::move(blob_)};
}

} // namespace

CppProgram emit_cpp(const ir::Scene& scene, Precision precision, const std::string& blob_name) {
    return precision == Precision::single ? Emitter<float>(scene, precision, blob_name).emit()
                                          : Emitter<double>(scene, precision, blob_name).emit();
}

} // namespace scc::compiler
