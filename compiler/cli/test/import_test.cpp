#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

/// Scenes from other formats.
namespace scc::cli::test {
namespace {

const std::string small_nff = "v\nfrom 0 -5 2\nat 0 0 0\nup 0 0 1\nangle 40\nhither 1\nresolution 32 24\n"
                              "l 3 -4 5\nf 1 0.5 0.2 0.8 0.2 20 0.5 1.5\ns 0 0 0 1\n"
                              "f 1 0.5 0.2 0.8 0.2 20 0 1\nc 2 0 0 0.5 2 0 1 0\n";

TEST_F(CommandLine, ImportsAndRenders) {
    write("a.nff", small_nff);
    const auto result = scc({"import", "nff", "a.nff", "-o", "a.scn"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err,
              "a.nff:6:1: warning: hither = 1: ray casting also shows what is nearer than that\n");
    EXPECT_EQ(scc({"import", "nff", "a.nff", "-o", "-"}).out, read("a.scn"));
    EXPECT_TRUE(scc({"check", "--strict", "a.scn"}).ok());
    const auto render = scc({"render", "a.scn", "-o", "a.png", "--stats", "-"});
    ASSERT_TRUE(render.ok()) << render.err;
    EXPECT_EQ(nlohmann::json::parse(render.out)["rays"]["primary"], 32 * 24);
}

TEST_F(CommandLine, RefusesToImportWhatIsWrong) {
    write("a.nff", small_nff + "s 0 0 0 -1\n");
    const auto wrong = scc({"import", "nff", "a.nff", "-o", "a.scn"});
    EXPECT_EQ(wrong.code, 1);
    EXPECT_EQ(wrong.err.find("a.nff:13:9: error: the radius is -1; "), 0U) << wrong.err;
    EXPECT_EQ(scc({"import", "nff", "none.nff", "-o", "a.scn"}).code, 3);
    EXPECT_EQ(files(), (std::vector<std::string>{"a.nff"}));
    write("a.nff", small_nff);
    EXPECT_EQ(scc({"import", "nff", "a.nff", "-o", "no/such/folder/a.scn"}).code, 3);
    EXPECT_EQ(scc({"import", "nff", "a.nff", "-o", "/dev/full"}).code, 3);
}

TEST_F(CommandLine, WarnsOfManyThingsWithoutFillingTheScreen) {
    std::string text = small_nff;
    for (int i = 0; i < 100; ++i) {
        text += "p 3\n0 0 0\n1 1 1\n2 2 2\n";
    }
    write("a.nff", text);
    const auto result = scc({"import", "nff", "a.nff", "-o", "a.scn"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 21);
    EXPECT_NE(result.err.find("and 81 more; comments in the scene say which\n"), std::string::npos);
}

const std::string small_obj =
    "mtllib small.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
    "usemtl brick\nf 1/1 2/2 3/3\nusemtl pane\nf 1/1 3/2 4/3\nusemtl rust\nf 1/1 4/2 2/3\n";
const std::string small_mtl =
    "newmtl brick\nKd 0.5 0.25 0.125\nmap_Kd bricks/wall.pgm\nmap_Bump wall.pgm\n\n"
    "newmtl pane\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 60\nKe 0 0 0.5\nNi 1.5\nd 0.25\n"
    "illum 3\n\nnewmtl unused\nKd 1 1 1\nmap_Kd none.png\n";

TEST_F(CommandLine, ImportsAMeshWithItsMaterials) {
    write("small.obj", small_obj);
    write("small.mtl", small_mtl);
    std::filesystem::create_directories(path("bricks"));
    write("bricks/wall.pgm", "P2 2 2 255\n255 0 0 255\n");
    const auto result = scc({"import", "obj", "small.obj", "-o", "small.scn"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err,
              "small.obj: warning: material `brick`: map_Bump wall.pgm: not taken over\n"
              "small.obj: warning: material `pane`: Ni 1.5: `ior`, if what it encloses is closed\n"
              "small.obj: warning: no library describes the material `rust`\n");
    EXPECT_EQ(
        read("small.scn"),
        R"(// Imported from small.obj (Wavefront OBJ). Camera and lights are a beginning; materials are those of
// its library, as far as they go.

world { ambient = rgb(0.2, 0.2, 0.2), background = #30363c }
perspective_camera { eye = (1.952, 1.589, 2.919), target = (0.5, 0.5, 0.5), fov_y = 35deg }
directional_light { towards = (2, 3, 3), color = rgb(0.8, 0.8, 0.8) }
directional_light { towards = (-3, 1, 1), color = rgb(0.2, 0.2, 0.25) }

let mtl_brick_image = image { file = "bricks/wall.pgm" }
let mtl_brick = phong {
  diffuse = fn(s: surface) = rgb(0.5, 0.25, 0.125) * mtl_brick_image(s.uv)
  // map_Bump wall.pgm: not taken over
}
let mtl_pane = phong {
  diffuse = rgb(0.1, 0.2, 0.3)
  specular = rgb(0.5, 0.5, 0.5)
  shininess = 60
  emission = rgb(0, 0, 0.5)
  reflect = rgb(0.5, 0.5, 0.5)
  opacity = 0.25
  // Ni 1.5: `ior`, if what it encloses is closed
}

mesh { file = "small.obj", part = "brick", material = mtl_brick }
mesh { file = "small.obj", part = "pane", material = mtl_pane }
mesh { file = "small.obj", part = "rust" }

render { file = "small.png", size = (640, 480), method = ray { samples = 4 } }
)");
    EXPECT_EQ(scc({"fmt", "--check", "small.scn"}).out, "");
    EXPECT_TRUE(scc({"check", "--strict", "small.scn"}).ok());
    EXPECT_TRUE(scc({"render", "small.scn", "-o", "small.png", "--size", "32x24"}).ok());

    // From a folder below, and from another one.
    std::filesystem::create_directories(path("meshes"));
    write("meshes/small.obj", small_obj);
    EXPECT_NE(scc({"import", "obj", "meshes/small.obj", "-o", "a.scn"})
                  .err.find("`small.mtl` is not in the folder"),
              std::string::npos);
    EXPECT_TRUE(scc({"check", "a.scn"}).ok());
    std::filesystem::create_directories(path("other"));
    const auto elsewhere = scc({"import", "obj", "small.obj", "-o", "other/small.scn"});
    EXPECT_NE(elsewhere.err.find("it needs `--asset-path "), std::string::npos) << elsewhere.err;
    EXPECT_TRUE(scc({"check", "other/small.scn", "--asset-path", path(".")}).ok());
}

TEST_F(CommandLine, SaysWhatAnImportedMeshLacks) {
    write("small.obj", small_obj);
    const auto without = scc({"import", "obj", "small.obj", "-o", "-"});
    EXPECT_NE(without.err.find("the material library `small.mtl` is not in the folder\n"), std::string::npos);
    EXPECT_NE(without.out.find("mesh { file = \"small.obj\", part = \"pane\" }\n"), std::string::npos);
    write("small.mtl", "newmtl brick\nmap_Kd ../../etc/wall.png\nnewmtl pane\nKd 1 2\nnewmtl rust\n");
    const auto outside = scc({"import", "obj", "small.obj", "-o", "a.scn"});
    EXPECT_NE(outside.err.find("the image `../../etc/wall.png` is not in the folder\n"), std::string::npos);
    EXPECT_TRUE(scc({"check", "a.scn"}).ok());
    write("cut.obj", small_obj.substr(0, small_obj.find("2/2 3/3")));
    const auto cut = scc({"import", "obj", "cut.obj", "-o", "cut.scn"});
    EXPECT_EQ(cut.code, 1);
    EXPECT_EQ(cut.err,
              "cut.obj: error: line 10 is a face with fewer than three corners; is the file cut short?\n");
    EXPECT_EQ(scc({"import", "obj", "none.obj", "-o", "none.scn"}).code, 3);
    EXPECT_FALSE(exists("cut.scn") || exists("none.scn"));
    write("wrong.scn", "mesh { file = \"small.obj\", part = \"brik\" }\nperspective_camera { }\n");
    EXPECT_NE(scc({"check", "wrong.scn"})
                  .err.find("wrong.scn:1:35: error: `small.obj`: has no part `brik`; did you "
                            "mean `brick`? [broken-mesh]"),
              std::string::npos);
}

} // namespace
} // namespace scc::cli::test
