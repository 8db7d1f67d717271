#include "compiler/backends/cpp.h"

#include "compiler/backends/tables.h"
#include "compiler/ir/traits.h"
#include "compiler/mesh_cache.h"
#include "compiler/scene_names.h"
#include "compiler/writer.h"
#include "runtime/host/cache.h"
#include "runtime/host/parallel.h"
#include "runtime/host/values.h"

#include <fmt/core.h>

#include <algorithm>

namespace scc::compiler {

namespace {

using runtime::Affine;
using runtime::Bare;
using runtime::Placed;
using runtime::Rgb;
using runtime::Varying;
using runtime::Vec3;

/// Tables with more rows than this are of no constant size: the kernels unroll none so long, and literals
/// would cost more to compile than they could save.
constexpr std::size_t most_constant_rows = 64;

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
std::string literal(const runtime::Vec2<R>& v) {
    return fmt::format("{{{}, {}}}", literal(v.x), literal(v.y));
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
    return fmt::format("{{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}}}", literal(p.ambient), literal(p.diffuse),
                       literal(p.specular), literal(p.emission), literal(p.reflect), literal(p.transmit),
                       literal(p.shininess), literal(p.ior), literal(p.fresnel), p.bump);
}
template <class R>
std::string literal(const runtime::PointLight<R>& l) {
    return fmt::format("{{{}, {}, {}, {}, {}, {}}}", literal(l.position), literal(l.diffuse),
                       literal(l.specular), literal(l.kc), literal(l.kl), literal(l.kq));
}
template <class R>
std::string literal(const runtime::SpotLight<R>& l) {
    return fmt::format("{{{}, {}, {}, {}, {}}}", literal(static_cast<const runtime::PointLight<R>&>(l)),
                       literal(l.axis), literal(l.cos_inner), literal(l.cos_outer), literal(l.exponent));
}
template <class R>
std::string literal(const runtime::RectangleLight<R>& l) {
    return fmt::format("{{{}, {}, {}, {}, {}}}", literal(static_cast<const runtime::PointLight<R>&>(l)),
                       literal(l.edge_u), literal(l.edge_v), l.nu, l.nv);
}
template <class R>
std::string literal(const runtime::DirectionalLight<R>& l) {
    return fmt::format("{{{}, {}, {}}}", literal(l.to_light), literal(l.diffuse), literal(l.specular));
}
template <class R>
std::string literal(const runtime::Camera<R>& c) {
    return fmt::format("{{Projection::{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}}",
                       word(runtime::projection_names, c.projection), literal(c.eye), literal(c.u),
                       literal(c.v), literal(c.n), literal(c.half_height), literal(c.shift_x),
                       literal(c.shift_y), literal(c.half_width), literal(c.lens_radius), literal(c.focus),
                       literal(c.near), literal(c.far));
}
template <class R>
std::string literal(const runtime::LineSegment<R>& l) {
    return fmt::format("{{{}, {}, {}, {}}}", literal(l.from), literal(l.to), literal(l.color),
                       literal(l.width));
}
template <class R>
std::string literal(const runtime::Mesh<R>& mesh) {
    return fmt::format("{{{}}}", mesh.mesh);
}
template <class R>
std::string literal(const runtime::Csg<R>& solid) {
    return fmt::format("{{{}}}", solid.root);
}
template <class R>
std::string literal(const runtime::Implicit<R>& implicit) {
    const runtime::Container<R>& within = implicit.within;
    return fmt::format("{{{}, {{Container<R>::Kind({}), {}, {}, {}, {}}}}}", implicit.field,
                       static_cast<int>(within.kind), literal(within.first), literal(within.second),
                       literal(within.radius), literal(within.radius_to));
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

template <class Primitive>
std::string literal(const runtime::Member<Primitive>& member) {
    return fmt::format("{{{}, {}, {}}}", literal(member.primitive), literal(member.inverted), member.solid);
}
std::string literal(const runtime::CsgNode& node) {
    static constexpr const char* ops[] = {"member", "unite", "intersect", "subtract"};
    return fmt::format("{{CsgOp::{}, {}, {{{}, {}}}}}", ops[static_cast<std::size_t>(node.op)], node.size,
                       node.member.kind, node.member.index);
}

std::string literal(const runtime::RenderSettings& s) {
    std::string text = fmt::format(
        "{{{}, {}, {}, {}, {}, PixelPoint::{}, Sampler::{}, PixelFilter::{}, {}", s.width, s.height,
        s.samples, s.depth, literal(s.shadows), word(runtime::pixel_point_names, s.point),
        word(runtime::sampler_names, s.sampler), word(runtime::filter_names, s.filter), literal(s.adaptive));
    const bool is_moved = s.origin != decltype(s.origin){};
    if (s.method == runtime::Method::raster || is_moved) {
        text += fmt::format(
            ", Method::{}, {{RasterShading::{}, Cull::{}, {}, {}}}", word(runtime::method_names, s.method),
            word(runtime::raster_shading_names, s.raster.shading), word(runtime::cull_names, s.raster.cull),
            literal(s.raster.clip), literal(s.raster.tessellation));
    }
    if (is_moved) {
        text +=
            fmt::format(", {{{}, {}, {}}}", literal(s.origin[0]), literal(s.origin[1]), literal(s.origin[2]));
    }
    return text + "}";
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
    Emitter(const ir::Scene& scene, Precision precision, Numbers numbers, const std::string& values_name,
            const ProgramParameters* parameters, bool draws_aovs)
        : scene_(scene), precision_(precision), in_code_(numbers == Numbers::in_code),
          any_scene_(numbers == Numbers::of_any_scene), values_name_(values_name), parameters_(parameters),
          draws_aovs_(draws_aovs) {}

    CppProgram emit();

private:
    bool has_values() const { return draws_aovs_ || !reads_.empty(); }
    /// A member of the scene type: a constant, or one that the program reads from the values.
    template <class T>
    void member(const std::string& type, const std::string& name, const T& value);
    template <class T>
    void table(const std::string& row_type, const std::string& name, const std::vector<T>& rows);
    void read_member(const std::string& name);
    bool has_bands() const { return !scene_.bands.empty(); }
    void colors();
    template <class T>
    void colored_table(const std::string& row_type, const std::string& name, const std::vector<T>& rows);
    void traits();
    void primitives();
    std::string node_spelling(const ir::Function& function, const ir::Node& node, std::string_view point);
    /// One function of the scene type for those in `which`; its parameter is the point's name in the bodies.
    void functions(const std::vector<std::size_t>& which, const char* result_type, const char* name,
                   const char* parameter, std::string_view point);
    void material_functions(std::size_t results, const char* result_type, const char* name);
    void field_functions();
    std::vector<bool> are_fields() const;
    void meshes();
    void images();
    void scene_type();
    void draw_statement(const std::string& request, const std::string& image);
    void program();

    const ir::Scene& scene_;
    Precision precision_;
    bool in_code_;
    bool any_scene_;
    std::string values_name_;
    const ProgramParameters* parameters_;
    bool draws_aovs_;
    std::string structure_;
    host::ValuesWriter values_;
    std::vector<std::string> reads_; // statements of `load`, in the order of the values
    std::vector<R> function_constants_;
    std::vector<const ir::Image*> images_ = ir::images_of(scene_);
    std::vector<std::string> colored_; // tables of which each band has its own
    Writer out_;
};

template <class R>
void Emitter<R>::read_member(const std::string& name) {
    reads_.push_back(fmt::format("values.read(scene.{});", name));
}

template <class R>
template <class T>
void Emitter<R>::member(const std::string& type, const std::string& name, const T& value) {
    if (in_code_) {
        out_.line("static constexpr {} {}{};", type, name, literal(value));
        return;
    }
    out_.line("static inline {} {};", type, name);
    values_.add(value);
    read_member(name);
}

template <class R>
template <class T>
void Emitter<R>::table(const std::string& row_type, const std::string& name, const std::vector<T>& rows) {
    const bool constant_size = !any_scene_ && rows.size() <= most_constant_rows;
    const std::string type = !constant_size ? fmt::format("std::span<const {}>", row_type)
                                            : fmt::format("std::array<{}, {}>", row_type, rows.size());
    if (!in_code_ || !constant_size) {
        out_.line("static inline {} {};", type, name);
        values_.add(std::span<const T>(rows));
        read_member(name);
        return;
    }
    out_.line("static constexpr {} {}{{{{", type, name);
    out_.indent();
    for (const T& entry : rows) {
        out_.raw_line(literal(entry) + ",");
    }
    out_.dedent();
    out_.raw_line("}};");
}

template <class R>
void Emitter<R>::traits() {
    if (any_scene_) {
        out_.raw_line("static constexpr SceneTraits traits = everything;");
        return;
    }
    const runtime::SceneTraits& t = scene_.traits;
    std::string flags;
    for (const ir::TraitFlag& flag : ir::trait_flags) {
        flags += t.*flag.member ? fmt::format(", .{} = true", flag.name) : "";
    }
    const std::string members = !runtime::uses_csg(t)
                                    ? ""
                                    : fmt::format(", .bare_members = {:#x}, .placed_members = {:#x}",
                                                  t.bare_members, t.placed_members);
    out_.line("static constexpr SceneTraits traits{{.bare_shapes = {:#x}, .placed_shapes = {:#x}{}{}}};",
              t.bare_shapes, t.placed_shapes, members, flags);
}

template <class R>
void Emitter<R>::primitives() {
    runtime::DynamicScene<R> tables;
    for_each_primitive<R>(scene_, [&](const auto& primitive) { tables.add(primitive); });
    out_.raw_line("using SceneBase<R>::primitives;");
    const auto emit_table = [&]<class Primitive>(const std::vector<Primitive>& rows) {
        if (rows.empty() && !any_scene_) {
            return;
        }
        const Primitive* tag = nullptr;
        table(type_name(tag), table_name(tag), rows);
        out_.line("const auto& primitives(Of<{}>) const {{ return {}; }}", type_name(tag), table_name(tag));
    };
    std::apply([&](const auto&... rows) { (emit_table(rows), ...); }, tables.shapes.tables);
    if (!runtime::uses_csg(scene_.traits) && !any_scene_) {
        return;
    }
    out_.raw_line("using SceneBase<R>::members;");
    const auto emit_members = [&]<class Primitive>(const std::vector<runtime::Member<Primitive>>& rows) {
        if (rows.empty() && !any_scene_) {
            return;
        }
        const Primitive* tag = nullptr;
        const std::string name = "member_" + table_name(tag);
        table(fmt::format("Member<{}>", type_name(tag)), name, rows);
        out_.line("const auto& members(Of<{}>) const {{ return {}; }}", type_name(tag), name);
    };
    std::apply([&](const auto&... rows) { (emit_members(rows), ...); }, tables.shapes.members);
    table("CsgNode", "csg_nodes", csg_nodes_of(scene_));
}

/// Which functions are the fields of implicit surfaces.
template <class R>
std::vector<bool> Emitter<R>::are_fields() const {
    std::vector<bool> result(scene_.functions.size());
    for (const auto* objects : {&scene_.objects, &scene_.members}) {
        for (const ir::Object& object : *objects) {
            if (const auto* implicit = std::get_if<runtime::Implicit<double>>(&object.shape)) {
                result[static_cast<std::size_t>(implicit->field)] = true;
            }
        }
    }
    return result;
}

template <class R>
std::string Emitter<R>::node_spelling(const ir::Function& function, const ir::Node& node,
                                      std::string_view point) {
    switch (node.kind) {
    case ir::Node::Kind::constant:
        if (in_code_) {
            return fmt::format("L(R({}))", number(node.constant));
        }
        function_constants_.push_back(static_cast<R>(node.constant));
        return fmt::format("L(function_constants[{}])", function_constants_.size() - 1);
    case ir::Node::Kind::input:
        return fmt::format("{}{}", point, ir::name(node.input));
    case ir::Node::Kind::image: {
        const ir::Image* image = function.images[node.image].get();
        return fmt::format("image_channel(images[{}], {}, v{}, v{})",
                           std::find(images_.begin(), images_.end(), image) - images_.begin(), node.channel,
                           node.operands[0], node.operands[1]);
    }
    case ir::Node::Kind::apply:
        break;
    }
    const auto operand = [&](std::size_t i) { return fmt::format("v{}", node.operands[i]); };
    return fmt::format(fmt::runtime(ir::row(node.op).cpp), operand(0), operand(1), operand(2));
}

template <class R>
void Emitter<R>::material_functions(std::size_t results, const char* result_type, const char* name) {
    const std::vector<bool> is_field = are_fields();
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < scene_.functions.size(); ++i) {
        if (scene_.functions[i].results.size() == results && !is_field[i]) {
            which.push_back(i);
        }
    }
    functions(which, result_type, name, "const SurfacePoint<L>& s", "s.");
}

template <class R>
void Emitter<R>::field_functions() {
    const std::vector<bool> is_field = are_fields();
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < is_field.size(); ++i) {
        if (is_field[i]) {
            which.push_back(i);
        }
    }
    functions(which, "L", "field_function", "const Vec3<L>& p", "");
}

template <class R>
void Emitter<R>::functions(const std::vector<std::size_t>& which, const char* result_type, const char* name,
                           const char* parameter, std::string_view point) {
    if (which.empty()) {
        return;
    }
    out_.raw_line("template <class L>");
    out_.line("{} {}(std::int32_t index, {}) const {{", result_type, name, parameter);
    out_.indent();
    out_.raw_line("switch (index) {");
    for (const std::size_t i : which) {
        const ir::Function& function = scene_.functions[i];
        out_.line("case {}: {{{}", i, in_code_ ? " // " + comment_text(function.name) : "");
        out_.indent();
        for (std::size_t k = 0; k < function.nodes.size(); ++k) {
            out_.line("const L v{} = {};", k, node_spelling(function, function.nodes[k], point));
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
    colors();
    member("Camera<R>", "camera", convert(scene_.camera, R{}));
    material_functions(3, "Rgb<L>", "color_function");
    material_functions(1, "L", "number_function");
    field_functions();
    if (!function_constants_.empty()) {
        out_.line("static inline std::array<R, {}> function_constants;", function_constants_.size());
        values_.add(std::span<const R>(function_constants_));
        read_member("function_constants");
    }
    meshes();
    images();
    if (scene_.traits.accelerator || any_scene_) {
        out_.raw_line("Accelerator accelerator;");
    }
    out_.dedent();
    out_.raw_line("};");
}

/// Materials, lights and what surrounds the scene. Of a scene with spectra, those of the group of wavelengths
/// that `take_band` was called for.
template <class R>
void Emitter<R>::colors() {
    colored_table("Phong<R>", "materials", materials_of<R>(scene_));
    if (scene_.traits.point_lights || any_scene_) {
        colored_table("PointLight<R>", "point_lights", lights_of<runtime::PointLight, R>(scene_));
    }
    if (scene_.traits.directional_lights || any_scene_) {
        colored_table("DirectionalLight<R>", "directional_lights",
                      lights_of<runtime::DirectionalLight, R>(scene_));
    }
    if (scene_.traits.spot_lights || any_scene_) {
        colored_table("SpotLight<R>", "spot_lights", lights_of<runtime::SpotLight, R>(scene_));
    }
    if (scene_.traits.rectangle_lights || any_scene_) {
        colored_table("RectangleLight<R>", "rectangle_lights", lights_of<runtime::RectangleLight, R>(scene_));
    }
    if (scene_.traits.lines) {
        colored_table("LineSegment<R>", "line_segments", line_segments_of<R>(scene_));
    }
    if (!has_bands()) {
        member("Rgb<R>", "ambient", convert(scene_.ambient, R{}));
        member("Rgb<R>", "background", convert(scene_.background, R{}));
        return;
    }
    out_.raw_line("static inline Rgb<R> ambient, background;");
    out_.raw_line("static inline std::span<const BandGroup<R>> bands;");
    const std::vector<runtime::BandGroup<R>> bands = bands_of<R>(scene_);
    values_.add(std::span<const runtime::BandGroup<R>>(bands));
    read_member("bands");
    out_.raw_line("static void take_band(std::size_t band) {");
    out_.indent();
    for (const std::string& name : colored_) {
        out_.line("take_rows(all_{}, band, bands.size(), {});", name, name);
    }
    out_.raw_line("ambient = bands[band].ambient;");
    out_.raw_line("background = bands[band].background;");
    out_.dedent();
    out_.raw_line("}");
}

template <class R>
template <class T>
void Emitter<R>::colored_table(const std::string& row_type, const std::string& name,
                               const std::vector<T>& rows) {
    if (!has_bands()) {
        table(row_type, name, rows);
        return;
    }
    const std::size_t own = rows.size() / scene_.bands.size();
    const std::string type = any_scene_ || own > most_constant_rows
                                 ? fmt::format("std::span<const {}>", row_type)
                                 : fmt::format("std::array<{}, {}>", row_type, own);
    out_.line("static inline {} {};", type, name);
    out_.line("static inline std::span<const {}> all_{};", row_type, name);
    values_.add(std::span<const T>(rows));
    read_member("all_" + name);
    colored_.push_back(name);
}

template <class R>
void Emitter<R>::meshes() {
    if (scene_.meshes.empty() && !any_scene_) {
        return;
    }
    std::vector<BuiltMesh> built;
    std::vector<runtime::MeshData> data;
    for (const ir::Mesh& mesh : scene_.meshes) {
        built.push_back(build_mesh(mesh, {.threads = host::core_count()}));
        data.push_back(built.back().data);
        if (!scene_.traits.uv && !draws_aovs_) {
            data.back().uvs = nullptr;
            data.back().uv_count = 0;
        }
    }
    out_.raw_line("static inline std::vector<MeshData> meshes;");
    values_.add(data);
    read_member("meshes");
}

template <class R>
void Emitter<R>::images() {
    if (images_.empty()) {
        return;
    }
    std::vector<runtime::ImageData> data;
    for (const ir::Image* image : images_) {
        data.push_back(image->data);
    }
    out_.raw_line("static inline std::vector<ImageData> images;");
    values_.add(data);
    read_member("images");
}

template <class R>
void Emitter<R>::draw_statement(const std::string& request, const std::string& image) {
    if (!scene_.traits.raster) {
        out_.line("return render(scene, {}, {});", request, image);
        return;
    }
    out_.line("return draw_raster(scene, raster_model(scene, {}.settings), {}, {});", request, request,
              image);
}

template <class R>
void Emitter<R>::program() {
    out_.raw_line("Scene scene;");
    out_.blank();
    out_.line("void load({}scc::host::Values& values) {{", !reads_.empty() ? "" : "[[maybe_unused]] ");
    out_.indent();
    for (const std::string& read : reads_) {
        out_.raw_line(read);
    }
    if (has_bands()) {
        out_.raw_line("scene.take_band(0);");
    }
    if (!scene_.traits.raster) {
        out_.raw_line("prepare(scene);");
    }
    out_.dedent();
    out_.raw_line("}");
    out_.blank();
    out_.raw_line("RenderResult draw(const RenderRequest& request, Image& image) {");
    out_.indent();
    if (has_bands()) {
        out_.raw_line("return render_bands(scene.bands, request, image, [](std::size_t band, const auto& "
                      "one, Image& to) {");
        out_.indent();
        out_.raw_line("scene.take_band(band);");
        draw_statement("one", "to");
        out_.dedent();
        out_.raw_line("});");
    } else {
        draw_statement("request", "image");
    }
    out_.dedent();
    out_.raw_line("}");
    out_.blank();
    if (draws_aovs_) {
        out_.raw_line("bool draw_layers(const RenderRequest& request, AovImage& image) {");
        out_.indent();
        out_.raw_line(
            scene_.traits.raster
                ? "return draw_raster_aovs(scene, raster_model(scene, request.settings), request, image);"
                : "return draw_aovs(scene, request, image);");
        out_.dedent();
        out_.raw_line("}");
        out_.blank();
    }
    out_.raw_line("} // namespace");
    out_.blank();
    out_.raw_line("int main(int argc, char** argv) {");
    out_.indent();
    std::string features;
    for (const std::string& feature : ir::feature_names(scene_.traits)) {
        features += quote(Language::cpp, feature) + ", ";
    }
    out_.line("static constexpr const char* features[] = {{{}nullptr}};", features);
    std::string facts;
    if (in_code_) {
        facts = fmt::format(
            ", .scene = {}, .settings = {}{}", quote(Language::cpp, scene_.name), literal(scene_.settings),
            !has_values() ? "" : ", .values = scene_values, .values_size = sizeof scene_values");
    } else if (parameters_ != nullptr) {
        facts = fmt::format(", .redefine = scc::compiler::redefine, .structure = \"{}\"", structure_);
    }
    if (draws_aovs_) {
        facts += ", .draw_aovs = draw_layers";
    }
    out_.line(
        "return scc::host::run_program({{.precision = \"{}\", .isa = scc::host::compiled_isa, .features = "
        "features, .load = load, .draw = draw{}{}}}, argc, argv);",
        name_of(precision_), facts, scene_.traits.pixel_sampling ? ", .has_filters = true" : "");
    out_.dedent();
    out_.raw_line("}");
}

template <class R>
CppProgram Emitter<R>::emit() {
    if (!in_code_) {
        values_.add_text(scene_.name);
        values_.add(scene_.settings);
    }
    if (parameters_ != nullptr) {
        values_.add_text(parameters_->scene);
        values_.add_text(parameters_->listing);
    }
    if (draws_aovs_) {
        names_of(scene_).write(values_);
    }
    // The scene type is written first, since it says which values there are.
    scene_type();
    const std::string type = out_.take();
    const std::string values = values_.empty() ? std::string() : values_.take();

    out_ = Writer();
    for (const std::string_view header : program_headers) {
        out_.line("#include {}", header);
    }
    if (has_bands()) {
        out_.raw_line("#include \"runtime/bands.h\"");
    }
    if (scene_.traits.raster) {
        out_.raw_line("#include \"runtime/raster/draw.h\"");
    } else if (draws_aovs_) {
        out_.raw_line("#include \"runtime/draw_aovs.h\"");
    }
    if (parameters_ != nullptr) {
        out_.raw_line("#include \"compiler/redefine.h\"");
        structure_ = host::cache_key({type});
    }
    out_.blank();
    if (in_code_ && !values.empty()) {
        out_.line("asm(\".section .rodata\\n.balign 64\\nscene_values:\\n.incbin \\\"{}\\\"\\n.text\\n\");",
                  values_name_);
        out_.line("extern \"C\" const unsigned char scene_values[{}];", values.size());
        out_.blank();
    }
    out_.raw_line("namespace {");
    out_.blank();
    out_.raw_line("using namespace scc::runtime;");
    out_.blank();
    const std::string head = out_.take();
    out_ = Writer();
    program();
    return {head + type + "\n" + out_.take(), values, structure_};
}

} // namespace

CppProgram emit_cpp(const ir::Scene& scene, Precision precision, Numbers numbers,
                    const std::string& values_name, const ProgramParameters* parameters, bool draws_aovs) {
    const auto emit = [&]<class R>(R) {
        return Emitter<R>(scene, precision, numbers, values_name, parameters, draws_aovs).emit();
    };
    return precision == Precision::single ? emit(0.0F) : emit(0.0);
}

} // namespace scc::compiler
