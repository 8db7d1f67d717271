#include "compiler/cli/executable.h"
#include "compiler/cli/test/support.h"
#include "runtime/host/png.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

/// What is in the programs that `scc build` makes, and what is made anew and what taken from the cache.
namespace scc::cli::test {
namespace {

namespace fs = std::filesystem;

class BuiltProgram : public CommandLine {
protected:
    /// Its functions' names, not stripped.
    std::string symbols(const std::string& text, std::vector<std::string> options = {}) {
        write("s.scn", text);
        std::vector<std::string> arguments{"build", "s.scn", "-o", "prog"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const auto built = scc(arguments);
        EXPECT_TRUE(built.ok()) << built.err;
        const auto listed = start("nm", {"-C", "prog"});
        EXPECT_TRUE(listed.ok()) << listed.err;
        return listed.out;
    }
    static bool has(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
};

/// A feature, a scene that has it beside spheres, and a name that it brings into the program: that of its
/// table, or of its code where that is not all inlined into the one function that draws.
struct Feature {
    const char* symbol;
    const char* scene;
};
constexpr Feature features[] = {
    {"Scene::bare_triangle", "triangle { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] }\n"},
    {"Scene::bare_plane", "plane { normal = (0, 1, 0) }\n"},
    {"Scene::bare_box", "box { }\n"},
    {"Scene::bare_cylinder", "cylinder { }\n"},
    {"Scene::bare_disc", "disc { }\n"},
    {"RaysInMesh", "mesh { file = \"m.obj\" }\n"},
    {"Scene::function_constants",
     "sphere { material = phong { diffuse = fn(s: surface) = rgb(sin(s.p.x), 0.5, 0.5) } }\n"},
    {"Scene::images", "let q = image { file = \"i.png\" }\n"
                      "sphere { material = phong { diffuse = fn(s: surface) = q(s.uv) } }\n"},
    {"Scene::directional_lights", "directional_light { direction = (0, -1, 0) }\n"},
    {"FreePainter", "render { method = ray { filter = \"mitchell\" } }\n"},
    {"RasterPainter", "render { method = raster { } }\n"},
    {"TilePainter::bend", "let c = perspective_camera { aperture = 0.1 }\nc\nrender { camera = \"c\" }\n"},
};
constexpr const char* mesh_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(BuiltProgram, HoldsNoCodeForWhatItsSceneLacks) {
    const std::string names = symbols(spheres_only, {"--precision", "float"});
    EXPECT_TRUE(has(names, "Scene::bare_sphere"));
    EXPECT_TRUE(has(names, "Pack<float, "));
    for (const Feature& feature : features) {
        EXPECT_FALSE(has(names, feature.symbol)) << feature.symbol;
    }
    for (const char* other :
         {"Pack<double", "BvhBuilder", "traverse", "RaysInTurns", "OpenImageIO", "CLI::", "fmt::"}) {
        EXPECT_FALSE(has(names, other)) << other;
    }
}

// Only the scene can say that its picture keeps no more than 8 bits of each value.
TEST_F(BuiltProgram, IsInFloatForAnEightBitFileOfItsScene) {
    const auto precision = [&](const std::string& render, std::vector<std::string> options = {}) {
        write("s.scn", spheres_only + render);
        std::vector<std::string> arguments{"build", "s.scn", "-o", "prog"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const auto built = scc(arguments);
        EXPECT_TRUE(built.ok()) << built.err;
        const auto drawn = start(path("prog"), {"-o", "s.exr", "--size", "20x20", "--stats", "-"});
        EXPECT_TRUE(drawn.ok());
        const bool warns = has(drawn.err, "note: this program calculates in float");
        const std::string found = nlohmann::json::parse(drawn.out)["precision"];
        EXPECT_EQ(warns, found == "float") << drawn.err;
        return found;
    };
    EXPECT_EQ(precision("render { file = \"s.png\" }"), "float");
    EXPECT_EQ(start(path("prog"), {"-o", "s.png", "--size", "20x20"}).err, "");
    EXPECT_EQ(precision("render { file = \"s.exr\" }"), "double");
    EXPECT_EQ(precision("render { file = \"s.png\" }", {"--precision", "double"}), "double");
}

/// All features in as few programs as can be, since compiling takes its time: a scene has one `render`.
TEST_F(BuiltProgram, HoldsTheCodeForWhatItsSceneHas) {
    write("m.obj", mesh_text);
    write("i.png", host::encode_png(runtime::Image(2, 2)));
    symbols(spheres_only, {"--precision", "float"});
    const std::uint64_t plain = inspect_executable(path("prog")).code_bytes;
    std::vector<const char*> expected;
    std::string scene = spheres_only;
    for (const Feature& feature : features) {
        expected.push_back(feature.symbol);
        scene += feature.scene;
        if (has(feature.scene, "render {")) {
            const std::string names = symbols(scene, {"--precision", "float"});
            for (const char* symbol : expected) {
                EXPECT_TRUE(has(names, symbol)) << symbol;
            }
            EXPECT_GT(inspect_executable(path("prog")).code_bytes, plain);
            expected.clear();
            scene = spheres_only;
        }
    }
    EXPECT_TRUE(expected.empty()) << "the last feature has no `render`";
    std::string many = spheres_only;
    for (int i = 0; i < 20; ++i) {
        many += "sphere { center = (" + std::to_string(i) + ", 3, 0) }\n";
    }
    const std::string names = symbols(many, {"--precision", "double"});
    EXPECT_TRUE(has(names, "BvhBuilder"));
    EXPECT_TRUE(has(names, "Pack<double, "));
}

TEST_F(BuiltProgram, NeedsTheCxxLibraryAloneAndIsSmall) {
    symbols(spheres_only, {"--precision", "float"});
    const Executable program = inspect_executable(path("prog"));
    for (const std::string& library : program.libraries) {
        const bool expected = has(library, "libstdc++.so") || has(library, "libm.so") ||
                              has(library, "libgcc_s.so") || has(library, "libc.so") ||
                              has(library, "ld-linux");
        EXPECT_TRUE(expected) << library;
    }
    EXPECT_GE(program.libraries.size(), 2U);
    EXPECT_LT(fs::file_size(path("prog")), 400'000U);
}

TEST_F(BuiltProgram, WithoutItsValuesSaysSo) {
    symbols(spheres_only);
    const std::string whole = read("prog");
    EXPECT_TRUE(start(path("prog"), {"-o", "a.png", "--size", "8x8"}).ok());
    const auto expect_refusal = [&](const std::string& content, const char* reason) {
        std::ofstream(path("prog"), std::ios::binary | std::ios::trunc) << content;
        const auto result = start(path("prog"), {"-o", "b.png", "--size", "8x8"});
        EXPECT_EQ(result.code, 3);
        EXPECT_EQ(result.err, std::string("error: the scene's values in `this program` ") + reason +
                                  "; build the program again\n");
    };
    expect_refusal(whole.substr(0, whole.size() - 100), "are missing");
    std::string damaged = whole;
    damaged[whole.size() - 200] = static_cast<char>(damaged[whole.size() - 200] ^ 1);
    expect_refusal(damaged, "are damaged");
    EXPECT_FALSE(exists("b.png"));
}

// --target baseline: nothing beyond what every machine of the architecture has, so other statistics but same
// bits.
TEST_F(BuiltProgram, ForAnyMachineDrawsTheSamePicture) {
    write("s.scn", spheres_only);
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "host"}).ok());
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "any", "--target", "baseline"}).ok());
    ASSERT_TRUE(start(path("host"), {"-o", "host.pfm", "--size", "64x48"}).ok());
    const auto drawn = start(path("any"), {"-o", "any.pfm", "--size", "64x48", "--stats", "-"});
    ASSERT_TRUE(drawn.ok());
    EXPECT_TRUE(read("host.pfm") == read("any.pfm"));
#if defined(__x86_64__)
    EXPECT_TRUE(has(drawn.out, "\"isa\": \"sse2\"")) << drawn.out;
#endif
}

TEST_F(BuiltProgram, ReportSaysWhatIsLeftOutAndWhatThatSaves) {
    write("s.scn", spheres_only);
    const auto text = scc({"build", "s.scn", "-o", "prog", "--report"});
    ASSERT_TRUE(text.ok()) << text.err;
    for (const char* part : {"sphere                   s.scn:1\n", "point_lights             s.scn:4\n",
                             "left out\n", "triangle", "code\n", "time per sample\n"}) {
        EXPECT_TRUE(has(text.out, part)) << part << "\n" << text.out;
    }
    const auto json = scc({"build", "s.scn", "-o", "prog", "--report=json"});
    ASSERT_TRUE(json.ok()) << json.err;
    const auto report = nlohmann::json::parse(json.out);
    EXPECT_LT(report["code_bytes"], report["code_bytes_with_everything"]);
    EXPECT_GT(report["ns_per_sample"], 0);
    EXPECT_EQ(report["kept"][0]["asked_for_at"], "s.scn:1");
    EXPECT_EQ(report["precision"], "double");
    EXPECT_TRUE(has(report["precision_reason"], "the scene names no `file`")) << report["precision_reason"];
    EXPECT_EQ(scc({"build", "s.scn", "-o", "-", "--emit", "ir", "--report"}).code, 2);
    EXPECT_EQ(scc({"build", "s.scn", "-o", "prog", "--report=xml"}).code, 2);
}

class BuiltProgramWithParameters : public BuiltProgram {
protected:
    void SetUp() override {
        write("s.scn", "param r: number = 1 in 0.1..3 \"radius\"\nparam n: number = 100 in 1..1000\n"
                       "param tint: color = rgb(0.8, 0.3, 0.2)\n"
                       "for (i in 0..n) { sphere { center = (i, 2, 0), radius = r / 5 } }\n"
                       "sphere { radius = r, material = phong { diffuse = fn(s: surface) = "
                       "tint * (0.5 + 0.5 * sin(9 * s.p.x)) } }\n"
                       "perspective_camera { eye = (0, 1, 7) }\npoint_light { position = (5, 4, 5) }\n");
        const auto built = scc({"build", "s.scn", "-o", "prog", "-D", "n=80"});
        ASSERT_TRUE(built.ok()) << built.err;
    }
    validation::ProcessResult draw(const std::vector<std::string>& definitions) {
        std::vector<std::string> arguments{"-o", "native.pfm", "--size", "32x24"};
        for (const std::string& definition : definitions) {
            arguments.insert(arguments.end(), {"-D", definition});
        }
        return start(path("prog"), arguments);
    }
    void expect_as_rendered(const std::vector<std::string>& definitions) {
        const auto drawn = draw(definitions);
        ASSERT_TRUE(drawn.ok()) << drawn.err;
        std::vector<std::string> arguments{"render", "s.scn", "-o", "generic.pfm", "--size", "32x24"};
        for (const std::string& definition : definitions) {
            arguments.insert(arguments.end(), {"-D", definition});
        }
        const auto rendered = scc(arguments);
        ASSERT_TRUE(rendered.ok()) << rendered.err;
        EXPECT_TRUE(read("native.pfm") == read("generic.pfm"));
    }
};

TEST_F(BuiltProgramWithParameters, DrawsTheSceneWithOtherValues) {
    expect_as_rendered({"n=80"});
    expect_as_rendered({"r=2.5", "n=80"});
    expect_as_rendered({"r=0.5", "n=700", "tint=rgb(0.1, 0.9, 0.4)"});
    fs::remove(path("s.scn")); // it has all it needs
    EXPECT_TRUE(draw({"r=2"}).ok());
}

TEST_F(BuiltProgramWithParameters, KeepsWhatItsSceneImports) {
    fs::create_directory(folder() / "lights");
    write("lights/studio.scn", "import \"../tint.scn\" as tint\nparam power: number = 1\n"
                               "point_light { position = (5, 4, 5), color = power * tint.warm }\n");
    write("tint.scn", "let warm = rgb(1, 0.8, 0.6)\n");
    write("s.scn", "import \"lights/studio.scn\" as studio\nparam n: number = 1\nsphere { }\nstudio.scene\n"
                   "perspective_camera { eye = (0, 1, 7) }\n");
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "prog"}).ok());
    expect_as_rendered({"studio.power=0.5"});
    fs::remove(path("s.scn"));
    fs::remove_all(folder() / "lights");
    EXPECT_TRUE(draw({"studio.power=0.7"}).ok());
    EXPECT_TRUE(read("prog").find(folder().string()) == std::string::npos);
}

TEST_F(BuiltProgramWithParameters, ReadsImagesAgain) {
    runtime::Image image(2, 2);
    image.pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    write("i.png", host::encode_png(image));
    write("s.scn", "param wear: number = 0.7 in 0..1\nlet q = image { file = \"i.png\" }\n"
                   "sphere { material = phong { diffuse = fn(s: surface) = wear * q(s.uv * 3) } }\n"
                   "perspective_camera { eye = (0, 1, 7) }\npoint_light { position = (5, 4, 5) }\n");
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "prog"}).ok());
    expect_as_rendered({"wear=0.2"});
    fs::remove(path("i.png"));
    EXPECT_TRUE(draw({}).ok()) << "the program holds them";
    const auto without = draw({"wear=0.3"});
    EXPECT_EQ(without.code, 1);
    EXPECT_TRUE(has(without.err, "missing-asset")) << without.err;
}

TEST_F(BuiltProgramWithParameters, SaysWhatIsWrongWithTheValues) {
    const auto expect_refusal = [&](const std::string& definition, int code, const std::string& text) {
        const auto drawn = draw({definition});
        EXPECT_EQ(drawn.code, code) << drawn.err;
        EXPECT_TRUE(has(drawn.err, text)) << drawn.err;
        EXPECT_FALSE(exists("native.pfm"));
    };
    expect_refusal("r=5", 1, "-D r:1:1: error: the param `r` is 5; its range is 0.1..3 [value-out-of-range]");
    expect_refusal("rr=1", 1, "the scene has no param of this name");
    expect_refusal("tint=1", 1, "error: ");
    expect_refusal("tint", 2, "`-D tint` is not name=value");
    expect_refusal("n=3", 2, "with these values the scene needs other code");
}

TEST_F(BuiltProgramWithParameters, ListsThemInItsHelp) {
    const auto help = start(path("prog"), {"--help"});
    EXPECT_TRUE(help.ok());
    EXPECT_TRUE(has(help.out, "  -D NAME=VALUE ")) << help.out;
    EXPECT_TRUE(
        has(help.out, "\nParameters:\n  r: number = 1 in 0.1..3  // radius\n  n: number = 100 in 1..1000\n"))
        << help.out;
    symbols(spheres_only);
    EXPECT_FALSE(has(start(path("prog"), {"--help"}).out, "-D"));
    EXPECT_EQ(draw({"r=1"}).code, 2);
}

class CodeCache : public BuiltProgram {
protected:
    using Environment = std::vector<std::pair<std::string, std::string>>;
    Environment own() const {
        return {{"XDG_CACHE_HOME", path("cache")}, {"SCC_CACHE", ""}, {"SCC_CACHE_SIZE", ""}};
    }

    validation::ProcessResult build(const std::string& scene, const std::string& program,
                                    const Environment& environment) {
        write(scene + ".scn", texts_.at(scene));
        return scc({"build", scene + ".scn", "-o", program}, environment);
    }
    std::vector<fs::path> entries(const char* kind) const {
        std::vector<fs::path> found;
        if (fs::exists(folder() / "cache/scc" / kind)) {
            for (const auto& entry : fs::directory_iterator(folder() / "cache/scc" / kind)) {
                found.push_back(entry.path());
            }
        }
        return found;
    }
    /// The program draws what the generic renderer draws.
    void expect_right(const std::string& scene, const std::string& program) {
        ASSERT_TRUE(start(path(program), {"-o", "native.pfm", "--size", "32x24"}).ok());
        ASSERT_TRUE(scc({"render", scene + ".scn", "-o", "generic.pfm", "--size", "32x24"}).ok());
        EXPECT_TRUE(read("native.pfm") == read("generic.pfm"));
    }

private:
    const std::map<std::string, std::string> texts_{
        {"s", spheres_only},
        {"numbers",
         "sphere { center = (0, 1, 0), radius = 0.5, material = phong { diffuse = rgb(0.1, 0.2, 0.9) } }\n"
         "sphere { center = (1, 0, 0), material = phong { diffuse = rgb(0.9, 0.8, 0.2) } }\n"
         "perspective_camera { eye = (1, 0, 7) }\npoint_light { position = (5, 4, 5) }\n"},
        {"structure", std::string(spheres_only) + "plane { }\n"}};
};

TEST_F(CodeCache, ChangedNumbersUseTheSameCodeAndAChangedStructureIsCompiled) {
    ASSERT_TRUE(build("s", "first", own()).ok());
    EXPECT_EQ(entries("code").size(), 1U);
    EXPECT_EQ(entries("headers").size(), 1U);
    ASSERT_TRUE(build("numbers", "second", own()).ok());
    EXPECT_EQ(entries("code").size(), 1U) << "the numbers made another program";
    expect_right("numbers", "second");
    ASSERT_TRUE(build("structure", "third", own()).ok());
    EXPECT_EQ(entries("code").size(), 2U);
    EXPECT_EQ(entries("headers").size(), 1U);
    expect_right("structure", "third");
}

TEST_F(CodeCache, BuildsAtTheSameTimeAreAllRight) {
    std::vector<std::thread> builds;
    std::vector<validation::ProcessResult> results(3);
    write("s.scn", spheres_only);
    for (std::size_t i = 0; i < results.size(); ++i) {
        builds.emplace_back([&, i] {
            results[i] = scc({"build", "s.scn", "-o", "prog" + std::to_string(i)}, own());
        });
    }
    for (std::thread& one : builds) {
        one.join();
    }
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_TRUE(results[i].ok()) << results[i].err;
        expect_right("s", "prog" + std::to_string(i));
    }
    EXPECT_EQ(entries("code").size(), 1U);
}

TEST_F(CodeCache, DamagedEntriesAreMadeAnew) {
    ASSERT_TRUE(build("s", "first", own()).ok());
    for (const char* kind : {"code", "headers"}) {
        for (const fs::path& entry : entries(kind)) {
            std::fstream(entry).seekp(5000).write("damage", 6);
        }
    }
    ASSERT_TRUE(build("s", "second", own()).ok());
    EXPECT_TRUE(read("first") == read("second"));
    expect_right("s", "second");
}

TEST_F(CodeCache, IsNotNeeded) {
    write("in the way", "a file");
    const Environment without[] = {{{"XDG_CACHE_HOME", path("in the way")}},
                                   {{"XDG_CACHE_HOME", "/proc/none"}},
                                   {{"XDG_CACHE_HOME", ""}, {"HOME", ""}},
                                   {{"XDG_CACHE_HOME", path("cache")}, {"SCC_CACHE", "off"}}};
    for (const Environment& environment : without) {
        const auto built = build("s", "prog", environment);
        EXPECT_TRUE(built.ok()) << built.err;
    }
    expect_right("s", "prog");
    EXPECT_FALSE(exists("cache"));
}

} // namespace
} // namespace scc::cli::test
