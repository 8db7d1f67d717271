#include "compiler/mesh_cache.h"
#include "compiler/test/folder.h"
#include "compiler/test/support.h"
#include "runtime/host/checksum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace scc::compiler {
namespace {

namespace fs = std::filesystem;

/// Large enough to be kept; a square and a triangle without area among its faces.
std::string wavy_grid(int n) {
    std::string text = "# a grid\n";
    for (int i = 0; i < n * n; ++i) {
        const double x = i % n, z = i / n;
        text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", x, std::sin(0.3 * x) * std::cos(0.2 * z), z);
    }
    for (int i = 0; i + 1 < n; ++i) {
        for (int k = 1; k < n; ++k) {
            const int at = i * n + k;
            text += fmt::format("f {} {} {} {}\n", at, at + n, at + n + 1, at + 1);
        }
    }
    return text + "f 1 1 2\n";
}

template <class T>
std::string bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// All that is drawn and said of a mesh, as bytes.
std::string content(const LoadedMesh& loaded, runtime::BuildQuality quality = runtime::BuildQuality::high) {
    const ir::Mesh& mesh = loaded.mesh;
    const BuiltMesh built = build_mesh(mesh, {.threads = 2, .quality = quality});
    const runtime::MeshData& d = built.data;
    std::string text = mesh.name + "\n";
    for (const std::string& warning : loaded.warnings) {
        text += warning + "\n";
    }
    text += bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.indices) +
            bytes_of(mesh.normal_indices) + bytes_of(std::span(&mesh.box, 1));
    text += bytes_of(std::span(d.nodes, d.node_count)) +
            bytes_of(std::span(d.triangles, runtime::triangle_words(d.triangle_count)));
    text += bytes_of(std::span<const float>(d.min)) + bytes_of(std::span<const float>(d.max));
    if (d.normals != nullptr) {
        text += bytes_of(std::span(d.normals, std::size_t{3} * d.normal_count)) +
                bytes_of(std::span(d.normal_indices, std::size_t{3} * d.triangle_count));
    }
    return text;
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    if (fs::exists(folder)) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file()) {
                files.push_back(entry.path());
            }
        }
    }
    return files;
}

class MeshCache : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_ / "cache");
        test::save(file_, wavy_grid(60));
    }
    LoadedMesh load(MeshNormals normals = MeshNormals::smooth) { return load_mesh(file_, normals, cache_); }

    test::Folder folder_;
    fs::path file_ = folder_ / "grid.obj";
    host::Cache cache_{folder_ / "cache", 1U << 30};
};

TEST_F(MeshCache, GivesTheSameBitsAndWarningsAgain) {
    for (const MeshNormals normals : {MeshNormals::file, MeshNormals::flat, MeshNormals::smooth}) {
        const std::string fresh = content(load_obj(file_, normals));
        EXPECT_NE(fresh.find("no area"), std::string::npos);
        EXPECT_EQ(content(load(normals)), fresh);
        const std::size_t kept = files_in(folder_ / "cache").size();
        EXPECT_EQ(content(load(normals)), fresh);
        EXPECT_EQ(files_in(folder_ / "cache").size(), kept);
    }
}

TEST_F(MeshCache, KeepsParts) {
    const std::string grid = wavy_grid(60);
    const std::size_t half = grid.find("\nf ", grid.size() / 2 + grid.size() / 4) + 1;
    test::save(file_, grid.substr(0, half) + "usemtl upper\n" + grid.substr(half));
    const LoadedMesh fresh = load_obj(file_, MeshNormals::smooth);
    EXPECT_EQ(fresh.parts, (std::vector<std::string>{"upper", "none"}));
    load();
    const LoadedMesh kept = load();
    EXPECT_EQ(kept.parts, fresh.parts);
    EXPECT_EQ(kept.part_of, fresh.part_of);
    const ir::Mesh upper = select_part(kept, "upper"), lower = select_part(kept, "none");
    EXPECT_EQ(upper.indices.size() + lower.indices.size(), kept.mesh.indices.size());
    EXPECT_NE(upper.key, lower.key);
    EXPECT_NE(upper.key, kept.mesh.key);
    EXPECT_EQ(build_mesh(upper, {}).data.triangle_count, upper.indices.size() / 3);
    EXPECT_EQ(build_mesh(upper, {}).data.triangle_count, upper.indices.size() / 3); // from the cache
}

TEST_F(MeshCache, HoldsTheMeshUntilItsLastUse) {
    content(load());
    BuiltMesh built;
    {
        const LoadedMesh loaded = load();
        built = build_mesh(loaded.mesh, {});
    }
    EXPECT_EQ(built.data.triangle_count, 2U * 59 * 59);
    EXPECT_NEAR(built.data.normals[1], 1, 0.5);
}

TEST_F(MeshCache, GoesByContentAndNotByName) {
    const std::string first = content(load());
    test::save(folder_ / "other.obj", wavy_grid(60));
    EXPECT_EQ(load_mesh(folder_ / "other.obj", MeshNormals::smooth, cache_).mesh.name, "other");
    EXPECT_EQ(files_in(folder_ / "cache").size(), 2U);
    std::string changed = wavy_grid(60);
    changed[changed.find("0.5")] = '7';
    test::save(file_, changed); // of the same size, perhaps in the same second
    EXPECT_NE(content(load()), first);
    EXPECT_EQ(content(load()), content(load_obj(file_, MeshNormals::smooth)));
}

TEST_F(MeshCache, QualitiesAreKeptApart) {
    const LoadedMesh fresh = load_obj(file_, MeshNormals::flat);
    for (int run = 0; run < 2; ++run) {
        for (const auto quality : {runtime::BuildQuality::quick, runtime::BuildQuality::high}) {
            EXPECT_EQ(content(load(MeshNormals::flat), quality), content(fresh, quality));
        }
    }
}

TEST_F(MeshCache, DamagedEntriesAreMadeAgain) {
    const std::string fresh = content(load());
    for (const fs::path& entry : files_in(folder_ / "cache")) {
        const auto size = fs::file_size(entry);
        {
            std::fstream stream(entry, std::ios::in | std::ios::out | std::ios::binary);
            stream.seekp(static_cast<std::streamoff>(size / 2));
            stream.put('!').put('?');
        }
        EXPECT_EQ(content(load()), fresh) << entry;
        fs::resize_file(entry, size / 3);
        EXPECT_EQ(content(load()), fresh) << entry;
        fs::resize_file(entry, 0);
        EXPECT_EQ(content(load()), fresh) << entry;
        EXPECT_EQ(fs::file_size(entry), size);
        // Whole, but of something else.
        cache_.store(entry.parent_path().filename().string(), entry.filename(), "no tables");
        EXPECT_EQ(content(load()), fresh) << entry;
    }
}

TEST_F(MeshCache, SmallFilesAreReadEachTime) {
    test::save(file_, wavy_grid(5));
    content(load());
    EXPECT_TRUE(files_in(folder_ / "cache").empty());
}

TEST_F(MeshCache, BrokenFilesAreReportedEachTime) {
    test::save(file_, wavy_grid(60) + "f 1 2 999999\n");
    for (int run = 0; run < 2; ++run) {
        EXPECT_THROW(load(), MeshError);
    }
    EXPECT_THROW(load_mesh(folder_ / "none.obj", MeshNormals::flat, cache_), MeshError);
    EXPECT_TRUE(files_in(folder_ / "cache").empty());
}

TEST_F(MeshCache, ServesSeveralAtOnce) {
    const std::string fresh = content(load_obj(file_, MeshNormals::smooth));
    std::vector<int> differing(4, 0);
    {
        std::vector<std::jthread> threads;
        for (int& count : differing) {
            threads.emplace_back([&] {
                for (int run = 0; run < 10; ++run) {
                    count += content(load()) != fresh ? 1 : 0;
                    std::error_code gone;
                    fs::remove_all(folder_ / "cache/hierarchies", gone);
                }
            });
        }
    }
    EXPECT_EQ(differing, std::vector<int>(4, 0));
}

TEST_F(MeshCache, WithoutAFolderNothingIsKept) {
    const LoadedMesh loaded = load_mesh(file_, MeshNormals::smooth, {});
    EXPECT_EQ(content(loaded), content(load_obj(file_, MeshNormals::smooth)));
    EXPECT_TRUE(files_in(folder_ / "cache").empty());
}

// What is kept must be what would be built now. If this fails because meshes are loaded or built otherwise
// than before, raise the format in mesh_cache.cpp, then change the number here.
TEST_F(MeshCache, FormatIsRaisedWithTheBuilder) {
    EXPECT_EQ(host::checksum(content(load_obj(file_, MeshNormals::smooth))), 10054583042194542394U);
}

} // namespace
} // namespace scc::compiler
