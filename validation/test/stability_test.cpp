#include "validation/stability/families.h"
#include "validation/stability/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace scc::validation {
namespace {

Reading reading(double max_error, double wrong = 0) {
    return {.drawn = true, .reason = {}, .max_error = max_error, .wrong = wrong};
}

/// Three steps; float is lost from the second on, double from the third on.
Sweep falling(const char* chosen_second) {
    Sweep sweep;
    sweep.name = "<falling>";
    sweep.title = "a & b";
    sweep.holds_to = 1;
    const Reading good = reading(1e-7), bad = reading(0.5, 1);
    const bool single = std::string_view(chosen_second) == "float";
    sweep.steps = {{0, {good, good, good}, "float", "why", false},
                   {1, {bad, good, single ? bad : good}, chosen_second, "why", false},
                   {2, {bad, bad, bad}, "double", "why", false}};
    return sweep;
}

TEST(Stability, TheTableIsSane) {
    std::set<std::string_view> names;
    for (const Family& family : families()) {
        SCOPED_TRACE(family.name);
        EXPECT_TRUE(names.insert(family.name).second);
        EXPECT_EQ(find_family(family.name), &family);
        EXPECT_NE(family.from, family.to);
        EXPECT_LE(std::abs(family.holds_to - family.from), std::abs(family.to - family.from));
        EXPECT_GE((family.holds_to - family.from) * (family.to - family.from), 0);
        EXPECT_EQ(family.bound.empty(), family.holds_to == family.to) << "a bound has a reason";
        const std::string_view text = scene_text(family.scene);
        EXPECT_NE(text.find("param value: number"), text.npos);
        EXPECT_EQ(text.find("param formula") != text.npos, family.reference == Reference::formula);
    }
    EXPECT_EQ(find_family("none"), nullptr);
    EXPECT_TRUE(scene_text("none").empty());
}

TEST(Stability, AThresholdIsTheLastStepBeforeTheFirstLoss) {
    Sweep sweep = falling("double");
    EXPECT_EQ(threshold(sweep, in_float), 0);
    EXPECT_EQ(threshold(sweep, in_double), 1);
    EXPECT_EQ(threshold(sweep, in_auto), 1);
    sweep.steps[0].readings[in_float] = {};
    EXPECT_EQ(threshold(sweep, in_float), std::nullopt);
    sweep.steps[2].readings[in_float] = reading(0);
    EXPECT_EQ(threshold(sweep, in_float), std::nullopt) << "what comes back later does not count";
}

TEST(Stability, AutoIsJudgedByItsRecordAndByItsPicks) {
    EXPECT_FALSE(is_worse_than_recorded(falling("double")));
    EXPECT_TRUE(wrong_picks(falling("double")).empty());
    EXPECT_TRUE(is_worse_than_recorded(falling("float")));
    EXPECT_EQ(wrong_picks(falling("float")), std::vector{1});
    EXPECT_EQ(beyond_double(falling("double")), std::vector{2});
    EXPECT_EQ(unwarned(falling("double")), std::vector{2});
    Sweep warned = falling("double");
    warned.steps[2].warned = true;
    EXPECT_TRUE(unwarned(warned).empty());
    Sweep unrecorded = falling("float");
    unrecorded.holds_to.reset();
    EXPECT_FALSE(is_worse_than_recorded(unrecorded));
    Sweep cautious = falling("double");
    cautious.steps[1].readings[in_float] = reading(0);
    EXPECT_EQ(cautious_picks(cautious), std::vector{1});
}

TEST(Stability, PicturesAreReadAwayFromEdgesAndAtThem) {
    runtime::Image flat(32, 32);
    const Reading same = read(flat, flat);
    EXPECT_TRUE(same.kept());
    EXPECT_EQ(same.digits(), 16);
    runtime::Image other = flat;
    other.at(5, 5)[1] = 1e-3F;
    const Reading off = read(flat, other);
    EXPECT_FALSE(off.kept());
    EXPECT_NEAR(off.digits(), 3, 1e-3);
    EXPECT_DOUBLE_EQ(off.wrong, 1.0 / 1024);
    other.at(5, 5)[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(read(flat, other).kept());
    EXPECT_EQ(read(flat, other).digits(), 0);
    EXPECT_FALSE(reading(0, 0.5).kept()) << "too much of it at edges";
}

TEST(Stability, APictureOfNothingButEdgesIsReadEverywhere) {
    runtime::Image checks(32, 32);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            checks.at(x, y)[0] = static_cast<float>((x + y) % 2);
        }
    }
    EXPECT_TRUE(read(checks, checks).kept());
    runtime::Image other = checks;
    other.at(5, 5)[0] += 0.01F;
    EXPECT_FALSE(read(checks, other).kept());
    EXPECT_NEAR(read(checks, other).digits(), 2, 1e-3);
}

TEST(Stability, TheReportHoldsTheNumbersAndEscapesTexts) {
    StabilityReport report;
    report.width = report.height = 64;
    report.sweeps = {falling("float")};
    const auto json = to_json(report);
    EXPECT_EQ(json["sweeps"][0]["thresholds"]["double"], 1);
    EXPECT_EQ(json["sweeps"][0]["auto"]["wrong_picks"][0], 1);
    EXPECT_EQ(json["sweeps"][0]["steps"][1]["engines"]["auto"]["kept"], false);
    const std::string html = to_html(report);
    EXPECT_EQ(html.find("<falling>"), html.npos);
    EXPECT_NE(html.find("&lt;falling&gt;"), html.npos);
    EXPECT_NE(html.find("<polyline"), html.npos);
    EXPECT_NE(to_text(report.sweeps[0]).find("WORSE"), std::string::npos);
}

} // namespace
} // namespace scc::validation
