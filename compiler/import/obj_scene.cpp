#include "compiler/import/obj.h"
#include "compiler/mesh_file.h"
#include "compiler/writer.h"
#include "runtime/math/vec.h"

#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace scc::compiler::obj {

namespace {

namespace fs = std::filesystem;
using runtime::Vec3;
using tinyobj::material_t;

constexpr double fov_y = 35; // degrees

/// A file of a scene's: neither elsewhere than in the folder nor above it. Empty: there is none.
fs::path file_within(const fs::path& folder, const std::string& name) {
    std::error_code error;
    const fs::path wanted = fs::path(name).lexically_normal();
    const bool leaves = wanted.empty() || wanted.is_absolute() || *wanted.begin() == "..";
    return !leaves && fs::is_regular_file(folder / wanted, error) ? wanted : fs::path();
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    return begin == std::string_view::npos ? std::string_view()
                                           : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// What stands after each `mtllib`.
std::vector<std::string> library_names(std::string_view text) {
    std::vector<std::string> names;
    constexpr std::string_view word = "mtllib";
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = trimmed(text.substr(begin, end - begin));
        if (line.starts_with(word) && line.size() > word.size() && std::isblank(line[word.size()]) != 0) {
            names.emplace_back(trimmed(line.substr(word.size())));
        }
        begin = end + 1;
    }
    return names;
}

std::string literal(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        result += c == '"' || c == '\\' ? "\\" : "";
        result += c;
    }
    return result + "\"";
}

/// As few digits as a float needs.
std::string number(float value) {
    return fmt::format("{}", value);
}
std::string rgb(const tinyobj::real_t* c) {
    return fmt::format("rgb({}, {}, {})", number(c[0]), number(c[1]), number(c[2]));
}
std::string rounded(const Vec3<double>& v) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z);
}
bool is_black(const tinyobj::real_t* c) {
    return c[0] == 0 && c[1] == 0 && c[2] == 0;
}
bool is_white(const tinyobj::real_t* c) {
    return c[0] == 1 && c[1] == 1 && c[2] == 1;
}

class SceneWriter {
public:
    SceneWriter(const fs::path& folder, std::string_view mesh_file, std::vector<std::string>& warnings)
        : folder_(folder), mesh_file_(mesh_file), warnings_(warnings) {}

    std::string write(std::string_view text) {
        loaded_ = parse_obj(text, MeshNormals::file);
        warnings_ = loaded_.warnings;
        read_libraries(library_names(text));
        out_.line("// Imported from {} (Wavefront OBJ). Camera and lights are a beginning{}",
                  comment_text(mesh_file_.filename().string()),
                  materials_.empty() ? "." : "; materials are those of");
        if (!materials_.empty()) {
            out_.line("// its library, as far as they go.");
        }
        out_.blank();
        write_view();
        write_meshes();
        out_.blank();
        out_.line("render {{ file = {}, size = (640, 480), method = ray {{ samples = 4 }} }}",
                  literal(picture_name()));
        return out_.take();
    }

private:
    void read_libraries(const std::vector<std::string>& names) {
        for (const std::string& name : names) {
            const fs::path library = file_within(folder_, name);
            std::ifstream stream(folder_ / library, std::ios::binary);
            if (library.empty() || !stream) {
                warnings_.push_back(fmt::format("the material library `{}` is not in the folder", name));
                continue;
            }
            std::map<std::string, int> numbers;
            std::vector<material_t> materials;
            std::string warning, error;
            tinyobj::LoadMtl(&numbers, &materials, &stream, &warning, &error);
            for (const material_t& material : materials) { // `usemtl` names them up to a blank
                materials_.emplace(material.name.substr(0, material.name.find_first_of(" \t\r")), material);
            }
        }
    }

    std::string picture_name() const {
        std::string stem = mesh_file_.stem().string();
        std::replace_if(
            stem.begin(), stem.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; }, '_');
        return stem + ".png";
    }

    void write_view() {
        const runtime::Bounds<double>& box = loaded_.mesh.box;
        const Vec3<double> center = box.center();
        const double radius = length(box.max - center);
        const double distance = 1.05 * radius / std::sin(fov_y / 2 * std::numbers::pi / 180);
        const Vec3<double> eye = center + distance * normalize(Vec3<double>{0.6, 0.45, 1});
        out_.line("world {{ ambient = rgb(0.2, 0.2, 0.2), background = #30363c }}");
        out_.line("perspective_camera {{ eye = {}, target = {}, fov_y = {}deg }}", rounded(eye),
                  rounded(center), fov_y);
        out_.line("directional_light {{ towards = (2, 3, 3), color = rgb(0.8, 0.8, 0.8) }}");
        out_.line("directional_light {{ towards = (-3, 1, 1), color = rgb(0.2, 0.2, 0.25) }}");
        out_.blank();
    }

    void write_meshes() {
        if (loaded_.parts.empty()) {
            out_.line("mesh {{ file = {} }}", literal(mesh_file_.string()));
            return;
        }
        Identifiers identifiers("mtl_");
        std::string meshes;
        const std::set<std::uint32_t> used(loaded_.part_of.begin(), loaded_.part_of.end());
        for (const std::uint32_t part : used) {
            const std::string& name = loaded_.parts[part];
            const auto material = materials_.find(name);
            std::string field;
            if (material != materials_.end()) {
                const std::string identifier = identifiers.make(name);
                write_material(material->second, identifier);
                field = ", material = " + identifier;
            } else if (name != unnamed_part) {
                warnings_.push_back(fmt::format("no library describes the material `{}`", name));
            }
            meshes += fmt::format("mesh {{ file = {}, part = {}{} }}\n", literal(mesh_file_.string()),
                                  literal(name), field);
        }
        out_.blank();
        meshes.pop_back(); // the last line's end
        out_.raw_line(meshes);
    }

    void write_material(const material_t& m, const std::string& identifier) {
        const std::string image = write_image(m, identifier);
        out_.line("let {} = phong {{", identifier);
        out_.indent();
        if (image.empty()) {
            out_.line("diffuse = {}", rgb(m.diffuse));
        } else if (is_white(m.diffuse)) {
            out_.line("diffuse = fn(s: surface) = {}(s.uv)", image);
        } else {
            out_.line("diffuse = fn(s: surface) = {} * {}(s.uv)", rgb(m.diffuse), image);
        }
        const bool shines = m.illum >= 2 || m.illum == 0; // 0 stands for a file that does not say
        if (shines && !is_black(m.specular) && m.shininess > 0) {
            out_.line("specular = {}", rgb(m.specular));
            out_.line("shininess = {}", number(m.shininess));
        }
        if (!is_black(m.emission)) {
            out_.line("emission = {}", rgb(m.emission));
        }
        const bool mirrors = m.illum == 3 || m.illum == 5;
        if (mirrors && !is_black(m.specular)) {
            out_.line("reflect = {}", rgb(m.specular));
        }
        if (m.dissolve < 1) {
            out_.line("opacity = {}", number(std::max(m.dissolve, 0.0F)));
            if (m.ior != 1) {
                remark(m, fmt::format("Ni {}: `ior`, if what it encloses is closed", number(m.ior)));
            }
        }
        for (const auto& [word, file] : unused_maps(m)) {
            if (!file.empty()) {
                remark(m, fmt::format("{} {}: not taken over", word, file));
            }
        }
        out_.dedent();
        out_.line("}}");
    }
    static std::vector<std::pair<std::string_view, std::string>> unused_maps(const material_t& m) {
        return {{"map_Ka", m.ambient_texname},
                {"map_Ks", m.specular_texname},
                {"map_Ns", m.specular_highlight_texname},
                {"map_d", m.alpha_texname},
                {"map_Ke", m.emissive_texname},
                {"map_Bump", m.bump_texname},
                {"disp", m.displacement_texname},
                {"norm", m.normal_texname},
                {"refl", m.reflection_texname}};
    }
    void remark(const material_t& m, const std::string& text) {
        out_.line("// {}", comment_text(text));
        warnings_.push_back(fmt::format("material `{}`: {}", m.name, text));
    }

    /// The name of the `let` of the diffuse colour's image; empty: there is none.
    std::string write_image(const material_t& m, const std::string& identifier) {
        if (m.diffuse_texname.empty()) {
            return {};
        }
        const fs::path image = file_within(folder_, m.diffuse_texname);
        const std::string problem = image.empty()              ? "is not in the folder"
                                    : loaded_.mesh.uvs.empty() ? "has no place on faces without `vt`"
                                                               : "";
        if (!problem.empty()) {
            warnings_.push_back(
                fmt::format("material `{}`: the image `{}` {}", m.name, m.diffuse_texname, problem));
            return {};
        }
        out_.line("let {}_image = image {{ file = {} }}", identifier,
                  literal((mesh_file_.parent_path() / image).generic_string()));
        return identifier + "_image";
    }

    const fs::path& folder_;
    fs::path mesh_file_;
    std::vector<std::string>& warnings_;
    LoadedMesh loaded_;
    std::map<std::string, material_t> materials_;
    Writer out_{2};
};

} // namespace

std::string scene_text(std::string_view text, const fs::path& folder, std::string_view mesh_file,
                       std::vector<std::string>& warnings) {
    return SceneWriter(folder, mesh_file, warnings).write(text);
}

} // namespace scc::compiler::obj
