#include "lang/colorimetry.h"
#include "lang/test/toy_schema.h"
#include "lang/test/trace_recorder.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scc::lang {
namespace {

using test::messages_of;
using test::Scene;
using test::value_of;

/// The numbers that `print(expression)` shows.
std::vector<double> numbers_of(const std::string& expression) {
    std::string text = value_of(expression);
    std::vector<double> numbers;
    for (std::size_t at = text.find_first_of("-0123456789"); at != std::string::npos;
         at = text.find_first_of("-0123456789", at)) {
        std::size_t length = 0;
        numbers.push_back(std::stod(text.substr(at), &length));
        at += length;
    }
    return numbers;
}

void expect_near(const std::string& expression, const std::vector<double>& expected, double tolerance) {
    const std::vector<double> found = numbers_of(expression);
    ASSERT_EQ(found.size(), expected.size()) << value_of(expression);
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], tolerance) << expression;
    }
}

TEST(Colorimetry, TheMatricesUndoEachOther) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                sum += rec709_from_xyz[i][k] * xyz_from_rec709[k][j];
            }
            EXPECT_NEAR(sum, i == j ? 1 : 0, 1e-15);
        }
    }
}

TEST(Colorimetry, ThePrimariesAndWhiteAreThoseOfTheStandard) { // ITU-R BT.709-6, item 3.2
    expect_near("chromaticity(rgb(1, 0, 0))", {0.64, 0.33}, 1e-12);
    expect_near("chromaticity(rgb(0, 1, 0))", {0.30, 0.60}, 1e-12);
    expect_near("chromaticity(rgb(0, 0, 1))", {0.15, 0.06}, 1e-12);
    expect_near("chromaticity(rgb(2, 2, 2))", {0.3127, 0.3290}, 1e-12);
    expect_near("luminance(rgb(1, 0, 0))", {0.2126}, 5e-5);
    expect_near("luminance(rgb(0, 1, 0))", {0.7152}, 5e-5);
    expect_near("luminance(rgb(3, 3, 3))", {3}, 1e-15);
    expect_near("xyz(0.3127 / 0.3290, 1, 0.3583 / 0.3290)", {1, 1, 1}, 1e-14);
    expect_near("xyz(0, 1, 0)", {-1.5373831775700935, 1.8759675015077206, -0.20397695888897657}, 1e-15);
}

TEST(Colorimetry, BlackBodiesLieOnThePlanckianLocus) { // CIE 15:2004; Wyszecki and Stiles
    expect_near("chromaticity(blackbody(2856))", {0.4476, 0.4074}, 1e-4);
    expect_near("chromaticity(blackbody(6500))", {0.3135, 0.3237}, 1e-4);
    expect_near("chromaticity(blackbody(5000))", {0.3451, 0.3516}, 1e-4);
    expect_near("chromaticity(blackbody(10000))", {0.2807, 0.2884}, 1e-4);
    // Of an endlessly hot body.
    expect_near("chromaticity(blackbody(1e12))", {0.2399, 0.2341}, 1e-4);
    for (const char* kelvin : {"1", "300", "1500", "6500", "1e9"}) {
        expect_near("luminance(blackbody(" + std::string(kelvin) + "))", {1}, 1e-9);
    }
}

TEST(Colorimetry, ColorsOutsideOfRec709KeepTheirSign) {
    EXPECT_LT(numbers_of("blackbody(1500)").at(2), 0);
    EXPECT_EQ(numbers_of("max(blackbody(1500), rgb(0, 0, 0))").at(2), 0);
}

TEST(Colorimetry, WhatHasNoColorIsAnError) {
    EXPECT_EQ(
        messages_of("print(blackbody(0))"),
        R"(a.scn:1:7: error: the temperature is 0; a temperature is in kelvin and greater than 0 [value-out-of-range]
    1 | print(blackbody(0))
      |       ^~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("print(blackbody(1 / 1e-308 * 1e10))").summary(), "1 value-out-of-range\n");
    EXPECT_EQ(Scene("print(chromaticity(rgb(0, 0, 0)))").summary(), "1 division-by-zero\n");
}

TEST(Colorimetry, SurfacesMayUseAllButTheBlackBody) {
    const auto messages = [](const char* tone) {
        Scene scene(fmt::format("ball {{ material = paint {{ tone = fn(s: surface) = {} }} }}", tone));
        test::trace_all(scene);
        return scene.messages();
    };
    EXPECT_EQ(messages("xyz(s.p.x, 1, luminance(rgb(s.p.x, 0, chromaticity(rgb(1, s.p.y, 0)).x)))"), "");
    EXPECT_EQ(messages("blackbody(6500) * s.p.x"), "");
    EXPECT_EQ(
        messages("blackbody(s.p.x)"),
        R"(a.scn:1:51: error: this argument depends on the surface; this function takes what is known [depends-on-surface]
    1 | ball { material = paint { tone = fn(s: surface) = blackbody(s.p.x) } }
      |                                                   ^~~~~~~~~~~~~~~~
)");
}

TEST(Colorimetry, LoopsTakeThem) {
    EXPECT_EQ(messages_of("for (i in 0..100) {\n  ball { radius = luminance(blackbody(1000 + i)) }\n"
                          "  ball { radius = luminance(xyz(i, 1, i)) }\n}"),
              "");
}

} // namespace
} // namespace scc::lang
