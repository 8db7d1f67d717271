#include "compiler/cli/test/support.h"
#include "runtime/host/read_image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <vector>

/// What is told of a picture beside its light: AOVs, and `scc explain`.
namespace scc::cli::test {
namespace {

using Json = nlohmann::json;
using Strings = std::vector<std::string>;

/// An OpenEXR file as OpenImageIO reads it.
struct Layers {
    int width = 0, height = 0;
    Strings names; ///< in the file's order
    std::map<std::string, std::vector<double>> channels;
    std::map<std::string, OIIO::TypeDesc> types;
    std::map<std::string, std::string> texts;
};
Layers read_layers(const std::string& path) {
    Layers layers;
    const auto input = OIIO::ImageInput::open(path);
    if (!input) {
        ADD_FAILURE() << OIIO::geterror();
        return layers;
    }
    const OIIO::ImageSpec& spec = input->spec();
    layers.width = spec.width;
    layers.height = spec.height;
    for (int c = 0; c < spec.nchannels; ++c) {
        const std::string& name = spec.channelnames[static_cast<std::size_t>(c)];
        std::vector<double>& values = layers.channels[name];
        values.resize(static_cast<std::size_t>(spec.width * spec.height));
        EXPECT_TRUE(input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::DOUBLE, values.data()));
        if (spec.channelformat(c) == OIIO::TypeDesc::UINT32) { // as double they are parts of the largest one
            std::vector<std::uint32_t> whole(values.size());
            EXPECT_TRUE(input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::UINT32, whole.data()));
            values.assign(whole.begin(), whole.end());
        }
        layers.names.push_back(name);
        layers.types[name] = spec.channelformat(c);
    }
    for (const char* text : {"object.manifest", "material.manifest"}) {
        layers.texts[text] = std::string(spec.get_string_attribute(text));
    }
    return layers;
}

constexpr const char* all_aovs = "depth,planar,position,normal,uv,object,material";

/// A ball of radius 1 before a disc in the plane z = -3, seen from (0, 0, 5); the picture's plane at distance
/// 1 reaches 1 up.
constexpr const char* ball_and_disc =
    "let red = phong { diffuse = rgb(0.8, 0.1, 0.1) }\n"
    "sphere { name = \"ball\", material = red }\n"
    "disc { center = (0, 0, -3), normal = (0, 0, 1), radius = 7, name = \"target\" }\n"
    "difference {\n  name = \"die\"\n  box { min = (-4, -1, -1), max = (-2, 1, 1) }\n"
    "  sphere { center = (-3, 0, 1), radius = 0.5 }\n}\n"
    "for (i in 0..3) { sphere { center = (3, i - 1, 0), radius = 0.2 } }\n"
    "perspective_camera { eye = (0, 0, 5), target = (0, 0, 0), fov_y = 90deg }\n"
    "point_light { position = (3, 4, 5) }\n";

TEST_F(CommandLine, AovsAreLayersThatOtherProgramsRead) {
    write("s.scn", ball_and_disc);
    const auto drawn = scc({"render", "s.scn", "-o", "a.exr", "--size", "64x48", "--aov", all_aovs});
    ASSERT_TRUE(drawn.ok()) << drawn.err;
    const Layers layers = read_layers(path("a.exr"));
    Strings names = layers.names;
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names,
              (Strings{"B", "G", "R", "depth.Z", "material.X", "normal.X", "normal.Y", "normal.Z", "object.X",
                       "planar.Z", "position.X", "position.Y", "position.Z", "uv.U", "uv.V"}));
    EXPECT_EQ(layers.types.at("object.X"), OIIO::TypeDesc::UINT32);
    EXPECT_EQ(layers.types.at("depth.Z"), OIIO::TypeDesc::FLOAT);
    ASSERT_TRUE(scc({"render", "s.scn", "-o", "plain.exr", "--size", "64x48"}).ok());
    const runtime::Image plain = host::read_image(path("plain.exr"));
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
        ASSERT_EQ(layers.channels.at(std::string(1, "RGB"[i % 3]))[i / 3],
                  static_cast<double>(plain.pixels[i]));
    }
    const Json objects = Json::parse(layers.texts.at("object.manifest"));
    EXPECT_EQ(objects.size(), 6U) << objects;
    for (const char* name : {"ball", "target", "die", "sphere[0]", "sphere[1]", "sphere[2]"}) {
        EXPECT_TRUE(objects.contains(name)) << objects;
    }
    EXPECT_TRUE(Json::parse(layers.texts.at("material.manifest")).contains("red"));
}

// Coordinates would lose digits there; what is told of places is where the author put them.
TEST_F(CommandLine, WhatStandsFarOffIsDrawnAsIfItStoodNear) {
    write("s.scn", "param far: number = 0\n"
                   "perspective_camera { eye = (far, 1, 5), target = (far, 0, 0) }\n"
                   "point_light { position = (far + 3, 4, 5) }\n"
                   "sphere { center = (far, 0, 0) }\n"
                   "box { min = (far - 2, -1, -1), max = (far - 1.25, 1, 1) }\n");
    for (const char* mode : {"ray", "raster"}) {
        const auto draw = [&](const char* far, const char* file) {
            const auto drawn = scc({"render", "s.scn", "--mode", mode, "-D", std::string("far=") + far, "-o",
                                    file, "--size", "64x48", "--aov", "depth,position"});
            EXPECT_EQ(drawn.err, "");
            return read_layers(path(file));
        };
        Layers near = draw("0", "near.exr"), far = draw("1e9", "far.exr");
        for (const char* channel : {"R", "G", "B", "depth.Z", "position.Y", "position.Z"}) {
            EXPECT_EQ(near.channels[channel], far.channels[channel]) << channel;
        }
        int met = 0;
        for (std::size_t i = 0; i < near.channels["R"].size(); ++i) {
            const bool is_met = std::isfinite(near.channels["depth.Z"][i]);
            met += is_met ? 1 : 0;
            EXPECT_EQ(far.channels["position.X"][i], is_met ? double{1e9F} : 0);
        }
        EXPECT_GT(met, 500);
    }
    const auto told = scc({"explain", "s.scn", "-D", "far=1e12", "--pixel", "400,300"});
    EXPECT_NE(told.out.find("coordinates count from (1e+12, 0, 0)"), std::string::npos) << told.out;
    EXPECT_NE(scc({"explain", "s.scn", "-D", "far=1e12", "--matrices"}).out.find("normalize((1e+12, 1, 5)"),
              std::string::npos);
    EXPECT_NE(scc({"check", "s.scn", "-D", "far=1e13"}).err.find("[beyond-double]"), std::string::npos)
        << "the author's own numbers are rounded there";
    // What a function reads in the world keeps the scene where it is.
    write("tied.scn", read("s.scn") + "sphere { center = (far, 2, 0), material = phong { diffuse = "
                                      "fn(s: surface) = rgb(0.5 + 0.5 * sin(s.world.x), 0, 0) } }\n");
    EXPECT_NE(scc({"check", "tied.scn", "-D", "far=1e12"}).err.find("[far-from-origin]"), std::string::npos);
}

TEST_F(CommandLine, AovsHaveTheirAnalyticValues) {
    write("s.scn", ball_and_disc);
    ASSERT_TRUE(scc({"render", "s.scn", "-o", "a.exr", "--size", "64x48", "--aov", all_aovs}).ok());
    Layers layers = read_layers(path("a.exr"));
    const Json objects = Json::parse(layers.texts.at("object.manifest"));
    const Json materials = Json::parse(layers.texts.at("material.manifest"));
    std::map<std::string, int> seen;
    for (int row = 0; row < 48; ++row) {
        for (int column = 0; column < 64; ++column) {
            const auto at = [&](const char* channel) {
                return layers.channels[channel][static_cast<std::size_t>(row * 64 + column)];
            };
            const std::array<double, 3> dir{(2 * (column + 0.5) - 64) / 48, (48 - 2 * (row + 0.5)) / 48, -1};
            const double depth = at("depth.Z"), planar = at("planar.Z");
            const double length = std::sqrt(dir[0] * dir[0] + dir[1] * dir[1] + 1);
            const double id = at("object.X");
            if (id == 0) {
                ++seen["nothing"];
                EXPECT_EQ(depth, std::numeric_limits<double>::infinity());
                EXPECT_EQ(planar, std::numeric_limits<double>::infinity());
                for (const char* channel : {"position.X", "position.Z", "normal.Y", "uv.U", "material.X"}) {
                    EXPECT_EQ(at(channel), 0) << channel;
                }
                continue;
            }
            EXPECT_NEAR(depth, planar * length, 1e-5 * depth);
            EXPECT_NEAR(at("position.X"), dir[0] * planar, 1e-5);
            EXPECT_NEAR(at("position.Y"), dir[1] * planar, 1e-5);
            EXPECT_NEAR(at("position.Z"), 5 - planar, 1e-5);
            if (id == objects["ball"].get<double>()) {
                ++seen["ball"];
                const double b = 5, a = length * length; // |(0, 0, 5) + t dir| = 1
                EXPECT_NEAR(planar, (b - std::sqrt(b * b - a * 24)) / a, 1e-5);
                EXPECT_NEAR(at("normal.X"), at("position.X"), 1e-6);
                EXPECT_NEAR(at("normal.Y"), at("position.Y"), 1e-6);
                EXPECT_NEAR(at("normal.Z"), at("position.Z"), 1e-6);
                EXPECT_NEAR(at("uv.V"), std::asin(at("position.Y")) / 3.14159265358979 + 0.5, 1e-5);
                EXPECT_EQ(at("material.X"), materials["red"].get<double>());
            } else if (id == objects["target"].get<double>()) {
                ++seen["target"];
                EXPECT_EQ(planar, 8);
                EXPECT_EQ(at("normal.Z"), 1);
            } else if (id == objects["die"].get<double>()) {
                ++seen["die"]; // in its dent the normal is the subtracted ball's, turned over
                const double x = at("position.X") + 3, y = at("position.Y"), z = at("position.Z") - 1;
                if (std::abs(at("position.Z") - 1) > 1e-5 && at("position.X") < -2.01) {
                    ++seen["dent"];
                    EXPECT_NEAR(std::sqrt(x * x + y * y + z * z), 0.5, 1e-5);
                    EXPECT_NEAR(at("normal.X"), -2 * x, 1e-4);
                }
            }
        }
    }
    for (const char* name : {"nothing", "ball", "target", "die", "dent"}) {
        EXPECT_GT(seen[name], 3) << name;
    }
}

TEST_F(CommandLine, BuiltProgramsDrawTheSameAovs) {
    write("s.scn",
          std::string("param r: number = 1\nsphere { center = (0, 3, 0), radius = r }\n") + ball_and_disc);
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "prog", "--aov"}).ok());
    const Strings options{"--size", "64x48", "--aov", all_aovs};
    const auto with = [&](Strings first) {
        first.insert(first.end(), options.begin(), options.end());
        return first;
    };
    ASSERT_TRUE(scc(with({"render", "s.scn", "-o", "generic.exr"})).ok());
    const auto drawn = start(path("prog"), with({"-o", "native.exr"}));
    ASSERT_TRUE(drawn.ok()) << drawn.err;
    EXPECT_TRUE(read("generic.exr") == read("native.exr"));
    ASSERT_TRUE(scc(with({"render", "s.scn", "-o", "generic.exr", "-D", "r=0.5"})).ok());
    ASSERT_TRUE(start(path("prog"), with({"-o", "native.exr", "-D", "r=0.5", "--threads", "3"})).ok());
    EXPECT_TRUE(read("generic.exr") == read("native.exr"));
    ASSERT_TRUE(scc({"render", "s.scn", "-o", "crop.exr", "--size", "64x48", "--crop", "5,7,20,21", "--aov",
                     "depth,object"})
                    .ok());
    ASSERT_TRUE(scc(with({"render", "s.scn", "-o", "generic.exr"})).ok());
    const std::vector<double> whole_depth = read_layers(path("generic.exr")).channels.at("depth.Z");
    const Layers crop = read_layers(path("crop.exr"));
    EXPECT_EQ(crop.channels.size(), 5U);
    EXPECT_EQ(crop.channels.at("depth.Z")[3 * 15 + 4], whole_depth[(7 + 3) * 64 + 5 + 4]);

    write("s.scn", spheres_only);
    ASSERT_TRUE(scc({"build", "s.scn", "-o", "plain", "--precision", "float"}).ok());
    const auto refused = start(path("plain"), with({"-o", "x.exr"}));
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("`scc build --aov` makes one"), std::string::npos) << refused.err;
    EXPECT_EQ(start(path("plain"), {"--help"}).out.find("--aov"), std::string::npos);
    EXPECT_NE(start(path("prog"), {"--help"}).out.find("--aov"), std::string::npos);
}

TEST_F(CommandLine, WrongAovsAreUsageMistakes) {
    write("s.scn", small_scene);
    const auto expect = [&](const char* list, const char* file, const char* message) {
        const auto result = scc({"render", "s.scn", "-o", file, "--aov", list});
        EXPECT_EQ(result.code, 2) << list;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    };
    expect("normal,depht", "a.exr", "--aov: there is no `depht`; there are depth, ");
    expect("everything", "a.exr", "there are depth, planar, position, normal, uv, object, material");
    expect("", "a.exr", "there is no ``");
    expect("depth,", "a.exr", "there is no ``");
    expect("uv,uv", "a.exr", "`uv` is named twice");
    expect("depth", "a.png", "give `-o` a name that ends in .exr");
    EXPECT_EQ(files(), (Strings{"s.scn"}));
}

/// Whole texts, in compiler/cli/test/explain; SCC_UPDATE_GOLDEN=1 writes them anew.
class Explain : public CommandLine {
protected:
    void expect_golden(const std::string& name, const std::string& text) {
        const std::string golden = SCC_SOURCE_DIR "/compiler/cli/test/explain/" + name;
        if (std::getenv("SCC_UPDATE_GOLDEN") != nullptr) {
            host::replace_file(golden, text);
        }
        std::ifstream stream(golden, std::ios::binary);
        EXPECT_EQ(text, std::string(std::istreambuf_iterator<char>(stream), {})) << name;
    }
    std::string explain(Strings arguments) {
        arguments.insert(arguments.begin(), "explain");
        const auto result = scc(arguments);
        EXPECT_TRUE(result.ok()) << result.err;
        return result.out;
    }
    void copy_example(const std::string& name) const { std::filesystem::copy(example(name), path(name)); }
};

TEST_F(Explain, TellsTheLecturesMatrices) {
    copy_example("lecture.scn");
    expect_golden("lecture_matrices.txt", explain({"lecture.scn", "--matrices", "--point", "1.5,1.2,-0.5"}));
}

/// A point through the matrices comes out at the pixel whose ray meets it.
TEST_F(Explain, MatricesLeadToThePixelThatShowsThePoint) {
    for (const char* camera :
         {"perspective_camera { eye = (1, 2, 5), target = (0, 0.3, 0), fov_y = 50deg, shift = (0.2, -0.1) }",
          "orthographic_camera { eye = (1, 2, 5), target = (0, 0.3, 0), height = 3, shift = (-0.1, 0.3) }"}) {
        write("s.scn", std::string("sphere { radius = 0.1, transform = translate(0.4, 0.6, -0.3) }\n"
                                   "point_light { position = (3, 4, 5) }\n") +
                           camera + "\n");
        const Json json = Json::parse(
            explain({"s.scn", "--matrices", "--size", "200x150", "--point", "0.4,0.6,-0.3", "--json"}));
        ASSERT_TRUE(scc({"render", "s.scn", "-o", "a.exr", "--size", "200x150", "--aov", "object"}).ok());
        const Layers layers = read_layers(path("a.exr"));
        double columns = 0, rows = 0, count = 0;
        for (int row = 0; row < 150; ++row) {
            for (int column = 0; column < 200; ++column) {
                const bool here =
                    layers.channels.at("object.X")[static_cast<std::size_t>(row * 200 + column)] != 0;
                columns += here ? column + 0.5 : 0;
                rows += here ? row + 0.5 : 0;
                count += here ? 1 : 0;
            }
        }
        ASSERT_GT(count, 10);
        EXPECT_NEAR(json["point"]["picture"][0].get<double>(), columns / count, 0.5) << camera;
        EXPECT_NEAR(json["point"]["picture"][1].get<double>(), rows / count, 0.5) << camera;
        EXPECT_EQ(json["point"]["outcode"], "");
        const Json& view = json["view"];
        for (std::size_t i = 0; i < 16; ++i) {
            EXPECT_EQ(view["column_vectors"][i / 4][i % 4], view["row_vectors"][i % 4][i / 4]);
        }
        const Json& model = json["model"][0];
        EXPECT_EQ(model["object"], "sphere");
        EXPECT_EQ(model["matrix"]["column_vectors"][0][3], 0.4);
    }
}

TEST_F(Explain, TellsWhichLineAsksForWhat) {
    copy_example("mirrors.scn");
    const std::string text = explain({"mirrors.scn", "--needs", "--size", "100x75"});
    // What is left out grows with the language; a trial's figures are others' concern.
    expect_golden("mirrors_needs.txt", text.substr(0, text.find("\nLEFT OUT")));
    EXPECT_NE(text.find("torus"), std::string::npos);
    EXPECT_NE(text.find("scc render into an 8-bit PNG: double, since the picture is too small"),
              std::string::npos)
        << text;
    const Json json = Json::parse(explain({"mirrors.scn", "--needs", "--size", "100x75", "--json"}));
    EXPECT_EQ(json["needs"][0]["asked_for_at"], "mirrors.scn:14");
    EXPECT_EQ(json["precision"].size(), 3U);
}

/// The red sphere, the mirror, and a shadow.
TEST_F(Explain, TellsHowThePixelsOfTheLectureCameAbout) {
    copy_example("lecture.scn");
    const auto pixel = [&](const char* place) {
        return explain(
            {"lecture.scn", "--pixel", place, "--size", "64x48", "--samples", "1", "--precision", "double"});
    };
    expect_golden("lecture_sphere.txt", pixel("32,25"));
    expect_golden("lecture_mirror.txt", pixel("46,23"));
    expect_golden("lecture_shadow.txt", pixel("28,28"));
}

struct Count {
    std::string text;
    std::size_t of(const std::string& part) const {
        std::size_t count = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
            ++count;
        }
        return count;
    }
};

/// What is told is what is drawn, and each hit is among the surfaces that the ray passes.
TEST_F(Explain, AddsUpToWhatIsDrawn) {
    std::vector<std::string> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(SCC_SOURCE_DIR "/examples")) {
        // Rays meet no lines.
        if (entry.path().extension() == ".scn" && entry.path().stem() != "lines") {
            scenes.push_back(entry.path().string());
        }
    }
    std::sort(scenes.begin(), scenes.end());
    EXPECT_GT(scenes.size(), 10U);
    std::size_t mirrored = 0, through = 0, blocked = 0, filtered = 0, cut = 0;
    int turn = 0;
    for (const std::string& scene : scenes) {
        for (const char* pixel : {"40,30", "31,35", "55,38"}) {
            const bool single = ++turn % 3 == 0;
            const Count told{
                explain({scene, "--mode", "ray", "--pixel", pixel, "--size", "80x60", "--samples",
                         turn % 2 == 0 ? "1" : "4", "--precision", single ? "float" : "double"})};
            EXPECT_EQ(told.of("the renderer draws the same, to the bit"), 1U) << told.text;
            if (told.of(" more\n") == 0) {
                EXPECT_EQ(told.of("  meets "), told.of("the nearest: this is seen")) << told.text;
            }
            EXPECT_EQ(told.of("t = inf"), 0U) << told.text;
            mirrored += told.of("MIRRORED RAY");
            through += told.of("RAY THROUGH");
            blocked += told.of("no diffuse, no specular");
            filtered += told.of("of the light\n");
            cut += told.of("no surface of the solid");
        }
    }
    for (const std::size_t count : {mirrored, through, blocked, filtered, cut}) {
        EXPECT_GT(count, 2U);
    }
}

TEST_F(Explain, TellsTheSampleThatIsAskedFor) {
    write("s.scn", small_scene);
    const auto told = [&](Strings more) {
        more.insert(more.begin(), {"s.scn", "--pixel", "5,7", "--size", "20x15", "--samples", "9"});
        return Count{explain(more)};
    };
    EXPECT_EQ(told({}).of("sample 1,1 of 3 x 3"), 1U);
    EXPECT_EQ(told({}).of("c = 5.5, r = 7.5"), 1U);
    const Count corner = told({"--sample", "2,0"});
    EXPECT_EQ(corner.of("sample 2,0 of 3 x 3"), 1U);
    EXPECT_EQ(corner.of("c = 5.83333, r = 7.83333"), 1U) << corner.text;
    EXPECT_EQ(corner.of("to the bit"), 1U);
}

TEST_F(Explain, TellsThePixelAsJsonToo) {
    write("s.scn", "sphere { material = phong { diffuse = rgb(0.5, 0.5, 0.5), reflect = rgb(0.2, 0.2, 0.2), "
                   "bump = fn(s: surface) = 0.05 * sin(9 * s.p.x) } }\n"
                   "perspective_camera { eye = (0, 0, 4) }\npoint_light { position = (2, 3, 4) }\n");
    const Json json = Json::parse(explain({"s.scn", "--pixel", "33,25", "--size", "64x48", "--json"}));
    EXPECT_EQ(json["schema"], 1);
    EXPECT_EQ(json["pixel"], (Json{33, 25}));
    ASSERT_EQ(json["rays"].size(), 2U);
    const Json& hit = json["rays"][0]["hit"];
    EXPECT_EQ(json["rays"][1]["way"], "mirrored");
    EXPECT_EQ(json["rays"][1]["parent"], 0);
    EXPECT_TRUE(json["rays"][1]["hit"].is_null());
    EXPECT_TRUE(hit["bumped"].get<bool>());
    EXPECT_NE(hit["normal"], hit["shading_normal"]);
    ASSERT_EQ(hit["lights"].size(), 1U);
    EXPECT_TRUE(hit["lights"][0]["reaches"].get<bool>());
    for (std::size_t i = 0; i < 3; ++i) { // what mirrors see is black
        EXPECT_NEAR(json["sum"][i].get<double>(), hit["light"][i].get<double>(), 1e-12);
    }
    EXPECT_EQ(json["pixel_color"], json["rendered"]);
}

TEST_F(Explain, SaysWhatItCannotExplain) {
    write("s.scn", small_scene);
    EXPECT_EQ(scc({"explain", "s.scn"}).code, 2);
    EXPECT_EQ(scc({"explain", "s.scn", "--matrices", "--needs", "--json"}).code, 2);
    EXPECT_EQ(scc({"explain", "s.scn", "--matrices", "--point", "1,2"}).code, 2);
    EXPECT_EQ(scc({"explain", "none.scn", "--matrices"}).code, 3);
    for (const char* pixel : {"5", "5,", "-1,2", "a,b", "800,0", "0,600", "1,2,3", "1.5,2"}) {
        EXPECT_EQ(scc({"explain", "s.scn", "--pixel", pixel}).code, 2) << pixel;
    }
    EXPECT_EQ(scc({"explain", "s.scn", "--pixel", "1,1", "--sample", "1,0"}).code, 2);
    write("s.scn", "sphere { radius = -1 }\n");
    EXPECT_EQ(scc({"explain", "s.scn", "--matrices"}).code, 1);
    EXPECT_EQ(scc({"explain", "s.scn", "--needs"}).code, 1);
}

} // namespace
} // namespace scc::cli::test
