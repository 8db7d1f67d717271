#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scc::lang {
namespace {

using test::messages_of;
using test::Scene;

constexpr const char* scene_text = "param n: number = 5 in 1..10 \"how many\"\n"
                                   "param tilt: angle = 30deg in 0deg..90deg\n"
                                   "param tone: color = #ffffff\n"
                                   "param title: string = \"none\"\n"
                                   "print([n])\nprint(tilt)\nprint(tone)\nprint(title)";

TEST(Params, TakeTheirDefaults) {
    const Scene scene(scene_text);
    EXPECT_EQ(scene.messages(), "");
    EXPECT_EQ(scene.module.prints, (std::vector<std::string>{"[5]", "30deg", "rgb(1, 1, 1)", "none"}));
}

TEST(Params, AreListedWithTypeRangeAndText) {
    const Scene scene(scene_text, {{"n", "7"}});
    ASSERT_EQ(scene.module.params.size(), 4u);
    const Param& n = scene.module.params[0];
    EXPECT_EQ(n.name, "n");
    EXPECT_EQ(to_string(n.type), "number");
    EXPECT_EQ(to_string(n.default_value), "5");
    EXPECT_EQ(to_string(n.value), "7");
    EXPECT_EQ(n.range, (std::pair<double, double>{1, 10}));
    EXPECT_EQ(n.text, "how many");
    EXPECT_EQ(scene.sources.text(n.span), "n");
    EXPECT_FALSE(scene.module.params[2].range);
    EXPECT_EQ(to_string(scene.module.params[3].type), "string");
}

TEST(Params, TakeExpressionsFromTheCommandLineAndTheLastOneWins) {
    const Scene scene(
        scene_text,
        {{"n", "100"}, {"n", "2 * 3"}, {"tilt", "45deg"}, {"tone", "rgb(1, 0, 0)"}, {"title", "1 + \"1"}});
    EXPECT_EQ(scene.messages(), "");
    EXPECT_EQ(scene.module.prints, (std::vector<std::string>{"[6]", "45deg", "rgb(1, 0, 0)", "1 + \"1"}));
    EXPECT_EQ(to_string(scene.module.params[0].default_value), "5");
}

TEST(Params, KeepTheSyntaxOfTheCommandLineAlive) {
    const Scene scene("param n: number = 0\nprint(n)", {{"n", "sum([for (index in 0..4) index])"}});
    EXPECT_EQ(scene.module.prints, std::vector<std::string>{"6"});
    EXPECT_EQ(messages_of("param n: number = 0\nprint(n)", {{"n", "sum([for (index in 0..4) 1 / index])"}}),
              R"(-D n:1:30: error: this divides by 0 [division-by-zero]
    1 | sum([for (index in 0..4) 1 / index])
      |                              ^~~~~
-D n:1:11: note: in the loop with index = 0
)");
}

TEST(Params, ReportUnknownNames) {
    EXPECT_EQ(messages_of("param wear: number = 0\nprint(wear)", {{"waer", "1"}}),
              "error: -D waer: the scene has no param of this name; did you mean `wear`? [unknown-param]\n");
}

TEST(Params, ReportValuesOfAnotherType) {
    EXPECT_EQ(messages_of(scene_text, {{"n", "\"a\""}, {"tilt", "40"}, {"tone", "n"}}),
              R"(-D n:1:1: error: the param `n` takes a number, this is a string [type-mismatch]
    1 | "a"
      | ^~~
-D tilt:1:1: error: the param `tilt` takes an angle, this is a number [angle-expected]
    1 | 40
      | ^~
      | 40deg
-D tone:1:1: error: nothing is called `n` here [unknown-name]
    1 | n
      | ^
)");
}

TEST(Params, ReportValuesOutOfTheirRange) {
    EXPECT_EQ(messages_of(scene_text, {{"n", "11"}, {"tilt", "-1deg"}}),
              R"(-D n:1:1: error: the param `n` is 11; its range is 1..10 [value-out-of-range]
    1 | 11
      | ^~
-D tilt:1:1: error: the param `tilt` is -1deg; its range is 0deg..90deg [value-out-of-range]
    1 | -1deg
      | ^~~~~
)");
    EXPECT_EQ(messages_of("param n: number = 3 in 0..1\nprint(n)"),
              R"(a.scn:1:19: error: the param `n` is 3; its range is 0..1 [value-out-of-range]
    1 | param n: number = 3 in 0..1
      |                   ^
)");
    EXPECT_EQ(messages_of("param n: number = 1 in 0..1\nprint(n)"), "");
}

TEST(Params, MayDependOnEachOtherInAnyOrder) {
    const Scene scene("param a: number = b * k\nparam b: number = 2\nlet k = 10\nprint(a)", {{"b", "3"}});
    EXPECT_EQ(scene.module.prints, std::vector<std::string>{"30"});
}

TEST(Params, HaveSimpleTypes) {
    EXPECT_EQ(
        messages_of("param p: shape = ball { }"),
        R"(a.scn:1:10: error: the param `p` is a shape; a param is a number, angle, bool, string, vec2, vec3 or color [param-type]
    1 | param p: shape = ball { }
      |          ^~~~~
)");
    EXPECT_EQ(
        messages_of("param p: string = \"a\" in 0..1"),
        R"(a.scn:1:26: error: the param `p` is a string; only a number or an angle has a range, written `a..b` [param-range]
    1 | param p: string = "a" in 0..1
      |                          ^~~~
)");
    EXPECT_EQ(Scene("param n: number = 1 in 0deg..1").summary(), "1 type-mismatch\n");
}

TEST(Params, StandAtTheTopOfAFile) {
    EXPECT_EQ(
        messages_of("pile { param p: number = 3 }"),
        R"(a.scn:1:8: error: a `param` stands within braces; its place is the top of a file [misplaced-item]
    1 | pile { param p: number = 3 }
      |        ^~~~~~~~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("if (true) { param p: number = 3 }").summary(), "1 misplaced-item\n");
}

} // namespace
} // namespace scc::lang
