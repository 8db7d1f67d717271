#include "compiler/import/nff.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace scc::compiler {
namespace {

namespace fs = std::filesystem;

const std::string view = "v\nfrom 0 -5 2\nat 0 0 0\nup 0 0 1\nangle 40\nhither 0\nresolution 64 48\n";
const std::string fill = "f 1 0.5 0.25 0.8 0.5 20 0 1\n";
const std::string start = view + fill;

std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

struct Imported {
    std::string text;
    std::vector<nff::Warning> warnings;
};
Imported imported(const std::string& text) {
    Imported result;
    result.text = nff::scene_text(nff::parse(text), "test.nff", result.warnings);
    return result;
}

/// The scene that the text stands for; every import is one without complaint.
ir::Scene scene_of(const std::string& text) {
    const Imported result = imported(text);
    test::Compiled compiled = test::compile(result.text);
    EXPECT_TRUE(compiled.fine) << compiled.messages << result.text.substr(0, 2000);
    return std::move(compiled.scene);
}

std::string error_of(const std::string& text) {
    try {
        nff::parse(text);
    } catch (const nff::Error& error) {
        return fmt::format("{}:{}: {}", error.place.line, error.place.column, error.what());
    }
    return "none";
}

template <class Shape>
const Shape& shape(const ir::Scene& scene, std::size_t i) {
    return std::get<Shape>(scene.objects.at(i).shape);
}

using runtime::Rgb;
using Vec3 = runtime::Vec3<double>;

TEST(Nff, TakesTheView) {
    const ir::Scene scene = scene_of("b 0.1 0.2 0.3\n" + start + "s 0 0 0 1\n");
    EXPECT_EQ(scene.background, (Rgb<double>{0.1, 0.2, 0.3}));
    EXPECT_EQ(scene.camera.eye, (Vec3{0, -5, 2}));
    EXPECT_NEAR(scene.camera.half_height, std::tan(20 * 3.14159265358979 / 180), 1e-12);
    EXPECT_EQ(scene.settings.width, 64);
    EXPECT_EQ(scene.settings.height, 48);
    EXPECT_NEAR(scene.camera.v.z, 5 / std::sqrt(29), 1e-12);
}

TEST(Nff, GivesLightsWithoutAColourTheSharesOfTheDatabases) {
    const ir::Scene one = scene_of(start + "l 1 2 3\ns 0 0 0 1\n");
    EXPECT_EQ(std::get<runtime::PointLight<double>>(one.lights.at(0).light).diffuse, (Rgb<double>{1, 1, 1}));
    const ir::Scene scene =
        scene_of(start + "l 1 2 3\nl 4 5 6 0.1 0.2 0.3 # tinted\ns 0 0 0 1\nl 0 0 9\nl 0 9 0\n");
    ASSERT_EQ(scene.lights.size(), 4U);
    const auto light = [&](std::size_t i) {
        return std::get<runtime::PointLight<double>>(scene.lights[i].light);
    };
    EXPECT_EQ(light(0).position, (Vec3{1, 2, 3}));
    EXPECT_EQ(light(0).diffuse, (Rgb<double>{0.5, 0.5, 0.5}));
    EXPECT_EQ(light(1).diffuse, (Rgb<double>{0.1, 0.2, 0.3}));
    EXPECT_EQ(light(3).diffuse, (Rgb<double>{0.5, 0.5, 0.5}));
}

TEST(Nff, TakesEveryShape) {
    const ir::Scene scene = scene_of(start + R"(
s 1 2 3 0.5
c 0 0 0 1  0 0 2 1
c
0 0 0 1
0 0 2 0
p 4
0 0 0
1 0 0
1 1 0
0 1 0
pp 3
0 0 0  0 0 1
1 0 0  0 1 1
0 1 0  1 0 1
)");
    ASSERT_EQ(scene.objects.size(), 6U);
    EXPECT_EQ(shape<runtime::Sphere<double>>(scene, 0).center, (Vec3{1, 2, 3}));
    const auto& cylinder = shape<runtime::Cylinder<double>>(scene, 1);
    EXPECT_EQ(cylinder.to, (Vec3{0, 0, 2}));
    EXPECT_FALSE(cylinder.caps) << "NFF's cones have no end caps";
    const auto& cone = shape<runtime::Cone<double>>(scene, 2);
    EXPECT_EQ(cone.radius_from, 1);
    EXPECT_EQ(cone.radius_to, 0);
    EXPECT_FALSE(cone.caps);
    EXPECT_EQ(shape<runtime::Triangle<double>>(scene, 3).points[2], (Vec3{1, 1, 0}));
    const auto& patch = shape<runtime::Triangle<double>>(scene, 5);
    EXPECT_TRUE(patch.smooth);
    EXPECT_EQ(patch.normals[1], (Vec3{0, 1, 1}));
}

TEST(Nff, SharesTheMaterialsOfEqualFills) {
    const Imported result = imported(start + "s 0 0 0 1\nf 0 0 1 1 0 1 0 0\ns 1 0 0 1\n" + fill +
                                     "s 2 0 0 1\nf 1 1 1 1 1 1 0 0\n");
    const std::string expected = R"(
let fill_1 = phong {
  diffuse = rgb(1, 0.5, 0.25) * 0.8
  specular = rgb(0.5, 0.5, 0.5), shininess = 20, reflect = rgb(0.5, 0.5, 0.5)
}
group {
  material = fill_1
  sphere { center = (0, 0, 0), radius = 1 }
}

let fill_2 = phong { diffuse = rgb(0, 0, 1) }
group {
  material = fill_2
  sphere { center = (1, 0, 0), radius = 1 }
}

group {
  material = fill_1
  sphere { center = (2, 0, 0), radius = 1 }
}
)";
    EXPECT_EQ(result.text.substr(result.text.find("\nlet fill_1")), expected);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(Nff, SaysWhatHasNoCounterpart) {
    const Imported result =
        imported("v\nfrom 0 -5 2\nat 0 0 0\nup 0 0 1\nangle 40\nhither 1.5\nresolution 64 48\n"
                 "f 1 1 1 0.1 0.2 20 0.7 0\ns 0 0 0 1\nf 1 1 1 1 0 1 0 1.3\ns 0 0 0 2\n"
                 "p 3\n0 0 0\n1 1 1\n2 2 2\n"
                 "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 0 0 1\n");
    const std::pair<unsigned, const char*> expected[] = {
        {6, "hither = 1.5: "},
        {8, "ior = 0: "},
        {10, "ior = 1.3: "},
        {12, "a polygon of 3 corners without area is left out"},
        {16, "a normal of this patch is 0"}};
    ASSERT_EQ(result.warnings.size(), std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i) {
        EXPECT_EQ(result.warnings[i].place.line, expected[i].first);
        EXPECT_EQ(result.warnings[i].text.find(expected[i].second), 0U) << result.warnings[i].text;
        EXPECT_NE(result.text.find("  // " + result.warnings[i].text + "\n"), std::string::npos);
    }
    EXPECT_TRUE(test::compile(result.text + "point_light { }\n").fine);
}

TEST(Nff, KeepsCommentsWhereNothingCanLeaveThem) {
    const Imported result = imported("# made by\thand\r\n" + start +
                                     "#\n# first ball */ \\\x01\xe2\x80\xa8 { }\r\n"
                                     "s 0 0 0 1 # its end\n");
    EXPECT_NE(result.text.find("\n// made by?hand\n"), std::string::npos) << result.text;
    EXPECT_NE(result.text.find("\n// first ball *? ????? { }\n"), std::string::npos) << result.text;
    EXPECT_NE(result.text.find("  // its end\n"), std::string::npos) << result.text;
    std::vector<nff::Warning> warnings;
    const std::string text =
        nff::scene_text(nff::parse(start + "s 0 0 0 1\n"), "a\nsphere { }\r// \\", warnings);
    EXPECT_NE(text.find("a?sphere { }?// ? (Neutral"), std::string::npos) << text;
}

TEST(Nff, PointsAtMistakes) {
    const std::pair<std::string, const char*> cases[] = {
        {"", "1:1: the file ends without a view"},
        {"s 0 0 0 1\n", "1:1: a sphere (`s`) before the first fill (`f`) has no material"},
        {fill, "2:1: the file ends without a view"},
        {start + "s 0 0 0\n", "10:1: the file ends in the middle of a sphere (`s`); a radius is missing"},
        {start + "s 0 0 0\ns 0 0 0 1\n", "10:1: `s` is not a number; a sphere (`s`) needs a radius here"},
        {start + "s 0 0 zero 1\n", "9:7: `zero` is not a number"},
        {start + "s 0 0 0 1 7\n", "9:11: `7` is more than a sphere (`s`) takes"},
        {start + "s 0 0 0 0x10\n", "9:9: `0x10` is not a number"},
        {start + "s 0 0 nan 1\n", "9:7: `nan` is no number that can be calculated with"},
        {start + "s 0 0 -inf 1\n", "9:7: `-inf` is no number"},
        {start + "s 0 0 1e999 1\n", "9:7: `1e999` is no number"},
        {start + "s 0 0 0 -1\n", "9:9: the radius is -1; "},
        {start + "s 0 0 0 0\n", "9:9: the radius is 0"},
        {start + "c 0 0 0 1 0 0 0 1\n", "9:1: in this cone, base (`from`) to apex (`to`): "},
        {start + "c 0 0 0 0 0 0 1 0\n", "9:1: in this cone, "},
        {start + "c 0 0 0 1 0 0 1 -2\n", "9:17: the radius is -2; "},
        {start + "p 2\n0 0 0\n1 0 0\n",
         "9:3: the number of corners is `2`; it is a whole number from 3 to 16384"},
        {start + "p 3.5\n", "9:3: the number of corners is `3.5`"},
        {start + "p 99999999999999999999\n", "9:3: the number of corners is `99999999999999999999`"},
        {start + "p 4000000000\n0 0 0\n", "9:3: the number of corners is `4000000000`"},
        {start + "p 16000\n0 0 0\n",
         "11:1: the file ends in the middle of a polygon (`p`); a corner's coordinate"},
        {start + "pp 3\n0 0 0\n",
         "11:1: the file ends in the middle of a patch (`pp`); a normal's component"},
        {start + "q 1\n", "9:1: there is no entity `q`"},
        {start + std::string("\0\x1b[31m", 6) + "\n",
         "9:1: there is no entity `\xef\xbf\xbd\xef\xbf\xbd[31m`"},
        {start + view, "9:1: there is a view already"},
        {"b 0 0 0\nb 0 0 0\n", "2:1: there is a background already"},
        {"b 0 -1 0\n", "1:5: green is -1; it is at least 0"},
        {"l 0 0 0 1\n", "2:1: the file ends in the middle of a light (`l`); green is missing"},
        {"f 1 1 1 1 1 -5 0 0\n", "1:13: Shine is -5"},
        {"v 1\n", "1:3: `1` is more than `v` takes"},
        {"v\nfrom 0 0 0\nat 1 0 0\nangle 40\nresolution 9 9\n", "1:1: the view has no `up`"},
        {"v\nfrom 0 0 0\nfrom 0 0 0\n", "3:1: the view has `from` twice"},
        {"v\nfrom 0 0 0 0\n", "2:12: `0` is more than `from` takes"},
        {"v\nfrom 0 0 0\nat 0 0 0\nup 0 0 1\nangle 40\nresolution 9 9\n",
         "1:1: `from` and `at` are the same"},
        {"v\nfrom 0 0 0\nat 0 0 4\nup 0 0 1\nangle 40\nresolution 9 9\n", "4:1: `up` is 0 or parallel"},
        {"v\nfrom 0 0 0\nat 0 0 4\nup 0 0 0\nangle 40\nresolution 9 9\n", "4:1: `up` is 0 or parallel"},
        {"v\nfrom 0 0 0\nat 0 0 4\nup 0 1 0\nangle 180\nresolution 9 9\n", "5:1: the angle of view is 180"},
        {"v\nresolution 0 9\n", "2:12: the picture's width is `0`; it is a whole number from 1 to 65536"},
    };
    for (const auto& [text, message] : cases) {
        EXPECT_EQ(error_of(text).find(message), 0U) << error_of(text) << "\nexpected " << message;
    }
}

TEST(Nff, TakesFilesAsOthersWriteThem) {
    const ir::Scene scene =
        scene_of("v\r\nat 0 0 0\r\nfrom +1 -5 2\r\nup 0 0 1\r\nresolution 32 32\r\nangle 4e1\r\n"
                 "f .5 1. 0 1 0 0 0 1\r\ns\t0 0 0 1\r\n\r\n  s 1 0 0 1");
    EXPECT_EQ(scene.objects.size(), 2U);
    EXPECT_EQ(scene.camera.eye, (Vec3{1, -5, 2}));
}

TEST(Nff, TakesConcavePolygons) {
    const ir::Scene scene = scene_of(start + "p 8\n0 0 0\n4 0 0\n4 4 0\n3 4 0\n3 1 0\n1 1 0\n1 4 0\n0 4 0\n");
    ASSERT_EQ(scene.objects.size(), 6U);
    double area = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto& p = shape<runtime::Triangle<double>>(scene, i).points;
        area += cross(p[1] - p[0], p[2] - p[0]).z / 2;
    }
    EXPECT_NEAR(area, 10, 1e-12);
}

/// Of all broken files, every one is either refused or becomes a scene without complaint.
TEST(Nff, BrokenFilesAreRefusedOrBecomeScenes) {
    const std::string whole = read(SCC_SOURCE_DIR "/compiler/test/nff/all.nff");
    ASSERT_FALSE(whole.empty());
    std::mt19937 engine(5);
    const std::string pieces[] = {"nan", "-1",         "1e300", "0", "p",      "\n", " ",
                                  "#",   "9999999999", "pp 4",  "-", "1e-320", ""};
    int refused = 0, taken = 0;
    for (int i = 0; i < 1500; ++i) {
        std::string text = whole;
        for (unsigned change = 0; change <= engine() % 3; ++change) {
            const std::size_t at = engine() % text.size();
            switch (engine() % 4) {
            case 0:
                text.resize(at + 1);
                break;
            case 1:
                text[at] = static_cast<char>(engine() % 256);
                break;
            case 2:
                text.erase(at, engine() % 20);
                break;
            default:
                text.replace(at, engine() % 4, pieces[engine() % std::size(pieces)]);
            }
            text += text.empty() ? "\n" : "";
        }
        try {
            const Imported result = imported(text);
            ++taken;
            if (taken % 4 == 0) {
                const test::Compiled compiled = test::compile(result.text);
                ASSERT_TRUE(compiled.fine) << compiled.messages << text;
            }
        } catch (const nff::Error& error) {
            ++refused;
            EXPECT_GE(error.place.line, 1U);
        }
    }
    EXPECT_GT(refused, 300);
    EXPECT_GT(taken, 100);
}

TEST(Nff, ImportsTheGoldenFile) {
    const fs::path folder = SCC_SOURCE_DIR "/compiler/test/nff";
    std::vector<nff::Warning> warnings;
    const std::string text = nff::scene_text(nff::parse(read(folder / "all.nff")), "all.nff", warnings);
    if (std::getenv("SCC_UPDATE_GOLDEN") != nullptr) {
        std::ofstream(folder / "all.scn", std::ios::binary) << text;
    }
    EXPECT_EQ(text, read(folder / "all.scn"));
    EXPECT_EQ(warnings.size(), 3U);
    const test::Compiled compiled = test::compile(text);
    EXPECT_TRUE(compiled.fine) << compiled.messages;
    EXPECT_TRUE(compiled.messages.empty()) << compiled.messages;
}

/// Of the Standard Procedural Databases: how many shapes each has. Another checkout may lack them.
TEST(Nff, ImportsTheStandardProceduralDatabases) {
    const fs::path folder = SCC_SOURCE_DIR "/../shared/data/nff";
    if (!fs::exists(folder)) {
        GTEST_SKIP() << "there is no ../shared/data/nff";
    }
    const std::pair<const char*, std::size_t> files[] = {
        {"balls2", 93}, {"balls4", 7383}, {"rings2", 302}, {"teapot6", 0}, {"tetra4", 256}};
    for (const auto& [name, shapes] : files) {
        const ir::Scene scene = scene_of(read(folder / (std::string(name) + ".nff")));
        if (shapes > 0) {
            EXPECT_EQ(scene.objects.size(), shapes) << name;
        } else {
            EXPECT_GT(scene.objects.size(), 2200U) << name;
        }
        EXPECT_EQ(scene.settings.width, 512) << name;
    }
}

} // namespace
} // namespace scc::compiler
