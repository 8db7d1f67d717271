#include "lang/spectrum.h"
#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

namespace scc::lang {
namespace {

using test::messages_of;
using test::value_of;

using Point = std::array<double, 2>;

std::string headline(const std::string& scene) {
    const std::string messages = messages_of(scene);
    return messages.substr(0, messages.find('\n'));
}

void expect_near(const Triple& found, const Triple& expected, double tolerance) {
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(found[k], expected[k], tolerance) << k;
    }
}

Triple rec709_under(const Spectrum& surface, std::string_view illuminant) {
    Spectrum light = *find_illuminant(illuminant);
    for (std::size_t i = 0; i < spectrum_size; ++i) {
        light[i] *= surface[i];
    }
    const Triple xyz = xyz_of_light(light);
    Triple result{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 3; ++k) {
            result[row] += rec709_from_xyz[row][k] * xyz[k];
        }
    }
    return result;
}

TEST(Spectrum, TheIlluminantsHaveTheirChromaticities) { // CIE 15:2004, table T.3
    const auto expect = [](std::string_view name, double x, double y) {
        const Triple xyz = xyz_of_light(*find_illuminant(name));
        const double sum = xyz[0] + xyz[1] + xyz[2];
        EXPECT_NEAR(xyz[0] / sum, x, 6e-6) << name;
        EXPECT_NEAR(xyz[1] / sum, y, 6e-6) << name;
        EXPECT_NEAR(xyz[1], 1, 1e-14) << name;
    };
    expect("a", 0.44758, 0.40745);
    expect("d65", 0.31272, 0.32903);
    expect("e", 1.0 / 3, 1.0 / 3);
}

TEST(Spectrum, LiesOnStraightLinesAndIsLevelOutside) {
    const Spectrum s = sampled(std::array{Point{400, 1}, Point{500, 2}, Point{700, 0}});
    EXPECT_EQ(s.front(), 1);
    EXPECT_DOUBLE_EQ(s[(450 - 380) / 5], 1.5);
    EXPECT_DOUBLE_EQ(s[(500 - 380) / 5], 2);
    EXPECT_DOUBLE_EQ(s[(650 - 380) / 5], 0.5);
    EXPECT_EQ(s.back(), 0);
}

TEST(Spectrum, LosesNoLineHoweverNarrow) {
    for (const double at : {500.0, 501.3, 502.5, 504.9}) {
        // Half a nanometre wide, of area 1
        const Spectrum s = sampled(std::array{Point{at - 0.5, 0}, Point{at, 2}, Point{at + 0.5, 0}});
        EXPECT_NEAR(5 * std::accumulate(s.begin(), s.end(), 0.0), 1, 1e-12) << at;
        double centre = 0;
        for (std::size_t i = 0; i < spectrum_size; ++i) {
            centre += 5 * s[i] * wavelength(i);
        }
        EXPECT_NEAR(centre, at, 1e-9);
    }
}

TEST(Spectrum, PlainColoursHaveReflectancesThatLookLikeThem) {
    const std::array<Spectrum, 3>& basis = rec709_reflectances();
    for (std::size_t k = 0; k < 3; ++k) {
        Triple expected{};
        expected[k] = 1;
        expect_near(rec709_under(basis[k], "d65"), expected, 1e-6);
        for (const double value : basis[k]) {
            EXPECT_GE(value, 0);
        }
    }
    for (std::size_t i = 0; i < spectrum_size; ++i) {
        EXPECT_NEAR(basis[0][i] + basis[1][i] + basis[2][i], 1, 3e-4);
    }
}

// Fresnel's equations for n + ik as tabulated at 659.5 nm, beside which both lie nearly level: gold 0.14
// + 3.697i, silver 0.05 + 4.483i
TEST(Spectrum, MetalsMirrorByTheirRefractiveIndex) {
    const auto at_660 = [](std::string_view name) { return (*metal_reflectance(name))[(660 - 380) / 5]; };
    EXPECT_NEAR(at_660("gold"), (0.86 * 0.86 + 3.697 * 3.697) / (1.14 * 1.14 + 3.697 * 3.697), 1e-3);
    EXPECT_NEAR(at_660("silver"), (0.95 * 0.95 + 4.483 * 4.483) / (1.05 * 1.05 + 4.483 * 4.483), 1e-3);
    expect_near(rec709_under(*metal_reflectance("gold"), "d65"), {1.04, 0.73, 0.36}, 0.01);
    expect_near(rec709_under(*metal_reflectance("copper"), "d65"), {0.93, 0.62, 0.52}, 0.01);
    for (const std::string_view name : metal_names()) {
        const Spectrum surface = *metal_reflectance(name);
        EXPECT_LT(*std::max_element(surface.begin(), surface.end()), 1) << name;
    }
    EXPECT_FALSE(metal_reflectance("brass"));
}

TEST(SpectralColour, AddsScalesAndMultipliesSampleBySample) {
    const std::string s = "spectrum([(400, 0.2), (700, 0.8)])";
    const std::string flat = "spectrum([(500, 0.5)])";
    EXPECT_EQ(value_of("luminance(" + flat + ")"), "0.5");
    EXPECT_EQ(value_of("luminance(2 * (" + flat + " + " + flat + ") / 4 - 0.5 * " + flat + ")"), "0.25");
    EXPECT_EQ(value_of("luminance(" + flat + " * " + flat + ")"), "0.25");
    EXPECT_EQ(value_of("luminance(sum([" + flat + ", " + flat + "]))"), "1");
    EXPECT_EQ(value_of("luminance(mix(" + flat + ", rgb(1, 1, 1), 0.5))"), "0.75");
    EXPECT_EQ(value_of("luminance(-" + flat + ")"), "-0.5");
    EXPECT_EQ(value_of("luminance(" + s + " * " + flat + ") == luminance(" + s + ") * 0.5"), "true");
    EXPECT_EQ(value_of("spectrum([(500, 0.5)])").substr(0, 16), "spectrum of rgb(");
}

TEST(SpectralColour, ASurfaceIsSeenUnderAnIlluminant) {
    const std::string red = "rgb(0.9, 0.2, 0.1)";
    EXPECT_EQ(value_of("length(chromaticity(illuminant(\"d65\") * (" + red +
                       " + spectrum([(500, 0)]))) - "
                       "chromaticity(" +
                       red + ")) < 1e-6"),
              "true");
    EXPECT_EQ(
        value_of(
            "length(chromaticity(illuminant(\"a\") * spectrum([(500, 1)])) - (0.44758, 0.40745)) < 1e-5"),
        "true");
}

TEST(SpectralColour, DoesNotGoWhereThereAreThreeNumbers) {
    const std::string rule = " does not take colours that have a spectrum; such colours can be added, mixed, "
                             "multiplied, and divided by numbers [spectral-color]";
    EXPECT_EQ(headline("print(max(metal(\"gold\"), rgb(0, 0, 0)))"),
              "a.scn:1:7: error: this function" + rule);
    EXPECT_EQ(headline("print(metal(\"gold\").r)"), "a.scn:1:7: error: `.r .g .b`" + rule);
    EXPECT_EQ(headline("print(metal(\"gold\") == metal(\"iron\"))"),
              "a.scn:1:7: error: this operation" + rule);
    EXPECT_EQ(headline("print(1 / 2 * metal(\"gold\") / rgb(1, 1, 1))"),
              "a.scn:1:7: error: this operation" + rule);
}

TEST(SpectralColour, WrongSpectraAreExplained) {
    EXPECT_EQ(headline("print(spectrum([]))"),
              "a.scn:1:7: error: this spectrum has no points; a point is (wavelength in nm, value) "
              "[bad-spectrum]");
    EXPECT_EQ(headline("print(spectrum([(500, 1), (400, 1)]))"),
              "a.scn:1:7: error: in this spectrum 400 nm comes after 500 nm; wavelengths ascend "
              "[bad-spectrum]");
    EXPECT_EQ(headline("print(spectrum([(-1, 1)]))"),
              "a.scn:1:7: error: this spectrum has the point (-1, 1); a wavelength is in nm and greater "
              "than 0, and a value at most 1e30 [bad-spectrum]");
    EXPECT_EQ(headline("print(metal(\"golt\"))"),
              "a.scn:1:7: error: the metal is \"golt\"; the choices are \"aluminium\", \"chromium\", "
              "\"copper\", \"gold\", \"iron\" or \"silver\" [unknown-choice]");
}

} // namespace
} // namespace scc::lang
