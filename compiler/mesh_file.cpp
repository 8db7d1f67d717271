#include "compiler/mesh_file.h"

#include "lang/nearest.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <istream>
#include <map>
#include <set>
#include <span>
#include <streambuf>
#include <utility>

namespace scc::compiler {

namespace {

struct Vector {
    double x = 0, y = 0, z = 0;
};
Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vector operator*(double s, Vector a) {
    return {s * a.x, s * a.y, s * a.z};
}
double dot(Vector a, Vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Vector a) {
    return std::sqrt(dot(a, a));
}

Vector at(std::span<const float> values, std::uint32_t index) {
    const std::size_t i = 3 * static_cast<std::size_t>(index);
    return {values[i], values[i + 1], values[i + 2]};
}

/// Reads two texts, one after the other, where they lie.
class TextBuffer : public std::streambuf {
public:
    TextBuffer(std::string_view first, std::string_view second) : second_(second) { show(first); }

private:
    void show(std::string_view text) {
        char* begin = const_cast<char*>(text.data()); // read only: no position is ever written to
        setg(begin, begin, begin + text.size());
    }
    int_type underflow() override {
        show(std::exchange(second_, {}));
        return gptr() == egptr() ? traits_type::eof() : traits_type::to_int_type(*gptr());
    }

    std::string_view second_;
};

/// Instead of the material library, which is not read: each name that a `usemtl` has gets its number.
struct PartNumbers : tinyobj::MaterialReader {
    explicit PartNumbers(const std::vector<std::string>& all) : parts(all) {}
    bool operator()(const std::string&, std::vector<tinyobj::material_t>*,
                    std::map<std::string, int>* numbers, std::string*, std::string*) override {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            numbers->emplace(parts[i], static_cast<int>(i));
        }
        return true;
    }
    const std::vector<std::string>& parts;
};

/// What stands after `usemtl`, up to a blank as tinyobjloader has it, in the file's order.
std::vector<std::string> part_names(std::string_view text) {
    constexpr std::string_view word = "usemtl";
    std::vector<std::string> names;
    std::set<std::string_view> known;
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
        const std::size_t before = text.find_last_not_of(" \t", at == 0 ? 0 : at - 1);
        if (at != 0 && before != std::string_view::npos && text[before] != '\n' && text[before] != '\r') {
            continue;
        }
        const std::string_view line = text.substr(at, text.find_first_of("\r\n", at) - at);
        const std::size_t begin = line.find_first_not_of(" \t", word.size());
        if (begin == std::string_view::npos || begin == word.size()) {
            continue;
        }
        const std::string_view name = line.substr(begin, line.find_first_of(" \t", begin) - begin);
        if (known.insert(name).second) {
            names.emplace_back(name);
        }
    }
    return names;
}

struct Parsed {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<float> uvs;
    std::vector<std::string> parts;
    std::vector<tinyobj::shape_t> shapes;

    std::size_t triangles() const {
        std::size_t corners = 0;
        for (const tinyobj::shape_t& shape : shapes) {
            corners += shape.mesh.indices.size();
        }
        return corners / 3;
    }
    /// f(corners of a triangle, its number) for all triangles.
    template <class F>
    void for_each_triangle(F&& f) const {
        std::size_t triangle = 0;
        for (const tinyobj::shape_t& shape : shapes) {
            for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
                f(&shape.mesh.indices[i], triangle++);
            }
        }
    }
    /// Each triangle's part; -1: none.
    std::vector<int> part_numbers() const {
        std::vector<int> numbers;
        for (const tinyobj::shape_t& shape : shapes) {
            numbers.insert(numbers.end(), shape.mesh.material_ids.begin(), shape.mesh.material_ids.end());
        }
        return numbers;
    }
};

// Faces are counted by line, since tinyobjloader skips the ones that it cannot use.
std::size_t broken_face_line(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    std::size_t line = 1;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end - begin >= 2 && text[begin] == 'f' && (text[begin + 1] == ' ' || text[begin + 1] == '\t')) {
            int words = 0;
            bool after_blank = false;
            for (std::size_t i = begin + 1; i < end && words < 3; ++i) {
                const bool is_blank = blank(text[i]);
                words += after_blank && !is_blank ? 1 : 0;
                after_blank = is_blank;
            }
            if (words < 3) {
                return line;
            }
        }
        begin = end + 1;
    }
    return 0;
}

/// What is wrong; empty: nothing.
std::string read(std::istream& stream, Parsed& parsed) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::material_t> materials;
    std::string warning;
    std::string error;
    PartNumbers numbers(parsed.parts);
    if (!tinyobj::LoadObj(&attributes, &parsed.shapes, &materials, &warning, &error, &stream, &numbers, true,
                          false)) {
        error.erase(error.find_last_not_of(" \n") + 1);
        return error.empty() ? "is not a Wavefront OBJ file" : error;
    }
    parsed.positions = std::move(attributes.vertices);
    parsed.normals = std::move(attributes.normals);
    parsed.uvs = std::move(attributes.texcoords);
    return {};
}

Parsed parse(std::string_view text) {
    if (const std::size_t line = broken_face_line(text); line != 0) {
        throw MeshError(
            fmt::format("line {} is a face with fewer than three corners; is the file cut short?", line));
    }
    Parsed parsed;
    parsed.parts = part_names(text);
    // Numbers are given at a `mtllib`, which a file may lack: it gets one more line at the start, and its
    // errors another line's number, which is why they are read without it.
    const std::string library = parsed.parts.empty() ? "" : "mtllib parts\n";
    TextBuffer buffer(library, text);
    std::istream stream(&buffer);
    std::string error = read(stream, parsed);
    if (!error.empty() && !library.empty()) {
        TextBuffer plain("", text);
        std::istream again(&plain);
        error = read(again, parsed);
    }
    if (!error.empty()) {
        throw MeshError(error);
    }
    return parsed;
}

void verify(const Parsed& parsed) {
    if (parsed.triangles() == 0) {
        throw MeshError("has no faces");
    }
    const auto check_finite = [](const std::vector<float>& values, std::size_t size, const char* what) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!std::isfinite(values[i])) {
                throw MeshError(fmt::format("{} {} is not finite", what, i / size + 1));
            }
        }
    };
    check_finite(parsed.positions, 3, "vertex");
    check_finite(parsed.normals, 3, "normal");
    check_finite(parsed.uvs, 2, "texture coordinate");
    const auto vertices = static_cast<int>(parsed.positions.size() / 3);
    const auto normals = static_cast<int>(parsed.normals.size() / 3);
    const auto uvs = static_cast<int>(parsed.uvs.size() / 2);
    parsed.for_each_triangle([&](const tinyobj::index_t* corners, std::size_t triangle) {
        for (const tinyobj::index_t* corner = corners; corner != corners + 3; ++corner) {
            if (corner->vertex_index < 0 || corner->vertex_index >= vertices) {
                throw MeshError(
                    fmt::format("triangle {} uses vertex {}, but there are {}; is the file cut short?",
                                triangle + 1, corner->vertex_index + 1, vertices));
            }
            if (corner->normal_index >= normals) {
                throw MeshError(fmt::format("triangle {} uses normal {}, but there are {}", triangle + 1,
                                            corner->normal_index + 1, normals));
            }
            if (corner->texcoord_index >= uvs) {
                throw MeshError(fmt::format("triangle {} uses texture coordinate {}, but there are {}",
                                            triangle + 1, corner->texcoord_index + 1, uvs));
            }
        }
    });
}

Vector face_normal(const ir::MeshArrays& mesh, std::size_t triangle) {
    const Vector a = at(mesh.positions, mesh.indices[3 * triangle]);
    return cross(at(mesh.positions, mesh.indices[3 * triangle + 1]) - a,
                 at(mesh.positions, mesh.indices[3 * triangle + 2]) - a);
}

double corner_angle(const ir::MeshArrays& mesh, std::size_t triangle, std::size_t corner) {
    const std::uint32_t* index = &mesh.indices[3 * triangle];
    const Vector p = at(mesh.positions, index[corner]);
    const Vector a = at(mesh.positions, index[(corner + 1) % 3]) - p;
    const Vector b = at(mesh.positions, index[(corner + 2) % 3]) - p;
    return std::atan2(length(cross(a, b)), dot(a, b));
}

void append(std::vector<float>& values, Vector v) {
    values.push_back(static_cast<float>(v.x));
    values.push_back(static_cast<float>(v.y));
    values.push_back(static_cast<float>(v.z));
}

void smooth_normals(ir::MeshArrays& mesh) {
    std::vector<Vector> sums(mesh.positions.size() / 3);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const Vector n = face_normal(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector weighted = (corner_angle(mesh, t, k) / length(n)) * n;
            Vector& sum = sums[mesh.indices[3 * t + k]];
            sum = {sum.x + weighted.x, sum.y + weighted.y, sum.z + weighted.z};
        }
    }
    for (const Vector& sum : sums) {
        const double size = length(sum);
        append(mesh.normals, size > 0 ? (1 / size) * sum : Vector{0, 1, 0});
    }
    mesh.normal_indices = mesh.indices;
}

bool file_normals_usable(const Parsed& parsed) {
    bool usable = !parsed.normals.empty();
    parsed.for_each_triangle([&](const tinyobj::index_t* corners, std::size_t) {
        for (std::size_t k = 0; usable && k < 3; ++k) {
            const int normal = corners[k].normal_index;
            usable = normal >= 0 && length(at(parsed.normals, static_cast<std::uint32_t>(normal))) != 0;
        }
    });
    return usable;
}

// Those of all corners: what lacks them in parts has none.
bool has_uvs(const Parsed& parsed) {
    bool all = !parsed.uvs.empty();
    parsed.for_each_triangle([&](const tinyobj::index_t* corners, std::size_t) {
        all = all && corners[0].texcoord_index >= 0 && corners[1].texcoord_index >= 0 &&
              corners[2].texcoord_index >= 0;
    });
    return all;
}

// Returns which triangles were left out because their corners lie on a line.
std::vector<std::size_t> add_triangles(ir::MeshArrays& mesh, const Parsed& parsed, bool with_normals,
                                       bool with_uvs) {
    std::vector<std::size_t> left_out;
    const std::size_t triangles = parsed.triangles();
    mesh.indices.reserve(3 * triangles);
    mesh.normal_indices.reserve(with_normals ? 3 * triangles : 0);
    mesh.uv_indices.reserve(with_uvs ? 3 * triangles : 0);
    parsed.for_each_triangle([&](const tinyobj::index_t* corners, std::size_t triangle) {
        for (std::size_t k = 0; k < 3; ++k) {
            mesh.indices.push_back(static_cast<std::uint32_t>(corners[k].vertex_index));
        }
        if (!(length(face_normal(mesh, mesh.indices.size() / 3 - 1)) > 0)) {
            mesh.indices.resize(mesh.indices.size() - 3);
            left_out.push_back(triangle);
            return;
        }
        for (std::size_t k = 0; with_normals && k < 3; ++k) {
            mesh.normal_indices.push_back(static_cast<std::uint32_t>(corners[k].normal_index));
        }
        for (std::size_t k = 0; with_uvs && k < 3; ++k) {
            mesh.uv_indices.push_back(static_cast<std::uint32_t>(corners[k].texcoord_index));
        }
    });
    return left_out;
}

void name_parts(LoadedMesh& loaded, const Parsed& parsed, const std::vector<std::size_t>& left_out) {
    if (parsed.parts.empty()) {
        return;
    }
    loaded.parts = parsed.parts;
    const std::vector<int> numbers = parsed.part_numbers();
    const auto unnamed = [&] {
        const auto found = std::find(loaded.parts.begin(), loaded.parts.end(), unnamed_part);
        const auto number = static_cast<std::uint32_t>(found - loaded.parts.begin());
        if (found == loaded.parts.end()) {
            loaded.parts.emplace_back(unnamed_part);
        }
        return number;
    };
    auto next_left_out = left_out.begin();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (next_left_out != left_out.end() && *next_left_out == i) {
            ++next_left_out;
        } else {
            loaded.part_of.push_back(numbers[i] < 0 ? unnamed() : static_cast<std::uint32_t>(numbers[i]));
        }
    }
}

/// The rows of `size` numbers that the chosen indices name, each once, and the indices into them.
class Selection {
public:
    Selection(std::span<const float> rows, std::size_t size) : rows_(rows), size_(size) {
        numbers_.resize(rows.size() / size, none);
    }
    void add(std::uint32_t index) {
        std::uint32_t& number = numbers_[index];
        if (number == none) {
            number = static_cast<std::uint32_t>(values.size() / size_);
            const auto row = rows_.subspan(index * size_, size_);
            values.insert(values.end(), row.begin(), row.end());
        }
        indices.push_back(number);
    }
    std::vector<float> values;
    std::vector<std::uint32_t> indices;

private:
    static constexpr std::uint32_t none = ~0U;
    std::span<const float> rows_;
    std::size_t size_;
    std::vector<std::uint32_t> numbers_;
};

} // namespace

std::string read_obj(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!stream || error) {
        throw MeshError("cannot be read");
    }
    std::string text(size, '\0');
    if (!stream.read(text.data(), static_cast<std::streamsize>(size))) {
        throw MeshError("cannot be read");
    }
    return text;
}

LoadedMesh parse_obj(std::string_view text, MeshNormals normals) {
    Parsed parsed = parse(text);
    verify(parsed);

    LoadedMesh result;
    if (text.back() != '\n') {
        result.warnings.push_back("the last line has no end; is the file cut short?");
    }
    ir::MeshArrays mesh;
    mesh.positions = std::move(parsed.positions);
    const bool with_normals = normals == MeshNormals::file && file_normals_usable(parsed);
    const bool with_uvs = has_uvs(parsed);
    const std::vector<std::size_t> left_out = add_triangles(mesh, parsed, with_normals, with_uvs);
    if (!left_out.empty()) {
        result.warnings.push_back(fmt::format("{} of {} triangles have no area and were left out",
                                              left_out.size(), parsed.triangles()));
    }
    name_parts(result, parsed, left_out);
    parsed.shapes.clear();
    if (with_uvs) {
        mesh.uvs = std::move(parsed.uvs);
    }
    if (mesh.indices.empty()) {
        throw MeshError("has no triangle with an area");
    }
    if (with_normals) {
        for (std::uint32_t i = 0; i < parsed.normals.size() / 3; ++i) {
            const Vector n = at(parsed.normals, i);
            const double size = length(n);
            append(mesh.normals, size > 0 ? (1 / size) * n : n);
        }
    } else if (normals == MeshNormals::smooth) {
        smooth_normals(mesh);
    }
    result.mesh = ir::make_mesh("", std::move(mesh));
    return result;
}

LoadedMesh load_obj(const std::filesystem::path& path, MeshNormals normals) {
    LoadedMesh result = parse_obj(read_obj(path), normals);
    result.mesh.name = path.stem().string();
    return result;
}

ir::Mesh select_part(const LoadedMesh& whole, std::string_view part) {
    const auto found = std::find(whole.parts.begin(), whole.parts.end(), part);
    if (found == whole.parts.end()) {
        if (whole.parts.empty()) {
            throw MeshError("has no parts, for want of a `usemtl`");
        }
        const std::vector<std::string_view> names(whole.parts.begin(), whole.parts.end());
        const auto meant = lang::nearest(part, names);
        throw MeshError(meant ? fmt::format("has no part `{}`; did you mean `{}`?", part, *meant)
                              : fmt::format("has no part `{}`; it has `{}`", part, fmt::join(names, "`, `")));
    }
    const auto wanted = static_cast<std::uint32_t>(found - whole.parts.begin());
    const ir::Mesh& mesh = whole.mesh;
    Selection positions(mesh.positions, 3), normals(mesh.normals, 3), uvs(mesh.uvs, 2);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (whole.part_of[i / 3] != wanted) {
            continue;
        }
        positions.add(mesh.indices[i]);
        if (!mesh.normal_indices.empty()) {
            normals.add(mesh.normal_indices[i]);
        }
        if (!mesh.uv_indices.empty()) {
            uvs.add(mesh.uv_indices[i]);
        }
    }
    if (positions.indices.empty()) {
        throw MeshError(fmt::format("has no triangles in part `{}`", part));
    }
    ir::Mesh result =
        ir::make_mesh(fmt::format("{} {}", mesh.name, part), {.positions = std::move(positions.values),
                                                              .normals = std::move(normals.values),
                                                              .uvs = std::move(uvs.values),
                                                              .indices = std::move(positions.indices),
                                                              .normal_indices = std::move(normals.indices),
                                                              .uv_indices = std::move(uvs.indices)});
    result.cache = mesh.cache;
    if (!mesh.key.empty()) {
        result.key = host::cache_key({mesh.key, part});
    }
    return result;
}

} // namespace scc::compiler
