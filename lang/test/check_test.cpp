#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

namespace scc::lang {
namespace {

using test::messages_of;
using test::Scene;

TEST(Check, SuggestsTheFieldThatWasMeant) {
    EXPECT_EQ(messages_of("lamp {\n  positon = (0, 0, 0)\n}"),
              R"(a.scn:2:3: error: lamp has no field `positon`; did you mean `position`? [unknown-field]
    2 |   positon = (0, 0, 0)
      |   ^~~~~~~
      |   position
)");
}

TEST(Check, AsksForTheSignOfAField) {
    EXPECT_EQ(messages_of("ball { radius 3, name \"b\" }\nball { center -(1, 2, 3) }\nball { radius(2) }"),
              R"(a.scn:1:15: error: found `3` after `radius`; a field is set with `=` [field-assignment]
    1 | ball { radius 3, name "b" }
      |               ^
      |               =
a.scn:1:23: error: found `"b"` after `name`; a field is set with `=` [field-assignment]
    1 | ball { radius 3, name "b" }
      |                       ^~~
      |                       =
a.scn:2:15: error: found `-` after `center`; a field is set with `=` [field-assignment]
    2 | ball { center -(1, 2, 3) }
      |               ^
      |               =
a.scn:3:14: error: found `(` after `radius`; a field is set with `=` [field-assignment]
    3 | ball { radius(2) }
      |              ^
      |               =
)");
}

TEST(Check, AsksForTheUnitOfAnAngle) {
    EXPECT_EQ(messages_of("eye { fov_y = -40 }"),
              R"(a.scn:1:15: error: `fov_y` takes an angle, this is a number [angle-expected]
    1 | eye { fov_y = -40 }
      |               ^~~
      |               -40deg
)");
    EXPECT_EQ(messages_of("print(rotate_x(2 * 3))"),
              R"(a.scn:1:16: error: `rotate_x` takes an angle, this is a number [angle-expected]
    1 | print(rotate_x(2 * 3))
      |                ^~~~~
)");
}

TEST(Check, ShowsHowAColorIsWritten) {
    EXPECT_EQ(messages_of("lamp { tone = 0.5 }\nlamp { tone = (1, 0, 0) }"),
              R"(a.scn:1:15: error: `tone` takes a color, this is a number [color-expected]
    1 | lamp { tone = 0.5 }
      |               ^~~
      |               rgb(0.5, 0.5, 0.5)
a.scn:2:15: error: `tone` takes a color, this is a vec3 [color-expected]
    2 | lamp { tone = (1, 0, 0) }
      |               ^~~~~~~~~
      |               rgb(1, 0, 0)
)");
}

TEST(Check, NamesBothTypesOfAMismatch) {
    EXPECT_EQ(messages_of("ball { center = 3 }"),
              R"(a.scn:1:17: error: `center` takes a vec3, this is a number [type-mismatch]
    1 | ball { center = 3 }
      |                 ^
)");
    EXPECT_EQ(
        messages_of("print((1, 2) + 3)"),
        R"(a.scn:1:14: error: a vec2 stands on the left of `+` and a number on the right [operand-mismatch]
    1 | print((1, 2) + 3)
      |              ^
)");
}

TEST(Check, AcceptsAFunctionOfASurfaceForPerPointFields) {
    EXPECT_EQ(messages_of("ball { material = paint { tone = fn(s: surface) = rgb(1, 0, 0), gloss = 3 } }"),
              "");
    EXPECT_EQ(
        messages_of("ball { material = paint { tone = fn(s: surface) = 3 } }"),
        R"(a.scn:1:34: error: `tone` takes a color or a function `fn(surface) -> color`, this is a function `fn(surface) -> number` [type-mismatch]
    1 | ball { material = paint { tone = fn(s: surface) = 3 } }
      |                                  ^~~~~~~~~~~~~~~~~~
)");
    EXPECT_EQ(
        messages_of("ball { radius = fn(s: surface) = 3 }"),
        R"(a.scn:1:17: error: `radius` takes a number, this is a function `fn(surface) -> number` [type-mismatch]
    1 | ball { radius = fn(s: surface) = 3 }
      |                 ^~~~~~~~~~~~~~~~~~
)");
}

TEST(Check, ListsTheChoicesOfAString) {
    EXPECT_EQ(messages_of("if (false) { output { shading = \"smoth\" } }"),
              R"(a.scn:1:33: error: shading is "smoth"; the choices are "flat" or "smooth" [unknown-choice]
    1 | if (false) { output { shading = "smoth" } }
      |                                 ^~~~~~~
      |                                 "smooth"
)");
}

TEST(Check, ChecksFunctionsThatAreNeverCalledAndBranchesThatAreNotTaken) {
    EXPECT_EQ(
        messages_of("fn f(x: number) = x + true\nprint(if (true) 1 else 2 + \"a\")"),
        R"(a.scn:1:21: error: a number stands on the left of `+` and a bool on the right [operand-mismatch]
    1 | fn f(x: number) = x + true
      |                     ^
a.scn:2:26: error: a number stands on the left of `+` and a string on the right [operand-mismatch]
    2 | print(if (true) 1 else 2 + "a")
      |                          ^
)");
}

TEST(Check, ReportsOneMistakeOnce) {
    EXPECT_EQ(
        messages_of("let a = b + 1\nlet c = a * (1, 2)\nball { radius = c, center = (a, c.x, sqrt(c)) }"),
        R"(a.scn:1:9: error: nothing is called `b` here [unknown-name]
    1 | let a = b + 1
      |         ^
)");
}

TEST(Check, SuggestsTheNameThatWasMeant) {
    EXPECT_EQ(
        messages_of("let color_of_wall = 1\nprint(color_of_wal)\nprint(sqr(3))\nbal { }"),
        R"(a.scn:2:7: error: nothing is called `color_of_wal` here; did you mean `color_of_wall`? [unknown-name]
    2 | print(color_of_wal)
      |       ^~~~~~~~~~~~
      |       color_of_wall
a.scn:3:7: error: nothing is called `sqr` here; did you mean `sqrt`? [unknown-name]
    3 | print(sqr(3))
      |       ^~~
      |       sqrt
a.scn:4:1: error: no constructor is called `bal`; did you mean `ball`? [unknown-constructor]
    4 | bal { }
      | ^~~
      | ball
)");
}

TEST(Check, SeesOnlyNamesOfEnclosingScopes) {
    EXPECT_EQ(Scene("for (i in 0..2) { let a = i\n ball { radius = a + 1 } }\nprint(a)").summary(),
              "3 unknown-name\n");
    EXPECT_EQ(Scene("fn f(x: number) = x\nprint(x)").summary(), "2 unknown-name\n");
}

TEST(Check, MakesTwoBindingsInOneScopeAnErrorAndInnerOnesNone) {
    EXPECT_EQ(messages_of("let a = 1\nlet a = 2"),
              R"(a.scn:2:5: error: `a` is bound in this scope already [duplicate-name]
    2 | let a = 2
      |     ^
a.scn:1:5: note: the first one is here
)");
    EXPECT_EQ(messages_of("let a = 1\nfn f(a: number) = a\nprint(f(a))"), "");
    EXPECT_EQ(Scene("fn f(a: number) { let a = 2\n a }").summary(), "1 duplicate-name\n");
}

TEST(Check, WarnsOfHiddenBuiltins) {
    EXPECT_EQ(messages_of("let scale = 2\nprint(scale)"),
              R"(a.scn:1:5: warning: `scale` hides the built-in function of this name [shadowed-name]
    1 | let scale = 2
      |     ^~~~~
)");
    EXPECT_EQ(Scene("let ball = ball { }\nball").summary(), "1 shadowed-name\n");
    EXPECT_EQ(Scene("fn f(pi: number) = pi").summary(), "1 shadowed-name\n");
}

TEST(Check, WarnsOfUnusedNamesOnlyInAFileWithoutErrors) {
    EXPECT_EQ(messages_of("let a = 1\nparam p: number = 1\nlet _c = 1\nfn f(x: number) = 1"),
              R"(a.scn:1:5: warning: `a` is never used [unused-let]
    1 | let a = 1
      |     ^
a.scn:2:7: warning: the param `p` is never used [unused-param]
    2 | param p: number = 1
      |       ^
)");
    EXPECT_EQ(Scene("let radius = 1\nball { radius = radiu }").summary(), "2 unknown-name\n");
}

TEST(Check, ShowsTheWayRoundACycle) {
    EXPECT_EQ(messages_of("let a = b\nlet b = f(1)\nfn f(x: number) = a + x"),
              R"(a.scn:1:5: error: `a` is defined by itself [cyclic-definition]
    1 | let a = b
      |     ^
a.scn:1:9: note: which needs `b` here
a.scn:2:9: note: which needs `f` here
a.scn:3:19: note: which needs `a` here
)");
    EXPECT_EQ(Scene("param a: number = b\nlet b = a").summary(), "1 cyclic-definition\n");
    EXPECT_EQ(Scene("fn f(x: number) -> number = a\nlet a = f(1)").summary(), "2 cyclic-definition\n");
}

TEST(Check, FindsCyclesAmongManyDefinitions) {
    std::string text = "let a = f0()\nfn f20000() -> number = a\n";
    for (int i = 0; i < 20000; ++i) {
        text += fmt::format("fn f{}() -> number = f{}()\n", i, i + 1);
    }
    EXPECT_EQ(Scene(text).summary(), "1 cyclic-definition\n");
}

TEST(Check, WantsTheResultTypeOfARecursiveFunction) {
    EXPECT_EQ(
        messages_of("fn f(n: number) = if (n == 0) 1 else n * f(n - 1)"),
        R"(a.scn:1:4: error: `f` calls itself; its result type has to be written, as `-> number` [result-type-needed]
    1 | fn f(n: number) = if (n == 0) 1 else n * f(n - 1)
      |    ^
)");
}

TEST(Check, KnowsWhatStandsWhere) {
    EXPECT_EQ(messages_of("pile { lamp { } }\nball { ball { } }\n[[paint { }]]"),
              R"(a.scn:1:8: error: `pile` takes shapes, this is a light [unexpected-item]
    1 | pile { lamp { } }
      |        ^~~~~~~~
a.scn:2:8: error: `ball` takes only fields, this is a shape [unexpected-item]
    2 | ball { ball { } }
      |        ^~~~~~~~
a.scn:3:1: error: the top of a file takes shapes, lights, cameras and settings, this is a list of [material] [unexpected-item]
    3 | [[paint { }]]
      | ^~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("for (i in 0..1) { if (true) { 3 } }").summary(), "1 unexpected-item\n");
}

TEST(Check, FindsRepeatedAndMissingFields) {
    EXPECT_EQ(messages_of("ball { radius = 1, radius = 2 }\nchain { }"),
              R"(a.scn:1:20: error: `radius` is set already [duplicate-field]
    1 | ball { radius = 1, radius = 2 }
      |                    ^~~~~~
a.scn:1:8: note: it is set here
a.scn:2:1: error: `chain` needs the field `points` [missing-field]
    2 | chain { }
      | ^~~~~
)");
}

TEST(Check, LetsEachBranchSetAField) {
    EXPECT_EQ(
        messages_of("ball { if (true) { radius = 1 } else if (false) { radius = 2 } else { radius = 3 } }"),
        "");
    EXPECT_EQ(Scene("ball {\nif (true) { radius = 1 }\nif (true) { radius = 2 } }").summary(),
              "3 duplicate-field\n");
    EXPECT_EQ(Scene("chain { if (1 > 2) { points = [] } }").summary(), "1 missing-field\n");
}

TEST(Check, MendsAConstructorThatIsCalled) {
    EXPECT_EQ(messages_of("ball(radius = 1)\nball\nsin { }"),
              R"(a.scn:1:1: error: `ball` builds a thing, which takes { } instead of ( ) [called-constructor]
    1 | ball(radius = 1)
      | ^~~~
      | ball { radius = 1 }
a.scn:2:1: error: `ball` builds a thing only with { } behind it [bare-constructor]
    2 | ball
      | ^~~~
      | ball { }
a.scn:3:1: error: `sin` is a function, which takes ( ) instead of { } [braces-on-function]
    3 | sin { }
      | ^~~
)");
}

TEST(Check, SaysWhatIsNotSupportedYetAtItsPlace) {
    EXPECT_EQ(messages_of("knot { loops = 3 }\nball { squeeze = 2 }"),
              R"(a.scn:1:1: error: `knot` is not supported yet [not-supported-yet]
    1 | knot { loops = 3 }
      | ^~~~
a.scn:2:8: error: `squeeze` is not supported yet [not-supported-yet]
    2 | ball { squeeze = 2 }
      |        ^~~~~~~
)");
    for (const char* call : {"picture { }((0, 0))"}) {
        EXPECT_EQ(Scene(fmt::format("print({})", call)).summary(), "1 not-supported-yet\n") << call;
    }
}

TEST(Check, AnImageIsAFunctionOfAVec2) {
    EXPECT_EQ(Scene("fn f(s: surface, t: image) = t(s.uv * 4).r").summary(), "");
    EXPECT_EQ(Scene("print(picture { }(1))").summary(), "1 type-mismatch\n");
    EXPECT_EQ(Scene("print(picture { }((0, 0), 1))").summary(), "1 argument-count\n");
    EXPECT_EQ(Scene("fn f(t: image) -> number = t((0, 0))").summary(), "1 type-mismatch\n");
    EXPECT_EQ(Scene("let t = picture { }\nlet a = t\nfor (i in 0..100) { ball { radius = 1 + a((i, 0)).r } }")
                  .summary(),
              "3 not-supported-yet\n")
        << "here, nobody knows what images hold; in a loop it is said once";
}

TEST(Check, MarksNamesUsedInUnsupportedThings) {
    EXPECT_EQ(Scene("let n = m\nknot { loops = n }").summary(), "1 unknown-name\n2 not-supported-yet\n");
}

TEST(Check, SuspectsDegreesWithoutAUnit) {
    EXPECT_EQ(
        messages_of("print(sin(90))\nprint(sin(6))"),
        R"(a.scn:1:11: warning: 90 radians are more than a full turn; degrees are written 90deg [degrees-suspected]
    1 | print(sin(90))
      |           ^~
      |           90deg
)");
}

TEST(Check, ReadsTheUnitOfTheWorldFromItsText) {
    EXPECT_EQ(
        messages_of("if (true) { world { unit = \"mm\" } }"),
        R"(a.scn:1:28: error: `unit` is needed before the scene is evaluated; it is a string in a `world` at the top of the file [unit-not-literal]
    1 | if (true) { world { unit = "mm" } }
      |                            ^~~~
)");
    EXPECT_EQ(Scene("world { unit = \"miles\" }").summary(), "1 unknown-choice\n");
    EXPECT_EQ(Scene("world { unit = 3 }").summary(), "1 type-mismatch\n");
}

TEST(Check, LimitsHowDeepTypesNest) {
    std::string text = "let a0 = [1]\n";
    for (int i = 1; i < 50; ++i) {
        text += fmt::format("let a{} = [a{}]\n", i, i - 1);
    }
    EXPECT_EQ(Scene(text + "print(a49)").summary(), "32 too-deep\n");
}

TEST(Check, SurvivesLongChainsOfDefinitions) {
    std::string text = "print(a0)\n";
    for (int i = 0; i < 50000; ++i) {
        text += fmt::format("let a{} = a{}\n", i, i + 1);
    }
    text += "let a50000 = 1\n";
    const std::string summary = Scene(text).summary();
    EXPECT_NE(summary.find("too-deep"), std::string::npos);
}

} // namespace
} // namespace scc::lang
