#include "lang/builtins.h"
#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace scc::lang {
namespace {

using test::messages_of;
using test::Scene;
using test::value_of;

constexpr const char* add = "fn add(x: number, y: number = 2) = x + y\n";

TEST(Calls, CountArguments) {
    EXPECT_EQ(messages_of(add + std::string("print(add(1, 2, 3))")),
              R"(a.scn:2:7: error: `add` takes 2 arguments, this call gives 3 [argument-count]
    2 | print(add(1, 2, 3))
      |       ^~~~~~~~~~~~
)");
    EXPECT_EQ(messages_of(add + std::string("print(add())")),
              R"(a.scn:2:7: error: `add` needs the argument `x` [missing-argument]
    2 | print(add())
      |       ^~~~~
)");
    EXPECT_EQ(messages_of("print(dot((1, 2)))"),
              R"(a.scn:1:7: error: `dot` takes 2 arguments, this call gives 1 [argument-count]
    1 | print(dot((1, 2)))
      |       ^~~~~~~~~~~
)");
}

TEST(Calls, MatchNamesOfArguments) {
    EXPECT_EQ(messages_of("fn f(size: number, y: number = 2) = size + y\nprint(f(sise = 3))"),
              R"(a.scn:2:9: error: `f` has no parameter `sise`; did you mean `size`? [unknown-argument]
    2 | print(f(sise = 3))
      |         ^~~~
      |         size
)");
    EXPECT_EQ(messages_of(add + std::string("print(add(1, x = 2))")),
              R"(a.scn:2:18: error: the parameter `x` is given already [duplicate-argument]
    2 | print(add(1, x = 2))
      |                  ^
a.scn:2:11: note: the first value is here
)");
    EXPECT_EQ(
        messages_of(add + std::string("print(add(x = 1, 2))")),
        R"(a.scn:2:18: error: this value has no name but follows a named one; arguments by position come first [unnamed-argument]
    2 | print(add(x = 1, 2))
      |                  ^
)");
    EXPECT_EQ(messages_of("print(len(list = [2]))"),
              R"(a.scn:1:11: error: `len` takes arguments by position only [named-argument]
    1 | print(len(list = [2]))
      |           ^~~~
)");
}

TEST(Calls, BuiltInFunctionsTakeArgumentsByName) {
    EXPECT_EQ(value_of("mix(t = 0.25, a = 4, b = 8)"), "5");
    EXPECT_EQ(value_of("clamp(7, high = 5, low = 0)"), "5");
    EXPECT_EQ(value_of("translate(x = 1, z = 3, y = 2)"), value_of("translate(1, 2, 3)"));
    EXPECT_EQ(Scene("print(mix(1, b = 2, 0.5))").summary(), "1 unnamed-argument\n");
    EXPECT_EQ(Scene("print(mix(1, 2, a = 3))").summary(), "1 duplicate-argument\n");
    EXPECT_EQ(messages_of("print(clamp(7, 0, hihg = 5))"),
              R"(a.scn:1:19: error: `clamp` has no parameter `hihg`; did you mean `high`? [unknown-argument]
    1 | print(clamp(7, 0, hihg = 5))
      |                   ^~~~
      |                   high
)");
}

TEST(Calls, CheckTypesOfArguments) {
    EXPECT_EQ(messages_of(add + std::string("print(add(1, y = \"a\"))")),
              R"(a.scn:2:18: error: `y` takes a number, this is a string [type-mismatch]
    2 | print(add(1, y = "a"))
      |                  ^~~
)");
    EXPECT_EQ(messages_of("fn turn(by: angle) = by * 2\nprint(turn(30))"),
              R"(a.scn:2:12: error: `by` takes an angle, this is a number [angle-expected]
    2 | print(turn(30))
      |            ^~
      |            30deg
)");
}

TEST(Calls, CheckDefaultsAndResults) {
    EXPECT_EQ(messages_of("fn f(x: number = \"a\") -> string = x"),
              R"(a.scn:1:18: error: `x` takes a number, this is a string [type-mismatch]
    1 | fn f(x: number = "a") -> string = x
      |                  ^~~
a.scn:1:35: error: the result of `f` takes a string, this is a number [type-mismatch]
    1 | fn f(x: number = "a") -> string = x
      |                                   ^
)");
}

TEST(Calls, ListTheOverloadsOfABuiltin) {
    EXPECT_EQ(
        messages_of("print(dot(1, 2))"),
        R"(a.scn:1:7: error: `dot` takes `(vec2, vec2)` or `(vec3, vec3)`; this call gives `(number, number)` [no-overload]
    1 | print(dot(1, 2))
      |       ^~~~~~~~~
)");
    EXPECT_EQ(messages_of("print(sqrt((1, 2)))"),
              R"(a.scn:1:12: error: `sqrt` takes a number, this is a vec2 [type-mismatch]
    1 | print(sqrt((1, 2)))
      |            ^~~~~~
)");
}

TEST(Calls, OfWhatIsNoFunction) {
    EXPECT_EQ(messages_of("let a = 1\nprint(a(2))"),
              R"(a.scn:2:7: error: this is a number, not a function [not-callable]
    2 | print(a(2))
      |       ^
)");
}

TEST(Calls, OfFunctionValuesTakeTypesInOrder) {
    const std::string apply = "fn apply(f: fn(number, angle) -> number) = f(1, 2deg)\n";
    EXPECT_EQ(messages_of(apply + "print(apply(fn(x: number, a: angle) = x))"), "");
    EXPECT_EQ(
        messages_of(apply + "print(apply(fn(x: number) = x))"),
        R"(a.scn:2:13: error: `f` takes a function `fn(number, angle) -> number`, this is a function `fn(number) -> number` [type-mismatch]
    2 | print(apply(fn(x: number) = x))
      |             ^~~~~~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("let f = fn(x: number) = x\nprint(f(1, 2))").summary(), "2 argument-count\n");
    EXPECT_EQ(Scene("let f = fn(x: number) = x\nprint(f(x = 1))").summary(), "2 named-argument\n");
    EXPECT_EQ(Scene("let f = fn(x: number) = x\nprint(f(true))").summary(), "2 type-mismatch\n");
}

TEST(Calls, OfListFunctions) {
    EXPECT_EQ(
        messages_of("print(map([1], fn(x: string) = x))"),
        R"(a.scn:1:16: error: `map` takes a function of a number, this is a function `fn(string) -> string` [type-mismatch]
    1 | print(map([1], fn(x: string) = x))
      |                ^~~~~~~~~~~~~~~~~
)");
    EXPECT_EQ(Scene("print(filter([1], fn(x: number) = x))").summary(), "1 type-mismatch\n");
    EXPECT_EQ(Scene("print(map([1]))").summary(), "1 argument-count\n");
    EXPECT_EQ(Scene("print(len(3))").summary(), "1 type-mismatch\n");
    EXPECT_EQ(Scene("print(sum([\"a\"]))").summary(), "1 type-mismatch\n");
    EXPECT_EQ(
        messages_of("print(map([1], sqrt))"),
        R"(a.scn:1:16: error: the built-in function `sqrt` stands without ( ); as a value it is wrapped in `fn` [bare-builtin]
    1 | print(map([1], sqrt))
      |                ^~~~
      |                fn(x: number) = sqrt(x)
)");
}

TEST(Calls, OfStatementsStandOnTheirOwn) {
    EXPECT_EQ(
        messages_of("let a = print(3)"),
        R"(a.scn:1:9: error: `print` gives no value; it stands on a line of its own [misplaced-statement]
    1 | let a = print(3)
      |         ^~~~~
)");
    EXPECT_EQ(Scene("assert(1, \"a\")").summary(), "1 type-mismatch\n");
    EXPECT_EQ(Scene("assert(true)").summary(), "1 argument-count\n");
}

TEST(Calls, EveryFunctionIsDescribedWithAnExampleThatRuns) {
    for (const std::string_view name : function_names()) {
        const auto& docs = function_docs();
        const auto doc =
            std::find_if(docs.begin(), docs.end(), [&](const FunctionDoc& row) { return row.name == name; });
        ASSERT_NE(doc, docs.end()) << name;
        EXPECT_FALSE(doc->doc.empty()) << name;
        EXPECT_FALSE(doc->signatures.empty()) << name;
        const std::string example(doc->example);
        EXPECT_NE(example.find(name), std::string::npos) << name;
        EXPECT_EQ(messages_of(is_statement(name) ? example : "print(" + example + ")"), "") << name;
    }
}

TEST(Calls, SignaturesNameTheParameters) {
    std::string text;
    for (const FunctionDoc& row : function_docs()) {
        if (row.name == "translate" || row.name == "atan2") {
            for (const std::string& signature : row.signatures) {
                text += signature + "\n";
            }
        }
    }
    EXPECT_EQ(text, "atan2(y: number, x: number) -> angle\n"
                    "translate(offset: vec3) -> transform\n"
                    "translate(x: number, y: number, z: number) -> transform\n");
}

} // namespace
} // namespace scc::lang
