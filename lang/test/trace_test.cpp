#include "lang/test/trace_recorder.h"

#include <gtest/gtest.h>

namespace scc::lang {
namespace {

using test::traced;

TEST(Trace, ReadsThePointAndNormalOfTheSurface) {
    EXPECT_EQ(traced("s.p.x"), "p.x\n");
    EXPECT_EQ(traced("s.world.z"), "world.z\n");
    EXPECT_EQ(traced("s.n.y"), "n.y\n");
}

TEST(Trace, FoldsWhatDoesNotDependOnTheSurface) {
    EXPECT_EQ(traced("2 * 3 + 1"), "7\n");
    EXPECT_EQ(traced("s.p.x * (2 + 3)"), "mul(p.x, 5)\n");
    EXPECT_EQ(traced("k ^ 2 + s.p.x", "let k = 3"), "add(9, p.x)\n");
}

TEST(Trace, HandsEveryOperatorToTheBuilder) {
    EXPECT_EQ(traced("-s.p.x"), "neg(p.x)\n");
    EXPECT_EQ(traced("s.p.x - s.p.y / s.p.z % 2"), "sub(p.x, mod(div(p.y, p.z), 2))\n");
    EXPECT_EQ(traced("s.p.x ^ 3"), "pow(p.x, 3)\n");
    EXPECT_EQ(traced("min(s.p.x, max(1, s.p.y))"), "min(p.x, max(1, p.y))\n");
    EXPECT_EQ(traced("abs(floor(ceil(sqrt(s.p.x))))"), "abs(floor(ceil(sqrt(p.x))))\n");
    EXPECT_EQ(traced("sin(s.p.x) + cos(s.p.y * 1rad) + tan(s.p.z)"),
              "add(add(sin(p.x), cos(mul(p.y, 1))), tan(p.z))\n");
    EXPECT_EQ(traced("(asin(s.p.x) + acos(s.p.y) + atan2(s.p.y, s.p.x)) / 1rad"),
              "div(add(add(asin(p.x), acos(p.y)), atan2(p.y, p.x)), 1)\n");
    EXPECT_EQ(traced("exp(log(s.p.x))"), "exp(log(p.x))\n");
}

TEST(Trace, ExpandsVectorFunctionsIntoScalars) {
    EXPECT_EQ(traced("dot(s.p, (1, 2, 3))"), "add(add(mul(p.x, 1), mul(p.y, 2)), mul(p.z, 3))\n");
    EXPECT_EQ(traced("length((s.p.x, 0))"), "sqrt(add(mul(p.x, p.x), 0))\n");
    EXPECT_EQ(traced("cross(s.p, s.n).z"), "sub(mul(p.x, n.y), mul(p.y, n.x))\n");
    EXPECT_EQ(traced("mix(1, 3, s.p.x)"), "add(mul(1, sub(1, p.x)), mul(3, p.x))\n");
    EXPECT_EQ(traced("clamp(s.p.x, 0, 1)"), "min(max(p.x, 0), 1)\n");
    EXPECT_EQ(traced("normalize((s.p.x, 1)).y"), "div(1, sqrt(add(mul(p.x, p.x), 1)))\n");
}

TEST(Trace, GivesThreeScalarsForAColor) {
    EXPECT_EQ(traced("rgb(1, s.p.x, 0) * 2", "", "tone"), "2\nmul(p.x, 2)\n0\n");
    EXPECT_EQ(traced("#ff0000", "", "tone"), "1\n0\n0\n");
}

TEST(Trace, SelectsComponentsWhereTheConditionIsUnknown) {
    EXPECT_EQ(traced("if (s.p.x > 0) rgb(1, 0, 0) else rgb(0, 0, 1)", "", "tone"),
              "select(gt(p.x, 0), 1, 0)\n0\nselect(gt(p.x, 0), 0, 1)\n");
    EXPECT_EQ(traced("if (s.p.x == s.p.y and not (s.p.z <= 1)) 1 else 2"),
              "select(logical_and(eq(p.x, p.y), logical_not(le(p.z, 1))), 1, 2)\n");
    EXPECT_EQ(traced("if (s.p.x != 0 or s.p.y >= 1 or s.p.z < 2) 1 else 2"),
              "select(logical_or(logical_or(ne(p.x, 0), ge(p.y, 1)), lt(p.z, 2)), 1, 2)\n");
}

TEST(Trace, DecidesKnownConditionsAtOnce) {
    EXPECT_EQ(traced("if (k > 0) s.p.x else s.p.y", "let k = 1"), "p.x\n");
    EXPECT_EQ(traced("if (true or s.p.x > 0) 1 else 2"), "1\n");
    EXPECT_EQ(traced("if (s.p.x > 0 and false) 1 else 2"), "2\n");
    EXPECT_EQ(traced("if (s.p.x > 0 or false) 1 else 2"), "select(gt(p.x, 0), 1, 2)\n");
}

TEST(Trace, FollowsCallsAndUnrollsKnownLoops) {
    EXPECT_EQ(traced("twice(s.p.x)", "fn twice(x: number) { let y = x + x\n y }"), "add(p.x, p.x)\n");
    EXPECT_EQ(traced("sum([for (i in 1..3) s.p.x * i])"), "add(mul(p.x, 1), mul(p.x, 2))\n");
    EXPECT_EQ(traced("power(s.p.x, 3)",
                     "fn power(x: number, n: number) -> number = if (n == 0) 1 else x * power(x, n - 1)"),
              "mul(p.x, mul(p.x, mul(p.x, 1)))\n");
}

TEST(Trace, LetsKnownRecursionStandUnderAnUnknownCondition) {
    EXPECT_EQ(traced("if (s.p.x > 0) twice(s.p.x, 2) else 0",
                     "fn twice(x: number, n: number) -> number = if (n == 0) x else twice(x + x, n - 1)"),
              "select(gt(p.x, 0), add(add(p.x, p.x), add(p.x, p.x)), 0)\n");
}

TEST(Trace, MemoisesLetsPerCall) {
    test::Scene scene("fn f(x: number) { let y = x * x\n y + y }\n"
                      "ball { material = paint { gloss = fn(s: surface) = f(s.p.x) } }");
    struct Counter final : SymbolBuilder {
        std::uint32_t count = 0;
        std::uint32_t constant(double) override { return count++; }
        std::uint32_t input(std::string_view) override { return count++; }
        std::uint32_t apply(std::string_view op, const std::vector<std::uint32_t>&) override {
            products += op == "mul";
            return count++;
        }
        int products = 0;
    } counter;
    const auto& material = std::get<ThingPtr>(scene.module.items.at(0)->find("material")->value.v);
    trace(std::get<ClosurePtr>(material->find("gloss")->value.v), counter, scene.diagnostics);
    EXPECT_EQ(counter.products, 1);
}

TEST(Trace, ReportsAnIndexThatDependsOnTheSurface) {
    EXPECT_EQ(
        traced("[1, 2][s.p.x]"),
        R"(a.scn:2:59: error: this index depends on the surface; a list takes a known index [depends-on-surface]
    2 | ball { material = paint { gloss = fn(s: surface) = [1, 2][s.p.x] } }
      |                                                           ^~~~~
)");
}

TEST(Trace, ReportsALoopThatDependsOnTheSurface) {
    EXPECT_EQ(
        traced("sum([for (i in 0..s.p.x) i])"),
        R"(a.scn:2:67: error: a bound of this range depends on the surface; a per-point function loops over known ranges [depends-on-surface]
    2 | ball { material = paint { gloss = fn(s: surface) = sum([for (i in 0..s.p.x) i]) } }
      |                                                                   ^~~~~~~~
)");
}

TEST(Trace, ReportsRecursionThatDependsOnTheSurface) {
    EXPECT_EQ(
        traced("f(s.p.x)", "fn f(x: number) -> number = if (x > 0) f(x - 1) else 0"),
        R"(a.scn:1:40: error: `f` calls itself under a condition that depends on the surface [surface-recursion]
    1 | fn f(x: number) -> number = if (x > 0) f(x - 1) else 0
      |                                        ^~~~~~~~
a.scn:2:52: note: in the call of `f`
)");
}

TEST(Trace, ReportsThingsThatAreBuiltPerPoint) {
    EXPECT_EQ(
        traced("len([ball { }])"),
        R"(a.scn:2:57: error: a per-point function builds a shape; it can only compute numbers, vectors and colors [shape-per-point]
    2 | ball { material = paint { gloss = fn(s: surface) = len([ball { }]) } }
      |                                                         ^~~~
)");
}

TEST(Trace, ReportsChoicesAndTransformsThatDependOnTheSurface) {
    EXPECT_NE(traced("len(if (s.p.x > 0) [1] else [1, 2])").find("this choice depends on the surface"),
              std::string::npos);
    EXPECT_NE(traced("len([translate(s.p)])").find("this transform depends on the surface"),
              std::string::npos);
    EXPECT_NE(traced("len(filter([1], fn(x: number) = x > s.p.x))")
                  .find("what `filter` keeps depends on the surface"),
              std::string::npos);
}

TEST(Trace, ReportsConstantResultsThatAreNotFinite) {
    EXPECT_EQ(
        traced("sqrt(-1)"),
        R"(a.scn:2:35: error: the result of this function is nan; a field takes finite numbers [not-finite]
    2 | ball { material = paint { gloss = fn(s: surface) = sqrt(-1) } }
      |                                   ^~~~~~~~~~~~~~~~~~~~~~~~~
)");
}

TEST(Trace, NamesFunctions) {
    const test::Scene scene("fn shiny(s: surface) = s.p.x\nlet dull = fn(s: surface) = 0\n"
                            "ball { material = paint { gloss = shiny } }\n"
                            "ball { material = paint { gloss = dull } }\n"
                            "ball { material = paint { gloss = fn(s: surface) = 1 } }");
    std::string names;
    for (const ThingPtr& item : scene.module.items) {
        const auto& material = std::get<ThingPtr>(item->find("material")->value.v);
        names += std::string(name_of(*std::get<ClosurePtr>(material->find("gloss")->value.v))) + ",";
    }
    EXPECT_EQ(names, "shiny,dull,,");
}

} // namespace
} // namespace scc::lang
