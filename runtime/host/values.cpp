#include "runtime/host/values.h"

#include "runtime/host/checksum.h"
#include "runtime/host/file.h"

#include <utility>

namespace scc::host {

namespace {

/// A table's rows start on a multiple of this, so that vectors may be loaded from a mapped file.
constexpr std::size_t alignment = 64;

/// Rows of an image's table.
constexpr std::size_t decoded_codes = 256;

struct alignas(alignment) TableHead {
    std::uint64_t row_size = 0;
    std::uint64_t rows = 0;
};

struct Seal {
    char magic[8] = {'s', 'c', 'c', ' ', 'v', 'a', 'l', '1'};
    std::uint64_t size = 0; ///< of the values before it
    std::uint64_t checksum = 0;
};

std::size_t aligned(std::size_t size) {
    return (size + alignment - 1) / alignment * alignment;
}

} // namespace

std::byte* ValuesWriter::add_table(std::size_t row_size, std::size_t rows) {
    TableHead head{row_size, rows};
    const std::size_t start = bytes_.size();
    bytes_.resize(start + sizeof head + aligned(row_size * rows));
    std::memcpy(&bytes_[start], &head, sizeof head.row_size + sizeof head.rows); // the rest is padding
    return reinterpret_cast<std::byte*>(bytes_.data()) + start + sizeof head;
}

void ValuesWriter::add(const std::vector<runtime::MeshData>& meshes) {
    add(static_cast<std::uint64_t>(meshes.size()));
    for (const runtime::MeshData& mesh : meshes) {
        const std::size_t normal_indices = mesh.normals != nullptr ? std::size_t{3} * mesh.triangle_count : 0;
        add(std::span(mesh.nodes, mesh.node_count));
        add(std::span(mesh.triangles, runtime::triangle_words(mesh.triangle_count)));
        add(std::span(mesh.normals, std::size_t{3} * mesh.normal_count));
        add(std::span(mesh.normal_indices, normal_indices));
        const std::size_t uv_indices = mesh.uvs != nullptr ? std::size_t{3} * mesh.triangle_count : 0;
        add(std::span(mesh.uvs, std::size_t{2} * mesh.uv_count));
        add(std::span(mesh.uv_indices, uv_indices));
        add(std::span<const float>(mesh.min));
        add(std::span<const float>(mesh.max));
    }
}

void Values::read(std::vector<runtime::MeshData>& meshes) {
    std::uint64_t count = 0;
    read(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        std::span<const runtime::BvhNode> nodes;
        std::span<const float> triangles, normals, uvs;
        std::span<const std::uint32_t> normal_indices, uv_indices;
        read(nodes);
        read(triangles);
        read(normals);
        read(normal_indices);
        read(uvs);
        read(uv_indices);
        runtime::MeshData mesh;
        mesh.nodes = nodes.data();
        mesh.triangles = triangles.data();
        if (!normals.empty()) {
            mesh.normals = normals.data();
            mesh.normal_indices = normal_indices.data();
        }
        if (!uvs.empty()) {
            mesh.uvs = uvs.data();
            mesh.uv_indices = uv_indices.data();
        }
        mesh.uv_count = static_cast<std::uint32_t>(uvs.size() / 2);
        mesh.node_count = static_cast<std::uint32_t>(nodes.size());
        mesh.triangle_count = runtime::triangles_in(triangles.size());
        mesh.normal_count = static_cast<std::uint32_t>(normals.size() / 3);
        read(mesh.min);
        read(mesh.max);
        meshes.push_back(mesh);
    }
}

void ValuesWriter::add(const std::vector<runtime::ImageData>& images) {
    add(static_cast<std::uint64_t>(images.size()));
    for (const runtime::ImageData& image : images) {
        add(std::span(image.codes, image.codes != nullptr ? image.size() : 0));
        add(std::span(image.values, image.codes != nullptr ? 0 : image.size()));
        add(std::span(image.decoded, image.codes != nullptr ? decoded_codes : 0));
        const std::array<std::uint32_t, 5> layout{image.width, image.height, image.channels,
                                                  static_cast<std::uint32_t>(image.wrap),
                                                  static_cast<std::uint32_t>(image.filter)};
        add(std::span<const std::uint32_t>(layout));
        add(std::span<const float>(image.min));
        add(std::span<const float>(image.max));
    }
}

void Values::read(std::vector<runtime::ImageData>& images) {
    std::uint64_t count = 0;
    read(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        std::span<const std::uint8_t> codes;
        std::span<const float> values, decoded;
        std::array<std::uint32_t, 5> layout{};
        runtime::ImageData& image = images.emplace_back();
        read(codes);
        read(values);
        read(decoded);
        read(layout);
        read(image.min);
        read(image.max);
        image.codes = codes.empty() ? nullptr : codes.data();
        image.values = values.empty() ? nullptr : values.data();
        image.decoded = decoded.data();
        image.width = layout[0];
        image.height = layout[1];
        image.channels = layout[2];
        image.wrap = static_cast<runtime::Wrap>(layout[3]);
        image.filter = static_cast<runtime::Filter>(layout[4]);
        if (image.codes != nullptr ? codes.size() != image.size() || decoded.size() != decoded_codes
                                   : values.size() != image.size()) {
            fail("are not those of its code");
        }
    }
}

std::string ValuesWriter::take() {
    Seal seal;
    seal.size = bytes_.size();
    seal.checksum = checksum(bytes_);
    bytes_.append(reinterpret_cast<const char*>(&seal), sizeof seal);
    return std::exchange(bytes_, {});
}

Values::Values(std::span<const std::byte> bytes, std::string owner) : owner_(std::move(owner)) {
    Seal seal;
    const Seal expected;
    if (bytes.size() < sizeof seal) {
        fail("are missing");
    }
    const std::span<const std::byte> before = bytes.first(bytes.size() - sizeof seal);
    std::memcpy(&seal, before.data() + before.size(), sizeof seal);
    if (std::memcmp(seal.magic, expected.magic, sizeof seal.magic) != 0) {
        fail("are missing");
    }
    if (seal.size > before.size()) {
        fail("are cut");
    }
    rest_ = before.last(seal.size);
    if (checksum({reinterpret_cast<const char*>(rest_.data()), rest_.size()}) != seal.checksum) {
        fail("are damaged");
    }
}

Values Values::unsealed(std::string_view bytes, std::string owner) {
    Values values;
    values.rest_ = std::as_bytes(std::span(bytes));
    values.owner_ = std::move(owner);
    return values;
}

const void* Values::next(std::size_t row_size, std::size_t& rows) {
    TableHead head;
    if (rest_.size() < sizeof head) {
        fail("are not those of its code");
    }
    std::memcpy(&head, rest_.data(), sizeof head);
    rest_ = rest_.subspan(sizeof head);
    if (head.row_size != row_size || head.rows > rest_.size() / row_size) {
        fail("are not those of its code");
    }
    const void* data = rest_.data();
    rest_ = rest_.subspan(aligned(head.rows * row_size));
    rows = head.rows;
    return data;
}

const void* Values::next_of(std::size_t row_size, std::size_t rows) {
    std::size_t found = 0;
    const void* data = next(row_size, found);
    if (found != rows) {
        fail("are not those of its code");
    }
    return data;
}

std::string Values::read_text() {
    std::span<const char> text;
    read(text);
    return {text.data(), text.size()};
}

void Values::fail(const char* reason) const {
    throw FileError("the scene's values in `" + owner_ + "` " + reason + "; build the program again");
}

} // namespace scc::host
