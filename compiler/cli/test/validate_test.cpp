#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>

/// `scc validate` on copies of an export that were broken on purpose: each is caught, and told by its kind.
namespace scc::cli::test {
namespace {

constexpr const char* scene =
    "plane { normal = (0, 1, 0), material = phong { diffuse = rgb(0.5, 0.6, 0.4) } }\n"
    "sphere { center = (-1, 1, 0), material = phong { diffuse = rgb(0.8, 0.2, 0.2), specular = rgb(0.3, 0.3, "
    "0.3) } }\n"
    "mesh { file = \"m.obj\", material = phong { diffuse = rgb(0.2, 0.3, 0.8) } }\n"
    "perspective_camera { eye = (0, 1.5, 6), target = (0, 1, 0) }\n"
    "point_light { position = (3, 4, 5), attenuation = (1, 0, 0.02) }\n"
    "directional_light { towards = (-1, 1, 0.5), color = rgb(0.3, 0.3, 0.3) }\n";
constexpr const char* mesh = "v 0.4 0.2 0\nv 1.8 0.2 0.3\nv 1.8 1.6 0\nv 0.4 1.6 0.3\n"
                             "vn -0.3 -0.2 1\nvn 0.3 -0.2 1\nvn 0.3 0.2 1\nvn -0.3 0.2 1\n"
                             "f 1//1 2//2 3//3\nf 1//1 3//3 4//4\n";

struct Break {
    const char* name;
    const char* edit; ///< of the exported text, for sed; for `gamma`, of the command line
    const char* cause;
    const char* finding;

    friend void PrintTo(const Break& one, std::ostream* out) { *out << one.name; }
};

class BrokenCopies : public CommandLine, public testing::WithParamInterface<Break> {
protected:
    void SetUp() override {
        const std::optional<std::string> povray = validation::find_program("povray");
        if (!povray) {
            GTEST_SKIP() << "povray is not installed";
        }
        write("s.scn", scene);
        write("m.obj", mesh);
        std::filesystem::create_directory(path("bin"));
        write("bin/povray", std::string("#!/bin/sh\n") + GetParam().edit + "\nexec " + *povray + " \"$@\"\n");
        std::filesystem::permissions(path("bin/povray"), std::filesystem::perms::owner_all);
    }
    validation::ProcessResult validate(const std::string& more_path) {
        return scc({"validate", "s.scn", "--against", "pov", "--report", "out", "--size", "80x60", "--cache",
                    "off", "--jobs", "2", "--junit", "out.xml"},
                   {{"PATH", more_path + std::getenv("PATH")}});
    }
};

INSTANTIATE_TEST_SUITE_P(
    All, BrokenCopies,
    testing::Values(
        Break{"flipped_normal",
              "sed -i 's/4, <-0.28221628, -0.18814418, 0.94/4, <0.28221628, 0.18814418, -0.94/' scene.pov",
              "geometry", "normal: "},
        Break{"attenuation", "sed -i 's/fade_power 2.0/fade_power 1.0/' scene.pov", "shading",
              "light `point_light` falls off differently"},
        Break{"half_pixel",
              "sed -i '/^    direction/s!$! + <0.82842712474619,0,0>*0.5/image_height!' scene.pov",
              "sampling", "samples 0.5 pixels to the right and 0 down"},
        Break{"gamma", "for a; do shift; [ \"$a\" = File_Gamma=1.0 ] || set -- \"$@\" \"$a\"; done",
              "encoding", "encoded by the sRGB curve"},
        Break{"lost_light", "sed -i '/parallel point_at/d' scene.pov", "shading",
              "light `directional_light` is missing"}),
    [](const auto& row) { return std::string(row.param.name); });

TEST_P(BrokenCopies, AreCaughtAndToldByTheirKind) {
    const auto result = validate(path("bin") + ":");
    EXPECT_EQ(result.code, 1) << result.out << result.err;
    const auto json = nlohmann::json::parse(read("out/report.json"));
    const auto& cause = json["scenes"][0]["renderers"][0]["cause"];
    EXPECT_EQ(cause["class"], GetParam().cause) << cause.dump(2);
    EXPECT_NE(cause["summary"].get<std::string>().find(GetParam().finding), std::string::npos)
        << cause.dump(2);
    EXPECT_EQ(json["scenes"][0]["renderers"][0]["layers"].size(), 4U);
    EXPECT_NE(json["scenes"][0]["renderers"][0]["worst_pixel"].get<std::string>().find("pixel"),
              std::string::npos);
    EXPECT_NE(read("out.xml").find("<failure "), std::string::npos);
    EXPECT_NE(read("out/index.html").find(std::string("Cause class: <strong>") + GetParam().cause),
              std::string::npos);
}

TEST_F(CommandLine, ValidateTakesLimitsFromTheSceneAndKeepsWhatOthersDrew) {
    if (!validation::find_program("povray")) {
        GTEST_SKIP() << "povray is not installed";
    }
    const std::string text = std::string("sphere { }\n") + small_scene;
    const auto validate = [&](const std::string& comment) {
        write("s.scn", comment + text);
        return scc({"validate", "s.scn", "--against", "pov", "--report", "out", "--size", "32x24", "--cache",
                    "kept", "--layers", "always"});
    };
    const auto renderer = [&] {
        return nlohmann::json::parse(read("out/report.json"))["scenes"][0]["renderers"][0];
    };
    EXPECT_EQ(validate("").code, 0);
    EXPECT_FALSE(renderer()["from_cache"]);
    for (const auto& layer : renderer()["layers"]) {
        EXPECT_FALSE(layer["differs"]) << layer.dump();
    }
    const auto strict = validate("//@ budget pov: max_error = 1e-9, outliers = 0 because it must be exact\n");
    EXPECT_EQ(strict.code, 1) << strict.out;
    EXPECT_TRUE(renderer()["from_cache"]) << "a comment does not change the export";
    EXPECT_NE(renderer()["budget"]["reason"].get<std::string>().find("it must be exact"), std::string::npos);
    const auto wrong = validate("//@ budget pov: max_error = 1e-9\n");
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.err.find("s.scn:1: error: a budget of the scene's own needs a reason"), std::string::npos)
        << wrong.err;
}

/// Error falls as samples and triangles become more, ours as POV-Ray's with the same samples.
TEST_F(CommandLine, ValidateSweepsErrorOverTime) {
    if (!validation::find_program("povray")) {
        GTEST_SKIP() << "povray is not installed";
    }
    // POV-Ray sees no farther than 1e7 of its units, which shows in a row of samples at the horizon.
    write("s.scn", std::string(scene) +
                       "let down = perspective_camera { eye = (0, 4, 6), target = (0, 0, 0) }\n"
                       "render { camera = \"down\" }\ndown\n");
    write("m.obj", mesh);
    const auto result = scc({"validate", "--sweep", "s.scn", "--against", "pov,native", "--report", "out",
                             "--size", "24x18", "--samples", "16", "--cache", "off"});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    const auto json = nlohmann::json::parse(read("out/report.json"))["sweeps"][0];
    EXPECT_TRUE(json["confirmed"]) << json["confirmation"];
    std::map<std::string, nlohmann::json> series;
    for (const auto& one : json["series"]) {
        EXPECT_FALSE(one.contains("failure")) << one;
        series[one["renderer"]] = one;
    }
    for (const char* const name : {"scc float", "scc double", "scc native double", "pov"}) {
        ASSERT_EQ(series.at(name)["points"].size(), 3U) << name; // 1, 4 and 16 samples
        EXPECT_LT(series.at(name)["order"], -0.4) << name;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto error = [&](const char* name) {
            return series.at(name)["points"][i]["rmse"].get<double>();
        };
        EXPECT_EQ(error("scc double"), error("scc native double"));
        EXPECT_NEAR(error("pov"), error("scc double"), 2e-5);
    }
    EXPECT_EQ(series.count("pov +AM2"), 1U);
    const auto& tessellation = json["tessellation"];
    EXPECT_EQ(tessellation["points"].size(), 6U);
    EXPECT_LT(tessellation["order"], -0.7) << tessellation;
    EXPECT_NE(read("out/index.html").find("over 1 / tessellation"), std::string::npos);

    write("glass.scn", "sphere { material = glass { } }\nperspective_camera { eye = (0, 0, 5) }\n");
    const auto glass = scc({"validate", "--sweep", "glass.scn", "--against", "native", "--report", "out",
                            "--size", "16x12", "--samples", "4", "--cache", "off"});
    const auto of_glass = nlohmann::json::parse(read("out/report.json"))["sweeps"][0]["tessellation"];
    EXPECT_NE(of_glass["failure"].get<std::string>().find("transparent"), std::string::npos) << glass.err;
}

TEST_F(CommandLine, ValidateGoesOnAfterAWrongScene) {
    write("wrong.scn", "sphere { radios = 1 }\n");
    write("s.scn", small_scene);
    const auto result = scc({"validate", "wrong.scn", "s.scn", "--against", "pov", "--report", "out",
                             "--size", "16x12", "--jobs", "2", "--junit", "out.xml"},
                            {{"PATH", "/nowhere"}});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(read("out.xml").find("tests=\"2\" failures=\"0\" errors=\"1\" skipped=\"1\""),
              std::string::npos)
        << read("out.xml");
    EXPECT_NE(result.out.find("s.scn\n  pov      skipped"), std::string::npos) << result.out;
}

} // namespace
} // namespace scc::cli::test
