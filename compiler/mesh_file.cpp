#include "compiler/mesh_file.h"

#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <cmath>
#include <fstream>
#include <iterator>

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

Vector at(const std::vector<float>& values, std::uint32_t index) {
    const std::size_t i = 3 * static_cast<std::size_t>(index);
    return {values[i], values[i + 1], values[i + 2]};
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream || stream.bad()) {
        throw MeshError("cannot be read");
    }
    return text;
}

// The material library of an OBJ file is not read; a reader that succeeds keeps tinyobjloader from
// complaining.
struct NoMaterials : tinyobj::MaterialReader {
    bool operator()(const std::string&, std::vector<tinyobj::material_t>*, std::map<std::string, int>*,
                    std::string*, std::string*) override {
        return true;
    }
};

struct Corner {
    int vertex = -1;
    int normal = -1;
};

struct Parsed {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<Corner> corners; // three per triangle
};

// Faces are counted by line, since tinyobjloader skips the ones that it cannot use.
std::size_t broken_face_line(const std::string& text) {
    std::size_t line = 1;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end - begin >= 2 && text[begin] == 'f' && (text[begin + 1] == ' ' || text[begin + 1] == '\t')) {
            int words = 0;
            for (std::size_t i = begin + 1; i < end; ++i) {
                const auto blank = [&](std::size_t k) {
                    return text[k] == ' ' || text[k] == '\t' || text[k] == '\r';
                };
                words += !blank(i) && blank(i - 1) ? 1 : 0;
            }
            if (words < 3) {
                return line;
            }
        }
        begin = end + 1;
    }
    return 0;
}

Parsed parse(const std::string& text) {
    if (const std::size_t line = broken_face_line(text); line != 0) {
        throw MeshError(
            fmt::format("line {} is a face with fewer than three corners; is the file cut short?", line));
    }
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning;
    std::string error;
    std::istringstream stream(text);
    NoMaterials no_materials;
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, &no_materials, true,
                          false)) {
        while (!error.empty() && (error.back() == '\n' || error.back() == ' ')) {
            error.pop_back();
        }
        throw MeshError(error.empty() ? "is not a Wavefront OBJ file" : error);
    }
    Parsed parsed;
    parsed.positions.assign(attributes.vertices.begin(), attributes.vertices.end());
    parsed.normals.assign(attributes.normals.begin(), attributes.normals.end());
    for (const tinyobj::shape_t& shape : shapes) {
        for (const tinyobj::index_t& index : shape.mesh.indices) {
            parsed.corners.push_back({index.vertex_index, index.normal_index});
        }
    }
    return parsed;
}

void verify(const Parsed& parsed) {
    if (parsed.corners.empty()) {
        throw MeshError("has no faces");
    }
    const auto check_finite = [](const std::vector<float>& values, const char* what) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!std::isfinite(values[i])) {
                throw MeshError(fmt::format("{} {} is not finite", what, i / 3 + 1));
            }
        }
    };
    check_finite(parsed.positions, "vertex");
    check_finite(parsed.normals, "normal");
    const auto vertices = static_cast<int>(parsed.positions.size() / 3);
    const auto normals = static_cast<int>(parsed.normals.size() / 3);
    for (std::size_t i = 0; i < parsed.corners.size(); ++i) {
        const Corner& corner = parsed.corners[i];
        if (corner.vertex < 0 || corner.vertex >= vertices) {
            throw MeshError(
                fmt::format("triangle {} uses vertex {}, but there are {}; is the file cut short?", i / 3 + 1,
                            corner.vertex + 1, vertices));
        }
        if (corner.normal >= normals) {
            throw MeshError(fmt::format("triangle {} uses normal {}, but there are {}", i / 3 + 1,
                                        corner.normal + 1, normals));
        }
    }
}

Vector face_normal(const ir::Mesh& mesh, std::size_t triangle) {
    const Vector a = at(mesh.positions, mesh.indices[3 * triangle]);
    return cross(at(mesh.positions, mesh.indices[3 * triangle + 1]) - a,
                 at(mesh.positions, mesh.indices[3 * triangle + 2]) - a);
}

double corner_angle(const ir::Mesh& mesh, std::size_t triangle, std::size_t corner) {
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

void smooth_normals(ir::Mesh& mesh) {
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
    if (parsed.normals.empty()) {
        return false;
    }
    for (const Corner& corner : parsed.corners) {
        if (corner.normal < 0 || length(at(parsed.normals, static_cast<std::uint32_t>(corner.normal))) == 0) {
            return false;
        }
    }
    return true;
}

// Returns how many triangles were left out because their corners lie on a line.
std::size_t add_triangles(ir::Mesh& mesh, const Parsed& parsed, bool with_normals) {
    std::size_t dropped = 0;
    for (std::size_t i = 0; i + 2 < parsed.corners.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            mesh.indices.push_back(static_cast<std::uint32_t>(parsed.corners[i + k].vertex));
        }
        if (!(length(face_normal(mesh, mesh.indices.size() / 3 - 1)) > 0)) {
            mesh.indices.resize(mesh.indices.size() - 3);
            ++dropped;
            continue;
        }
        for (std::size_t k = 0; with_normals && k < 3; ++k) {
            mesh.normal_indices.push_back(static_cast<std::uint32_t>(parsed.corners[i + k].normal));
        }
    }
    return dropped;
}

} // namespace

LoadedMesh load_obj(const std::filesystem::path& path, MeshNormals normals) {
    const std::string text = read_text(path);
    const Parsed parsed = parse(text);
    verify(parsed);

    LoadedMesh result;
    if (text.back() != '\n') {
        result.warnings.push_back("the last line has no end; is the file cut short?");
    }
    ir::Mesh& mesh = result.mesh;
    mesh.name = path.stem().string();
    mesh.positions = parsed.positions;
    const bool with_normals = normals == MeshNormals::file && file_normals_usable(parsed);
    if (const std::size_t dropped = add_triangles(mesh, parsed, with_normals); dropped > 0) {
        result.warnings.push_back(fmt::format("{} of {} triangles have no area and were left out", dropped,
                                              parsed.corners.size() / 3));
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
    return result;
}

} // namespace scc::compiler
