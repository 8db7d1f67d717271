#include "compiler/backends/function_range.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace scc::compiler {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// The range of an expression in x = s.p.x over an interval of x.
Range range_of(const std::string& expression, Range x) {
    const test::Compiled c =
        test::compile_shapes("fn f(s: surface) -> number {\n  let x = s.p.x\n  " + expression +
                             "\n}\nsphere { material = phong { specular = rgb(1, 1, 1), shininess = f } }");
    EXPECT_TRUE(c.fine) << c.messages;
    if (!c.fine || c.scene.functions.empty()) {
        return {};
    }
    const ir::Function& function = c.scene.functions[0];
    InputRanges inputs;
    inputs[static_cast<std::size_t>(ir::Input::p_x)] = x;
    return node_ranges(function, inputs)[function.results[0]];
}

void expect_range(const std::string& expression, Range x, Range expected) {
    const Range range = range_of(expression, x);
    EXPECT_NEAR(range.min, expected.min, 1e-12) << expression;
    EXPECT_NEAR(range.max, expected.max, 1e-12) << expression;
}

TEST(FunctionRange, FollowsArithmetic) {
    expect_range("2 * x + 1", {-1, 3}, {-1, 7});
    expect_range("1 - x", {-1, 3}, {-2, 2});
    expect_range("-2 * x", {-1, 3}, {-6, 2});
    expect_range("1 / x", {2, 4}, {0.25, 0.5});
    expect_range("abs(x)", {-1, 3}, {0, 3});
    expect_range("min(x, 2)", {-1, 3}, {-1, 2});
    expect_range("floor(x)", {-1.5, 3.5}, {-2, 3});
}

TEST(FunctionRange, FollowsElementaryFunctionsBetweenTheirTurns) {
    expect_range("sin(x)", {0, 1}, {0, std::sin(1.0)});
    expect_range("sin(x)", {1, 2}, {std::sin(1.0), 1});
    expect_range("cos(x)", {3, 4}, {-1, std::cos(4.0)});
    expect_range("sin(x)", {-100, 100}, {-1, 1});
    expect_range("exp(x)", {0, 1}, {1, std::exp(1.0)});
    expect_range("sqrt(x)", {4, 9}, {2, 3});
    expect_range("x ^ 2", {-2, 1}, {0, 4});
}

TEST(FunctionRange, PeriodicFunctionsAreBoundedOnEndlessSurfaces) {
    expect_range("0.5 + 0.5 * sin(3 * x)", {-inf, inf}, {0, 1});
    expect_range("x % 2", {-inf, inf}, {0, 2});
    expect_range("if (x > 0) 5 else 7", {-inf, inf}, {5, 7});
}

TEST(FunctionRange, IsEndlessWhereItCannotTell) {
    EXPECT_EQ(range_of("1 / x", {-1, 1}), Range{});
    EXPECT_EQ(range_of("x * x", {-inf, inf}).max, inf);
}

TEST(FunctionRange, ConditionsThatAreSettledTakeTheirBranch) {
    expect_range("if (x > 0) 5 else 7", {1, 2}, {5, 5});
    expect_range("if (x > 0) 5 else 7", {-2, -1}, {7, 7});
}

} // namespace
} // namespace scc::compiler
