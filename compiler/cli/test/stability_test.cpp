#include "compiler/cli/test/support.h"
#include "validation/stability/families.h"
#include "validation/stability/sweep.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <set>

/// The stiff and extreme suite: its table, its figures, and users' scenes put through it.
namespace scc::cli::test {
namespace {

using validation::Family;
using validation::Reading;
using validation::Sweep;

TEST(Stability, FamiliesAreWholeRows) {
    std::set<std::string_view> names;
    for (const Family& family : validation::families()) {
        EXPECT_TRUE(names.insert(family.name).second) << family.name;
        EXPECT_EQ(validation::find_family(family.name), &family);
        EXPECT_NE(validation::scene_text(family.scene), "") << family.name;
        EXPECT_NE(family.from, family.to) << family.name;
        EXPECT_LE(std::abs(family.holds_to - family.from), std::abs(family.to - family.from)) << family.name;
        EXPECT_EQ(family.bound.empty(), family.holds_to == family.to)
            << family.name << ": what ends early says why";
    }
    EXPECT_EQ(validation::find_family("none"), nullptr);
}

/// The powers 0, 1, 2, .. with auto in float up to `chosen_float`; whether each picture is kept.
Sweep sweep_of(const std::vector<bool>& in_float, const std::vector<bool>& in_double, int chosen_float) {
    const auto reading = [](bool kept) {
        Reading one;
        one.drawn = true;
        one.max_error = kept ? 1e-5 : 1;
        return one;
    };
    Sweep sweep;
    for (std::size_t i = 0; i < in_float.size(); ++i) {
        validation::Step step;
        step.power = static_cast<int>(i);
        const bool is_float = step.power <= chosen_float;
        step.chosen = is_float ? "float" : "double";
        step.readings = {reading(in_float[i]), reading(in_double[i]),
                         reading(is_float ? in_float[i] : in_double[i])};
        sweep.steps.push_back(step);
    }
    return sweep;
}

TEST(Stability, ThresholdsEndAtTheFirstStepThatIsNotKept) {
    Sweep sweep = sweep_of({true, true, false, true}, {true, true, true, false}, 1);
    EXPECT_EQ(threshold(sweep, validation::in_float), 1);
    EXPECT_EQ(threshold(sweep, validation::in_double), 2);
    EXPECT_EQ(threshold(sweep, validation::in_auto), 2);
    EXPECT_TRUE(wrong_picks(sweep).empty());
    EXPECT_EQ(beyond_double(sweep), std::vector<int>{3});
    EXPECT_FALSE(is_worse_than_recorded(sweep)) << "nothing is recorded";
    sweep.holds_to = 2;
    EXPECT_FALSE(is_worse_than_recorded(sweep));
    sweep.holds_to = 3;
    EXPECT_TRUE(is_worse_than_recorded(sweep));
    const Sweep hasty = sweep_of({true, true, false, false}, {true, true, true, true}, 2);
    EXPECT_EQ(wrong_picks(hasty), std::vector<int>{2});
    EXPECT_EQ(threshold(hasty, validation::in_auto), 1);
    EXPECT_EQ(threshold(sweep_of({false}, {false}, 0), validation::in_float), std::nullopt);
}

TEST_F(CommandLine, StabilitySweepsFamiliesAndKeepsWhatIsRecorded) {
    const auto result =
        scc({"stability", "shininess", "torus", "nested", "--size", "24x24", "--report", "out"});
    EXPECT_TRUE(result.ok()) << result.out << result.err;
    EXPECT_NE(result.out.find("auto     keeps 1e-4 to 1e8"), std::string::npos) << result.out;
    const auto report = nlohmann::json::parse(read("out/report.json"));
    ASSERT_EQ(report["sweeps"].size(), 3U);
    EXPECT_EQ(report["sweeps"][0]["thresholds"]["auto"], 8);
    EXPECT_LT(report["sweeps"][0]["thresholds"]["float"], 8) << "float has fewer digits";
    EXPECT_NE(read("out/index.html").find("<svg"), std::string::npos);
}

TEST_F(CommandLine, StabilitySweepsScenesOfUsers) {
    write("mine.scn", "sphere { }\nperspective_camera { eye = (0, 0, 5) }\n"
                      "point_light { position = (3, 4, 5), attenuation = (1, 0.1, 0.02) }\n");
    const auto result = scc({"stability", "mine.scn", "--size", "16x16", "--json"});
    EXPECT_TRUE(result.ok()) << result.err;
    const auto report = nlohmann::json::parse(result.out);
    ASSERT_EQ(report["sweeps"].size(), 3U);
    for (const auto& sweep : report["sweeps"]) {
        const int reached = sweep["thresholds"]["auto"];
        EXPECT_GE(std::abs(reached), 10) << sweep["name"];
    }
    write("tied.scn", "sphere { material = phong { diffuse = fn(s: surface) = rgb(s.world.x, 0, 0) } }\n");
    EXPECT_EQ(scc({"stability", "tied.scn"}).code, 1) << "what depends on its place cannot be moved";
}

TEST_F(CommandLine, StabilitySaysWhatItCannotSweep) {
    const auto unknown = scc({"stability", "shinines"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("did you mean `shininess`?"), std::string::npos) << unknown.err;
    EXPECT_EQ(scc({"stability", "torus", "--against", "opengl"}).code, 2);
    EXPECT_EQ(scc({"stability", "none.scn"}).code, 3);
    const auto list = scc({"stability", "--list"});
    EXPECT_TRUE(list.ok());
    EXPECT_NE(list.out.find("cylinder_afar"), std::string::npos);
}

} // namespace
} // namespace scc::cli::test
