#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

/// One mistake is one message, however much of the scene depends on it; and mistakes do not hide each other.
namespace scc::lang {
namespace {

using test::Scene;

struct Case {
    const char* text;
    const char* expected; ///< line and name of each diagnostic
};

class Recovery : public testing::TestWithParam<Case> {};

TEST_P(Recovery, ReportsExactlyTheseMistakes) {
    EXPECT_EQ(Scene(GetParam().text).summary(), GetParam().expected) << GetParam().text;
}

const Case syntax[] = {
    {"let a = = 3\nlet b = a + 1\nball { radius = b, center = (a, b, a.x) }", "1 unexpected-token\n"},
    {"let my-size = 3\nball { radius = my-size }", "1 unexpected-token\n"},
    {"let = 3\nlet = 4\nprint(1)", "1 unexpected-token\n2 unexpected-token\n"},
    {"let a 3\nball { radius = a }", "1 unexpected-token\n"},
    {"let a 3\nball { center = a }", "1 unexpected-token\n2 type-mismatch\n"},
    {"lte a = 3\nball { radius = a }", "1 missing-separator\n1 field-outside\n"},
    {"func f(x) = 3\nball { radius = f(2) }", "1 missing-separator\n"},
    {"fn f(x: number y: number) = x + y\nball { radius = f(1, 2) }", "1 unexpected-token\n"},
    {"fn f(x number) = x\nball { radius = f(true) }", "1 unexpected-token\n2 type-mismatch\n"},
    {"fn f(x = 3) = x\nball { radius = f(1, 2, 3) }", "1 unexpected-token\n"},
    {"fn f x: number = x\nball { radius = f(1) }", "1 unexpected-token\n"},
    {"fn f(x: number) { let y = x }\nball { radius = f(1), center = f(2) }", "1 missing-result\n"},
    {"param p = 3\nball { radius = p }", "1 unexpected-token\n"},
    {"param p: number 3\nball { radius = p }", "1 unexpected-token\n"},
    {"import studio as s\ns.scene\nball { radius = s.key }", "1 unexpected-token\n"},
    {"chain { points [(0, 0, 0)] }", "1 field-assignment\n"},
    {"ball { radius -1, center (0, 0, 0) }", "1 field-assignment\n1 field-assignment\n"},
    {"ball { radius 3 }", "1 field-assignment\n"},
    {"ball { radius true }", "1 field-assignment\n1 type-mismatch\n"},
    {"ball { radius: -3 }", "1 field-assignment\n1 value-out-of-range\n"},
    {"chain { pionts: [(0, 0, 0)] }", "1 unknown-field\n1 field-assignment\n"},
    {"for i in 0..3 {\n  let r = i + 1\n  ball { radius = r }\n}", "1 unexpected-token\n"},
    {"if 1 > 2 { ball { } }", "1 unexpected-token\n"},
    {"pile {\n  ball { radius = 1\n  lamp { }\n}\nparam p: number = 1\nlet a = p\nball { radius = a }",
     "1 unclosed-bracket\n"},
    {"let a = 2\nball { radius = b }\npile {\n  ball { radius = a, sise = 3\nlet b = true\neye { }",
     "4 unclosed-bracket\n"},
    {"ball { radius = (1 + 2 }\nball { radius = -1 }", "1 unclosed-bracket\n2 value-out-of-range\n"},
    {"ball { radius = 1 ]\nball { radius = -1 }", "1 wrong-bracket\n2 value-out-of-range\n"},
    {"ball { radius = -1 } }\nball { radius = -2 }",
     "1 value-out-of-range\n1 unopened-bracket\n2 value-out-of-range\n"},
    {"for (i in 0..3) {\n  ball { radius = i + 1 }\nball { radius = -1 }", "1 unclosed-bracket\n"},
    {"let a = \"x\nball { name = a }", "1 unterminated-string\n"},
    {"let a = 3furlong\nball { radius = a }", "1 unknown-unit\n"},
    {"let gr\xC3\xB6\xC3\x9F\x65 = 3\nball { radius = gr\xC3\xB6\xC3\x9F\x65 }",
     "1 unexpected-character\n2 unexpected-character\n"},
    {"let a = fn(x: 3) = x\nprint(a(1, 2, 3))", "1 unexpected-token\n"},
    {"let a: [number number] = [1]\nprint(a)", "1 unexpected-token\n"},
    {"let a = f(1 2)\nfn f(x: number) = x\nprint(a)", "1 unexpected-token\n"},
    {"let unused = 1\nball { center = (1, 2 unused) }", "2 unexpected-token\n"},
};
INSTANTIATE_TEST_SUITE_P(Syntax, Recovery, testing::ValuesIn(syntax));

const Case meaning[] = {
    {"let a = b\nlet c = [a, a * 2]\nfor (i in a) { ball { radius = i } }\nprint(c[0].x)",
     "1 unknown-name\n"},
    {"let a = 1\nlet a = (1, 2, 3)\nball { radius = a, center = a }", "2 duplicate-name\n"},
    {"fn f(x: vec4) -> nunber = x.w\nball { radius = f(3), center = f(true) }",
     "1 unknown-type\n1 unknown-type\n"},
    {"let a: [vec4] = [1, 2]\nball { center = a[0] }", "1 unknown-type\n"},
    {"fn f(g: fn(vec4) -> number) = g(1)\nprint(f(3))", "1 unknown-type\n"},
    {"let a: number = (1, 2)\nball { radius = a }", "1 type-mismatch\n"},
    {"let a: number = a\nball { radius = a }", "1 cyclic-definition\n"},
    {"fn f(n: number) = n * f(n - 1)\nball { radius = f(3) }", "1 result-type-needed\n"},
    {"fn f(n: number) -> number { let a = g(n)\n a }\nfn g(n: number) = f(n)\nprint(f(1))",
     "3 calls-too-deep\n"},
    {"chain { pionts = [(0, 0, 0)] }", "1 unknown-field\n"},
    {"chain { points = [(0, 0, oops)] }", "1 unknown-name\n"},
    {"chain { points = 3 }", "1 type-mismatch\n"},
    {"chain { for (i in 0..2) { points = [] } }", "1 field-in-loop\n"},
    {"blal { radius = -1, lamp { } }", "1 unknown-constructor\n"},
    {"ball { radius = 1, radius = -1 }", "1 duplicate-field\n1 value-out-of-range\n"},
    {"fn f(x: number, y: number) = x\nball { radius = f(1) }\nball { radius = f(1, 2, 3) }\nprint(f(1, 2))",
     "2 missing-argument\n3 argument-count\n"},
    {"let f = fn(x: number) = x\nball { radius = f(1, 2) }", "2 argument-count\n"},
    {"if (oops) { ball { radius = -1 } } else { lamp { tone = 3 } }", "1 unknown-name\n1 color-expected\n"},
    {"pile { param n: number = 3, ball { radius = n } }", "1 misplaced-item\n"},
    {"pile { ball { radius = n } }\nlet unused = 1", "1 unknown-name\n"},
    {"let unused = 1\nball { radius = true }", "1 unused-let\n2 type-mismatch\n"},
    {"let unused = 1 + true", "1 operand-mismatch\n"},
    {"let m = paint { gloss = oops }\nball { material = m, radius = -1 }",
     "1 unknown-name\n2 value-out-of-range\n"},
    {"output { shading = \"smoth\" }", "1 unknown-choice\n"},
    {"print(1 + true)\nprint(1 / 0)\nball { radius = 0 }\nassert(1 > 2, \"no\")",
     "1 operand-mismatch\n2 division-by-zero\n3 value-out-of-range\n4 assertion-failed\n"},
    {"let l = if (false) [] else [true]\nball { radius = l[0] }", "2 type-mismatch\n"},
    {"let l = [[], [true]]\nball { radius = l[1][0] }", "2 type-mismatch\n"},
};
INSTANTIATE_TEST_SUITE_P(Meaning, Recovery, testing::ValuesIn(meaning));

TEST(RecoveryOfParams, SaysNothingOfOnesThatCouldNotBeRead) {
    EXPECT_EQ(Scene("param p = 3\nball { radius = p }", {{"p", "4"}}).summary(), "1 unexpected-token\n");
    EXPECT_EQ(Scene("pile {\nparam p: number = 3", {{"p", "4"}}).summary(), "1 unclosed-bracket\n");
}

TEST(RecoveryOfThings, KeepsTheOnesWithoutMistakes) {
    const Scene scene(
        "ball { radius = 1 }\nball { radius = -1 }\nball { raduis = 1 }\n"
        "pile { ball { radius = 2 }\n ball { radius = oops } }\nlamp { tone = 3 }\nball { radius = 3 }");
    EXPECT_EQ(scene.summary(), "2 value-out-of-range\n3 unknown-field\n5 unknown-name\n6 color-expected\n");
    std::string kept;
    for (const ThingPtr& thing : scene.module.items) {
        kept += fmt::format("{} {}, ", thing->constructor->name, thing->children.size());
    }
    EXPECT_EQ(kept, "ball 0, pile 1, ball 0, ");
}

} // namespace
} // namespace scc::lang
