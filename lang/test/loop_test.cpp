#include "lang/test/outcome.h"

#include <gtest/gtest.h>

#include <random>

namespace scc::lang {
namespace {

using test::Scene;

constexpr EvaluationLimits round_by_round{.recorded_rounds = ~std::uint64_t{0}};
constexpr EvaluationLimits all_at_once{.recorded_rounds = 1};

using test::outcome;

/// How many things were made by recorded loops.
std::size_t in_rows(const Scene& scene) {
    std::size_t count = 0;
    for (const ThingPtr& item : scene.module.items) {
        count += item->rows ? count_of(*item) : 0;
    }
    return count;
}

void expect_same(const std::string& text, std::size_t recorded) {
    const Scene slow(text, {}, round_by_round);
    const Scene fast(text, {}, all_at_once);
    EXPECT_EQ(outcome(fast), outcome(slow)) << text;
    EXPECT_EQ(in_rows(slow), 0U);
    EXPECT_EQ(in_rows(fast), recorded) << text;
}

TEST(Loop, MakesRowsOfThingsThatDifferInNumbers) {
    expect_same("for (i in 0..1000) { ball { center = (i, i * 2, 1), radius = 1 + i } }", 1000);
    expect_same("for (i in -3..4) { let r = abs(i) + 1\nball { radius = r }\nball { center = (i, 0, r) } }",
                14);
    expect_same("for (i in 0..7) { chain { points = [(i, 0, 0), (0, i, 0), (1, 2, 3)] } }", 7);
    expect_same("let base = 4\nfn at(i: number) -> vec3 { let a = i * 20deg\n (base * cos(a), noise((a / "
                "1rad, 0, 7)), "
                "sin(a)) }\nfor (i in 0..300) { ball { center = at(i), radius = 0.1 + random(i, 7) } }",
                300);
}

TEST(Loop, MakesMaterialsOfTheirOwn) {
    expect_same("let tones = [rgb(1, 0, 0), rgb(0, 1, 0), #457b9d]\n"
                "for (i in 0..20) { ball { material = paint { tone = tones[i % 3], gloss = i } } }",
                20);
    expect_same("let red = paint { tone = rgb(1, 0, 0) }\nfor (i in 0..5) { ball { material = red, radius = "
                "i + 1 } }",
                5);
}

TEST(Loop, JoinsLoopsWithinLoops) {
    expect_same("for (i in 0..5) { for (j in 2..9) { ball { center = (i, j, i % (j + 1)) } } }", 35);
    expect_same("for (i in 0..3) { let a = i * i\nfor (j in 0..4) { let b = a - j\nfor (k in 5..7) { "
                "ball { center = (a, b, k) }\nwall { normal = (1, j, k) } } } }",
                48);
    expect_same("for (i in 1..6) { for (j in 0..i) { ball { center = (i, j, 0) } } }",
                15); // each loop of its own
    expect_same("for (i in 0..3) { ball { }\nfor (j in 0..2) { wall { normal = (i, j, 1) } } }", 6);
}

TEST(Loop, ChoosesByConditionsThatDependOnTheVariable) {
    expect_same("for (i in 0..9) { ball { radius = if (i % 2 == 0 and i > 3 or i == 1) 1 + i else 2 } }", 9);
    expect_same("let few = [3, 4]\nfor (i in 0..9) { ball { radius = if (i < 2) few[i] else 1 } }", 9);
    expect_same("for (i in 0..9) { ball { radius = if (i > 0) 1 / i else 2 } }", 9);
    expect_same("for (i in 0..9) { let x = 1 / i\nball { radius = if (i > 0) x else 2 } }", 8); // 0 by itself
}

TEST(Loop, GoesRoundByRoundWhereRoundsDiffer) {
    expect_same("for (i in 0..4) { if (i % 2 == 0) { ball { } } else { wall { normal = (1, 0, 0) } } }", 0);
    expect_same("for (i in 0..4) { ball { transform = translate(i, 0, 0) } }", 0);
    expect_same("for (i in 0..4) { pile { ball { radius = i + 1 } } }", 0);
    expect_same("for (i in 0..4) { print(i)\nball { } }", 0);
    expect_same("for (i in 0..4) { lamp { position = (i, 0, 0) } }", 0);
    expect_same("for (i in 0..4) { ball { material = paint { gloss = fn(s: surface) = s.p.x * i } } }", 0);
    expect_same("let names = [\"a\", \"b\"]\nfor (i in 0..2) { ball { name = names[i] } }", 0);
    expect_same(
        "fn f(n: number) -> number = if (n <= 0) 1 else f(n - 1)\nfor (i in 0..4) { ball { radius = f(i) } }",
        0);
    expect_same("pile { for (i in 0..4) { ball { radius = i + 1 } } }",
                0); // in rows, but not on the top level
}

TEST(Loop, ReportsWhatIsWrongAsRoundByRound) {
    const std::string text = "for (i in 0..1000) { ball { radius = 3 - i } }";
    EXPECT_EQ(Scene(text, {}, all_at_once).messages(),
              R"(a.scn:1:38: error: radius is 0; a radius is greater than 0 [value-out-of-range]
    1 | for (i in 0..1000) { ball { radius = 3 - i } }
      |                                      ^~~~~
a.scn:1:1: note: in the loop with i = 3; the first of 997 such values
)");
    expect_same(text, 3);
    expect_same("for (i in -4..5) { ball { radius = 10 / i } }", 4);
    expect_same("for (i in -4..5) { ball { radius = 5 + 10 % i } }", 8);
    expect_same("for (i in 0..9) { ball { radius = [1, 2, 3, 4][i / 2] } }", 4);
    expect_same("for (i in 0..9) { ball { radius = 1 + [][i] } }", 0);
    expect_same("for (i in -2..9) { ball { radius = 1 + sqrt(i) } }", 9);
    expect_same("for (i in -2..3) { wall { normal = (i, i * i, 0) } }", 4);
    expect_same("for (i in -2..3) { ball { center = normalize((i, 0, 0)) } }", 4);
    expect_same("for (i in 0..9) { assert(i < 5, \"too many\")\nball { } }", 5);
    expect_same("for (i in 0..3) { for (j in 0..4) { ball { radius = 3 + i * j - 6 } } }", 2);
    expect_same("let bad = 1 / 0\nfor (i in 0..9) { ball { radius = i + bad } }", 0);
    expect_same("let odd = 1 / 0\nlet r = 2\nfor (i in 0..9) { ball { radius = if (i > 20) odd else r } }",
                0);
    expect_same("for (i in 0..2.5) { ball { } }", 0);
    expect_same("pile { ball { }\nfor (i in 0..9) { ball { radius = 5 - i } } }", 0);
}

TEST(Loop, KeepsTheLimits) {
    EvaluationLimits few{.steps = 500, .recorded_rounds = 1};
    EXPECT_EQ(Scene("for (i in 0..1000) { ball { } }", {}, few).summary(), "1 steps-exceeded\n");
    EvaluationLimits short_lists{.list_length = 500, .recorded_rounds = 1};
    EXPECT_EQ(Scene("for (i in 0..1000) { ball { } }", {}, short_lists).summary(), "1 list-too-long\n");
}

/// Random expressions over i, j and what can be in scope.
class Expressions {
public:
    explicit Expressions(unsigned seed) : random_(seed) {}

    std::string number(int depth) {
        if (depth == 0) {
            return pick({"i", "j", "i", "k", "2", "0.5", "3", "7", "1e3", "-1"});
        }
        const auto n = [&] { return number(depth - 1); };
        switch (below(15)) {
        case 0:
            return fmt::format("({} + {})", n(), n());
        case 1:
            return fmt::format("({} - {})", n(), n());
        case 2:
            return fmt::format("({} * {})", n(), n());
        case 3:
            return fmt::format("({} / {})", n(), n());
        case 4:
            return fmt::format("({} % {})", n(), n());
        case 5:
            return fmt::format("{}({})",
                               pick({"floor", "ceil", "abs", "sin", "cos", "tan", "exp", "-", "sqrt", "log"}),
                               n());
        case 6:
            return fmt::format("{}({}, {})", pick({"min", "max", "random", "pow", "twice"}), n(), n());
        case 7:
            return fmt::format("(if ({}) {} else {})", truth(depth - 1), n(), n());
        case 8:
            return fmt::format("[1.5, k, -2, 40][floor(abs({})) % {}]", n(), pick({"4", "3", "5"}));
        case 9:
            return fmt::format("noise(({}, {}, {}))", n(), n(), n());
        case 10:
            return fmt::format("dot({}, {})", vector(depth - 1), vector(depth - 1));
        case 11:
            return fmt::format("length({})", vector(depth - 1));
        case 12:
            return fmt::format("sum([for (m in 0..3) m * {}])", n());
        case 13:
            return fmt::format("{}.{}", vector(depth - 1), pick({"x", "y", "z"}));
        default:
            return fmt::format("mix({}, {}, {})", n(), n(), n());
        }
    }
    std::string vector(int depth) {
        switch (depth == 0 ? 0 : below(5)) {
        case 0:
            return fmt::format("({}, {}, {})", number(0), number(0), number(0));
        case 1:
            return fmt::format("cross({}, {})", vector(depth - 1), vector(depth - 1));
        case 2:
            return fmt::format("normalize({})", vector(depth - 1));
        case 3:
            return fmt::format("({} * {})", vector(depth - 1), number(depth - 1));
        default:
            return fmt::format("[{}, (1, 2, 3)][floor(abs({})) % 2]", vector(0), number(depth - 1));
        }
    }
    std::string truth(int depth) {
        if (depth > 0 && below(3) == 0) {
            return fmt::format("({} {} {})", truth(depth - 1), pick({"and", "or"}), truth(depth - 1));
        }
        return fmt::format("({} {} {})", number(depth), pick({"<", "<=", ">", ">=", "==", "!="}),
                           number(depth));
    }
    std::string pick(std::initializer_list<const char*> from) { return *(from.begin() + below(from.size())); }
    std::size_t below(std::size_t n) { return random_() % n; }

private:
    std::mt19937 random_;
};

TEST(Loop, ComputesTheSameBitsAsRoundByRound) {
    std::size_t recorded = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
        Expressions e(seed);
        const std::string body =
            fmt::format("let j = {}\nball {{ center = {}, radius = {}, material = paint {{ gloss = "
                        "{}, tone = rgb({}, 0.5, j) }} }}\nwall {{ normal = {} }}",
                        e.number(0) == "j" ? "3" : "floor(i / 3)", e.vector(2), e.number(3), e.number(2),
                        e.number(1), e.vector(1));
        const std::string text = fmt::format("let k = 3\nfn twice(a: number, b: number) = a * 2 + b\n"
                                             "for (i in -40..260) {{\n{}\n}}",
                                             body);
        const Scene slow(text, {}, round_by_round);
        const Scene fast(text, {}, all_at_once);
        ASSERT_EQ(outcome(fast), outcome(slow)) << text;
        recorded += in_rows(fast) > 0 ? 1 : 0;
    }
    EXPECT_GT(recorded, 100U);
}

TEST(Loop, KnowsRandomNumbersAndNoise) {
    using test::value_of;
    EXPECT_EQ(value_of("[random(0), random(1), random(1, 2), random(1, 2, 3)]"),
              "[0.5026230818294767, 0.17943657272475655, 0.9438732680757902, 0.8551758355031345]");
    EXPECT_EQ(value_of("random(-1 * 0, 5) == random(0, 5)"), "true");
    EXPECT_EQ(value_of("[noise(0.5), noise((0.5, 3)), noise((-7.25, 0.5, 1e6))]"),
              "[0.21351787634193897, 0.8646634875331074, 0.1529474751032467]");
    EXPECT_EQ(value_of("noise((4, 5, 6)) == noise((4, 5, 6.01))"), "false");
}

} // namespace
} // namespace scc::lang
