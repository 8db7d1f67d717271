#include "compiler/backends/function_program.h"
#include "compiler/backends/function_range.h"
#include "compiler/derivative.h"
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

/// Against the derivatives that the tracer has, which are made in another way.
TEST(Field, GradientAsAFunctionIsThatOfDualNumbers) {
    using D = runtime::Dual<double, 3>;
    for (const char* field :
         {"p.x * p.y / (p.z + 3) - p.x ^ 3", "(p.x + 2) ^ (p.y * 0.5)", "(p.x + 2) ^ 0.3 + sqrt(p.y + 2)",
          "sin(p.x * 2) * cos(p.y) + tan(p.z * 0.3)", "asin(p.x * 0.5) / 1rad + acos(p.y * 0.5) / 1rad",
          "atan2(p.y + 0.1, p.x + 2) / 1rad", "exp(p.x) + log(p.y + 2)",
          "max(p.x, p.y * 2) + min(p.z, 0.2) + abs(p.x)", "if (p.x > 0.1) p.y * p.y else -p.z",
          "(p.x + 5) % 1.5 + floor(p.y * 2) + p.z", "7"}) {
        const test::Compiled c = surface(field);
        ASSERT_TRUE(c.fine) << field << c.messages;
        const auto derived = with_gradient(c.scene.functions.at(0));
        ASSERT_TRUE(derived) << field;
        ASSERT_EQ(derived->results.size(), 4U);
        const auto program = program_of<double>(c.scene.functions[0]);
        const auto all = program_of<double>(*derived);
        for (int i = 0; i < 20; ++i) {
            const double x = std::sin(7.0 * i), y = std::sin(11.0 * i + 1), z = std::sin(13.0 * i + 2);
            const D expected = run(
                program, runtime::SurfacePoint<D>{{D::variable(x, 0), D::variable(y, 1), D::variable(z, 2)},
                                                  {},
                                                  {}})[program.results[0]];
            const double* found = run(all, runtime::SurfacePoint<double>{{x, y, z}, {}, {}});
            EXPECT_NEAR(found[all.results[0]], expected.v, 1e-12) << field;
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_NEAR(found[all.results[k + 1]], expected.d[k], 1e-9) << field << " by " << k;
            }
        }
    }
    EXPECT_FALSE(with_gradient(surface("noise(p) - 0.5").scene.functions.at(0)));
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
