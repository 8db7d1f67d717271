#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>

/// Every example, end to end. A new example is a row here.
namespace scc::cli::test {
namespace {

class Examples : public CommandLine, public testing::WithParamInterface<const char*> {
protected:
    std::string scene() const { return example(std::string(GetParam()) + ".scn"); }
};

INSTANTIATE_TEST_SUITE_P(All, Examples,
                         testing::Values("lecture", "mesh", "transforms", "lights", "mirrors", "implicit"),
                         [](const auto& name) { return std::string(name.param); });

TEST_P(Examples, CheckWithoutAWarning) {
    const auto result = scc({"check", "--strict", scene()});
    EXPECT_TRUE(result.ok()) << result.err;
}

TEST_P(Examples, GenericAndSpecialisedPicturesAreIdentical) {
    for (const char* precision : {"double", "float"}) {
        ASSERT_TRUE(scc({"build", scene(), "-o", "prog", "--precision", precision}).ok());
        ASSERT_TRUE(scc({"render", scene(), "-o", "generic.pfm", "--size", "160x120", "--samples", "4",
                         "--precision", precision})
                        .ok());
        ASSERT_TRUE(start(path("prog"), {"-o", "native.pfm", "--size", "160x120", "--samples", "4"}).ok());
        EXPECT_TRUE(read("generic.pfm") == read("native.pfm")) << precision;
    }
}

TEST_P(Examples, AgreeWithPovRayAndBlender) {
    for (const char* renderer : {"povray", "blender"}) {
        if (!validation::find_program(renderer)) {
            GTEST_SKIP() << renderer << " is not installed";
        }
    }
    // Exports to Blender drop implicit surfaces.
    const char* const against =
        std::string_view(GetParam()) == "implicit" ? "pov,native" : "pov,blender,native";
    const auto result = scc({"validate", scene(), "--against", against, "--report", "out", "--size",
                             "160x120", "--samples", "1"});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

/// Blender gets no solids that are made of others.
TEST_F(CommandLine, SolidsAgreeWithPovRay) {
    const std::string scene = example("csg.scn");
    EXPECT_TRUE(scc({"check", "--strict", scene}).ok());
    for (const char* precision : {"double", "float"}) {
        ASSERT_TRUE(scc({"build", scene, "-o", "prog", "--precision", precision}).ok());
        ASSERT_TRUE(scc({"render", scene, "-o", "generic.pfm", "--size", "160x120", "--samples", "4",
                         "--precision", precision})
                        .ok());
        ASSERT_TRUE(start(path("prog"), {"-o", "native.pfm", "--size", "160x120", "--samples", "4"}).ok());
        EXPECT_TRUE(read("generic.pfm") == read("native.pfm")) << precision;
    }
    EXPECT_EQ(scc({"export", "blender", scene, "-o", "s.py"}).code, 1);
    if (!validation::find_program("povray")) {
        GTEST_SKIP() << "povray is not installed";
    }
    const auto result = scc({"validate", scene, "--against", "pov,native", "--report", "out", "--size",
                             "160x120", "--samples", "1"});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

/// Too many objects for the other renderers; see Arrays for what they get.
TEST_F(CommandLine, DrawsAHundredThousandSpheres) {
    const std::string scene = example("spheres.scn");
    EXPECT_TRUE(scc({"check", "--strict", scene}).ok());
    ASSERT_TRUE(scc({"build", scene, "-o", "prog", "--precision", "double"}).ok());
    const auto drawn = scc(
        {"render", scene, "-o", "generic.pfm", "--size", "160x120", "--precision", "double", "--stats", "-"});
    ASSERT_TRUE(drawn.ok()) << drawn.err;
    ASSERT_TRUE(start(path("prog"), {"-o", "native.pfm", "--size", "160x120"}).ok());
    EXPECT_TRUE(read("generic.pfm") == read("native.pfm"));
}

} // namespace
} // namespace scc::cli::test
