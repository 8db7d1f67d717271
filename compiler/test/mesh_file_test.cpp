#include "compiler/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace scc::compiler {
namespace {

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvt 0.5 0.25\n";

std::string error_of(const auto& act) {
    try {
        act();
    } catch (const MeshError& error) {
        return error.what();
    }
    return "";
}

std::vector<float> positions_of(const ir::Mesh& mesh) {
    std::vector<float> values;
    for (const std::uint32_t index : mesh.indices) {
        const auto corner = mesh.positions.subspan(std::size_t{3} * index, 3);
        values.insert(values.end(), corner.begin(), corner.end());
    }
    return values;
}

/// Whether the file names a library or not, and whatever stands around the words.
TEST(MeshFile, PartsAreWhatStandsAfterUsemtl) {
    const std::string faces = "f 1 2 5\n  usemtl\tred paint\r\nf 1 2 3 4\n#usemtl no\ng usemtl\nusemtl blue\n"
                              "f 1 1 2\nf 3 4 5\nusemtl red\nf 2 3 5\nusemtl idle\n";
    for (const char* const library : {"", "mtllib none.mtl\n"}) {
        const LoadedMesh loaded = parse_obj(library + corners + faces, MeshNormals::smooth);
        EXPECT_EQ(loaded.parts, (std::vector<std::string>{"red", "blue", "idle", "none"}));
        EXPECT_EQ(loaded.part_of, (std::vector<std::uint32_t>{3, 0, 0, 1, 0}));
        const ir::Mesh blue = select_part(loaded, "blue");
        EXPECT_EQ(positions_of(blue), (std::vector<float>{1, 1, 0, 0, 1, 0, 0, 0, 1}));
        EXPECT_EQ(blue.positions.size(), 9U); // those that it uses
        EXPECT_EQ(blue.normals.size(), 9U);   // of the whole mesh's
        EXPECT_EQ(blue.box.min.z, 0);
        EXPECT_EQ(blue.box.max.y, 1);
        EXPECT_EQ(select_part(loaded, "red").indices.size(), 9U);
        EXPECT_EQ(select_part(loaded, "none").indices.size(), 3U);
        EXPECT_EQ(error_of([&] { select_part(loaded, "idle"); }), "has no triangles in part `idle`");
        EXPECT_EQ(error_of([&] { select_part(loaded, "bleu"); }), "has no part `bleu`; did you mean `blue`?");
        EXPECT_EQ(error_of([&] { select_part(loaded, "roof"); }),
                  "has no part `roof`; it has `red`, `blue`, `idle`, `none`");
    }
    const LoadedMesh whole = parse_obj(corners + "f 1 2 3\n", MeshNormals::flat);
    EXPECT_TRUE(whole.parts.empty());
    EXPECT_EQ(error_of([&] { select_part(whole, "red"); }), "has no parts, for want of a `usemtl`");
}

TEST(MeshFile, PartsKeepNormalsAndTextureCoordinates) {
    const LoadedMesh loaded = parse_obj(
        corners + "usemtl a\nf 1/1/1 2/1/1 3/1/1\nusemtl b\nf 1/1/1 3/1/1 4/1/1\n", MeshNormals::file);
    const ir::Mesh b = select_part(loaded, "b");
    EXPECT_EQ(b.normal_indices.size(), 3U);
    EXPECT_EQ(b.normals[2], 1);
    EXPECT_EQ(b.uv_indices.size(), 3U);
    EXPECT_EQ(b.uvs[1], 0.25F);
}

/// The file's own line, not that of what the reader is given.
TEST(MeshFile, ErrorsNameTheFilesLine) {
    for (const char* const part : {"", "usemtl a\n"}) {
        const std::string text = part + corners + "f 1 2 0\n";
        const std::string line = std::to_string(std::count(text.begin(), text.end(), '\n'));
        const std::string error = error_of([&] { parse_obj(text, MeshNormals::flat); });
        EXPECT_NE(error.find("line " + line), std::string::npos) << error;
    }
}

} // namespace
} // namespace scc::compiler
