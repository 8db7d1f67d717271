#include "lang/parser.h"
#include "lang/test/front.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace scc::lang {
namespace {

using test::Front;

constexpr const char* scenes[] = {"lecture", "mesh_and_textures", "many_spheres", "csg_and_implicit"};

std::string scene(const std::string& name) {
    std::ifstream in(SCC_SOURCE_DIR "/lang/test/scenes/" + name + ".scn", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A dump on one line: `binary +` with two children becomes `+(a b)`.
std::string flat(std::string_view dump) {
    std::string out;
    std::size_t depth = 0;
    while (!dump.empty()) {
        const std::size_t end = dump.find('\n');
        std::string_view line = dump.substr(0, end);
        dump.remove_prefix(end + 1);
        const std::size_t indent = line.find_first_not_of(' ');
        const std::size_t level = indent / 2;
        line.remove_prefix(indent);
        for (const std::string_view word : {"binary ", "unary ", "number ", "name "}) {
            line.remove_prefix(line.starts_with(word) ? word.size() : 0);
        }
        if (level > depth) {
            out += '(';
        } else if (!out.empty()) {
            out += std::string(depth - level, ')') + ' ';
        }
        out += line;
        depth = level;
    }
    return out + std::string(depth, ')');
}

std::string tree(std::string_view text) {
    Front front(text);
    const std::string dump = dump_ast(*front.parse());
    EXPECT_EQ(front.messages(), "");
    return flat(dump);
}

std::string expression(std::string_view text) {
    Front front(text);
    const ast::ExprPtr parsed = parse_expression(front.sources, front.file, front.diagnostics);
    EXPECT_EQ(front.messages(), "");
    return flat(dump_ast(*parsed));
}

std::string summary(std::string_view text) {
    Front front(text);
    front.parse();
    return front.summary();
}

std::string messages(std::string_view text) {
    Front front(text);
    front.parse();
    return front.messages();
}

std::string repeat(std::string_view text, std::size_t times) {
    std::string out;
    for (std::size_t i = 0; i < times; ++i) {
        out += text;
    }
    return out;
}

TEST(ParseExpression, OperatorsBindAsTheGrammarSays) {
    EXPECT_EQ(expression("a + b * c - d"), "-(+(a *(b c)) d)");
    EXPECT_EQ(expression("a or b and c == d"), "or(a and(b ==(c d)))");
    EXPECT_EQ(expression("0..n - 1 == r"), "==(..(0 -(n 1)) r)");
    EXPECT_EQ(expression("scale(s) then t or u"), "then(call(scale argument(s)) or(t u))");
    EXPECT_EQ(expression("a then b then c"), "then(then(a b) c)");
    EXPECT_EQ(expression("a / b % c"), "%(/(a b) c)");
}

TEST(ParseExpression, PowerBindsTighterThanSignAndToTheRight) {
    EXPECT_EQ(expression("-a ^ 2"), "-(^(a 2))");
    EXPECT_EQ(expression("2 ^ -b ^ c"), "^(2 -(^(b c)))");
    EXPECT_EQ(expression("2 * -3"), "*(2 -(3))");
    EXPECT_EQ(expression("not not a and b"), "and(not(not(a)) b)");
}

TEST(ParseExpression, PostfixFormsChain) {
    EXPECT_EQ(expression("s.p.x"), "member x(member p(s))");
    EXPECT_EQ(expression("palette[i % 5].r"), "member r(index(palette %(i 5)))");
    EXPECT_EQ(expression("f(1)(a = 2, 3)[4]"),
              "index(call(call(f argument(1)) argument a(2) argument(3)) 4)");
    EXPECT_EQ(expression("f()"), "call(f)");
}

TEST(ParseExpression, LiteralsKeepTheirValues) {
    EXPECT_EQ(expression("40deg"), "40deg");
    EXPECT_EQ(expression("1e-3"), "0.001");
    EXPECT_EQ(expression("#c83232"), "color #c83232");
    EXPECT_EQ(expression(R"("a\"b")"), R"(string "a\"b")");
    EXPECT_EQ(expression("[true, false]"), "list(true false)");
}

TEST(ParseExpression, ParenthesesGroupOrMakeVectors) {
    EXPECT_EQ(expression("(a + b) * c"), "*(+(a b) c)");
    EXPECT_EQ(expression("(1, 2)"), "tuple(1 2)");
    EXPECT_EQ(expression("(1, 2, 3)"), "tuple(1 2 3)");
    EXPECT_EQ(expression("((1))"), "1");
}

TEST(ParseExpression, SpanOfAGroupHasItsParentheses) {
    Front front("0.02 * (a - b)");
    const ast::ExprPtr parsed = parse_expression(front.sources, front.file, front.diagnostics);
    EXPECT_EQ(front.sources.text(parsed->span), "0.02 * (a - b)");
    const auto& product = std::get<ast::Binary>(parsed->node);
    EXPECT_EQ(front.sources.text(product.right->span), "(a - b)");
    EXPECT_EQ(front.sources.text(product.op_span), "*");
}

TEST(ParseExpression, ListsAndComprehensions) {
    EXPECT_EQ(expression("[]"), "list");
    EXPECT_EQ(expression("[1, [2]]"), "list(1 list(2))");
    EXPECT_EQ(expression("[for (i in 0..3) i * 2]"), "comprehension i(..(0 3) *(i 2))");
}

TEST(ParseExpression, ConditionalsAndLambdasReachAsFarAsTheyCan) {
    EXPECT_EQ(expression("if (a) b else if (c) d else e + f"), "if(a b if(c d +(e f)))");
    EXPECT_EQ(expression("fn(s: surface, k: number = 2) = s.n * k"),
              "lambda(formal s: surface formal k: number(2) *(member n(s) k))");
}

TEST(ParseExpression, NameWithABodyIsAConstructor) {
    EXPECT_EQ(expression("ray { depth = 4 }"), "construct ray(field depth(4))");
    EXPECT_EQ(expression("ray { }"), "construct ray");
}

TEST(ParseExpression, TextAfterTheExpressionIsAMistake) {
    for (const char* text : {"1 2", "1)", "a = 3", "", "1 +"}) {
        Front front(text);
        parse_expression(front.sources, front.file, front.diagnostics);
        EXPECT_EQ(front.diagnostics.error_count(), 1u) << text;
    }
}

TEST(ParseItems, EveryKind) {
    EXPECT_EQ(tree("language 1\nsphere {}"), "language 1 child(construct sphere)");
    EXPECT_EQ(tree("import \"a.scn\" as a with { n = 3 }"), "import as a(string \"a.scn\" with(field n(3)))");
    EXPECT_EQ(tree("param n: number = 3 in 0..9 \"how many\""),
              "param n: number(default(3) in(..(0 9)) text \"how many\")");
    EXPECT_EQ(tree("let a: [vec3] = b"), "let a: [vec3](b)");
    EXPECT_EQ(tree("fn f(g: fn(number, vec2) -> color) = g"),
              "fn f(formal g: fn(number, vec2) -> color result(g))");
    EXPECT_EQ(tree("fn f(x: number) -> number { let a = x; a }"),
              "fn f -> number(formal x: number let a(x) result(a))");
    EXPECT_EQ(tree("for (i in 0..3) { ball }"), "for i(in(..(0 3)) do(child(ball)))");
    EXPECT_EQ(tree("fn(x: number) = x"), "child(lambda(formal x: number x))");
}

TEST(ParseItems, ConditionsHoldBodiesOrExpressions) {
    EXPECT_EQ(tree("if (a) { b } else if (c) { d } else { e }"),
              "if(condition(a) then(child(b)) else(if(condition(c) then(child(d)) else(block(child(e))))))");
    EXPECT_EQ(tree("if (a) b else c"), "child(if(a b c))");
}

TEST(ParseItems, FieldsStandInThingsAlsoUnderConditions) {
    EXPECT_EQ(tree("g { if (a) { x = 1 } else { x = 2 } }"),
              "child(construct g(if(condition(a) then(field x(1)) else(block(field x(2))))))");
    EXPECT_EQ(summary("if (a) { x = 1 }"), "1 field-outside\n");
}

TEST(ParseItems, SeparatorsAreLineEndsCommasAndSemicolons) {
    EXPECT_EQ(tree("a\nb, c; d\n\n\ne,\nf"), "child(a) child(b) child(c) child(d) child(e) child(f)");
    EXPECT_EQ(tree("g { a = 1, b = 2; c\n}"), "child(construct g(field a(1) field b(2) child(c)))");
    EXPECT_EQ(tree("\n\n"), "");
}

TEST(ParseItems, LinesEndItems) {
    EXPECT_EQ(tree("let a = b\n- c"), "let a(b) child(-(c))");
    EXPECT_EQ(tree("let a = b\n(c)"), "let a(b) child(c)");
    EXPECT_EQ(tree("a\n[b]"), "child(a) child(list(b))");
}

TEST(ParseItems, LinesThatEndOpenGoOn) {
    EXPECT_EQ(tree("let a =\n  b +\n  c *\n  -\n  d"), "let a(+(b *(c -(d))))");
    EXPECT_EQ(tree("let a = b then\n c"), "let a(then(b c))");
    EXPECT_EQ(tree("fn f() ->\n number = 1"), "fn f -> number(result(1))");
    EXPECT_EQ(tree("let a = f(\n b,\n c\n)"), "let a(call(f argument(b) argument(c)))");
}

TEST(ParseItems, LinesThatBeginWithConnectivesGoOn) {
    EXPECT_EQ(tree("let t = a\n  then b\n  then c"), "let t(then(then(a b) c))");
    EXPECT_EQ(tree("let t = a\n  or b\n  and c"), "let t(or(a and(b c)))");
    EXPECT_EQ(tree("let t = if (a) b\n  else c"), "let t(if(a b c))");
    EXPECT_EQ(tree("if (a) {}\nelse {}"), "if(condition(a) then else(block))");
}

TEST(ParseItems, LinesAreBlanksInParenthesesButNotInBracesWithin) {
    EXPECT_EQ(tree("let a = (b\n+ c)"), "let a(+(b c))");
    EXPECT_EQ(tree("let a = [b\n, c\n]"), "let a(list(b c))");
    EXPECT_EQ(tree("f(g { a = b\n-c })"), "child(call(f argument(construct g(field a(b) child(-(c))))))");
}

TEST(ParseScenes, SamplesHaveNoMistakes) {
    for (const char* name : scenes) {
        const std::string text = scene(name);
        ASSERT_FALSE(text.empty()) << name;
        Front front(text);
        front.parse();
        EXPECT_EQ(front.messages(), "") << name;
    }
}

TEST(ParseScenes, SampleGivesTheTreeItShows) {
    const std::string dump = tree(scene("many_spheres"));
    EXPECT_NE(dump.find("fn place -> vec3(formal i: number let a(*(i 137.50776deg)) let r(*(0.03 call(sqrt "
                        "argument(i)))) "
                        "result(tuple(*(r call(cos argument(a)))"),
              std::string::npos)
        << dump;
    EXPECT_NE(dump.find("for i(in(..(0 n)) do(child(construct sphere(field center(call(place argument(i)))"),
              std::string::npos)
        << dump;
}

// ---- mistakes -------------------------------------------------------------------------------------------

struct Mistake {
    const char* text;
    const char* expected; ///< line and name of each diagnostic
};

const Mistake mistakes[] = {
    {"a @", "1 unexpected-character\n"},
    {"let a = \"b", "1 unterminated-string\n"},
    {"a /* b", "1 unterminated-comment\n"},
    {"let a = \"\\q\"", "1 bad-escape\n"},
    {"let a = .5", "1 bad-number\n"},
    {"let a = 3furlong", "1 unknown-unit\n"},
    {"let a = #ff", "1 bad-hex-color\n"},
    {"let a = 1e999", "1 number-out-of-range\n"},
    {"let a = \"\xff\"", "1 bad-utf8\n"},
    {"let a = )", "1 unopened-bracket\n"},
    {"let a =\nlet b = 1", "1 unexpected-token\n"},
    {"let a = b +\n\nlet c = 1", "1 unexpected-token\n"},
    {"g { a =\n b = 2 }", "1 unexpected-token\n"},
    {"let 3 = a\nb", "1 unexpected-token\n"},
    {"let a 3\nb", "1 unexpected-token\n"},
    {"param a = 3\nb", "1 unexpected-token\n"},
    {"import a as b", "1 unexpected-token\n"},
    {"for i in 0..3 {\n  a\n  b\n}", "1 unexpected-token\n"},
    {"if a == 3 {\n  b\n}", "1 unexpected-token\n"},
    {"let a = f(1,)", "1 unexpected-token\n"},
    {"let a = [1 2 3]", "1 unexpected-token\n"},
    {"let a = ()", "1 unexpected-token\n"},
    {"g { , a = 1 }", "1 unexpected-token\n"},
    {"a,, b", "1 unexpected-token\n"},
    {"a.\nb", "1 unexpected-token\n"},
    {"let f: fn number = a", "1 unexpected-token\n"},
    {"sphere {} sphere {}", "1 missing-separator\n"},
    {"a b c d", "1 missing-separator\n"},
    {"let a = 1 let b = 2", "1 missing-separator\n"},
    {"g { a = 1 b = 2 }", "1 missing-separator\n"},
    {"let a = 40 deg", "1 unit-apart\n"},
    {"let in = 3", "1 reserved-word\n"},
    {"g { with = 3 }", "1 reserved-word\n"},
    {"g { a: 3 }", "1 field-assignment\n"},
    {"g { a == 3 }", "1 field-assignment\n"},
    {"a = 3", "1 field-outside\n"},
    {"sphere\n{\n a = 1\n}", "2 brace-on-new-line\n"},
    {"if (a)\n{}\nelse\n{}", "2 brace-on-new-line\n"},
    {"let a = b < c < d < e", "1 chained-operator\n"},
    {"let a = 0..1..2", "1 chained-operator\n"},
    {"let a = (1, 2, 3, 4)", "1 vector-size\n"},
    {"fn f() { let a = 1 }", "1 missing-result\n"},
    {"fn f() {\n 1\n 2\n 3\n}", "3 after-result\n"},
    {"a\nelse { b }", "2 else-without-if\n"},
    {"a\nlanguage 1", "2 language-not-first\n"},
    {"language 2", "1 unknown-language\n"},
    {"language one", "1 unexpected-token\n"},
    {"g {\n  a = (1\n  b = 2\n}\nc", "2 unclosed-bracket\n"},
    {"g {\n a = [1, 2\n b = f(3)", "2 unclosed-bracket\n"},
    {"g { h { i {", "1 unclosed-bracket\n"},
    {"g { a = (1, 2, b = 3 }", "1 unclosed-bracket\n"},
    {"a\n}\nb", "2 unopened-bracket\n"},
    {"let a = (1, 2]\nb", "1 wrong-bracket\n"},
};

TEST(ParserMistakes, EachIsOneMessage) {
    for (const Mistake& mistake : mistakes) {
        EXPECT_EQ(summary(mistake.text), mistake.expected) << mistake.text;
    }
}

TEST(ParserMistakes, NextItemIsReadAgain) {
    EXPECT_EQ(summary("let a = = 3\nlet b = * 4, let c = / 5\nbox {\n x = ^ 6\n y = % 7 }"),
              "1 unexpected-token\n2 unexpected-token\n2 unexpected-token\n4 unexpected-token\n5 "
              "unexpected-token\n");
    EXPECT_EQ(summary("let a = [(1, 2),\n (3 4),\n (5 6)]\nlet b = 7 8"),
              "2 unexpected-token\n3 unexpected-token\n4 missing-separator\n");
}

TEST(ParserMistakes, WhatIsKnownStaysInTheTree) {
    Front front("let a = (1 2)\nx = 3\nsphere { radius: 2 }\nlet b = 4 deg");
    EXPECT_EQ(flat(dump_ast(*front.parse())),
              "let a(error) let x(3) child(construct sphere(field radius(2))) let b(4deg)");
    EXPECT_EQ(front.diagnostics.error_count(), 4u);
}

TEST(ParserMistakes, MessagesPointAtTheNarrowestPlace) {
    EXPECT_EQ(messages("let a = f(1 2)\n"),
              "a.scn:1:13: error: found `2` where `,` or `)` is expected [unexpected-token]\n"
              "    1 | let a = f(1 2)\n"
              "      |             ^\n");
    EXPECT_EQ(
        messages("let a =   // nothing\nlet b = 1\n"),
        "a.scn:1:8: error: found the end of the line where an expression is expected [unexpected-token]\n"
        "    1 | let a =   // nothing\n"
        "      |        ^\n");
    EXPECT_EQ(messages("let a = (1, 2]"),
              "a.scn:1:14: error: found `]` where `)` is expected [wrong-bracket]\n"
              "    1 | let a = (1, 2]\n"
              "      |              ^\n"
              "      |              )\n"
              "a.scn:1:9: note: it was opened here\n");
}

TEST(ParserMistakes, FixesMendTheText) {
    const std::pair<const char*, const char*> cases[] = {{"a {} b {}", "a {}, b {}"},
                                                         {"g { a: 3 }", "g { a = 3 }"},
                                                         {"g { a == 3 }", "g { a = 3 }"},
                                                         {"a = 3", "let a = 3"},
                                                         {"a\n{ }", "a { }"},
                                                         {"let a = 40 deg", "let a = 40deg"},
                                                         {"let a = (1, 2]", "let a = (1, 2)"},
                                                         {"let a = \"b", "let a = \"b\""}};
    for (const auto& [text, mended] : cases) {
        Front front(text);
        front.parse();
        const std::vector<Diagnostic> found = front.diagnostics.sorted();
        ASSERT_EQ(found.size(), 1u) << text;
        ASSERT_TRUE(found[0].fix.has_value()) << text;
        const Fix& fix = *found[0].fix;
        EXPECT_EQ(std::string(text).replace(fix.span.begin, fix.span.end - fix.span.begin, fix.replacement),
                  mended);
        EXPECT_EQ(summary(mended), "");
    }
}

TEST(ParserMistakes, FixKeepsCommentsBeforeAMisplacedBrace) {
    Front front("sphere // round\n{ }");
    front.parse();
    EXPECT_EQ(front.summary(), "2 brace-on-new-line\n");
    EXPECT_FALSE(front.diagnostics.sorted()[0].fix.has_value());
}

TEST(ParserMistakes, DeepNestingIsOneMessage) {
    constexpr std::size_t many = 100000;
    const std::string cases[] = {
        repeat("(", many) + repeat(")", many),
        repeat("(", many),
        "let a = " + repeat("[", many) + repeat("]", many),
        repeat("a(", many) + repeat(")", many),
        repeat("g { ", many) + repeat("}", many),
        repeat("g {\n", many),
        repeat("g {\n", many) + repeat("}\n", many),
        repeat("for (i in r) { ", many) + repeat("}", many),
        "let a = " + repeat("-", many) + "1",
        "let a = " + repeat("not ", many) + "b",
        "let a = " + repeat("b ^ ", many) + "c",
        "let a = " + repeat("if (b) c else ", many) + "d",
        "let a = " + repeat("fn(b: c) = ", many) + "d",
        "let a: " + repeat("[", many) + "b" + repeat("]", many) + " = c",
        "let a: " + repeat("fn(b) -> ", many) + "b = c",
        "if (a) {}" + repeat(" else if (b) {}", many),
        "let a = " + repeat("[for (i in ", many) + "b" + repeat(") c]", many),
    };
    for (const std::string& text : cases) {
        const std::string found = summary(text);
        EXPECT_EQ(found.substr(std::min(found.size(), found.find(' '))), " nesting-too-deep\n")
            << text.substr(0, 20);
    }
}

TEST(ParserMistakes, LongChainsAreOneMessage) {
    constexpr std::size_t many = 100000;
    for (const char* link : {" + a", " then a", " and a", ".a", "()", "[0]"}) {
        EXPECT_EQ(summary("let a = a" + repeat(link, many)), "1 chain-too-long\n") << link;
    }
}

TEST(Parser, ChainsAndNestingUpToTheLimitsAreRead) {
    EXPECT_EQ(summary("let a = a" + repeat(" + a * a.x", max_chain - 8)), "");
    EXPECT_EQ(summary("let a = " + repeat("(", max_nesting - 1) + "1" + repeat(")", max_nesting - 1)), "");
    EXPECT_EQ(summary(repeat("g { ", max_nesting - 1) + repeat("}", max_nesting - 1)), "");
    EXPECT_EQ(summary("let a = " + repeat("(", max_nesting) + "1" + repeat(")", max_nesting)),
              "1 nesting-too-deep\n");
}

/// Heights add up: the tree of a chain inside the first operand of a chain is as high as both together.
TEST(Parser, NestedChainsShareOneLimit) {
    std::string text = "a";
    for (int i = 0; i < 15; ++i) {
        text = "(" + text + ")" + repeat(" + a", 50);
    }
    EXPECT_EQ(summary("let a = " + text), "1 chain-too-long\n");
}

TEST(Parser, EveryLexerAndParserDiagnosticIsTested) {
    std::string seen;
    for (const Mistake& mistake : mistakes) {
        seen += summary(mistake.text);
    }
    seen += summary(repeat("(", 1000)) + summary("let a = a" + repeat("+ a", 1000));
    const auto first = static_cast<std::size_t>(Diag::unexpected_character);
    const auto last = static_cast<std::size_t>(Diag::chain_too_long);
    for (std::size_t i = first; i <= last; ++i) {
        const std::string name(diagnostic_rows()[i].name);
        EXPECT_NE(seen.find(' ' + name + '\n'), std::string::npos) << name;
    }
}

TEST(Parser, DamagedScenesNeitherCrashNorPassSilently) {
    std::uint32_t state = 1;
    const auto random = [&state](std::size_t below) {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) % below;
    };
    for (const char* name : scenes) {
        const std::string text = scene(name);
        for (int round = 0; round < 300; ++round) {
            std::string damaged = text;
            for (std::size_t edits = random(4) + 1; edits > 0; --edits) {
                const std::size_t place = random(damaged.size());
                if (random(2) == 0) {
                    damaged.erase(place, random(10) + 1);
                } else {
                    damaged.insert(place, 1, "(){}[]=,\"\n;:.+-x0"[random(17)]);
                }
            }
            Front front(damaged);
            const std::string dump = '\n' + dump_ast(*front.parse());
            const bool has_holes = dump.find(" error\n") != std::string::npos;
            EXPECT_TRUE(!has_holes || front.diagnostics.has_errors()) << damaged;
            front.messages();
        }
    }
}

} // namespace
} // namespace scc::lang
