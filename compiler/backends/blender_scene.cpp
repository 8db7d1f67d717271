#include "compiler/backends/blender_scene.h"

#include "compiler/backends/blender_function.h"
#include "compiler/backends/blender_mesh.h"
#include "compiler/backends/blender_python.h"
#include "compiler/ir/objects.h"

#include <map>

namespace scc::compiler {

namespace {

using runtime::Rgb;
using runtime::Varying;

/// How far along a ray the true surface is looked for: seen at less than three degrees it may be farther.
constexpr double steps_from_mesh = 20;

class SceneWriter {
public:
    SceneWriter(Writer& out, const ir::Scene& scene, const BlenderNeeds& needs)
        : out_(out), scene_(scene), needs_(needs), keys_(scene.functions.size()) {}

    void write() {
        write_constants();
        write_camera();
        write_lights();
        write_images();
        write_functions();
        write_fields();
        write_materials();
        write_meshes();
        write_solids();
        write_objects();
    }

private:
    bool has(std::string_view feature) const { return needs_.features.contains(feature); }

    void write_constants() {
        const runtime::RenderSettings& settings = scene_.settings;
        out_.line("NAME = {}", python(scene_.name.empty() ? "scene" : scene_.name));
        out_.line("SIZE = ({}, {})", settings.width, settings.height);
        if (const auto& o = settings.origin; o != decltype(settings.origin){}) {
            out_.line("# The scene stands far from the world's origin: its coordinates count from {}.",
                      python(runtime::Vec3<double>{o[0], o[1], o[2]}));
        }
        if (has("through")) {
            write_paths();
        }
        out_.line("BOUNCES = {}", needs_.bounces);
        if (has("light")) {
            out_.line("SHADOWS = {}", settings.shadows ? "True" : "False");
        }
        out_.line("AMBIENT = {}", python(scene_.ambient));
        out_.line("BACKGROUND = {}", python(scene_.background));
        if (has("plane")) {
            out_.line("CENTER = {}", python(needs_.center));
        }
        out_.line("EXTENT = {}  # half the size of what is bounded, the lights and the camera together",
                  python(needs_.extent));
    }

    void write_paths() {
        out_.line("# One view layer each follows what goes through surfaces (T) and what is mirrored (R).");
        std::string line = "PATHS = (";
        for (const std::string& path : needs_.ways.paths) {
            line += '"' + path + "\", ";
            if (line.size() > 100) {
                out_.raw_line(line.substr(0, line.size() - 1));
                line = "         ";
            }
        }
        out_.raw_line(line + ")");
    }

    void write_camera() {
        const runtime::Camera<double>& camera = scene_.camera;
        static constexpr const char* types[] = {"PERSP", "ORTHO", "PANO"};
        out_.line("CAMERA = dict(type=\"{}\", eye={}, right={}, up={}, back={},",
                  types[static_cast<std::size_t>(camera.projection)], python(camera.eye), python(camera.u),
                  python(camera.v), python(camera.n));
        std::string more;
        if (has("panorama")) {
            more += fmt::format(", half_width={}", python(camera.half_width));
        }
        if (has("lens")) {
            more +=
                fmt::format(", lens_radius={}, focus={}", python(camera.lens_radius), python(camera.focus));
        }
        out_.line("              half_height={}, shift=({}, {}){})", python(camera.half_height),
                  python(camera.shift_x), python(camera.shift_y), more);
        if (has("corner")) {
            out_.line("SAMPLES_ACROSS = {}  # of a pixel: by so much `--size` is larger than the picture",
                      samples_per_axis(scene_.settings));
        }
    }

    void write_lights() {
        out_.line("LIGHTS = {{");
        out_.indent();
        for (const ir::Light& light : scene_.lights) {
            std::visit([&](const auto& l) { write_light(light.name, l); }, light.light);
        }
        out_.dedent();
        out_.line("}}");
    }
    template <class Light>
    void write_light(const std::string& name, const Light& light) {
        out_.line("{}: dict({}{}),", python(name), place(light), colors(light));
    }
    void write_light(const std::string& name, const runtime::RectangleLight<double>& light) {
        int number = 0;
        for_each_point(light, [&](const runtime::PointLight<double>& point) {
            write_light(fmt::format("{}[{}]", name, number++), point);
        });
    }
    static std::string place(const runtime::PointLight<double>& light) {
        std::string text = "type=\"POINT\", position=" + python(light.position);
        if (light.kc != 1 || light.kl != 0 || light.kq != 0) {
            text += fmt::format(", attenuation=({}, {}, {})", python(light.kc), python(light.kl),
                                python(light.kq));
        }
        return text;
    }
    static std::string place(const runtime::SpotLight<double>& light) {
        return place(static_cast<const runtime::PointLight<double>&>(light)) +
               fmt::format(", axis={}, cone=({}, {}, {})", python(light.axis), python(light.cos_inner),
                           python(light.cos_outer), python(light.exponent));
    }
    static std::string place(const runtime::DirectionalLight<double>& light) {
        return "type=\"SUN\", to_light=" + python(light.to_light);
    }
    template <class Light>
    static std::string colors(const Light& light) {
        const std::string diffuse = ", diffuse=" + python(light.diffuse);
        return light.diffuse == light.specular ? diffuse : diffuse + ", specular=" + python(light.specular);
    }

    void write_images() {
        if (needs_packing(scene_, needs_)) {
            write_unpacking(out_);
        }
        if (!has("image")) {
            return;
        }
        Identifiers identifiers("");
        out_.line("IMAGES = {{");
        out_.indent();
        for (const auto& image : needs_.images) {
            const std::string key = identifiers.make(image->name);
            image_keys_.emplace(image->key, key);
            write_image(out_, *image, key);
        }
        out_.dedent();
        out_.line("}}");
    }

    void write_functions() {
        if (!has("function")) {
            return;
        }
        Identifiers identifiers("pattern_");
        for (std::size_t i = 0; i < scene_.functions.size(); ++i) {
            if (needs_.functions[i]) {
                keys_[i] = identifiers.make(scene_.functions[i].name);
                out_.blank();
                out_.blank();
                write_function(out_, scene_.functions[i], keys_[i], images_of(scene_.functions[i]));
            }
        }
        out_.blank();
        out_.blank();
        out_.line("FUNCTIONS = {{  # and what they read");
        out_.indent();
        for (std::size_t i = 0; i < scene_.functions.size(); ++i) {
            if (needs_.functions[i]) {
                std::string points;
                for (const std::string_view point : points_read(scene_.functions[i])) {
                    points += fmt::format("\"{}\", ", point);
                }
                out_.line("\"{}\": ({}, ({})),", keys_[i], keys_[i], points);
            }
        }
        out_.dedent();
        out_.line("}}");
    }

    std::vector<std::string> images_of(const ir::Function& function) const {
        std::vector<std::string> keys;
        for (const std::shared_ptr<const ir::Image>& image : function.images) {
            keys.push_back(image_keys_.at(image->key));
        }
        return keys;
    }

    void write_fields() {
        if (!has("field")) {
            return;
        }
        field_keys_.resize(scene_.functions.size());
        Identifiers identifiers("field_");
        std::string table;
        for (std::size_t i = 0; i < scene_.functions.size(); ++i) {
            if (needs_.fields[i]) {
                const std::string& key = field_keys_[i] = identifiers.make(scene_.functions[i].name);
                out_.blank();
                out_.blank();
                const ir::Function field = *field_for_nodes(scene_, static_cast<std::int32_t>(i));
                write_function(out_, field, key, images_of(field));
                table += fmt::format("{}\"{}\": {}", table.empty() ? "" : ", ", key, key);
            }
        }
        out_.blank();
        out_.blank();
        out_.line("FIELDS = {{{}}}", table);
    }

    void write_materials() {
        out_.line("MATERIALS = {{");
        out_.indent();
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            if (needs_.materials[i]) {
                out_.line("{}: dict({}),", python(scene_.materials[i].name),
                          fields(scene_.materials[i].phong));
            }
        }
        out_.dedent();
        out_.line("}}");
    }
    std::string fields(const runtime::Phong<double>& phong) const {
        std::string text = fmt::format("ambient={}, diffuse={}", field(phong.ambient), field(phong.diffuse));
        if (is_present(phong.specular)) {
            text += fmt::format(", specular={}, shininess={}", field(phong.specular), field(phong.shininess));
        }
        if (is_present(phong.emission)) {
            text += ", emission=" + field(phong.emission);
        }
        if (has("mirror") && (has_mirror(phong) || (has("through") && is_present(phong.reflect)))) {
            text += ", reflect=" + field(phong.reflect);
        }
        if (has("through") && (lets_through(phong) || phong.fresnel != 0)) {
            text += fmt::format(", transmit={}, ior={}", field(phong.transmit), python(phong.ior));
            text += phong.fresnel != 0 ? ", fresnel=1.0" : "";
        }
        if (phong.bump != runtime::no_function) {
            text += fmt::format(", bump=\"{}\"", keys_[static_cast<std::size_t>(phong.bump)]);
        }
        return text;
    }
    template <class T>
    std::string field(const Varying<T>& value) const {
        if (value.function == runtime::no_function) {
            return python(value.value);
        }
        return '"' + keys_[static_cast<std::size_t>(value.function)] + '"';
    }

    void write_meshes() {
        if (!has("mesh")) {
            return;
        }
        out_.line("MESHES = {{");
        out_.indent();
        for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
            if (needs_.meshes[i]) {
                write_mesh(out_, scene_.meshes[i], has("uv"));
            }
        }
        out_.dedent();
        out_.line("}}");
    }

    void write_solids() {
        if (!has("solid")) {
            return;
        }
        out_.line("SOLIDS = {{");
        out_.indent();
        for (const auto& [path, solid] : needs_.solids) {
            for_each_part(solid, [&](const BlenderSolid& part) { write_solid(out_, part); });
        }
        out_.dedent();
        out_.line("}}");
    }

    std::string materials(const runtime::Sides& sides) const {
        const std::string front = python(scene_.materials[sides.front].name);
        if (sides.front == sides.back) {
            return "material=" + front;
        }
        return fmt::format("front={}, back={}", front, python(scene_.materials[sides.back].name));
    }

    void write_objects() {
        out_.line("OBJECTS = [");
        out_.indent();
        ir::for_each_object(scene_, [&](const ir::Object& object) {
            const auto solid = needs_.solids.find(object.path);
            std::string text =
                solid != needs_.solids.end()
                    ? "type=\"solid\""
                    : std::visit([&](const auto& shape) { return described(shape); }, object.shape);
            if (text.empty()) {
                return; // dropped
            }
            text += fmt::format(", name={}", python(object.path));
            text += ", " + (solid != needs_.solids.end() ? faces(solid->second) : materials(object.sides));
            if (const auto around = needs_.ways.outside.find(object.path);
                around != needs_.ways.outside.end()) {
                text += ", outside=" + python(around->second);
            }
            if (!(object.world_from_object == runtime::Affine<double>{})) {
                text += fmt::format(", world={}", python(object.world_from_object));
            }
            out_.line("dict({}),", text);
        });
        out_.dedent();
        out_.line("]");
    }
    static std::string described(const runtime::Sphere<double>& s) {
        return fmt::format("type=\"sphere\", center={}, radius={}", python(s.center), python(s.radius));
    }
    static std::string described(const runtime::Box<double>& b) {
        return fmt::format("type=\"box\", low={}, high={}", python(b.min), python(b.max));
    }
    static std::string described(const runtime::Plane<double>& p) {
        return fmt::format("type=\"plane\", normal={}, offset={}", python(p.normal), python(p.offset));
    }
    static std::string described(const runtime::Cylinder<double>& c) {
        return fmt::format("type=\"cylinder\", start={}, end={}, radius={}, caps={}", python(c.from),
                           python(c.to), python(c.radius), c.caps ? "True" : "False");
    }
    /// Begins at the wider end. `taper`: how much of the radius is lost towards the other.
    static std::string described(const runtime::Cone<double>& c) {
        const bool narrows = c.radius_to <= c.radius_from;
        const double wide = narrows ? c.radius_from : c.radius_to;
        const double narrow = narrows ? c.radius_to : c.radius_from;
        return fmt::format("type=\"cone\", start={}, end={}, radius={}, taper={}, caps={}",
                           python(narrows ? c.from : c.to), python(narrows ? c.to : c.from), python(wide),
                           python((wide - narrow) / wide), c.caps ? "True" : "False");
    }
    static std::string described(const runtime::Disc<double>& d) {
        const std::string hole = d.hole > 0 ? ", hole=" + python(d.hole) : "";
        return fmt::format("type=\"disc\", center={}, normal={}, radius={}{}", python(d.center),
                           python(d.normal), python(d.radius), hole);
    }
    static std::string described(const runtime::Triangle<double>& t) {
        const auto triple = [](const std::array<runtime::Vec3<double>, 3>& v) {
            return fmt::format("({}, {}, {})", python(v[0]), python(v[1]), python(v[2]));
        };
        const std::string normals = t.smooth ? ", normals=" + triple(t.normals) : "";
        return fmt::format("type=\"triangle\", points={}{}", triple(t.points), normals);
    }
    static std::string described(const runtime::Csg<double>&) { return ""; }      // by its faces, or dropped
    static std::string described(const runtime::Implicit<double>&) { return ""; } // by its faces

    std::string faces(const BlenderSolid& solid) const {
        std::string list;
        for (const BlenderFace& face : solid.faces) {
            list += (list.empty() ? "" : ", ") + fmt::format("dict({})", described(face, solid));
        }
        return fmt::format("faces=[{}]", list) + (solid.is_part ? cuts(solid) : "");
    }
    /// Also none: Blender makes such solids otherwise.
    std::string cuts(const BlenderSolid& solid) const {
        std::string list;
        for (const BlenderCut& cut : solid.cuts) {
            list += fmt::format("({}, dict(type=\"solid\", name={}, {})), ", python(operation(cut.op)),
                                python(cut.solid.mesh.name), faces(cut.solid));
        }
        return fmt::format(", cuts=[{}]", list.substr(0, list.empty() ? 0 : list.size() - 2));
    }
    static std::string operation(runtime::CsgOp op) {
        return op == runtime::CsgOp::unite       ? "UNION"
               : op == runtime::CsgOp::intersect ? "INTERSECT"
                                                 : "DIFFERENCE";
    }
    std::string described(const BlenderFace& face, const BlenderSolid& solid) const {
        using Formula = BlenderFace::Formula;
        std::string text = materials(face.sides);
        if (!(face.member_from_world == runtime::Affine<double>{})) {
            text += ", member=" + python(face.member_from_world);
        }
        if (face.formula == Formula::none) {
            return fmt::format("kind=\"{}\", {}", solid.is_part ? "part" : "face", text);
        }
        text += ", frame=" + python(face.q_from_world);
        if (face.inverted) {
            text += ", inverted=True";
        }
        if (face.formula == Formula::field) {
            return fmt::format("kind=\"field\", field=\"{}\", reach={}, {}",
                               field_keys_[static_cast<std::size_t>(face.field)],
                               python(steps_from_mesh * solid.deviation), text);
        }
        if (face.formula == Formula::quadric) {
            const runtime::Quadric<double>& q = face.quadric;
            return fmt::format("kind=\"quadric\", squares={}, products={}, linear={}, constant={}, {}",
                               python(q.squares), python(q.products), python(q.linear), python(q.constant),
                               text);
        }
        const std::string_view kind = face.formula == Formula::ball    ? "ball"
                                      : face.formula == Formula::round ? "round"
                                                                       : "ring";
        if (face.formula == Formula::ring) {
            text += ", reach=" + python(steps_from_mesh * solid.deviation);
        }
        return fmt::format("kind=\"{}\", radius=({}, {}), {}", kind, python(face.radius), python(face.slope),
                           text);
    }
    /// `tube`: its radius as a part of the circle's.
    static std::string described(const runtime::Torus<double>& t) {
        return fmt::format("type=\"torus\", center={}, axis={}, major={}, tube={}", python(t.center),
                           python(t.axis), python(t.major), python(t.minor / t.major));
    }
    static std::string described(const runtime::Quadric<double>&) { return ""; } // the same
    std::string described(const runtime::Mesh<double>& m) const {
        return fmt::format("type=\"mesh\", mesh={}", python(scene_.meshes[m.mesh].name));
    }

    Writer& out_;
    const ir::Scene& scene_;
    const BlenderNeeds& needs_;
    std::map<std::string, std::string> image_keys_; ///< by the images' own
    std::vector<std::string> keys_;                 ///< of each function: its name in Python
    std::vector<std::string> field_keys_;           ///< of each field
};

} // namespace

void write_blender_scene(Writer& out, const ir::Scene& scene, const BlenderNeeds& needs) {
    SceneWriter(out, scene, needs).write();
}

} // namespace scc::compiler
