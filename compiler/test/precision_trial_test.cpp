#include "compiler/backends/precision_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace scc::compiler {
namespace {

/// The grey at a place of the picture; both coordinates from 0 to 1.
using Picture = std::function<double(double, double)>;

decltype(host::Drawable::render) renderer_of(const Picture& picture) {
    return [picture](const runtime::RenderRequest& request, runtime::Image& image) {
        const runtime::Crop& crop = request.crop;
        for (int y = crop.y0; y < crop.y1; ++y) {
            for (int x = crop.x0; x < crop.x1; ++x) {
                const auto grey = static_cast<float>(
                    picture((x + 0.5) / request.settings.width, (y + 0.5) / request.settings.height));
                float* pixel = image.at(x - crop.x0, y - crop.y0);
                pixel[0] = pixel[1] = pixel[2] = grey;
            }
        }
        return runtime::RenderResult{};
    };
}

class PrecisionTrialOf : public testing::TestWithParam<bool> {
protected:
    static constexpr int width = 640, height = 480;

    PrecisionTrial run(const Picture& single, const Picture& full) const {
        runtime::RenderSettings settings;
        settings.width = width;
        settings.height = height;
        return try_float(renderer_of(single), renderer_of(full), settings, {.coherent = GetParam()});
    }
    static Picture shifted(const Picture& picture, double pixels) {
        return [=](double u, double v) { return picture(u + pixels / width, v); };
    }
};
INSTANTIATE_TEST_SUITE_P(SparseAndInBlocks, PrecisionTrialOf, testing::Bool());

double smooth(double u, double v) {
    return 0.5 + 0.4 * std::sin(5 * u) * std::cos(3 * v);
}
/// Of stripes so narrow that about one sample in a hundred lies within 1/200 pixel of an edge.
double edges(double u, double v) {
    return std::fmod(877.3 * u + 101.7 * v, 2) < 1 ? 0.2 : 0.7;
}

TEST_P(PrecisionTrialOf, SmallDifferencesPass) {
    const PrecisionTrial trial = run([](double u, double v) { return smooth(u, v) + 5e-5; }, smooth);
    EXPECT_TRUE(trial.passed) << trial.reason;
    EXPECT_EQ(trial.reason.find("1/128 pixel"), std::string::npos) << trial.reason;
}

TEST_P(PrecisionTrialOf, SlightShiftsOfEdgesPass) {
    const PrecisionTrial trial = run(shifted(edges, 1.0 / 200), edges);
    EXPECT_TRUE(trial.passed) << trial.reason;
    EXPECT_NE(trial.reason.find("where the picture changes within 1/128 pixel"), std::string::npos)
        << trial.reason;
}

TEST_P(PrecisionTrialOf, LargerShiftsFail) {
    EXPECT_FALSE(run(shifted(edges, 1.0 / 20), edges).passed);
}

TEST_P(PrecisionTrialOf, WrongTonesFail) {
    for (const double offset : {5e-4, 5e-3}) {
        const PrecisionTrial trial = run([=](double u, double v) { return smooth(u, v) + offset; }, smooth);
        EXPECT_FALSE(trial.passed) << trial.reason;
    }
}

TEST_P(PrecisionTrialOf, SpecksFail) {
    const auto specks = [](double u, double v) {
        return std::fmod(12345.678 * u + 3456.789 * v, 1) < 0.02 ? 0.0 : smooth(u, v);
    };
    EXPECT_FALSE(run(specks, smooth).passed);
    EXPECT_FALSE(run([](double, double) { return NAN; }, smooth).passed);
    EXPECT_FALSE(run([](double, double) { return NAN; }, [](double, double) { return NAN; }).passed);
}

// Where all is a matter of digits, a shift is no excuse.
TEST_P(PrecisionTrialOf, NoiseFails) {
    const auto noise = [](double u, double v) { return 0.5 + 0.5 * std::sin(1e7 * u + 1e6 * v); };
    const PrecisionTrial trial = run(shifted(noise, 1.0 / 1000), noise);
    EXPECT_FALSE(trial.passed) << trial.reason;
}

} // namespace
} // namespace scc::compiler
