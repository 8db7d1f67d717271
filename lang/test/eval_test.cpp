#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scc::lang {
namespace {

using test::messages_of;
using test::Scene;

std::string with_limits(std::string_view text, EvaluationLimits limits) {
    return Scene(text, {}, limits).messages();
}

TEST(Evaluation, CollectsTheThingsOfTheFileInOrder) {
    const Scene scene(
        "lamp { }\nfor (i in 1..3) { ball { radius = i } }\nif (1 > 2) { eye { } } else { ball { } }\n"
        "[for (i in 0..2) ball { radius = 5 + i }]");
    ASSERT_EQ(scene.messages(), "");
    std::string kinds;
    for (const ThingPtr& thing : scene.module.items) {
        kinds += std::string(thing->constructor->name) + " " +
                 to_string(thing->get("radius") ? *thing->get("radius") : Value{}) + ", ";
    }
    EXPECT_EQ(kinds, "lamp error, ball 1, ball 2, ball 1, ball 5, ball 6, ");
}

TEST(Evaluation, SharesAThingThatIsNamedAndAddedTwice) {
    const Scene scene("let b = ball { radius = 2 }\npile { b\n b }\nb");
    ASSERT_EQ(scene.module.items.size(), 2u);
    const Thing& pile = *scene.module.items[0];
    ASSERT_EQ(pile.children.size(), 2u);
    EXPECT_EQ(pile.children[0], pile.children[1]);
    EXPECT_EQ(pile.children[0], scene.module.items[1]);
    EXPECT_EQ(pile.height, 2u);
}

TEST(Evaluation, NamesThingsByTheirDefinition) {
    const Scene scene(
        "let b = if (true) ball { } else ball { }\nfn leg(x: number) = ball { center = (x, 0, 0) }\n"
        "let legs = [for (i in 0..1) ball { }]\nb\nleg(1)\nball { }\nlegs\n"
        "let held = pile { ball { } }\nheld");
    std::string names;
    for (const ThingPtr& thing : scene.module.items) {
        names += thing->name + ",";
    }
    EXPECT_EQ(names, "b,leg,,legs,held,");
    EXPECT_EQ(scene.module.items.back()->children.at(0)->name, "");
}

TEST(Evaluation, KeepsTheSpansOfFields) {
    const Scene scene("ball { radius = 1 + 2 }");
    const FieldValue& field = *scene.module.items.at(0)->find("radius");
    EXPECT_EQ(scene.sources.text(field.name_span), "radius");
    EXPECT_EQ(scene.sources.text(field.value_span), "1 + 2");
    EXPECT_EQ(scene.sources.text(scene.module.items[0]->span), "ball { radius = 1 + 2 }");
}

TEST(Evaluation, ReportsAValueOutOfRangeOncePerPlaceWithItsLoop) {
    EXPECT_EQ(messages_of("for (i in 0..10) {\n  ball { radius = i - 5 }\n}"),
              R"(a.scn:2:19: error: radius is -5; a radius is greater than 0 [value-out-of-range]
    2 |   ball { radius = i - 5 }
      |                   ^~~~~
a.scn:1:1: note: in the loop with i = 0; the first of 6 such values
)");
    EXPECT_EQ(messages_of("let b = [for (i in [3, 4]) ball { radius = 3 - i }]\nb"),
              R"(a.scn:1:44: error: radius is 0; a radius is greater than 0 [value-out-of-range]
    1 | let b = [for (i in [3, 4]) ball { radius = 3 - i }]
      |                                            ^~~~~
a.scn:1:15: note: in the loop with i = 3; the first of 2 such values
)");
    EXPECT_EQ(messages_of("fn f(r: number) = ball { radius = r }\nf(-1)\nf(-2)"),
              R"(a.scn:1:35: error: radius is -1; a radius is greater than 0 [value-out-of-range]
    1 | fn f(r: number) = ball { radius = r }
      |                                   ^
a.scn:2:1: note: in the call of `f`; the first of 2 such values
)");
    EXPECT_EQ(messages_of("ball { radius = [-1][0] }\nball { center = (0, sum([-1, exp(1000)]), 0) }"),
              R"(a.scn:1:17: error: radius is -1; a radius is greater than 0 [value-out-of-range]
    1 | ball { radius = [-1][0] }
      |                 ^~~~~~~
a.scn:2:21: error: center is (0, inf, 0); a field takes finite numbers [not-finite]
    2 | ball { center = (0, sum([-1, exp(1000)]), 0) }
      |                     ^~~~~~~~~~~~~~~~~~~~
)");
}

TEST(Evaluation, TellsWhereInTheSceneAValueIsWrong) {
    EXPECT_EQ(messages_of(R"(fn leg(x: number) = ball { radius = x }
let table = pile {
  for (i in 0..2) {
    for (j in 1..4) {
      leg(1.5 - i * j)
    }
  }
}
pile { table })"),
              R"(a.scn:1:37: error: radius is -0.5; a radius is greater than 0 [value-out-of-range]
    1 | fn leg(x: number) = ball { radius = x }
      |                                     ^
a.scn:5:7: note: in the call of `leg`; the first of 2 such values
a.scn:4:5: note: in the loop with j = 2
a.scn:3:3: note: in the loop with i = 1
a.scn:2:13: note: in `table/leg[4]`
)");
}

// What a definition needs is computed when it is first used, but that is not where it stands.
TEST(Evaluation, KnowsDefinitionsFromTheirUses) {
    EXPECT_EQ(messages_of("let b = ball { radius = -1 }\nfor (i in 0..3) { pile { b } }"),
              R"(a.scn:1:25: error: radius is -1; a radius is greater than 0 [value-out-of-range]
    1 | let b = ball { radius = -1 }
      |                         ^~
)");
}

TEST(Evaluation, TellsTheInnermostAndTheOutermostOfManyCalls) {
    EXPECT_EQ(messages_of("fn f(n: number) -> number = if (n == 0) 1 / n else f(n - 1)\nprint(f(9))"),
              R"(a.scn:1:45: error: this divides by 0 [division-by-zero]
    1 | fn f(n: number) -> number = if (n == 0) 1 / n else f(n - 1)
      |                                             ^
a.scn:1:52: note: in the call of `f`
a.scn:1:52: note: in the call of `f`
a.scn:1:52: note: in the call of `f`
a.scn:2:7: note: in the call of `f`, 7 calls further out
)");
}

TEST(Evaluation, ReportsIndependentMistakesAndNothingThatFollowsFromThem) {
    EXPECT_EQ(messages_of("let a = 1 / 0\nlet b = a + [1][2]\nball { radius = b, center = (b, 0, 0) }\n"
                          "chain { if (a > 1) { points = [] } }\nassert(a == 1, \"one\")\n"
                          "for (i in 0..a) { ball { radius = -1 } }\noutput { samples = 5 }"),
              R"(a.scn:1:13: error: this divides by 0 [division-by-zero]
    1 | let a = 1 / 0
      |             ^
a.scn:2:17: error: the index is 2; the list has 1 element, counted from 0 [index-out-of-range]
    2 | let b = a + [1][2]
      |                 ^
a.scn:7:20: error: samples is 5; `samples` is a square number, at least 1 [value-out-of-range]
    7 | output { samples = 5 }
      |                    ^
)");
}

TEST(Evaluation, PutsLimitsWithoutWordsIntoWords) {
    EXPECT_EQ(
        messages_of(
            "output { size = (1.5, 2), samples = 5 }\neye { fov_y = 200deg }\nwall { normal = (0, 0, 0) }"),
        R"(a.scn:1:18: error: size is (1.5, 2); `size` is a whole number, at least 1 [value-out-of-range]
    1 | output { size = (1.5, 2), samples = 5 }
      |                  ^~~
a.scn:1:37: error: samples is 5; `samples` is a square number, at least 1 [value-out-of-range]
    1 | output { size = (1.5, 2), samples = 5 }
      |                                     ^
a.scn:2:15: error: fov_y is 200deg; `fov_y` is at least 0deg and at most 180deg [value-out-of-range]
    2 | eye { fov_y = 200deg }
      |               ^~~~~~
a.scn:3:17: error: normal is (0, 0, 0); `normal` is not the zero vector [value-out-of-range]
    3 | wall { normal = (0, 0, 0) }
      |                 ^~~~~~~~~
)");
    EXPECT_EQ(
        messages_of(
            "output { size = (1, 2), samples = 16 }\neye { fov_y = 180deg }\nwall { normal = (0, 0, 1e-9) }"),
        "");
}

TEST(Evaluation, RefusesValuesThatAreNotFinite) {
    EXPECT_EQ(messages_of("chain { points = [(0, 1, 2), (0, exp(1000), 0)] }"),
              R"(a.scn:1:34: error: points is (0, inf, 0); a field takes finite numbers [not-finite]
    1 | chain { points = [(0, 1, 2), (0, exp(1000), 0)] }
      |                                  ^~~~~~~~~
)");
    EXPECT_EQ(Scene("ball { radius = sqrt(-1) }").summary(), "1 not-finite\n");
}

TEST(Evaluation, ChecksChoicesThatAreComputed) {
    EXPECT_EQ(messages_of("fn kind(smooth: bool) = if (smooth) \"smooth\" else \"round\"\noutput { shading = "
                          "kind(false) }"),
              R"(a.scn:2:20: error: shading is "round"; the choices are "flat" or "smooth" [unknown-choice]
    2 | output { shading = kind(false) }
      |                    ^~~~~~~~~~~
)");
}

TEST(Evaluation, FindsAMissingFieldOfABranchThatWasNotTaken) {
    EXPECT_EQ(Scene("chain { if (1 > 2) { points = [(0, 0, 0)] } }").summary(), "1 missing-field\n");
    EXPECT_EQ(Scene("chain { if (1 < 2) { points = [(0, 0, 0)] } }").summary(), "");
}

TEST(Evaluation, ReportsDivisionByZeroAtTheDivisor) {
    EXPECT_EQ(messages_of("let a = 3\nprint(1 / (a - 3))"),
              R"(a.scn:2:11: error: this divides by 0 [division-by-zero]
    2 | print(1 / (a - 3))
      |           ^~~~~~~
)");
    EXPECT_EQ(Scene("print((1, 2) / (1, 0))\nprint(5 % 0)\nprint(mod(1, 0))\nprint(1deg / 0deg)").summary(),
              "1 division-by-zero\n2 division-by-zero\n3 division-by-zero\n4 division-by-zero\n");
}

TEST(Evaluation, ReportsAnIndexOutsideOfTheList) {
    EXPECT_EQ(
        messages_of("print([1, 2][2])\nprint([1, 2][-1])\nprint([1, 2][0.5])\nprint([][0])"),
        R"(a.scn:1:14: error: the index is 2; the list has 2 elements, counted from 0 [index-out-of-range]
    1 | print([1, 2][2])
      |              ^
a.scn:2:14: error: the index is -1; the list has 2 elements, counted from 0 [index-out-of-range]
    2 | print([1, 2][-1])
      |              ^~
a.scn:3:14: error: the index is 0.5; an index is a whole number [index-out-of-range]
    3 | print([1, 2][0.5])
      |              ^~~
a.scn:4:10: error: the index is 0; the list is empty [index-out-of-range]
    4 | print([][0])
      |          ^
)");
}

TEST(Evaluation, ReportsTransformsThatFlatten) {
    EXPECT_EQ(messages_of("ball { transform = scale(1, 0, 1) }"),
              R"(a.scn:1:20: error: this transform has no inverse [singular-transform]
    1 | ball { transform = scale(1, 0, 1) }
      |                    ^~~~~~~~~~~~~~
)");
    EXPECT_EQ(
        messages_of("print(look_at((0, 1, 0), (0, 0, 0), (0, 1, 0)))"),
        R"(a.scn:1:7: error: this transform has no inverse; the eye is the target, or `up` points along the view [singular-transform]
    1 | print(look_at((0, 1, 0), (0, 0, 0), (0, 1, 0)))
      |       ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
)");
    EXPECT_EQ(
        messages_of("ball { transform = scale(1, 1, 1e-5) then scale(1, 1, 1e-6) }"),
        R"(a.scn:1:20: warning: this transform loses about 11 of 16 digits when it is undone [ill-conditioned-transform]
    1 | ball { transform = scale(1, 1, 1e-5) then scale(1, 1, 1e-6) }
      |                    ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("ball { transform = scale(1, 1, 1e-9) then scale(1, 1, 1e-9) }").summary(),
              "1 singular-transform\n");
    EXPECT_EQ(Scene("ball { transform = scale(1e-9) }").summary(), "");
}

TEST(Evaluation, ReportsMatricesThatAreNotAffine) {
    EXPECT_EQ(messages_of("print(matrix([1, 2]))"),
              R"(a.scn:1:7: error: this matrix has 2 numbers; a matrix has 16, row by row [bad-matrix]
    1 | print(matrix([1, 2]))
      |       ^~~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("print(matrix([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1]))").summary(),
              "1 bad-matrix\n");
}

TEST(Evaluation, ReportsDirectionsOfZeroVectors) {
    EXPECT_EQ(messages_of("print(normalize((0, 0, 0)))\nprint(rotate((0, 0, 0), 1deg))"),
              R"(a.scn:1:7: error: this vector has length 0; `normalize` needs a direction [zero-vector]
    1 | print(normalize((0, 0, 0)))
      |       ^~~~~~~~~~~~~~~~~~~~
a.scn:2:7: error: this vector has length 0; `rotate` needs a direction [zero-vector]
    2 | print(rotate((0, 0, 0), 1deg))
      |       ^~~~~~~~~~~~~~~~~~~~~~~
)");
}

TEST(Evaluation, RunsAssertionsAndPrints) {
    const Scene scene("assert(1 < 2, \"fine\")\nassert(2 < 1, \"two is more\")\nfor (i in 0..2) { print(i) "
                      "}\nprint(\"text\")");
    EXPECT_EQ(scene.messages(), R"(a.scn:2:8: error: two is more [assertion-failed]
    2 | assert(2 < 1, "two is more")
      |        ^~~~~
)");
    EXPECT_EQ(scene.module.prints, (std::vector<std::string>{"0", "1", "text"}));
}

TEST(Evaluation, LoopsOverWholeNumbersOnly) {
    EXPECT_EQ(messages_of("for (i in 0..2.5) { }"),
              R"(a.scn:1:11: error: the range is 0..2.5; a loop runs over whole numbers [fractional-range]
    1 | for (i in 0..2.5) { }
      |           ^~~~~~
)");
}

TEST(Limits, BoundTheSteps) {
    EvaluationLimits limits;
    limits.steps = 1000;
    EXPECT_EQ(with_limits("for (i in 0..1000000000) { }", limits),
              R"(a.scn:1:11: error: the scene takes more than 1000 steps to evaluate [steps-exceeded]
    1 | for (i in 0..1000000000) { }
      |           ^~~~~~~~~~~~~
a.scn:1:1: note: in the loop with i = 996
)");
}

TEST(Limits, BoundTheDepthOfCalls) {
    EXPECT_EQ(messages_of("fn f(n: number) -> number = f(n + 1)\nprint(f(1))"),
              R"(a.scn:1:29: error: calls are nested more than 500 deep [calls-too-deep]
    1 | fn f(n: number) -> number = f(n + 1)
      |                             ^~~~~~~~
)");
}

TEST(Limits, KeepTheNativeStackWhateverTheDepthOfCalls) {
    EvaluationLimits limits;
    limits.call_depth = 100'000'000;
    const std::string text = with_limits("fn f(n: number) -> number = 1 + f(n + 1)\nprint(f(1))", limits);
    EXPECT_NE(text.find("this is nested too deeply [too-deep]"), std::string::npos) << text;
}

TEST(Limits, BoundTheLengthOfListsAndStrings) {
    EvaluationLimits limits;
    limits.list_length = 10;
    limits.string_length = 10;
    EXPECT_EQ(with_limits("print([for (i in 0..11) i])", limits),
              R"(a.scn:1:7: error: this list has more than 10 elements [list-too-long]
    1 | print([for (i in 0..11) i])
      |       ^~~~~~~~~~~~~~~~~~~~
a.scn:1:13: note: in the loop with i = 9
)");
    EXPECT_EQ(Scene("for (i in 0..11) { ball { } }", {}, limits).summary(), "1 list-too-long\n");
    EXPECT_EQ(Scene("for (i in 0..10) { ball { } }", {}, limits).summary(), "");
    EXPECT_EQ(with_limits("print(\"12345678901\")", limits),
              R"(a.scn:1:7: error: this text has more than 10 bytes [string-too-long]
    1 | print("12345678901")
      |       ^~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("for (i in 0..20) { print(i) }", {}, limits).summary(), "1 string-too-long\n");
}

TEST(Limits, BoundHowDeepThingsNest) {
    std::string text = "let g0 = ball { }\n";
    for (int i = 1; i < 300; ++i) {
        text += fmt::format("let g{} = pile {{ g{} }}\n", i, i - 1);
    }
    EXPECT_EQ(Scene(text + "g299").summary(), "201 too-deep\n");
    EXPECT_EQ(Scene(text + "g199").summary(), "300 unused-let\n");
}

TEST(Limits, BoundTextOfListsThatShareTheirElements) {
    std::string text = "let a0 = [1, 1]\n";
    for (int i = 1; i < 31; ++i) {
        text += fmt::format("let a{0} = [a{1}, a{1}]\n", i, i - 1);
    }
    EXPECT_EQ(Scene(text + "print(a30)").summary(), "32 string-too-long\n");
}

} // namespace
} // namespace scc::lang
