#include "compiler/import/nff.h"
#include "compiler/import/triangulate.h"
#include "compiler/shape_rules.h"
#include "compiler/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

template <>
struct fmt::formatter<scc::compiler::nff::Vec3> : fmt::formatter<double> {
    template <class Context>
    auto format(const scc::compiler::nff::Vec3& v, Context& context) const {
        return fmt::format_to(context.out(), "({}, {}, {})", v.x, v.y, v.z);
    }
};
template <>
struct fmt::formatter<scc::compiler::nff::Rgb> : fmt::formatter<double> {
    template <class Context>
    auto format(const scc::compiler::nff::Rgb& c, Context& context) const {
        return fmt::format_to(context.out(), "rgb({}, {}, {})", c.r, c.g, c.b);
    }
};

namespace scc::compiler::nff {

namespace {

// Where the language's cameras end, unless told otherwise.
constexpr double default_far = 1000;

Rgb grey(double x) {
    return {x, x, x};
}

class SceneWriter {
public:
    SceneWriter(const File& file, std::vector<Warning>& warnings) : file_(file), warnings_(warnings) {}

    std::string write(std::string_view name) {
        write_header(name);
        const auto body = file_.items.begin() + static_cast<std::ptrdiff_t>(file_.heading);
        std::for_each(file_.items.begin(), body,
                      [&](const Item& item) { write_comment(std::get<Comment>(item).text); });
        write_settings(name);
        std::for_each(body, file_.items.end(),
                      [&](const Item& item) { std::visit([&](const auto& i) { write_item(i); }, item); });
        close_group();
        write_comments();
        return std::move(out_);
    }

private:
    template <class... Args>
    void line(fmt::format_string<Args...> text, Args&&... args) {
        out_.append(in_body_ ? 2 : 0, ' ');
        fmt::format_to(std::back_inserter(out_), text, std::forward<Args>(args)...);
        out_ += '\n';
    }

    /// Said here and to the user.
    void warn(Place place, const std::string& text) {
        line("// {}", text);
        warnings_.push_back({place, text});
    }

    void write_header(std::string_view name) {
        line("// Imported from {} (Neutral File Format), which leaves shading to the renderer. Here",
             comment_text(name));
        line(
            "//   f r g b Kd Ks Shine: diffuse Kd (r, g, b), white highlight and mirror Ks, exponent Shine;");
        line("//   f ... T ior: what is seen through the surface T, index of refraction ior;");
        line("//   l without a colour: white, 1 / sqrt(number of lights);");
        line("//   ambient light: 0.1 of diffuse; angle: from the picture's lower to its upper edge.");
        out_ += '\n';
    }

    /// The file's name, as far as it can be one everywhere, with another ending.
    static std::string picture_name(std::string_view name) {
        std::string stem(name.substr(0, name.rfind('.')));
        for (char& c : stem) {
            const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
            c = plain || c == '-' || c == '.' ? c : '_';
        }
        return stem + ".png";
    }

    void write_settings(std::string_view name) {
        line("world {{ ambient = {}, background = {} }}", grey(0.1), file_.background.value_or(Rgb{}));
        write_camera();
        write_lights();
        const View& view = file_.view;
        line("render {{ file = \"{}\", size = ({}, {}), method = ray {{ }} }}", picture_name(name),
             view.width, view.height);
    }

    void write_camera() {
        const View& view = file_.view;
        line("perspective_camera {{");
        in_body_ = true;
        line("eye = {}, target = {}, up = {}, fov_y = {}deg", view.from, view.at, view.up, view.angle);
        if (view.hither > 0) {
            warn(view.hither_place,
                 fmt::format("hither = {}: ray casting also shows what is nearer than that", view.hither));
            line("near = {}", view.hither);
            if (view.hither >= default_far) {
                line("far = {}", view.hither * 1000);
            }
        }
        in_body_ = false;
        line("}}");
    }

    void write_lights() {
        const bool some_white = std::any_of(file_.lights.begin(), file_.lights.end(),
                                            [](const Light& light) { return !light.color; });
        if (some_white && file_.lights.size() > 1) {
            line("let intensity = 1 / sqrt({})", file_.lights.size());
        }
        for (const Light& light : file_.lights) {
            if (light.color) {
                line("point_light {{ position = {}, color = {} }}", light.position, *light.color);
            } else if (file_.lights.size() == 1) {
                line("point_light {{ position = {} }}", light.position);
            } else {
                line("point_light {{ position = {}, color = rgb(intensity, intensity, intensity) }}",
                     light.position);
            }
        }
    }

    /// Comments wait for what follows them, but for one that ends a shape's line.
    void write_item(const Comment& comment) {
        if (comment.ends_a_line && in_body_) {
            write_comment(comment.text);
        } else {
            comments_.push_back(comment.text);
        }
    }

    void write_comments() {
        for (const std::string_view text : std::exchange(comments_, {})) {
            write_comment(text);
        }
    }
    void write_comment(std::string_view text) {
        const std::size_t begin = text.find_first_not_of(" \t\r");
        if (begin != std::string_view::npos) {
            const std::size_t end = text.find_last_not_of(" \t\r") + 1;
            line("// {}", comment_text(text.substr(begin, end - begin)));
        }
    }

    void write_item(const Fill& fill) {
        close_group();
        fill_ = &fill;
    }

    /// Before a shape: the group of the last fill.
    void open_group() {
        if (fill_ == nullptr) {
            write_comments();
            return;
        }
        const Fill& f = *fill_;
        const auto [known, is_new] = fills_.try_emplace(
            {f.color.r, f.color.g, f.color.b, f.kd, f.ks, f.shine, f.t, f.ior}, fills_.size() + 1);
        const std::size_t number = known->second;
        out_ += '\n';
        write_comments();
        if (is_new) {
            write_material(f, number);
        }
        line("group {{");
        in_body_ = true;
        line("material = fill_{}", number);
        fill_ = nullptr;
    }
    void close_group() {
        if (in_body_) {
            in_body_ = false;
            line("}}");
        }
    }

    void write_material(const Fill& fill, std::size_t number) {
        std::string diffuse = fmt::format("diffuse = {}", fill.color);
        if (fill.kd != 1) {
            diffuse += fmt::format(" * {}", fill.kd);
        }
        const bool odd_ior = fill.ior != 0 && fill.ior != 1;
        if (fill.ks == 0 && fill.t == 0 && !odd_ior) {
            line("let fill_{} = phong {{ {} }}", number, diffuse);
            return;
        }
        line("let fill_{} = phong {{", number);
        in_body_ = true;
        line("{}", diffuse);
        if (fill.ks > 0) {
            line("specular = {}, shininess = {}, reflect = {}", grey(fill.ks), fill.shine, grey(fill.ks));
        }
        if (fill.t > 0) {
            if (fill.ior <= 0) {
                warn(fill.place, fmt::format("ior = {}: no index of refraction; it is taken as 1", fill.ior));
            }
            line("transmit = {}, ior = {}", grey(fill.t), fill.ior > 0 ? fill.ior : 1.0);
        } else if (odd_ior) {
            warn(fill.place, fmt::format("ior = {}: without transmission it changes nothing", fill.ior));
        }
        in_body_ = false;
        line("}}");
    }

    void write_item(const Sphere& sphere) {
        open_group();
        line("sphere {{ center = {}, radius = {} }}", sphere.center, sphere.radius);
    }

    void write_item(const Cone& cone) {
        open_group();
        if (cone.base_radius == cone.apex_radius) {
            line("cylinder {{ from = {}, to = {}, radius = {}, caps = false }}", cone.base, cone.apex,
                 cone.base_radius);
        } else {
            line("cone {{ from = {}, to = {}, radius_from = {}, radius_to = {}, caps = false }}", cone.base,
                 cone.apex, cone.base_radius, cone.apex_radius);
        }
    }

    void write_item(const Polygon& polygon) {
        open_group();
        corners_.clear();
        normals_.clear();
        const std::size_t step = polygon.is_patch ? 2 : 1;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            corners_.push_back(file_.points[polygon.first + step * i]);
            if (polygon.is_patch) {
                normals_.push_back(file_.points[polygon.first + step * i + 1]);
            }
        }
        const Triangulation cut = triangulate(corners_);
        if (cut.crosses_itself) {
            warn(polygon.place, "this polygon's outline crosses itself; the triangles cover it roughly");
        }
        if (std::any_of(normals_.begin(), normals_.end(), [](const Vec3& n) { return n == Vec3{}; })) {
            warn(polygon.place, "a normal of this patch is 0; it is drawn flat");
            normals_.clear();
        }
        std::size_t written = 0;
        for (const auto& [a, b, c] : cut.triangles) {
            runtime::Triangle<double> triangle;
            triangle.points = {corners_[a], corners_[b], corners_[c]};
            if (!problem(triangle).empty()) {
                continue;
            }
            ++written;
            if (normals_.empty()) {
                line("triangle {{ points = [{}, {}, {}] }}", corners_[a], corners_[b], corners_[c]);
            } else {
                line("triangle {{ points = [{}, {}, {}], normals = [{}, {}, {}] }}", corners_[a], corners_[b],
                     corners_[c], normals_[a], normals_[b], normals_[c]);
            }
        }
        if (written == 0) {
            warn(polygon.place,
                 fmt::format("a polygon of {} corners without area is left out", polygon.count));
        }
    }

    const File& file_;
    std::vector<Warning>& warnings_;
    std::string out_;
    bool in_body_ = false;       ///< between braces, which stand one deep
    const Fill* fill_ = nullptr; ///< of the next shape, if that is the first one to have it
    std::map<std::array<double, 8>, std::size_t> fills_; ///< the numbers in their names
    std::vector<std::string_view> comments_;
    std::vector<Vec3> corners_, normals_;
};

} // namespace

std::string scene_text(const File& file, std::string_view name, std::vector<Warning>& warnings) {
    return SceneWriter(file, warnings).write(name);
}

} // namespace scc::compiler::nff
