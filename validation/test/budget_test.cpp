#include "validation/budget.h"
#include "validation/scene_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scc::validation {
namespace {

using runtime::Image;

Judgement judge_images(const Budget& budget, const Image& reference, const Image& other) {
    return judge(budget, compare(reference, other, {.thresholds = thresholds_for(budget)}));
}

/// A flat image with an error in the first `count` pixels.
Image off_by(int width, int height, float error, int count) {
    Image image(width, height);
    for (int i = 0; i < count; ++i)
        image.at(i % width, i / width)[1] = error;
    return image;
}

TEST(Budget, GrowsWithTheImageButNotBelowItsBase) {
    EXPECT_EQ(budget_for("pov", 160, 120)->outliers, 5U);
    EXPECT_EQ(budget_for("pov", 640, 480)->outliers, 5U);
    EXPECT_EQ(budget_for("pov", 1280, 960)->outliers, 20U);
    EXPECT_EQ(budget_for("pov", 640, 480, 3)->outliers, 5U);
    EXPECT_EQ(budget_for("blender", 640, 480, 4)->above_1e3, 320U);
    EXPECT_EQ(budget_for("blender", 64, 48)->above_1e3, 20U);
    EXPECT_EQ(budget_for("blender", 1280, 480)->above_1e3, 40U);
    EXPECT_EQ(budget_for("native", 6400, 4800)->outliers, 0U);
}

TEST(Budget, FollowsTheExposureOfAnIntegerFileOnly) {
    EXPECT_DOUBLE_EQ(budget_for("pov", 640, 480, 1, 0.25)->max_error, 8e-5);
    EXPECT_EQ(budget_for("blender", 640, 480, 1, 0.25)->max_away_from_edges, 1e-4);
    EXPECT_EQ(budget_for("native", 640, 480, 1, 0.25)->max_error, 0);
}

TEST(Budget, AllowsForTheOutlinesOfRefinedMeshes) {
    const Budget whole = with_refined_meshes(*budget_for("blender", 640, 480), 640, 480);
    EXPECT_EQ(whole.above_1e3, 420U);
    EXPECT_EQ(whole.outliers, 620U);
    EXPECT_EQ(whole.max_error, 1e-4);
    EXPECT_FALSE(whole.max_away_from_edges);
    EXPECT_NE(whole.reason.find("outlines"), std::string::npos);
    // In a small picture they are fewer.
    EXPECT_EQ(with_refined_meshes(*budget_for("blender", 160, 120), 160, 120).above_1e3, 45U);
    EXPECT_EQ(with_refined_meshes(*budget_for("blender", 160, 120, 2), 160, 120, 2).above_1e3, 120U);
}

TEST(Budget, UnknownRendererHasNone) {
    EXPECT_FALSE(budget_for("povray", 640, 480));
}

TEST(Budget, EveryLimitHasAReason) {
    for (const char* renderer : {"native", "pov", "blender"}) {
        EXPECT_FALSE(budget_for(renderer, 640, 480)->reason.empty());
        EXPECT_EQ(to_json(*budget_for(renderer, 640, 480))["renderer"], renderer);
    }
    EXPECT_FALSE(to_json(*budget_for("blender", 640, 480)).contains("max_error"));
}

TEST(Judge, NativeMustBeIdentical) {
    const Budget budget = *budget_for("native", 32, 32);
    const Image reference(32, 32);
    EXPECT_EQ(judge_images(budget, reference, reference).verdict, Verdict::passed);
    const Judgement judgement =
        judge_images(budget, reference, off_by(32, 32, std::numeric_limits<float>::denorm_min(), 1));
    EXPECT_EQ(judgement.verdict, Verdict::failed);
    EXPECT_EQ(judgement.reason,
              "1 pixels differ by more than 0, 0 may; the largest error is 1.4e-45 at pixel (0, 0)");
}

TEST(Judge, PovMayHaveFiveOutliers) {
    const Budget budget = *budget_for("pov", 64, 48);
    const Image reference(64, 48);
    EXPECT_EQ(judge_images(budget, reference, off_by(64, 48, 1.9e-5F, 64 * 48)).verdict, Verdict::passed);
    EXPECT_EQ(judge_images(budget, reference, off_by(64, 48, 0.5F, 5)).verdict, Verdict::passed);
    EXPECT_EQ(judge_images(budget, reference, off_by(64, 48, 2.1e-5F, 6)).verdict, Verdict::failed);
}

TEST(Judge, DarkerDrawnPovIsMeasuredByItsCoarserSteps) {
    const Budget budget = *budget_for("pov", 64, 48, 1, 0.25);
    const Image reference(64, 48);
    EXPECT_EQ(judge_images(budget, reference, off_by(64, 48, 7.9e-5F, 100)).verdict, Verdict::passed);
    EXPECT_EQ(judge_images(budget, reference, off_by(64, 48, 8.1e-5F, 100)).verdict, Verdict::failed);
}

TEST(Judge, BlenderIsStrictInsideAndCountsEdges) {
    const Budget budget = *budget_for("blender", 64, 48);
    Image reference(64, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 32; x < 64; ++x)
            reference.at(x, y)[0] = 0.5F;
    Image other = reference;
    for (int y = 0; y < 20; ++y)
        other.at(32, y)[0] = 0;
    EXPECT_EQ(judge_images(budget, reference, other).verdict, Verdict::passed);
    other.at(32, 20)[0] = 0;
    EXPECT_NE(
        judge_images(budget, reference, other).reason.find("21 pixels differ by more than 0.001, 20 may"),
        std::string::npos);
    other = reference;
    other.at(5, 5)[0] = 1.1e-4F;
    EXPECT_EQ(judge_images(budget, reference, other).reason,
              "away from edges the largest error is 0.00011 at pixel (5, 5), 0.0001 may be");
}

TEST(Judge, ImageOfNothingButEdgesIsNotPassed) {
    Image reference(8, 8);
    for (int i = 0; i < 64; ++i)
        reference.at(i % 8, i / 8)[0] = static_cast<float>((i + i / 8) % 2);
    EXPECT_EQ(judge_images(*budget_for("blender", 8, 8), reference, reference).verdict, Verdict::failed);
}

TEST(Judge, ValuesThatAreNotFiniteAlwaysFail) {
    Image image(64, 48);
    image.at(1, 1)[0] = std::nanf("");
    for (const char* renderer : {"native", "pov", "blender"})
        EXPECT_EQ(judge_images(*budget_for(renderer, 64, 48), image, image).verdict, Verdict::failed)
            << renderer;
}

TEST(SceneBudget, ReplacesWhatItStatesAndSaysSo) {
    const std::vector<SceneBudget> stated =
        read_scene_budgets("// budget of rays\n  //@ budget blender: above_1e-3 = 60, away_from_edges = 2e-4 "
                           "because it is: random, too\r\nsphere { } //@ no comment of its own\n"
                           "//@ budget pov:max_error=1e-4,outliers=0 because so\n");
    ASSERT_EQ(stated.size(), 2U);
    EXPECT_EQ(stated[0].line, 2);
    const Budget usual = *budget_for("blender", 640, 480);
    const Budget budget = with_scene_budget(usual, stated[0], 1280, 480);
    EXPECT_EQ(budget.above_1e3, 120U);
    EXPECT_EQ(budget.max_away_from_edges, 2e-4);
    EXPECT_EQ(budget.outliers, usual.outliers);
    EXPECT_NE(budget.reason.find("line 2: it is: random, too (otherwise: single precision"),
              std::string::npos)
        << budget.reason;
    const Budget pov = with_scene_budget(*budget_for("pov", 640, 480), stated[1], 640, 480);
    EXPECT_EQ(pov.max_error, 1e-4);
    EXPECT_EQ(pov.outliers, 0U);
}

TEST(SceneBudget, WhatIsNoneIsAnErrorWithItsLine) {
    for (const char* text :
         {"//@ budgets pov: outliers = 1 because x", "//@ budget pov outliers = 1 because x",
          "//@ budget maya: outliers = 1 because x", "//@ budget pov: outlier = 1 because x",
          "//@ budget pov: outliers = 1", "//@ budget pov: outliers = 1 because ",
          "//@ budget pov: outliers = 1.5 because x", "//@ budget pov: outliers = -1 because x",
          "//@ budget pov: outliers = 1e300 because x", "//@ budget pov: max_error = nan because x",
          "//@ budget pov: max_error = 1x because x", "//@ budget pov: max_error because x",
          "//@ budget pov: because x", "//@ budget pov: outliers = 1, because x",
          "//@ budget pov: outliers = 1 because x\n//@ budget pov: outliers = 2 because x", "//@", "//@x"}) {
        try {
            read_scene_budgets("\n" + std::string(text));
            ADD_FAILURE() << text;
        } catch (const BudgetError& error) {
            EXPECT_GE(error.line, 2) << text;
        }
    }
    EXPECT_TRUE(read_scene_budgets("").empty());
}

} // namespace
} // namespace scc::validation
