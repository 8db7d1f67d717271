#include "compiler/cli/test/support.h"
#include "runtime/host/read_image.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Spectra take Blender 27 pictures, which is too long here, and of the ways that light takes in glass.scn it
// follows too few. The built programs draw the generic pictures bit for bit, as another test shows; that
// `validate` runs them is shown once. A lens is compared in tests of its own, with many samples, and a zone
// plate asks for more digits than Blender has.
INSTANTIATE_TEST_SUITE_P(
    All, Examples,
    testing::Values(Example{"lecture", "pov,blender,native"}, Example{"mesh", "pov,blender"},
                    Example{"lighthouse", "pov,blender"}, Example{"transforms", "pov,blender"},
                    Example{"lights", "pov,blender"}, Example{"mirrors", "pov,blender"},
                    Example{"stage", "pov,blender"}, Example{"rings", "pov,blender"},
                    Example{"quadrics", "pov,blender"}, Example{"landscape", "pov,blender"},
                    Example{"textures", "pov,blender"}, Example{"bump", "pov,blender"},
                    Example{"csg", "pov,blender"}, Example{"cutaway", "pov,blender"}, Example{"glass", "pov"},
                    Example{"shapes", "pov,blender"}, Example{"implicit", "pov,blender"},
                    Example{"lattice", "pov,blender"}, Example{"spectra", "pov"},
                    Example{"panorama", "pov,blender"}, Example{"lens", "native"},
                    Example{"zone_plate", "pov", false}, Example{"shading", "opengl", false},
                    Example{"highlight", "opengl", false}, Example{"quad_split", "opengl", false},
                    Example{"lines", "native", false}),
    [](const auto& row) { return std::string(row.param.name); });

TEST_P(Examples, CheckWithoutAWarning) {
    const auto result = scc({"check", "--strict", scene()});
    EXPECT_TRUE(result.ok()) << result.err;
}

/// Compiling takes its time: every other example in float, the rest in double.
TEST_P(Examples, GenericAndSpecialisedPicturesAreIdentical) {
    const char* const precision = std::string_view(GetParam().name).size() % 2 == 0 ? "float" : "double";
    ASSERT_TRUE(scc({"build", scene(), "-o", "prog", "--precision", precision}).ok());
    ASSERT_TRUE(scc({"render", scene(), "-o", "generic.pfm", "--size", "160x120", "--samples", "4",
                     "--precision", precision})
                    .ok());
    ASSERT_TRUE(start(path("prog"), {"-o", "native.pfm", "--size", "160x120", "--samples", "4"}).ok());
    EXPECT_TRUE(read("generic.pfm") == read("native.pfm")) << precision;
}

TEST_P(Examples, AgreeWithOtherRenderers) {
    for (const char* renderer : {"povray", "blender"}) {
        if (!validation::find_program(renderer)) {
            GTEST_SKIP() << renderer << " is not installed";
        }
    }
#ifndef SCC_HAS_OPENGL
    if (against().find("opengl") != std::string::npos) {
        GTEST_SKIP() << "built without OpenGL (libosmesa6-dev)";
    }
#endif
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

TEST_F(CommandLine, ExportsLeaveOutNeitherLensesNorFiltersUnasked) {
    EXPECT_EQ(scc({"export", "pov", example("lens.scn"), "-o", "s.pov"}).code, 1);
    EXPECT_EQ(scc({"export", "pov", example("zone_plate.scn"), "-o", "s.pov"}).code, 1);
    EXPECT_FALSE(exists("s.pov"));
    EXPECT_TRUE(scc({"export", "pov", example("zone_plate.scn"), "-o", "s.pov", "--allow-drop"}).ok());
}

/// Where a zone plate's rings are finer than two pixels, the right answer is their mean: what differs from it
/// is at false frequencies. The figures stand in the README.
TEST_F(CommandLine, ZonePlatesShowWhatSamplersAndFiltersLeaveOfFalseRings) {
    struct Row {
        const char *samples, *sampler, *filter;
        double deviation; ///< from the mean, root mean square
    };
    for (const Row& row :
         {Row{"1", "grid", "box", 0.354}, Row{"16", "grid", "box", 0.0733},
          Row{"16", "low_discrepancy", "box", 0.0740}, Row{"16", "grid", "mitchell", 0.0188},
          Row{"16", "low_discrepancy", "mitchell", 0.0294}, Row{"16", "grid", "gaussian", 0.0146},
          Row{"16", "low_discrepancy", "gaussian", 0.0240}, Row{"16", "grid", "blackman_harris", 0.0258},
          Row{"16", "low_discrepancy", "blackman_harris", 0.0341}}) {
        ASSERT_TRUE(scc({"render", example("zone_plate.scn"), "-o", "plate.pfm", "-D",
                         std::string("samples=") + row.samples, "-D", std::string("sampler=") + row.sampler,
                         "--filter", row.filter})
                        .ok());
        const runtime::Image image = host::read_image(path("plate.pfm"));
        double squares = 0;
        int count = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const double rings = 1.5 * std::hypot((x + 0.5) / 128 - 1, (y + 0.5) / 128 - 1); // per pixel
                if (rings > 0.6 && rings < 1.5) {
                    squares += std::pow(double{image.at(x, y)[0]} - 0.5, 2);
                    ++count;
                }
            }
        }
        EXPECT_NEAR(std::sqrt(squares / count), row.deviation, 0.02 * row.deviation)
            << row.samples << " " << row.sampler << " " << row.filter;
    }
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
