#include "compiler/cli/test/support.h"
#include "runtime/host/read_image.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

/// Raster mode: how it is asked for, and that it is drawn the same everywhere.
namespace scc::cli::test {
namespace {

class Raster : public CommandLine {
protected:
    runtime::Image drawn(std::vector<std::string> options, const std::string& file = "a.pfm") {
        std::vector<std::string> arguments{"render", "s.scn", "-o", file, "--size", "64x48"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const auto result = scc(arguments);
        EXPECT_TRUE(result.ok()) << result.err;
        return host::read_image(path(file));
    }
    static double difference(const runtime::Image& a, const runtime::Image& b) {
        double most = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) {
            most = std::max(most, std::abs(double{a.pixels[i]} - double{b.pixels[i]}));
        }
        return most;
    }
};

constexpr const char* ball =
    "sphere { material = phong { diffuse = rgb(0.7, 0.5, 0.2), specular = rgb(0.5, 0.5, 0.5), shininess = 20 "
    "} }\n"
    "perspective_camera { eye = (0, 1, 5), near = 1, far = 20 }\npoint_light { position = (3, 4, 5) }\n";

TEST_F(Raster, IsWhatTheFirstRenderOrTheCommandLineAsksFor) {
    const std::string flat = "render { method = raster { shading = \"flat\", tessellation = 0.02 } }\n";
    write("s.scn", std::string(ball) + flat);
    const runtime::Image by_scene = drawn({});
    const runtime::Image by_rays = drawn({"--mode", "ray"});
    EXPECT_EQ(by_scene.pixels, drawn({"--mode", "raster"}).pixels);
    EXPECT_GT(difference(by_scene, by_rays), 0.05);
    write("s.scn", std::string(ball) + "render { }\n" + flat);
    EXPECT_EQ(drawn({}).pixels, by_rays.pixels);
    EXPECT_EQ(drawn({"--mode", "raster"}).pixels, by_scene.pixels);
    const auto note = scc({"render", "s.scn", "-o", "a.pfm", "--size", "8x8"});
    EXPECT_NE(note.err.find("`--mode raster` draws it [render-left-out]"), std::string::npos) << note.err;
    write("s.scn", ball);
    EXPECT_LT(difference(drawn({"--mode", "raster", "--samples", "16"}),
                         drawn({"--mode", "ray", "--samples", "16"})),
              0.1)
        << "lit per pixel, and nothing casts shadows; a sample at an outline may differ";
}

TEST_F(Raster, DrawsLinesThatRaysCannotMeet) {
    std::string text = ball;
    text += "polyline { points = [(-3, 1.5, 0), (3, 1.5, 0)], color = rgb(1, 0, 0) }\n"
            "render { method = raster { } }\n";
    write("s.scn", text);
    const runtime::Image image = drawn({});
    int red = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* pixel = image.at(x, y);
            red += pixel[0] == 1 && pixel[1] == 0 && pixel[2] == 0 ? 1 : 0;
        }
    }
    EXPECT_GE(red, 40);
    EXPECT_LE(red, 64);
    const auto by_rays = scc({"render", "s.scn", "-o", "b.pfm", "--mode", "ray"});
    EXPECT_EQ(by_rays.code, 1);
    EXPECT_NE(by_rays.err.find("[thin-line]"), std::string::npos);
}

TEST_F(Raster, ExplainsWhatLiesOnAPixel) {
    write("s.scn", std::string(ball) +
                       "let pane = phong { diffuse = rgb(0, 0.2, 0), opacity = 0.5 }\n"
                       "disc { center = (0, 0, 2), normal = (0, 0, 1), material = pane }\n"
                       "polyline { points = [(-3, 0.3, 0), (3, 0.3, 0)], color = rgb(1, 0, 0) }\n"
                       "render { method = raster { shading = \"gouraud\" } }\n");
    const runtime::Image image = drawn({"--precision", "double"});
    const auto explain = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"explain", "s.scn", "--pixel",     "32,24",
                                           "--size",  "64x48", "--precision", "double"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = scc(arguments);
        EXPECT_TRUE(result.ok()) << result.err;
        return result.out;
    };
    const auto json = nlohmann::json::parse(explain({"--json"}));
    ASSERT_EQ(json["drawn"].size(), 3U) << json.dump(1);
    EXPECT_EQ(json["drawn"][0]["verdict"], "through");
    EXPECT_EQ(json["drawn"][1]["verdict"], "seen");
    EXPECT_EQ(json["drawn"][2]["verdict"], "farther");
    const auto& ball_triangle = json["drawn"][1];
    double weights = 0;
    for (const auto& weight : ball_triangle["weights"]) {
        EXPECT_GE(weight.get<double>(), -0.1);
        weights += weight.get<double>();
    }
    EXPECT_NEAR(weights, 1, 1e-9);
    EXPECT_EQ(ball_triangle["points"].size(), 3U) << "lit at its corners";
    for (std::size_t c = 0; c < 3; ++c) {
        const double expected = double{image.at(32, 24)[c]};
        EXPECT_NEAR(json["sample_color"][c].get<double>(), expected, 1e-5);
        EXPECT_EQ(json["rendered"][c].get<float>(), image.at(32, 24)[c]);
    }
    const std::string text = explain({});
    for (const char* part : {"TRIANGLES AND LINES that cover it, by z* (L4)", "the nearest: this is seen",
                             "lets light through", "lit at corner 3 (L10)", "diffuse: Id rd (s.m)"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
    }
    EXPECT_EQ(scc({"explain", "s.scn", "--pixel", "64,24", "--size", "64x48"}).code, 2);
}

TEST_F(Raster, DrawsLinesInScenesWithSpectra) {
    const std::string line = "polyline { points = [(-3, 1.5, 0), (3, 1.5, 0)], color = rgb(1, 0.5, 0) }\n"
                             "polyline { points = [(-3, -1.5, 0), (3, -1.5, 0)] }\n"
                             "render { method = raster { } }\n";
    write("s.scn", ball + line);
    const runtime::Image plain = drawn({});
    write("s.scn", std::string(ball) +
                       "disc { center = (0, 0, -90), material = phong { diffuse = spectrum([(400, "
                       "0.2), (700, 0.8)]) } }\n" +
                       line);
    const runtime::Image spectral = drawn({});
    // The colour of light on the ball is a product of two spectra, which rays make differ by as much.
    EXPECT_LT(difference(plain, spectral), 5e-4) << "plain colours come out as they are";
}

TEST_F(Raster, RefusesWhatItHasNot) {
    write("s.scn", ball);
    EXPECT_EQ(scc({"render", "s.scn", "-o", "a.pfm", "--mode", "raster", "--filter", "mitchell"}).code, 2);
    EXPECT_EQ(scc({"render", "s.scn", "-o", "a.pfm", "--mode", "scanline"}).code, 2);
    EXPECT_FALSE(exists("a.pfm"));
}

/// What raster mode has not is left out of the other renderers' scenes as well; what they have not is said.
TEST_F(Raster, IsExportedAsFarAsRaysCanFollow) {
    const std::string mirror = "plane { material = phong { reflect = rgb(0.9, 0.9, 0.9) } }\n";
    write("s.scn", ball + mirror + "render { method = raster { } }\n");
    ASSERT_TRUE(scc({"export", "pov", "s.scn", "-o", "s.pov", "--ledger", "s.json"}).ok());
    EXPECT_EQ(read("s.pov").find("reflection"), std::string::npos);
    EXPECT_NE(read("s.pov").find("no_shadow"), std::string::npos);
    EXPECT_NE(read("s.json").find("\"raster\""), std::string::npos);
    write("s.scn", ball + mirror + "render { method = raster { shading = \"gouraud\" } }\n");
    const auto refused = scc({"export", "pov", "s.scn", "-o", "t.pov"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("shading \"gouraud\" cannot be written for POV-Ray"), std::string::npos)
        << refused.err;
    EXPECT_FALSE(exists("t.pov"));
}

TEST_F(Raster, LayersAreOfTheTriangles) {
    write("s.scn", ball);
    const auto of = [&](const char* mode, const char* file) {
        const auto result =
            scc({"render", "s.scn", "-o", file, "--size", "64x48", "--mode", mode, "--aov", "depth"});
        EXPECT_TRUE(result.ok()) << result.err;
    };
    of("ray", "ray.exr");
    of("raster", "raster.exr");
    EXPECT_EQ(scc({"compare", "ray.exr", "raster.exr", "--max", "0.05"}).code, 0);
}

} // namespace
} // namespace scc::cli::test
