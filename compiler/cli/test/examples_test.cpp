#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>

/// Every example, end to end. A new example is a row here.
namespace scc::cli::test {
namespace {

struct Example {
    const char* name;
    const char* against; ///< the renderers that get all of it
    bool whole = true;   ///< nothing is dropped for Blender

    friend void PrintTo(const Example& example, std::ostream* out) { *out << example.name; }
};

class Examples : public CommandLine, public testing::WithParamInterface<Example> {
protected:
    std::string scene() const { return example(std::string(GetParam().name) + ".scn"); }
    std::string against() const { return GetParam().against; }
};

// Blender has no unbounded quadrics, and no exact normals on tori that are parts of solids; spectra take it
// 27 pictures, which is too long here. Glass is not written for it. The built programs draw the generic
// pictures bit for bit, as another test shows; that `validate` runs them is shown once.
INSTANTIATE_TEST_SUITE_P(All, Examples,
                         testing::Values(Example{"lecture", "pov,blender,native"},
                                         Example{"mesh", "pov,blender"}, Example{"transforms", "pov,blender"},
                                         Example{"lights", "pov,blender"}, Example{"mirrors", "pov,blender"},
                                         Example{"stage", "pov,blender"}, Example{"rings", "pov"},
                                         Example{"quadrics", "pov", false},
                                         Example{"landscape", "pov,blender"},
                                         Example{"textures", "pov,blender"}, Example{"csg", "pov,blender"},
                                         Example{"glass", "pov", false}, Example{"implicit", "pov,blender"},
                                         Example{"lattice", "pov,blender"}, Example{"spectra", "pov"}),
                         [](const auto& row) { return std::string(row.param.name); });

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

TEST_P(Examples, AgreeWithOtherRenderers) {
    for (const char* renderer : {"povray", "blender"}) {
        if (!validation::find_program(renderer)) {
            GTEST_SKIP() << renderer << " is not installed";
        }
    }
    const auto result = scc({"validate", scene(), "--against", against(), "--report", "out", "--size",
                             "160x120", "--samples", "1"});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

/// For the renderers that they are compared with, the comparison has shown it.
TEST_P(Examples, AreExportedWholeOrNotAtAll) {
    if (against().find("blender") != std::string::npos) {
        return;
    }
    const bool whole = GetParam().whole;
    EXPECT_EQ(scc({"export", "blender", scene(), "-o", "s.py"}).code, whole ? 0 : 1);
    EXPECT_EQ(exists("s.py"), whole);
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
