#include "compiler/mesh_cache.h"

#include "runtime/host/checksum.h"
#include "runtime/host/file.h"
#include "runtime/host/values.h"

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scc::compiler {

namespace {

// To be raised when the same file gives other values than before, or they are laid out otherwise.
constexpr std::string_view mesh_format = "mesh 3", hierarchy_format = "hierarchy 2";

/// Below this, parsing takes about as long as finding.
constexpr std::uintmax_t smallest_kept_file = 32 * 1024;

/// Two sums over a text that comes in parts; the parts' lengths are in them.
class ContentSum {
public:
    void add(std::string_view part) {
        for (std::uint64_t& sum : sums_) {
            sum = host::checksum(part, sum);
        }
    }
    std::string key(MeshNormals normals) const {
        const std::string_view sums(reinterpret_cast<const char*>(sums_.data()), sizeof sums_);
        return host::cache_key({mesh_format, std::to_string(static_cast<int>(normals)), sums});
    }
    static constexpr std::size_t part_size = std::size_t{1} << 18; ///< stays in the processor's cache

private:
    std::array<std::uint64_t, 2> sums_{1, 2};
};

/// Read in parts and not mapped: a file that is cut meanwhile gives another sum and no crash.
std::string key_of_file(const std::filesystem::path& path, MeshNormals normals) {
    std::ifstream stream(path, std::ios::binary);
    std::vector<char> part(ContentSum::part_size);
    ContentSum sum;
    while (stream.read(part.data(), static_cast<std::streamsize>(part.size())) || stream.gcount() > 0) {
        sum.add({part.data(), static_cast<std::size_t>(stream.gcount())});
    }
    return sum.key(normals);
}

std::string key_of_text(std::string_view text, MeshNormals normals) {
    ContentSum sum;
    for (; !text.empty(); text.remove_prefix(std::min(text.size(), ContentSum::part_size))) {
        sum.add(text.substr(0, ContentSum::part_size));
    }
    return sum.key(normals);
}

void store_mesh(const LoadedMesh& loaded) {
    const ir::Mesh& mesh = loaded.mesh;
    host::ValuesWriter values;
    values.reserve(mesh.positions.size_bytes() + mesh.normals.size_bytes() + mesh.indices.size_bytes() +
                   mesh.normal_indices.size_bytes() + mesh.uvs.size_bytes() + mesh.uv_indices.size_bytes() +
                   sizeof(std::uint32_t) * loaded.part_of.size() + 4096);
    values.add(static_cast<std::uint64_t>(loaded.warnings.size()));
    for (const std::string& warning : loaded.warnings) {
        values.add_text(warning);
    }
    values.add(mesh.box);
    values.add(mesh.positions);
    values.add(mesh.normals);
    values.add(mesh.indices);
    values.add(mesh.normal_indices);
    values.add(mesh.uvs);
    values.add(mesh.uv_indices);
    values.add(static_cast<std::uint64_t>(loaded.parts.size()));
    for (const std::string& part : loaded.parts) {
        values.add_text(part);
    }
    values.add(std::span<const std::uint32_t>(loaded.part_of));
    mesh.cache.store("meshes", mesh.key, values.take_unsealed());
}

std::optional<LoadedMesh> find_mesh(const host::Cache& cache, const std::string& key) {
    std::optional<host::Cache::Entry> entry = cache.find("meshes", key);
    if (!entry) {
        return std::nullopt;
    }
    try {
        host::Values values = host::Values::unsealed(entry->content(), "the cache");
        LoadedMesh loaded;
        std::uint64_t warnings = 0;
        values.read(warnings);
        for (std::uint64_t i = 0; i < warnings; ++i) {
            loaded.warnings.push_back(values.read_text());
        }
        values.read(loaded.mesh.box);
        values.read(loaded.mesh.positions);
        values.read(loaded.mesh.normals);
        values.read(loaded.mesh.indices);
        values.read(loaded.mesh.normal_indices);
        values.read(loaded.mesh.uvs);
        values.read(loaded.mesh.uv_indices);
        std::uint64_t parts = 0;
        values.read(parts);
        for (std::uint64_t i = 0; i < parts; ++i) {
            loaded.parts.push_back(values.read_text());
        }
        std::span<const std::uint32_t> part_of;
        values.read(part_of);
        loaded.part_of.assign(part_of.begin(), part_of.end());
        loaded.mesh.owner = std::make_shared<const host::Cache::Entry>(std::move(*entry));
        return loaded;
    } catch (const host::FileError&) {
        return std::nullopt; // laid out otherwise
    }
}

/// What a BuiltMesh points to: the normals are the mesh's own.
struct BuiltOwner {
    std::shared_ptr<const void> mesh;
    runtime::MeshStorage storage;
    std::optional<host::Cache::Entry> entry;
};

void store_hierarchy(const host::Cache& cache, const std::string& key, const runtime::MeshData& data) {
    host::ValuesWriter values;
    values.reserve(sizeof(runtime::BvhNode) * data.node_count +
                   sizeof(float) * runtime::triangle_words(data.triangle_count) + 4096);
    values.add(std::vector{data});
    cache.store("hierarchies", key, values.take_unsealed());
}

bool find_hierarchy(const host::Cache& cache, const std::string& key, BuiltOwner& owner,
                    runtime::MeshData& data) {
    owner.entry = cache.find("hierarchies", key);
    if (!owner.entry) {
        return false;
    }
    try {
        std::vector<runtime::MeshData> found;
        host::Values values = host::Values::unsealed(owner.entry->content(), "the cache");
        values.read(found);
        data = found.at(0);
        return true;
    } catch (const std::exception&) {
        return false; // laid out otherwise
    }
}

} // namespace

LoadedMesh load_mesh(const std::filesystem::path& path, MeshNormals normals, const host::Cache& cache) {
    std::error_code error;
    if (!cache.keeps() || std::filesystem::file_size(path, error) < smallest_kept_file || error) {
        return load_obj(path, normals);
    }
    const std::string wanted = key_of_file(path, normals);
    std::optional<LoadedMesh> loaded = find_mesh(cache, wanted);
    if (loaded) {
        loaded->mesh.name = path.stem().string();
        loaded->mesh.key = wanted;
        loaded->mesh.cache = cache;
        return std::move(*loaded);
    }
    {
        const std::string text = read_obj(path);
        loaded = parse_obj(text, normals);
        // Not `wanted`: the file may have been replaced since.
        loaded->mesh.key = key_of_text(text, normals);
    }
    loaded->mesh.name = path.stem().string();
    loaded->mesh.cache = cache;
    store_mesh(*loaded);
    return std::move(*loaded);
}

BuiltMesh build_mesh(const ir::Mesh& mesh, const runtime::BuildOptions& options) {
    const auto owner = std::make_shared<BuiltOwner>();
    owner->mesh = mesh.owner;
    runtime::MeshData data;
    const bool keeps = mesh.cache.keeps() && !mesh.key.empty();
    const std::string key = host::cache_key(
        {hierarchy_format, options.quality == runtime::BuildQuality::quick ? "quick" : "high", mesh.key});
    if (!keeps || !find_hierarchy(mesh.cache, key, *owner, data)) {
        owner->storage = runtime::build_mesh(mesh.positions, mesh.indices, {}, {}, options);
        data = owner->storage.data();
        if (keeps) {
            store_hierarchy(mesh.cache, key, data);
        }
    }
    if (!mesh.normals.empty()) {
        data.normals = mesh.normals.data();
        data.normal_indices = mesh.normal_indices.data();
        data.normal_count = static_cast<std::uint32_t>(mesh.normals.size() / 3);
    }
    if (!mesh.uvs.empty()) {
        data.uvs = mesh.uvs.data();
        data.uv_indices = mesh.uv_indices.data();
        data.uv_count = static_cast<std::uint32_t>(mesh.uvs.size() / 2);
    }
    return {data, owner};
}

} // namespace scc::compiler
