#include "compiler/backends/blender_mesh.h"

#include "compiler/backends/blender_python.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

namespace scc::compiler {

namespace {

constexpr std::size_t longest_list = 120;
constexpr std::size_t line_width = 100;

std::string text(float value) {
    const std::string digits = fmt::format("{}", value);
    return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}
std::string text(std::uint32_t value) {
    return fmt::format("{}", value);
}

template <class Unsigned>
void append_little_endian(std::string& bytes, Unsigned value) {
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
        bytes += static_cast<char>((value >> (8 * i)) & 0xff);
    }
}

struct Packed {
    std::string_view type; ///< numpy's name
    std::string bytes;
};

Packed packed(std::span<const float> values) {
    Packed result{"<f4", {}};
    for (const float value : values) {
        append_little_endian(result.bytes, std::bit_cast<std::uint32_t>(value));
    }
    return result;
}

Packed packed(std::span<const std::uint32_t> values) {
    const bool is_short = std::all_of(values.begin(), values.end(), [](std::uint32_t value) {
        return value <= std::numeric_limits<std::uint16_t>::max();
    });
    Packed result{is_short ? "<u2" : "<u4", {}};
    for (const std::uint32_t value : values) {
        if (is_short) {
            append_little_endian(result.bytes, static_cast<std::uint16_t>(value));
        } else {
            append_little_endian(result.bytes, value);
        }
    }
    return result;
}

void write_packed(Writer& out, std::string_view name, const Packed& array) {
    const std::string digits = base64(array.bytes);
    out.line("{}=unpacked(\"{}\", \"\"\"", name, array.type);
    for (std::size_t i = 0; i < digits.size(); i += line_width) {
        out.raw_line(std::string_view(digits).substr(i, line_width));
    }
    out.line("\"\"\"),");
}

template <class T>
void write_array(Writer& out, std::string_view name, std::span<const T> values) {
    if (values.empty()) {
        return;
    }
    if (values.size() <= longest_list) {
        std::string list;
        for (const T value : values) {
            list += (list.empty() ? "" : ", ") + text(value);
        }
        out.line("{}=[{}],", name, list);
        return;
    }
    write_packed(out, name, packed(values));
}

bool is_long(const ir::Mesh& mesh) {
    return std::max({mesh.positions.size(), mesh.normals.size(), mesh.indices.size(), mesh.uvs.size()}) >
           longest_list;
}

void write_entry(Writer& out, const ir::Mesh& mesh, bool with_uvs, std::span<const std::uint32_t> slots) {
    out.line("{}: dict(", python(mesh.name));
    out.indent();
    write_array(out, "points", mesh.positions);
    write_array(out, "indices", mesh.indices);
    write_array(out, "normals", mesh.normals);
    write_array(out, "normal_indices", mesh.normal_indices);
    if (with_uvs) {
        write_array(out, "uvs", mesh.uvs);
        write_array(out, "uv_indices", mesh.uv_indices);
    }
    write_array(out, "slots", slots);
    out.dedent();
    out.line("),");
}

} // namespace

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k) {
            group = (group << 8) | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            result += k <= count ? digits[(group >> (18 - 6 * k)) & 63] : '=';
        }
    }
    return result;
}

bool needs_packing(const ir::Scene& scene, const BlenderNeeds& needs) {
    const auto is_long_solid = [](const auto& entry) {
        bool result = false;
        for_each_part(entry.second, [&](const BlenderSolid& part) { result = result || is_long(part.mesh); });
        return result;
    };
    if (!needs.images.empty() || std::any_of(needs.solids.begin(), needs.solids.end(), is_long_solid)) {
        return true;
    }
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (needs.meshes[i] && is_long(scene.meshes[i])) {
            return true;
        }
    }
    return false;
}

void write_unpacking(Writer& out) {
    out.blank();
    out.blank();
    out.line("def unpacked(kind, text):");
    out.indent();
    out.line("return np.frombuffer(base64.b64decode(text), kind)");
    out.dedent();
    out.blank();
    out.blank();
}

void write_image(Writer& out, const ir::Image& image, const std::string& key) {
    const runtime::ImageData& data = image.data;
    out.line("{}: dict(size=({}, {}), wrap={}, filter={},", python(key), data.width, data.height,
             data.wrap == runtime::Wrap::repeat ? "\"REPEAT\"" : "\"EXTEND\"",
             data.filter == runtime::Filter::bilinear ? "\"Linear\"" : "\"Closest\"");
    out.indent();
    if (data.codes != nullptr) {
        write_packed(out, "light_of_code", packed(std::span(data.decoded, 256)));
        const std::string_view codes(reinterpret_cast<const char*>(data.codes), data.size());
        write_packed(out, "texels", {"u1", std::string(codes)});
    } else {
        write_packed(out, "texels", packed(std::span(data.values, data.size())));
    }
    out.dedent();
    out.line("),");
}

void write_mesh(Writer& out, const ir::Mesh& mesh, bool with_uvs) {
    write_entry(out, mesh, with_uvs, {});
}

void write_solid(Writer& out, const BlenderSolid& solid) {
    write_entry(out, solid.mesh, false, solid.slots);
}

} // namespace scc::compiler
