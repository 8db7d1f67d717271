#include "compiler/cli/explain.h"
#include "compiler/cli/needs.h"
#include "compiler/ir/objects.h"
#include "compiler/values.h"
#include "lang/check.h"
#include "lang/schema.h"
#include "runtime/camera.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace scc::cli {

namespace {

using Json = nlohmann::ordered_json;
using runtime::Affine;
using runtime::Camera;
using runtime::Vec3;
using Vec4 = std::array<double, 4>;
using Matrix = std::array<Vec4, 4>; ///< rows

constexpr std::size_t most_models = 24; ///< in text; JSON has all

Matrix matrix_of(const Affine<double>& a) {
    Matrix m{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            m[row][column] = a.m[row][column];
        }
    }
    m[3][3] = 1;
    return m;
}

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            for (std::size_t k = 0; k < 4; ++k) {
                m[row][column] += a[row][k] * b[k][column];
            }
        }
    }
    return m;
}

Vec4 product(const Matrix& a, const Vec4& v) {
    Vec4 result{};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t k = 0; k < 4; ++k) {
            result[row] += a[row][k] * v[k];
        }
    }
    return result;
}

Matrix transposed(const Matrix& a) {
    Matrix m{};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            m[row][column] = a[column][row];
        }
    }
    return m;
}

/// L2: rows u, v, n, each with the eye's own coordinate taken away.
Matrix view_of(const Camera<double>& c) {
    const auto row = [&](const Vec3<double>& axis) {
        return Vec4{axis.x, axis.y, axis.z, -dot(axis, c.eye)};
    };
    return {row(c.u), row(c.v), row(c.n), {0, 0, 0, 1}};
}

/// L3 and L4. With k = half_height and a = width / height, x of the window is X / (k -Z) (parallel: X / k) in
/// half window heights, from whose middle the picture's is 2 shift_x away, and reaches from -a to a.
Matrix projection_of(const Camera<double>& c, double near, double far, double aspect) {
    const double k = c.half_height, depth = far - near;
    if (c.projection == runtime::Projection::perspective) {
        return {{{1 / (aspect * k), 0, 2 * c.shift_x / aspect, 0},
                 {0, 1 / k, 2 * c.shift_y, 0},
                 {0, 0, -(far + near) / depth, -2 * far * near / depth},
                 {0, 0, -1, 0}}};
    }
    return {{{1 / (aspect * k), 0, 0, -2 * c.shift_x / aspect},
             {0, 1 / k, 0, -2 * c.shift_y},
             {0, 0, -2 / depth, -(far + near) / depth},
             {0, 0, 0, 1}}};
}

/// L6: columns from the left, rows from the top, depth 0 to 1.
Matrix viewport_of(int width, int height) {
    const double w = width / 2.0, h = height / 2.0;
    return {{{w, 0, 0, w}, {0, -h, 0, h}, {0, 0, 0.5, 0.5}, {0, 0, 0, 1}}};
}

/// What the author wrote of the camera that the scene is seen by.
struct Author {
    Vec3<double> target, up;
    std::string camera, place;
};
Author author_of(const Loaded& loaded) {
    const compiler::ir::Scene& scene = loaded.scene;
    for (const lang::ThingPtr& item : loaded.module.items) {
        if (item->constructor->type == lang::TypeKind::camera && item->span.file == scene.camera_span.file &&
            item->span.begin == scene.camera_span.begin) {
            return {compiler::to_vec3(*item->get("target")), compiler::to_vec3(*item->get("up")),
                    std::string(item->constructor->name), place_of(loaded, item->span)};
        }
    }
    return {scene.camera.eye - scene.camera.n, scene.camera.v, "a camera that frames everything", ""};
}

struct Model {
    std::string path, place;
    Affine<double> map;
};
std::vector<Model> models_of(const Loaded& loaded) {
    std::vector<Model> models;
    const auto add = [&](const compiler::ir::Object& object) {
        if (!std::holds_alternative<runtime::Csg<double>>(object.shape)) {
            models.push_back({object.path, place_of(loaded, object.span), object.world_from_object});
        }
    };
    compiler::ir::for_each_piece(loaded.scene, add, [&](const compiler::ir::ObjectArray& array) {
        for (const compiler::ir::ObjectColumn& column : array.columns) {
            const std::string last = column.path_of(array.rounds - 1);
            models.push_back({column.path_of(0) + (array.rounds > 1 ? " to " + last : ""),
                              place_of(loaded, column.span_of(0)), column.world_from_object});
        }
    });
    for (const compiler::ir::Object& member : loaded.scene.members) {
        add(member);
    }
    return models;
}

/// What rounding leaves of a number that would be 0 is shown as 0.
std::string text(double v) {
    return fmt::format("{:.6g}", std::abs(v) < 1e-14 ? 0.0 : v);
}
std::string text(const Vec3<double>& v) {
    return fmt::format("({}, {}, {})", text(v.x), text(v.y), text(v.z));
}
std::string text(const Vec4& v) {
    return fmt::format("({}, {}, {}, {})", text(v[0]), text(v[1]), text(v[2]), text(v[3]));
}

/// Both forms beside each other, aligned by columns.
std::string text(const Matrix& m) {
    const auto lines = [](const Matrix& of) {
        std::array<std::size_t, 4> width{};
        for (const Vec4& row : of) {
            for (std::size_t k = 0; k < 4; ++k) {
                width[k] = std::max(width[k], text(row[k]).size());
            }
        }
        std::array<std::string, 4> result;
        for (std::size_t row = 0; row < 4; ++row) {
            result[row] = "[";
            for (std::size_t k = 0; k < 4; ++k) {
                result[row] += fmt::format(" {:>{}}", text(of[row][k]), width[k]);
            }
            result[row] += " ]";
        }
        return result;
    };
    const auto columns = lines(m), rows = lines(transposed(m));
    std::string result = fmt::format("    {:<{}}   {}\n", "M p (columns)", columns[0].size(), "p M (rows)");
    for (std::size_t i = 0; i < 4; ++i) {
        result += fmt::format("    {}   {}\n", columns[i], rows[i]);
    }
    return result;
}

struct Stages {
    Matrix view, projection, viewport;
    Matrix clip_from_world, pixel_from_world;
};

/// A point on its way through the stages.
struct Journey {
    Vec4 world, camera, clip;
    Vec3<double> ndc{};
    Vec4 pixel{};
    bool is_behind = false; ///< w <= 0: the division has no meaning
};
Journey journey_of(const Stages& s, const Vec3<double>& p) {
    Journey j{{p.x, p.y, p.z, 1}, {}, {}};
    j.camera = product(s.view, j.world);
    j.clip = product(s.projection, j.camera);
    j.is_behind = !(j.clip[3] > 0);
    if (!j.is_behind) {
        j.ndc = {j.clip[0] / j.clip[3], j.clip[1] / j.clip[3], j.clip[2] / j.clip[3]};
        j.pixel = product(s.viewport, Vec4{j.ndc.x, j.ndc.y, j.ndc.z, 1});
    }
    return j;
}

// ---- clipping (L5) -------------------------------------------------------------------------------------

constexpr std::array<const char*, 6> plane_names{"L", "R", "B", "T", "N", "F"};

/// Of clip coordinates, from L, R, B, T, N, F: negative beyond the plane.
double inside(std::size_t plane, const Vec4& clip) {
    return clip[3] + (plane % 2 == 0 ? clip[plane / 2] : -clip[plane / 2]);
}

using Outcode = std::array<bool, 6>;
Outcode outcode(const Vec4& clip) {
    Outcode code{};
    for (std::size_t plane = 0; plane < code.size(); ++plane) {
        code[plane] = inside(plane, clip) < 0;
    }
    return code;
}
std::string outside(const Vec4& clip) {
    std::string names;
    const Outcode code = outcode(clip);
    for (std::size_t plane = 0; plane < code.size(); ++plane) {
        names += code[plane] ? plane_names[plane] : "";
    }
    return names;
}

/// A straight piece of a line and what is left of it.
struct ClippedLine {
    std::string place;
    Vec4 from, to;
    Outcode code_from, code_to, both, any;
    double first = 0, last = 1;                       ///< the part inside
    std::vector<std::pair<std::size_t, double>> cuts; ///< a plane, and at which part of the line

    bool is_rejected() const { return std::find(both.begin(), both.end(), true) != both.end(); }
    bool is_accepted() const { return std::find(any.begin(), any.end(), true) == any.end(); }
    bool is_empty() const { return is_rejected() || !(first < last); }
    Vec4 at(double part) const {
        Vec4 point{};
        for (std::size_t i = 0; i < point.size(); ++i) {
            point[i] = from[i] + part * (to[i] - from[i]);
        }
        return point;
    }
};

ClippedLine clip_line(std::string place, const Vec4& from, const Vec4& to) {
    ClippedLine line{std::move(place), from, to, outcode(from), outcode(to), {}, {}, 0, 1, {}};
    for (std::size_t plane = 0; plane < line.any.size(); ++plane) {
        line.both[plane] = line.code_from[plane] && line.code_to[plane];
        line.any[plane] = line.code_from[plane] || line.code_to[plane];
        if (!line.any[plane] || line.both[plane]) {
            continue;
        }
        const double a = inside(plane, from), b = inside(plane, to), part = a / (a - b);
        line.cuts.emplace_back(plane, part);
        (a < 0 ? line.first : line.last) = a < 0 ? std::max(line.first, part) : std::min(line.last, part);
    }
    return line;
}

std::vector<ClippedLine> clipped_lines(const Loaded& loaded, const Matrix& clip_from_world) {
    std::vector<ClippedLine> lines;
    for (const compiler::ir::Polyline& polyline : loaded.scene.polylines) {
        const auto clip = [&](const Vec3<double>& p) {
            return product(clip_from_world, Vec4{p.x, p.y, p.z, 1});
        };
        for (std::size_t i = 1; i < polyline.points.size(); ++i) {
            lines.push_back(clip_line(fmt::format("{}, piece {}", place_of(loaded, polyline.span), i - 1),
                                      clip(polyline.points[i - 1]), clip(polyline.points[i])));
        }
    }
    return lines;
}

std::string text(const Outcode& code) {
    std::string bits;
    for (const bool bit : code) {
        bits += bit ? "1 " : "0 ";
    }
    return bits;
}

/// Where a part of the line is in the picture.
std::string divided(const Vec4& clip) {
    return text(Vec3<double>{clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]});
}

constexpr std::size_t most_lines = 24; ///< in text; JSON has all

std::string lines_text(const Loaded& loaded, const Matrix& clip_from_world) {
    const std::vector<ClippedLine> lines = clipped_lines(loaded, clip_from_world);
    if (lines.empty()) {
        return "";
    }
    std::string out = "\nLINES (L5): the outcodes of both ends, before the division by w\n";
    for (std::size_t i = 0; i < std::min(lines.size(), most_lines); ++i) {
        const ClippedLine& line = lines[i];
        out += fmt::format("  {}\n            L R B T N F\n", line.place);
        out += fmt::format("    from    {} {}\n", text(line.code_from), text(line.from));
        out += fmt::format("    to      {} {}\n", text(line.code_to), text(line.to));
        out += fmt::format("    and     {}\n    or      {}\n", text(line.both), text(line.any));
        if (line.is_rejected()) {
            out += "    trivial reject: both ends are beyond the same plane\n";
            continue;
        }
        if (line.is_accepted()) {
            out += "    trivial accept: neither end is beyond any plane\n";
            continue;
        }
        for (const auto& [plane, part] : line.cuts) {
            out += fmt::format("    meets {} at {} of the way\n", plane_names[plane], text(part));
        }
        out += line.is_empty()
                   ? "    nothing of it is inside\n"
                   : fmt::format("    inside from {} to {}, in NDC from {} to {}\n", text(line.first),
                                 text(line.last), divided(line.at(line.first)), divided(line.at(line.last)));
    }
    if (lines.size() > most_lines) {
        out += fmt::format("  ... and {} more, which --json has\n", lines.size() - most_lines);
    }
    return out;
}

Json lines_json(const Loaded& loaded, const Matrix& clip_from_world) {
    Json lines = Json::array();
    for (const ClippedLine& line : clipped_lines(loaded, clip_from_world)) {
        Json one{{"line", line.place}, {"from", line.from}, {"to", line.to}};
        one["outcode_from"] = outside(line.from);
        one["outcode_to"] = outside(line.to);
        one["decision"] = line.is_rejected() ? "reject" : line.is_accepted() ? "accept" : "clip";
        if (!line.is_empty()) {
            one["inside"] = {line.first, line.last};
            one["clipped_from"] = line.at(line.first);
            one["clipped_to"] = line.at(line.last);
        }
        lines.push_back(std::move(one));
    }
    return lines;
}

// ---- the chapter ---------------------------------------------------------------------------------------

std::string models_text(const Loaded& loaded) {
    const std::vector<Model> models = models_of(loaded);
    std::string out = "MODEL (L1): object coordinates to world coordinates\n";
    std::string standing;
    std::size_t shown = 0;
    for (const Model& model : models) {
        if (model.map == Affine<double>{}) {
            standing += (standing.empty() ? "" : ", ") + model.path;
            continue;
        }
        if (shown++ < most_models) {
            out += fmt::format("  {} ({})\n{}", model.path, model.place, text(matrix_of(model.map)));
        }
    }
    if (shown > most_models) {
        out += fmt::format("  ... and {} more, which --json has\n", shown - most_models);
    }
    constexpr std::size_t longest = 400;
    if (standing.size() > longest) {
        standing = standing.substr(0, standing.find_last_of(',', longest)) + ", ...";
    }
    return out +
           (standing.empty() ? "" : fmt::format("  Described in world coordinates (M = 1): {}\n", standing));
}

std::string journey_text(const Loaded& loaded, const Journey& j, const std::string& what) {
    const compiler::ir::Scene& scene = loaded.scene;
    std::string out = fmt::format("ONE POINT: {}\n", what);
    out += fmt::format("  world     p = {}\n", text(j.world));
    out += fmt::format("  camera    V p = {}\n", text(j.camera));
    out += fmt::format("  clip      P V p = {}\n", text(j.clip));
    if (j.is_behind) {
        return out + "  w is not greater than 0: the point is not in front of the eye, and is clipped away\n";
    }
    const std::string code = outside(j.clip);
    out += fmt::format("  outcode   {} (L5)\n",
                       code.empty() ? "none of L R B T N F: inside" : code + ": outside, clipped away");
    out += fmt::format("  NDC       / w = {}\n", text(j.ndc));
    out += fmt::format("  picture   S = column {}, row {} from the top, depth {}\n", text(j.pixel[0]),
                       text(j.pixel[1]), text(j.pixel[2]));
    const double z = j.camera[2], near = scene.camera.near, far = scene.camera.far;
    if (scene.camera.projection == runtime::Projection::perspective) {
        out += fmt::format("  By similar triangles (L3): P'y = Py near / -Pz = {} * {} / {} = {}; the plane "
                           "at near reaches to "
                           "{}, the part of which is {}\n",
                           text(j.camera[1]), text(near), text(-z), text(j.camera[1] * near / -z),
                           text(near * scene.camera.half_height),
                           text(j.camera[1] / -z / scene.camera.half_height));
        out += fmt::format("  Pseudodepth (L4): z* = ((far + near) z + 2 far near) / ((far - near) z) = {}\n",
                           text(((far + near) * z + 2 * far * near) / ((far - near) * z)));
    }
    out += "  For row vectors read from the left: p V P, the same numbers in a row.\n";
    return out;
}

std::string matrices_text(const Loaded& loaded, const Stages& s, const Author& author, int width, int height,
                          const Journey& journey, const std::string& what) {
    const compiler::ir::Scene& scene = loaded.scene;
    const Camera<double>& c = scene.camera;
    std::string out = fmt::format("scene `{}`, {} x {} pixels, {}{}\n\n"
                                  "Each matrix stands twice: on the left for points as columns, p' = M p, "
                                  "composed from right to left;\n"
                                  "on the right for points as rows, p' = p M, composed from left to right. "
                                  "One is the other's transpose.\n\n",
                                  scene.name, width, height, author.camera,
                                  author.place.empty() ? "" : " (" + author.place + ")");
    out += models_text(loaded);
    out += fmt::format(
        "\nVIEW (L2): world coordinates to the camera's, which sits at the origin and looks down -z\n"
        "  n = normalize(eye - lookAt) = normalize({} - {}) = {}\n"
        "  u = normalize(up x n) = {}\n  v = n x u = {}\n"
        "  the last column is -u.eye, -v.eye, -n.eye\n{}",
        text(c.eye), text(author.target), text(c.n), text(c.u), text(c.v), text(s.view));
    const bool perspective = c.projection == runtime::Projection::perspective;
    const double aspect = static_cast<double>(width) / height;
    out +=
        fmt::format("\nPROJECTION (L3, L4): camera coordinates to clip coordinates; near = {}, far = {}\n  ",
                    text(scene.camera.near), text(scene.camera.far));
    out +=
        perspective
            ? fmt::format("half extents at distance 1: H = tan(fov_y / 2) = {}, W = H width / height = {}\n",
                          text(c.half_height), text(c.half_height * aspect))
            : fmt::format("half extents: H = height / 2 = {}, W = H width / height = {}\n",
                          text(c.half_height), text(c.half_height * aspect));
    if (c.shift_x != 0 || c.shift_y != 0) {
        out += fmt::format("  the window is shifted by ({}, {}) of its height\n", text(c.shift_x),
                           text(c.shift_y));
    }
    out += text(s.projection);
    out += "  Ray casting takes the same W and H but clips by neither near nor far.\n";
    out += "\nVIEWPORT (L6): NDC to pixels, columns from the left, rows from the top, depth 0 to 1\n" +
           text(s.viewport);
    out += "\nCOMPOSED: world to clip, P V\n" + text(s.clip_from_world);
    out += "\nCOMPOSED: world to the picture, S P V, to be divided by w\n" + text(s.pixel_from_world);
    return out + "\n" + journey_text(loaded, journey, what) + lines_text(loaded, s.clip_from_world);
}

Json json_of(const Matrix& m) {
    return {{"column_vectors", m}, {"row_vectors", transposed(m)}};
}
Json json_of(const Vec3<double>& v) {
    return {v.x, v.y, v.z};
}

std::string matrices_json(const Loaded& loaded, const Stages& s, int width, int height, const Journey& j) {
    Json models = Json::array();
    for (const Model& model : models_of(loaded)) {
        models.push_back(
            {{"object", model.path}, {"place", model.place}, {"matrix", json_of(matrix_of(model.map))}});
    }
    Json point{{"world", j.world}, {"camera", j.camera}, {"clip", j.clip}};
    if (!j.is_behind) {
        point["outcode"] = outside(j.clip);
        point["ndc"] = json_of(j.ndc);
        point["picture"] = {j.pixel[0], j.pixel[1], j.pixel[2]};
    }
    const Json json{{"schema", 1},
                    {"scene", loaded.scene.name},
                    {"size", {width, height}},
                    {"near", loaded.scene.camera.near},
                    {"far", loaded.scene.camera.far},
                    {"model", models},
                    {"view", json_of(s.view)},
                    {"projection", json_of(s.projection)},
                    {"viewport", json_of(s.viewport)},
                    {"clip_from_world", json_of(s.clip_from_world)},
                    {"picture_from_world", json_of(s.pixel_from_world)},
                    {"point", point},
                    {"lines", lines_json(loaded, s.clip_from_world)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

std::string explain_matrices(const Loaded& loaded, const ExplainOptions& options) {
    const compiler::ir::Scene& scene = loaded.scene;
    if (scene.camera.projection == runtime::Projection::spherical) {
        throw host::UsageError("--matrices: a spherical camera has none, since straight lines become curves; "
                               "--pixel shows its rays");
    }
    const auto [width, height] =
        options.render.size.value_or(std::pair{scene.settings.width, scene.settings.height});
    const double aspect = static_cast<double>(width) / height;
    Stages s{view_of(scene.camera),
             projection_of(scene.camera, scene.camera.near, scene.camera.far, aspect),
             viewport_of(width, height),
             {},
             {}};
    s.clip_from_world = product(s.projection, s.view);
    s.pixel_from_world = product(s.viewport, s.clip_from_world);
    const Author author = author_of(loaded);
    const Journey journey = journey_of(s, options.point.value_or(author.target));
    return options.json
               ? matrices_json(loaded, s, width, height, journey)
               : matrices_text(loaded, s, author, width, height, journey,
                               options.point ? "the one of --point" : "the camera's target (lookAt)");
}

} // namespace scc::cli
