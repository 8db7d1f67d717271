#include "compiler/backends/pov.h"

#include "compiler/backends/pov_frame.h"
#include "compiler/backends/pov_light.h"
#include "compiler/backends/pov_material.h"
#include "compiler/backends/pov_shape.h"
#include "compiler/backends/pov_text.h"
#include "compiler/backends/sampling_ledger.h"
#include "compiler/backends/spectra.h"
#include "compiler/bounds.h"
#include "compiler/field_bounds.h"
#include "compiler/ir/objects.h"
#include "compiler/resolve_bumps.h"
#include "compiler/resolve_uv.h"
#include "compiler/writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

namespace scc::compiler {

using runtime::Vec3;

namespace {

class PovExport {
public:
    PovExport(const ir::Scene& scene, Ledger& ledger, ExportFiles& files, const lang::SourceSet* sources)
        : scene_(scene), ledger_(ledger), sources_(sources), frame_(choose_frame(scene)),
          in_union_(needs_object_union(scene)),
          materials_(scene, frame_.scale, files, functions_, textures_, ledger), files_(files) {}

    std::string run() {
        emit_camera();
        emit_objects();
        emit_lights(scene_, frame_, lights_, ledger_);
        record_spectra(scene_, ledger_);
        Writer file;
        emit_settings(file);
        append(file, "camera", camera_);
        append(file, "per-point functions", functions_);
        append(file, "materials", textures_);
        append(file, "meshes", meshes_);
        append(file, "objects", objects_);
        append(file, "lights", lights_);
        return file.take();
    }

private:
    static void append(Writer& file, std::string_view title, Writer& section) {
        if (section.text().empty()) {
            return;
        }
        file.blank();
        file.line("// ---- {} ----", title);
        file.blank();
        std::string text = section.take();
        text.pop_back();
        file.raw_line(text);
    }

    void note(Fidelity fidelity, std::string feature, std::string subject, lang::Span span, std::string how,
              double bound = 0) {
        ledger_.push_back({fidelity, std::move(feature), std::move(subject), span, std::move(how), bound});
    }

    void emit_settings(Writer& file) {
        const runtime::RenderSettings& settings = scene_.settings;
        file.line("// {}, exported by scc", comment_text(scene_.name));
        file.line("//   povray +ITHIS.pov +OIMAGE.png +W{} +H{} +FN16 File_Gamma=1.0 -A -D", settings.width,
                  settings.height);
        if (!files_.files.empty()) {
            file.line("// in the folder of this file, where its images are.");
        }
        file.line("#version 3.7;");
        emit_frame_comment(file);
        file.blank();
        file.line("// Declare=scc_exposure=0.25 on the command line makes the picture four times darker.");
        file.line("#ifndef (scc_exposure) #declare scc_exposure = 1; #end");
        file.line("global_settings {{");
        file.indent();
        file.line("assumed_gamma 1.0");
        file.line("max_trace_level {}", std::min(trace_level(), highest_trace_level));
        file.line("adc_bailout 0");
        file.line("ambient_light rgb scc_exposure*{}", pov_color(scene_.ambient));
        file.dedent();
        file.line("}}");
        file.line("#default {{ finish {{ ambient 0 diffuse 0 specular 0 }} }}");
        file.line("background {{ rgb scc_exposure*{} }}", pov_color(scene_.background));
        note(Fidelity::exact, "ambient", "world", {}, "ambient_light");
        note(Fidelity::exact, "background", "world", {}, "background");
        note_settings();
    }

    static constexpr int highest_trace_level = 256;
    bool has_bounces() const { return scene_.traits.reflection || scene_.traits.refraction; }
    int trace_level() const { return scene_.settings.depth + (takes_bounces() ? 1 : 2); }
    /// POV-Ray counts no level for a ray that goes straight on, but lets none go on at the last one. Where
    /// nothing else takes levels, one more does no harm.
    bool takes_bounces() const { return has_bounces() || !scene_.traits.transmission; }
    bool passes_straight() const {
        return std::any_of(scene_.materials.begin(), scene_.materials.end(),
                           [](const ir::Material& m) { return lets_through(m.phong) && m.phong.ior == 1; });
    }

    void note_settings() {
        const runtime::RenderSettings& settings = scene_.settings;
        if (takes_bounces() && passes_straight()) {
            note(Fidelity::approximated, "depth", "render", {},
                 "max_trace_level; a ray that goes straight through a surface after its last bounce sees "
                 "black; "
                 "bound in radiance at such pixels",
                 1);
        } else if (has_bounces() && trace_level() > highest_trace_level) {
            note(Fidelity::approximated, "depth", "render", {},
                 "max_trace_level, which is at most 256; bound in radiance where rays go on for longer", 1);
        } else {
            note(Fidelity::exact, "depth", "render", {}, "max_trace_level");
        }
        if (!settings.shadows) {
            note(Fidelity::exact, "shadows", "render", {}, "every object is no_shadow");
        }
        if (settings.samples > 1) {
            const int n = samples_per_axis(settings);
            note(Fidelity::exact, "samples", "render", {},
                 fmt::format("a picture {} times larger, averaged over {} x {} pixels, is the sampled one", n,
                             n, n));
        }
        record_sampling(scene_, ledger_);
    }

    void emit_frame_comment(Writer& file) {
        const auto& moved = scene_.settings.origin;
        const runtime::Vec3<double> origin =
            frame_.origin + runtime::Vec3<double>{moved[0], moved[1], moved[2]};
        if (frame_.scale == 1 && origin == runtime::Vec3<double>{}) {
            return;
        }
        const std::string how =
            fmt::format("written as {} (p - {})", number(frame_.scale), pov_vector(origin));
        file.line("// POV-Ray's tolerances are absolute lengths: world point p is {} here.", how);
        note(Fidelity::exact, "world", "world", {},
             fmt::format("POV-Ray's tolerances are absolute lengths: world point p is {}", how));
    }

    void emit_camera() {
        camera_.line("camera {{");
        camera_.indent();
        camera_.line("{}", word(runtime::projection_names, scene_.camera.projection));
        if (scene_.camera.projection == runtime::Projection::spherical) {
            emit_spherical();
        } else {
            emit_window();
        }
        camera_.dedent();
        camera_.line("}}");
        const bool windowed = scene_.camera.projection != runtime::Projection::spherical;
        note(Fidelity::exact,
             fmt::format("{}_camera", word(runtime::projection_names, scene_.camera.projection)), "camera",
             scene_.camera_span,
             windowed ? "location, direction, right and up; `near` and `far` do not matter to ray casting"
                      : "location, direction, right, up and angle");
        if (scene_.camera.lens_radius > 0) {
            note(Fidelity::dropped, "aperture", "camera", scene_.camera_span,
                 "POV-Ray's own focal blur is another lens (4e-2 off, root mean square, at 500 points)");
        }
        if (scene_.settings.point == runtime::PixelPoint::corner) {
            note(windowed ? Fidelity::exact : Fidelity::dropped, "sampling", "render", scene_.method_span,
                 windowed ? "the window is shifted by half a pixel"
                          : "POV-Ray's spherical camera has no latitudes but those around its direction");
        }
    }

    void emit_window() {
        const runtime::Camera<double>& c = scene_.camera;
        const bool perspective = c.projection == runtime::Projection::perspective;
        const double half = perspective ? c.half_height : c.half_height * frame_.scale;
        // Windows are shifted by window heights; right is in window widths.
        const Vec3<double> shift = (2 * half) * (c.shift_x * c.u + c.shift_y * c.v);
        const Vec3<double> eye = frame_.point(c.eye);
        const auto corner = [&]() -> std::string { // half a pixel of the final picture to the left and down
            if (scene_.settings.point != runtime::PixelPoint::corner) {
                return "";
            }
            const double n = samples_per_axis(scene_.settings);
            return fmt::format(" - {}/image_height", pov_vector((n * half) * (c.u + c.v)));
        };
        camera_.line("location {}{}", pov_vector(perspective ? eye : eye + shift),
                     perspective ? "" : corner());
        camera_.line("direction {}{}", pov_vector(perspective ? shift - c.n : -c.n),
                     perspective ? corner() : "");
        camera_.line("right {}*image_width/image_height", pov_vector((2 * half) * c.u));
        camera_.line("up {}", pov_vector((2 * half) * c.v));
    }

    /// POV-Ray turns the direction about `up` and `right` in a left-handed world.
    void emit_spherical() {
        const runtime::Camera<double>& c = scene_.camera;
        constexpr double degrees = 180 / std::numbers::pi;
        camera_.line("location {}", pov_vector(frame_.point(c.eye)));
        camera_.line("direction {}", pov_vector(-c.n));
        camera_.line("right {}", pov_vector(-c.u));
        camera_.line("up {}", pov_vector(-c.v));
        camera_.line("angle {}, {}", number(2 * c.half_width * degrees), number(2 * c.half_height * degrees));
    }

    void emit_objects() {
        for (const ir::Mesh& mesh : scene_.meshes) {
            mesh_names_.push_back(mesh_identifiers_.make(mesh.name));
        }
        if (in_union_) {
            objects_.line("// A union, because lights whose highlight has a colour of its own refer to it.");
            objects_.line("#declare {} = union {{", pov_objects_name);
            objects_.indent();
        }
        ir::for_each_object(scene_, [&](const ir::Object& object) { emit_object(object); });
        if (in_union_) {
            objects_.dedent();
            objects_.line("}}");
            objects_.line("object {{ {} }}", pov_objects_name);
        }
    }

    void emit_object(const ir::Object& object) {
        if (const auto* solid = std::get_if<runtime::Csg<double>>(&object.shape)) {
            if (!describe_members(object, *solid)) {
                return;
            }
            objects_.line("// {}", comment_text(object.path + line_of(object.span)));
            emit_solid(solid->root, true);
            note(Fidelity::exact, std::string(ir::csg_word(scene_.csg_nodes[solid->root].op)), object.path,
                 object.span, pov_word(scene_.csg_nodes[solid->root].op));
        } else {
            emit_shape(object, true, false);
        }
    }

    /// POV-Ray shows a union's inner surfaces to whoever is inside; a merge has none, as our union.
    static const char* pov_word(runtime::CsgOp op) {
        return op == runtime::CsgOp::unite       ? "merge"
               : op == runtime::CsgOp::intersect ? "intersection"
                                                 : "difference";
    }

    void emit_solid(std::size_t at, bool whole) {
        const ir::CsgNode& node = scene_.csg_nodes[at];
        if (node.op == runtime::CsgOp::member) {
            emit_shape(scene_.members[node.member], whole, node.inverted);
            return;
        }
        const std::size_t end = at + node.size;
        if (at + 1 + scene_.csg_nodes[at + 1].size == end) { // POV-Ray wants two operands
            emit_solid(at + 1, whole);
            return;
        }
        objects_.line("{} {{", pov_word(node.op));
        objects_.indent();
        for (std::size_t child = at + 1; child < end; child += scene_.csg_nodes[child].size) {
            emit_solid(child, false);
        }
        if (whole) {
            finish_object(ir::iors_of_solid(scene_, at));
        }
        objects_.dedent();
        objects_.line("}}");
    }

    /// What concerns an object as a whole.
    void finish_object(const std::vector<double>& iors) {
        if (!iors.empty() && iors[0] != 1) {
            objects_.line("interior {{ ior {} }}", number(iors[0]));
        }
        if (!scene_.settings.shadows) {
            objects_.line("no_shadow");
        }
    }

    /// `inverted`: it is taken away from a solid.
    void emit_shape(const ir::Object& object, bool whole, bool inverted) {
        const Placement placement = place(object, scene_, frame_);
        PovField field;
        const auto* implicit = std::get_if<runtime::Implicit<double>>(&object.shape);
        if (implicit != nullptr && !describe_field(object, *implicit, field)) {
            return;
        }
        PovShape shape = pov_shape(object.shape, placement, mesh_names_, field);
        if (implicit != nullptr) {
            shape.precision = field.precision;
            shape.bound = field.bound;
        }
        // Of what it takes away, POV-Ray turns the coefficients of quadrics over, and with them their sides.
        if (inverted && std::holds_alternative<runtime::Quadric<double>>(object.shape)) {
            shape.reversed = !shape.reversed;
        }
        declare_mesh_of(object);
        objects_.line("// {}", comment_text(object.path + line_of(object.span)));
        objects_.line("{} {{", shape.keyword);
        objects_.indent();
        for (const std::string& line : shape.lines) {
            objects_.raw_line(line);
        }
        // What stands before the transform moves with the shape.
        const std::vector<TextureLine> textures = texture_lines(object, placement, shape);
        write_textures(textures, false);
        if (const std::string moved = pov_transform(placement.transform); !shape.placed && !moved.empty()) {
            objects_.raw_line(moved);
        }
        write_textures(textures, true);
        if (whole) {
            finish_object(ir::iors_of(scene_, object));
        }
        objects_.dedent();
        objects_.line("}}");
        note_object(object, shape);
    }

    struct TextureLine {
        std::string text;
        bool in_world;
    };

    std::vector<TextureLine> texture_lines(const ir::Object& object, const Placement& placement,
                                           const PovShape& shape) {
        std::string in_object;
        if (placement.shape_scale != 1) {
            in_object += " scale " + number(placement.shape_scale);
        }
        if (const std::string moved = pov_transform(placement.transform); shape.placed && !moved.empty()) {
            in_object += " " + moved;
        }
        std::vector<TextureLine> lines;
        const auto add = [&](std::string_view keyword, std::uint32_t material) {
            const PovMaterials::Use use = materials_.use(material, object);
            const std::string moved = !use.varies    ? ""
                                      : use.in_world ? frame_.texture_transform()
                                                     : in_object;
            lines.push_back(
                {fmt::format("{} {{ {}{}{} }}", keyword, use.by_uv ? "uv_mapping " : "", use.texture, moved),
                 use.in_world});
        };
        const auto [front, back] = object.sides;
        add("texture", shape.reversed ? back : front);
        if (front != back) {
            add("interior_texture", shape.reversed ? front : back);
        }
        return lines;
    }

    /// The members of a solid that are more than a formula. False: it is dropped, since one of them would be
    /// missing.
    bool describe_members(const ir::Object& object, const runtime::Csg<double>& solid) {
        bool has_all = true;
        ir::for_each_csg_node(scene_, solid, [&](const ir::CsgNode& node) {
            if (node.op != runtime::CsgOp::member) {
                return;
            }
            const ir::Object& member = scene_.members[node.member];
            if (const auto* implicit = std::get_if<runtime::Implicit<double>>(&member.shape)) {
                PovField ignored;
                has_all &= describe_field(member, *implicit, ignored);
            } else if (const auto* mesh = std::get_if<runtime::Mesh<double>>(&member.shape)) {
                note(Fidelity::approximated, std::string(mesh->name), member.path, member.span,
                     "inside_vector; POV-Ray counts crossings, so that it has a hollow where the mesh "
                     "overlaps "
                     "itself; bound in radiance at such pixels",
                     1);
            }
        });
        if (!has_all) {
            note(Fidelity::dropped, std::string(ir::csg_word(scene_.csg_nodes[solid.root].op)), object.path,
                 object.span, "a member of it is dropped");
        }
        return has_all;
    }

    /// False: it is dropped.
    bool describe_field(const ir::Object& object, const runtime::Implicit<double>& implicit,
                        PovField& field) {
        const auto drop = [&](std::string_view why) {
            note(Fidelity::dropped, std::string(implicit.name), object.path, object.span, std::string(why));
            return false;
        };
        const PovFunctions::Declared& declared = materials_.functions().field(implicit.field);
        if (declared.name.empty()) {
            return drop(declared.obstacle);
        }
        const ir::Function& function = scene_.functions[static_cast<std::size_t>(implicit.field)];
        const Steepness steepness = gradient_bound(function, pov_field_box(implicit.within));
        if (steepness.at_zero) {
            return drop(
                "POV-Ray needs a bound of the field's slope, which has none where the field may be 0");
        }
        field.function = declared.name;
        field.steepest_slope = steepness.bound;
        field.precision =
            "isosurface; POV-Ray stops where its steps are small; bound relative to the container";
        field.bound = pov_isosurface_accuracy;
        if (steepness.elsewhere) {
            field.precision =
                "isosurface; the field's slope has no bound in places where it is not 0, near which "
                "POV-Ray may miss the surface; bound in radiance at such pixels";
            field.bound = 1;
        }
        return true;
    }

    void write_textures(const std::vector<TextureLine>& lines, bool in_world) {
        for (const TextureLine& line : lines) {
            if (line.in_world == in_world) {
                objects_.raw_line(line.text);
            }
        }
    }

    void declare_mesh_of(const ir::Object& object) {
        const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape);
        if (mesh != nullptr && declared_meshes_.insert(mesh->mesh).second) {
            const bool is_solid =
                std::any_of(scene_.members.begin(), scene_.members.end(), [&](const ir::Object& member) {
                    const auto* used = std::get_if<runtime::Mesh<double>>(&member.shape);
                    return used != nullptr && used->mesh == mesh->mesh;
                });
            declare_mesh(scene_.meshes[mesh->mesh], mesh_names_[mesh->mesh], scene_.traits.uv, is_solid,
                         meshes_);
        }
    }

    void note_object(const ir::Object& object, const PovShape& shape) {
        const std::string kind = std::visit(
            [](const auto& s) { return std::string(std::decay_t<decltype(s)>::name); }, object.shape);
        if (shape.precision.empty()) {
            note(Fidelity::exact, kind, object.path, object.span, shape.keyword);
        } else {
            note(Fidelity::approximated, kind, object.path, object.span, shape.precision, shape.bound);
        }
        if (scene_.traits.refraction) {
            note_refraction(object);
        }
        if (object.sides.front == object.sides.back) {
            return;
        }
        if (has_smooth_normals(object)) {
            note(Fidelity::approximated, "two_sided", object.path, object.span,
                 "interior_texture; POV-Ray tells the sides by the interpolated normal, so that pixels near "
                 "the silhouette may show the other material; bound in radiance",
                 1);
        } else {
            note(Fidelity::exact, "two_sided", object.path, object.span, "interior_texture");
        }
    }

    void note_refraction(const ir::Object& object) {
        const runtime::Phong<double>&front = scene_.materials[object.sides.front].phong,
              &back = scene_.materials[object.sides.back].phong;
        if ((front.fresnel || back.fresnel) && has_other_bodies(object)) {
            note(Fidelity::approximated, "glass", object.path, object.span,
                 "what it mirrors where it is in another transparent body, or has one on its surface, is "
                 "that of "
                 "glass in air; bound in radiance at such pixels",
                 1);
        } else if (refracts(front) || refracts(back)) {
            note(Fidelity::exact, "refraction", object.path, object.span, "interior");
        }
    }

    /// Whether the box around some other transparent body meets the object's. Of so many that it would take
    /// long to find out, it is assumed.
    bool has_other_bodies(const ir::Object& object) {
        if (bodies_.empty()) {
            ir::for_each_surface(scene_, [&](const ir::Object& one) {
                if (lets_through(scene_.materials[one.sides.front].phong) ||
                    lets_through(scene_.materials[one.sides.back].phong)) {
                    bodies_.push_back({one.path, box_of(one)});
                }
            });
        }
        const runtime::Bounds<double> box = box_of(object);
        return bodies_.size() > most_bodies ||
               std::any_of(bodies_.begin(), bodies_.end(), [&](const auto& body) {
                   const Vec3<double> gap =
                       maximum(body.second.min, box.min) - minimum(body.second.max, box.max);
                   return body.first != object.path && largest_component(gap) <= 0;
               });
    }
    runtime::Bounds<double> box_of(const ir::Object& object) const {
        constexpr double inf = std::numeric_limits<double>::infinity();
        const std::optional<runtime::Bounds<double>> own = object_bounds(object.shape, scene_);
        return own ? transform_bounds(object.world_from_object, *own)
                   : runtime::Bounds<double>{{-inf, -inf, -inf}, {inf, inf, inf}};
    }

    bool has_smooth_normals(const ir::Object& object) const {
        if (const auto* triangle = std::get_if<runtime::Triangle<double>>(&object.shape)) {
            return triangle->smooth;
        }
        const auto* mesh = std::get_if<runtime::Mesh<double>>(&object.shape);
        return mesh != nullptr && !scene_.meshes[mesh->mesh].normals.empty();
    }

    std::string line_of(lang::Span span) const {
        if (sources_ == nullptr || span == lang::Span{}) {
            return "";
        }
        const lang::SourceFile& file = sources_->file(span.file);
        const std::string& path = file.path();
        return fmt::format(" ({}:{})", path.substr(path.find_last_of("/\\") + 1),
                           file.position(span.begin).line);
    }

    const ir::Scene& scene_;
    Ledger& ledger_;
    const lang::SourceSet* sources_;
    PovFrame frame_;
    bool in_union_;
    Writer camera_, functions_, textures_, meshes_, objects_, lights_;
    PovMaterials materials_;
    const ExportFiles& files_;
    Identifiers mesh_identifiers_{"mesh_"};
    std::vector<std::string> mesh_names_;
    std::set<std::uint32_t> declared_meshes_;
    static constexpr std::size_t most_bodies = 1000;
    std::vector<std::pair<std::string, runtime::Bounds<double>>> bodies_; ///< transparent ones
};

} // namespace

std::string emit_pov(const ir::Scene& scene, Ledger& ledger, ExportFiles& files,
                     const lang::SourceSet* sources) {
    std::optional<ir::Scene> resolved;
    if (scene.traits.uv) {
        resolved = resolve_uv(scene);
    }
    if (scene.traits.bump) {
        ResolvedBumps bumps = resolve_bumps(resolved ? *resolved : scene, BumpForm::height_along_surface);
        for (const std::uint32_t material : bumps.flat) {
            const ir::Material& flat = bumps.scene.materials[material];
            ledger.push_back(
                {Fidelity::dropped, "phong bump", flat.name, flat.span,
                 "POV-Ray's normals know no tangents; the compiler has none of a mesh, nor of a field "
                 "with `noise`",
                 0});
        }
        resolved = std::move(bumps.scene);
    }
    return PovExport(resolved ? *resolved : scene, ledger, files, sources).run();
}

} // namespace scc::compiler
