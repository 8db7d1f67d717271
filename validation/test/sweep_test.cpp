#include "validation/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scc::validation {
namespace {

/// error = 1 / sqrt(samples), time = seconds_per_sample * samples.
SweepSeries series(const std::string& name, double seconds_per_sample, int from = 1, int to = 256) {
    SweepSeries result{.renderer = name, .knob = "samples per pixel"};
    for (int samples = from; samples <= to; samples *= 4) {
        SweepPoint point{.setting = std::to_string(samples), .quality = double(samples)};
        point.error = 1 / std::sqrt(point.quality);
        point.times.total = point.times.trace = seconds_per_sample * point.quality;
        result.points.push_back(point);
    }
    return result;
}

TEST(Sweep, FitsOrders) {
    const auto fit = error_by_quality(series("scc", 1));
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->order, -0.5, 1e-12);
    EXPECT_NEAR(fit->factor, 1, 1e-12);
    EXPECT_EQ(fit->points, 5U);
    EXPECT_FALSE(fit_power_law({1, 2}, {1, 2}));
    EXPECT_FALSE(fit_power_law({2, 2, 2}, {1, 2, 3}));
    EXPECT_FALSE(fit_power_law({0, -1, 2, 4}, {1, 1, NAN, 3}));
}

TEST(Sweep, RatiosAreInterpolatedAndNeverExtrapolated) {
    // Twenty times slower per sample: twenty times longer to the same error, sqrt(20) times worse after the
    // same time.
    const SweepSeries ours = series("scc double", 0.01);
    const SweepSeries other = series("pov", 0.2, 2, 32);
    const auto error = equal_error_ratio(ours, other, &RenderTimes::total);
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->median, 20, 1e-9);
    EXPECT_NEAR(error->least, 20, 1e-9);
    EXPECT_EQ(error->points, 3U);
    const auto time = equal_time_ratio(ours, other, &RenderTimes::trace);
    ASSERT_TRUE(time);
    EXPECT_NEAR(time->median, std::sqrt(20), 1e-9);
    EXPECT_EQ(time->points, 2U) << "6.4 s are beyond what ours took";
    EXPECT_FALSE(equal_error_ratio(series("scc", 1, 1, 4), series("pov", 1, 16, 64), &RenderTimes::total));
    EXPECT_FALSE(equal_error_ratio(ours, other, &RenderTimes::parse));
}

TEST(Sweep, WhatIsNeitherBetterNorCheaperDoesNotCount) {
    SweepSeries ours = series("scc double", 0.01);
    SweepPoint worse = ours.points[2];
    worse.error *= 3;
    worse.times.total = 0.5;
    ours.points.push_back(worse);
    EXPECT_NEAR(equal_error_ratio(ours, series("pov", 0.2), &RenderTimes::total)->median, 20, 1e-9);
}

TEST(Sweep, HtmlAndJsonHoldPlotsOrdersAndRatios) {
    SweepScene scene{.name = "s", .reference_made_by = "scc <64>", .confirmation = "by POV-Ray"};
    scene.series = {
        series("scc double", 0.01), series("pov", 0.2), {.renderer = "blender", .failure = "a<b"}};
    const auto json = to_json(scene);
    EXPECT_NEAR(json["series"][0]["order"].get<double>(), -0.5, 1e-9);
    EXPECT_EQ(json["ratios"].size(), 2U);
    EXPECT_NEAR(json["ratios"][0]["equal_error_process"]["median"].get<double>(), 20, 1e-9);
    EXPECT_TRUE(json["ratios"][1]["equal_error_process"].is_null());
    const std::string html = to_html(scene);
    for (const char* part : {"<svg", "-0.50", "20 (20 .. 20, 5)", "none in common", "a&lt;b", "&lt;64&gt;"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_EQ(html.find("inf"), std::string::npos);
}

} // namespace
} // namespace scc::validation
