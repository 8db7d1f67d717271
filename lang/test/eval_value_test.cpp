#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

namespace scc::lang {
namespace {

using test::value_of;

TEST(Values, AddMultiplyAndRaiseNumbers) {
    EXPECT_EQ(value_of("1 + 2 * 3 - 4 / 8"), "6.5");
    EXPECT_EQ(value_of("2 ^ 3 ^ 2"), "512");
    EXPECT_EQ(value_of("-2 ^ 2"), "-4");
    EXPECT_EQ(value_of("pow(2, 0.5) * pow(2, 0.5)"), "2.0000000000000004");
}

TEST(Values, TakeTheRemainderWithTheSignOfTheDivisor) {
    EXPECT_EQ(value_of("-7 % 3"), "2");
    EXPECT_EQ(value_of("7 % -3"), "-2");
    EXPECT_EQ(value_of("-7.5 % 2"), "0.5");
    EXPECT_EQ(value_of("6 % 3"), "0");
    EXPECT_EQ(value_of("mod(-1, 5)"), "4");
    EXPECT_EQ(value_of("450deg % 360deg"), "90deg");
}

TEST(Values, AddAndScaleAngles) {
    EXPECT_EQ(value_of("30deg + 15deg * 2"), "60deg");
    EXPECT_EQ(value_of("2 * 30deg - 60deg / 2"), "30deg");
    EXPECT_EQ(value_of("90deg / 30deg"), "3");
    EXPECT_EQ(value_of("-1rad"), "-1rad");
    EXPECT_EQ(value_of("180deg / 1rad == pi"), "true");
}

TEST(Values, CombineVectorsComponentByComponent) {
    EXPECT_EQ(value_of("(1, 2, 3) + (4, 5, 6) * 2"), "(9, 12, 15)");
    EXPECT_EQ(value_of("(2, 4) * (3, 5)"), "(6, 20)");
    EXPECT_EQ(value_of("(2, 4) / (4, 2)"), "(0.5, 2)");
    EXPECT_EQ(value_of("2 * (1, 2, 3) / 4"), "(0.5, 1, 1.5)");
    EXPECT_EQ(value_of("-(1, 2)"), "(-1, -2)");
    EXPECT_EQ(value_of("rgb(1, 0.5, 0) * rgb(0.5, 0.5, 1) + rgb(0, 0, 1)"), "rgb(0.5, 0.25, 1)");
    EXPECT_EQ(value_of("rgb(1, 0.5, 0) * 2"), "rgb(2, 1, 0)");
}

TEST(Values, ReadComponents) {
    EXPECT_EQ(value_of("[(1, 2).y, (1, 2, 3).z, rgb(4, 5, 6).g]"), "[2, 3, 5]");
}

TEST(Values, ComputeVectorFunctions) {
    EXPECT_EQ(value_of("dot((1, 2, 3), (4, 5, 6))"), "32");
    EXPECT_EQ(value_of("dot((1, 2), (3, 4))"), "11");
    EXPECT_EQ(value_of("cross((1, 0, 0), (0, 1, 0))"), "(0, 0, 1)");
    EXPECT_EQ(value_of("cross((1, 2, 3), (4, 5, 6))"), "(-3, 6, -3)");
    EXPECT_EQ(value_of("length((3, 4))"), "5");
    EXPECT_EQ(value_of("normalize((0, 3, 4))"), "(0, 0.6, 0.8)");
}

TEST(Values, ComputeNumberFunctions) {
    EXPECT_EQ(value_of("[abs(-2), floor(-1.5), ceil(1.2), sqrt(9), min(1, 2), max(1, 2)]"),
              "[2, -2, 2, 3, 1, 2]");
    EXPECT_EQ(value_of("[exp(0), log(1), sin(0), cos(0deg), tan(0)]"), "[1, 0, 0, 1, 0]");
    EXPECT_EQ(value_of("[asin(1), acos(1), atan2(1, 1), atan2(0, -1)]"), "[90deg, 0deg, 45deg, 180deg]");
    EXPECT_EQ(value_of("sin(30deg) - sin(pi / 6)"), "0");
    EXPECT_EQ(value_of("[clamp(5, 0, 1), clamp(-5, 0, 1), mix(1, 3, 0.25)]"), "[1, 0, 1.5]");
    EXPECT_EQ(value_of("clamp((-1, 0.5, 2), 0, 1)"), "(0, 0.5, 1)");
    EXPECT_EQ(value_of("mix(rgb(0, 0, 0), rgb(1, 2, 4), 0.5)"), "rgb(0.5, 1, 2)");
    EXPECT_EQ(value_of("mix(10deg, 20deg, 0.5)"), "15deg");
    EXPECT_EQ(value_of("floor((1.5, -1.5))"), "(1, -2)");
}

TEST(Values, DecodeDisplayColors) {
    EXPECT_EQ(value_of("#ffffff"), "rgb(1, 1, 1)");
    EXPECT_EQ(value_of("srgb(0.04045, 0, 1)"), "rgb(0.0031308049535603713, 0, 1)");
    EXPECT_EQ(value_of("srgb(0.5, 0.5, 0.5).r"), "0.21404114048223255"); // ((0.5 + 0.055) / 1.055) ^ 2.4
    EXPECT_EQ(value_of("#808080 == srgb(128 / 255, 128 / 255, 128 / 255)"), "true");
}

TEST(Values, CompareAndJoinConditions) {
    EXPECT_EQ(value_of("[1 < 2, 2 <= 1, 1 > 2, 2 >= 2, 1 == 1, 1 != 1]"),
              "[true, false, false, true, true, false]");
    EXPECT_EQ(value_of("[\"a\" == \"a\", (1, 2) == (1, 3), rgb(1, 0, 0) != rgb(1, 0, 1), 10deg < 1rad]"),
              "[true, false, true, true]");
    EXPECT_EQ(value_of("true and not false or false"), "true");
}

TEST(Values, StopConditionsEarly) {
    EXPECT_EQ(value_of("false and 1 / 0 > 1"), "false");
    EXPECT_EQ(value_of("true or 1 / 0 > 1"), "true");
    EXPECT_EQ(value_of("if (true) 1 else 1 / 0"), "1");
}

TEST(Values, ScaleLengthsToTheUnitOfTheWorld) {
    EXPECT_EQ(value_of("[25mm, 1cm, 2m, 3km, 1inch]"), "[0.025, 0.01, 2, 3000, 0.0254]");
    EXPECT_EQ(value_of("[25mm, 1cm, 2m, 1inch]", "world { unit = \"mm\" }"), "[25, 10, 2000, 25.4]");
    EXPECT_EQ(value_of("[25.4mm, 1m]", "world { unit = \"inch\" }"), "[1, 39.37007874015748]");
}

TEST(Values, BuildAndReadLists) {
    EXPECT_EQ(value_of("[for (i in 1..4) i * i]"), "[1, 4, 9]");
    EXPECT_EQ(value_of("[for (i in [1, 5]) (i, -i)]"), "[(1, -1), (5, -5)]");
    EXPECT_EQ(value_of("[for (i in 3..1) i]"), "[]");
    EXPECT_EQ(value_of("[4, 5, 6][2]"), "6");
    EXPECT_EQ(value_of("len([1, 2, 3]) + sum([1, 2, 3])"), "9");
    EXPECT_EQ(value_of("sum([(1, 2), (3, 4)])"), "(4, 6)");
    EXPECT_EQ(value_of("sum(filter([(1, 2)], fn(p: vec2) = p.x > 5))"), "(0, 0)");
    EXPECT_EQ(value_of("map(filter([1, 2, 3], fn(x: number) = x != 2), fn(x: number) = x * 10)"), "[10, 30]");
    EXPECT_EQ(value_of("[[], [1]]"), "[[], [1]]");
}

TEST(Values, EvaluateDefinitionsInAnyOrder) {
    EXPECT_EQ(value_of("a", "let a = b + 1\nlet b = f(2)\nfn f(x: number) = x * c\nlet c = 5"), "11");
}

TEST(Values, EvaluateALetOnceAndOnlyIfNeeded) {
    const test::Scene scene("let bad = 1 / 0\nlet n = if (false) bad else 2\nprint(n)");
    EXPECT_EQ(scene.messages(), "");
    EvaluationLimits limits;
    limits.steps = 3000; // the list alone takes more than a thousand
    const test::Scene shared(
        "let list = [for (i in 0..500) i]\nprint(sum(list))\nprint(len(list) + len(list))", {}, limits);
    EXPECT_EQ(shared.messages(), "");
    EXPECT_EQ(shared.module.prints.at(1), "1000");
}

TEST(Values, CallFunctionsWithNamesAndDefaults) {
    const char* f = "let two = 2\nfn f(x: number, y: number = two, z: number = 3) = (x, y, z)";
    EXPECT_EQ(value_of("f(1)", f), "(1, 2, 3)");
    EXPECT_EQ(value_of("f(z = 7, x = 1)", f), "(1, 2, 7)");
    EXPECT_EQ(value_of("f(1, z = 4)", f), "(1, 2, 4)");
}

TEST(Values, CloseOverLocalNames) {
    EXPECT_EQ(value_of("map([1, 2], adder(10))", "fn adder(k: number) = fn(x: number) = x + k"), "[11, 12]");
    EXPECT_EQ(value_of("map([for (i in 0..3) fn(x: number) = x + i], fn(f: fn(number) -> number) = f(10))"),
              "[10, 11, 12]");
    EXPECT_EQ(
        value_of("outer(3)", "fn outer(n: number) { let k = n * 2\n let f = fn(x: number) = x + k\n f(1) }"),
        "7");
}

TEST(Values, RecurseWhereTheResultTypeIsWritten) {
    EXPECT_EQ(value_of("fact(10)", "fn fact(n: number) -> number = if (n == 0) 1 else n * fact(n - 1)"),
              "3628800");
    EXPECT_EQ(value_of("even(7)", "fn even(n: number) -> bool = if (n == 0) true else odd(n - 1)\n"
                                  "fn odd(n: number) = if (n == 0) false else even(n - 1)"),
              "false");
    EXPECT_EQ(
        value_of("f(400)", "fn f(n: number) -> number { let rest = if (n == 0) 0 else f(n - 1)\n rest + 1 }"),
        "401");
}

TEST(Values, PrintAsTheLanguageWritesThem) {
    EXPECT_EQ(value_of("[\"a\\\"b\\n\"]"), R"(["a\"b\n"])");
    EXPECT_EQ(value_of("0.1 + 0.2"), "0.30000000000000004");
    EXPECT_EQ(value_of("2..5"), "2..5");
    EXPECT_EQ(value_of("0.3rad"), "0.3rad");
    EXPECT_EQ(value_of("-0"), "0");
    EXPECT_EQ(value_of("ball { radius = 3 }"), "ball { }");
}

} // namespace
} // namespace scc::lang
