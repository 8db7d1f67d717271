#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
