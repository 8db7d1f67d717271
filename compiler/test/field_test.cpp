#include "compiler/backends/function_range.h"
#include "compiler/field_bounds.h"
#include "compiler/function_builder.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scc::compiler {
namespace {

test::Compiled surface(const std::string& field, const std::string& within = "sphere { }") {
    return test::compile_shapes("implicit { field = fn(p: vec3) = " + field + ", within = " + within + " }");
}

std::string refused(const std::string& field, const std::string& within = "sphere { }") {
    const test::Compiled c = surface(field, within);
    EXPECT_FALSE(c.fine) << field;
    return c.messages;
}

TEST(Field, WithoutFiniteValuesIsAMistakeAtTheOperation) {
    EXPECT_NE(refused("p.y + 1 / p.x").find("this divides by 0"), std::string::npos);
    EXPECT_NE(refused("log(p.x)").find("logarithm"), std::string::npos);
    EXPECT_NE(refused("sqrt(p.x - 0.5)").find("square root of negative"), std::string::npos);
    EXPECT_NE(refused("tan(p.x * 2)").find("pole"), std::string::npos);
    EXPECT_NE(refused("asin(p.x * 1.01) / 1rad").find("beyond -1 and 1"), std::string::npos);
    EXPECT_NE(refused("p.x ^ 0.5").find("powers that are not whole"), std::string::npos);
    EXPECT_NE(refused("exp(p.x * 1000)").find("too large"), std::string::npos);
}

TEST(Field, WithFiniteValuesInTheContainerAloneIsFine) {
    for (const char* field :
         {"1 / (p.x + 1.001)", "sqrt(p.x * p.x + p.y * p.y) - 0.5", "length(p) - 0.5", "sqrt(1.0001 - p.x)",
          "1 / (p.x * p.x - 2 * p.x * p.y + p.y * p.y + 0.5)", "if (p.x > 0.1) 1 / p.x else 3",
          "p.x ^ -2 + p.y", "noise(p * 3) - 0.5", "random(floor(p.x)) - 0.5", "7"}) {
        const bool divides = std::string(field) == "p.x ^ -2 + p.y";
        const test::Compiled c = surface(field, divides ? "sphere { center = (3, 0, 0) }" : "sphere { }");
        EXPECT_TRUE(c.fine) << field << "\n" << c.messages;
    }
    // The corners of the box around the ball are outside of it.
    EXPECT_TRUE(surface("sqrt(1.1 - dot(p, p))").fine);
    EXPECT_FALSE(surface("sqrt(1.1 - dot(p, p))", "box { }").fine);
}

TEST(Field, TakesClosedConvexContainers) {
    EXPECT_NE(refused("p.x", "plane { }").find("this is a plane; a container is"), std::string::npos);
    EXPECT_NE(refused("p.x", "group { sphere { } }").find("this is a group"), std::string::npos);
    EXPECT_NE(refused("p.x", "cone { caps = false }").find("open"), std::string::npos);
    EXPECT_NE(refused("p.x", "sphere { transform = scale(2) }").find("no `transform`"), std::string::npos);
    EXPECT_NE(refused("p.x", "sphere { material = phong { } }").find("no `material`"), std::string::npos);
    for (const char* within : {"box { }", "cylinder { }", "cone { }"}) {
        EXPECT_TRUE(surface("p.x - 0.2", within).fine) << within;
    }
}

TEST(Field, InALoopHasItsOwnNumbers) {
    const test::Compiled c = test::compile_shapes("for (i in 0..40) { implicit { field = fn(p: vec3) = "
                                                  "dot(p, p) - i / 100 - 0.1, within = sphere { } } }");
    ASSERT_TRUE(c.fine) << c.messages;
    ASSERT_EQ(c.scene.objects.size(), 40U);
    EXPECT_EQ(c.scene.functions.size(), 40U);
}

TEST(Field, GradientBoundIsCloseAboveTheSteepest) {
    const auto bound = [](const std::string& field) {
        const test::Compiled c = surface(field, "box { }");
        return gradient_bound(c.scene.functions.at(0), {{-1, -1, -1}, {1, 1, 1}});
    };
    const Steepness ball = bound("dot(p, p) - 0.5");
    EXPECT_GE(ball.bound, 2 * std::sqrt(3.0));
    EXPECT_LE(ball.bound, 2 * std::sqrt(3.0) * 1.01);
    EXPECT_FALSE(ball.at_zero || ball.elsewhere);
    const Steepness distance = bound("length(p) - 0.5");
    EXPECT_GE(distance.bound, 1);
    EXPECT_TRUE(distance.elsewhere && !distance.at_zero);
    EXPECT_TRUE(bound("floor(p.x) + 0.5").at_zero);
}

TEST(FunctionBuilder, MakesPowersOfProducts) {
    const test::Compiled c = surface("p.x ^ 5 + p.y * p.y");
    for (const ir::Node& node : c.scene.functions.at(0).nodes) {
        EXPECT_TRUE(node.kind != ir::Node::Kind::apply || node.op != ir::Op::pow);
    }
    const std::vector<Range> ranges = node_ranges(c.scene.functions[0], [] {
        InputRanges inputs;
        inputs.fill({-2, 1});
        return inputs;
    }());
    EXPECT_NEAR(ranges[c.scene.functions[0].results[0]].max, 16 + 4, 1e-9);
}

} // namespace
} // namespace scc::compiler
