#include "lang/format.h"
#include "lang/test/front.h"
#include "lang/test/program_generator.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace scc::lang {
namespace {

using test::Front;

std::string formatted(std::string_view text) {
    Front front(text);
    const std::vector<Token> tokens = front.lex();
    const ast::File tree = parse(front.sources, front.file, tokens, front.diagnostics);
    EXPECT_EQ(front.messages(), "");
    return format(front.sources, tokens, tree);
}

std::string tree_of(std::string_view text) {
    Front front(text);
    const std::string tree = dump_ast(*front.parse());
    return tree + front.messages();
}

std::vector<std::string> comments_of(std::string_view text) {
    Front front(text);
    std::vector<std::string> comments;
    std::size_t at = 0;
    for (const Token& token : front.lex()) {
        while (true) {
            at = text.find('/', at);
            if (at >= token.span.begin || at == std::string_view::npos) {
                break;
            }
            const bool is_line = text[at + 1] == '/';
            const std::size_t end =
                is_line ? std::min(text.find('\n', at), text.size()) : text.find("*/", at + 2) + 2;
            std::string comment;
            for (const char c : text.substr(at, end - at)) {
                if (c != '\r' && c != ' ') {
                    comment += c;
                }
            }
            comments.push_back(comment);
            at = end;
        }
        at = token.span.end;
    }
    return comments;
}

void expect_same_scene(const std::string& text) {
    const std::string once = formatted(text);
    ASSERT_EQ(tree_of(once), tree_of(text)) << text << "\n---\n" << once;
    ASSERT_EQ(comments_of(once), comments_of(text)) << text << "\n---\n" << once;
    ASSERT_EQ(formatted(once), once) << text;
    ASSERT_EQ(once.find(" \n"), std::string::npos) << once;
    ASSERT_EQ(once.find("\n\n\n"), std::string::npos) << once;
}

TEST(Format, SpacesTokens) {
    EXPECT_EQ(formatted("let  a=- 1+b*(c-d) ^2"), "let a = -1 + b * (c - d) ^ 2\n");
    EXPECT_EQ(formatted("for(i in 0 .. n-1){a}"), "for (i in 0..n - 1) { a }\n");
    EXPECT_EQ(formatted("let a = f ( 1 ,2 ) [ 0 ] . x"), "let a = f(1, 2)[0].x\n");
    EXPECT_EQ(formatted("fn f(x:number=1,g:fn ( number )->[ vec3 ])->color=if(x>0)(1,2)else -x"),
              "fn f(x: number = 1, g: fn(number) -> [vec3]) -> color = if (x > 0) (1, 2) else -x\n");
    EXPECT_EQ(formatted("let a = b - -c, let d = not-e"), "let a = b - -c\nlet d = not -e\n");
    EXPECT_EQ(formatted("sphere{}"), "sphere { }\n");
    EXPECT_EQ(formatted("param n:number=1 in 0 .. 5 \"how many\""),
              "param n: number = 1 in 0..5 \"how many\"\n");
    EXPECT_EQ(formatted("let a = map([1],fn (x:number)=x)"), "let a = map([1], fn(x: number) = x)\n");
    EXPECT_EQ(formatted("language  1;a"), "language 1\na\n");
    EXPECT_EQ(formatted("let a = if (b) - 1 else (fn (x: number) = x) (2)"),
              "let a = if (b) -1 else (fn(x: number) = x)(2)\n");
}

TEST(Format, KeepsShortBodiesOnTheirLine) {
    EXPECT_EQ(formatted("a{b=1;c=2}"), "a { b = 1, c = 2 }\n");
    EXPECT_EQ(formatted("a{b=1\nc=2}"), "a {\n  b = 1\n  c = 2\n}\n");
    EXPECT_EQ(formatted("a { b = c { d = 1,\n e = 2 }, f = 3 }"),
              "a {\n  b = c {\n    d = 1\n    e = 2\n  }\n  f = 3\n}\n");
    EXPECT_EQ(formatted("fn f(x: number) { let y = x, y }"), "fn f(x: number) { let y = x, y }\n");
    EXPECT_EQ(formatted("fn f(x: number) { let y = x\ny }"), "fn f(x: number) {\n  let y = x\n  y\n}\n");
}

TEST(Format, GivesEachItemOfALongBodyALine) {
    const std::string first(40, 'a');
    const std::string second(44, 'b');
    EXPECT_EQ(formatted("g { " + first + ", " + second + " }"), "g { " + first + ", " + second + " }\n");
    const std::string wide = second + "bbbbb";
    EXPECT_EQ(formatted("ggg { " + first + ", " + wide + " }"), "ggg { " + first + ", " + wide + " }\n");
    EXPECT_EQ(formatted("ggggg { " + first + "_, " + wide + " }"),
              "ggggg {\n  " + first + "_\n  " + wide + "\n}\n");
}

TEST(Format, BreaksLongItems) {
    const std::string a(30, 'a');
    EXPECT_EQ(formatted("let value_of_something_long = " + a + " + " + a + " * " + a),
              "let value_of_something_long =\n  " + a + " + " + a + " * " + a + "\n");
    EXPECT_EQ(formatted("let t = " + a + " then " + a + " then " + a + " then " + a),
              "let t = " + a + "\n  then " + a + "\n  then " + a + "\n  then " + a + "\n");
    EXPECT_EQ(formatted("let l = [" + a + ", " + a + ", " + a + ", " + a + "]"),
              "let l = [\n  " + a + ",\n  " + a + ",\n  " + a + ",\n  " + a + "\n]\n");
    EXPECT_EQ(formatted("if (" + a + ") { " + a + " } else { " + a + ", " + a + " }"),
              "if (" + a + ") {\n  " + a + "\n} else {\n  " + a + "\n  " + a + "\n}\n");
}

TEST(Format, KeepsTheLinesOfAnItem) {
    EXPECT_EQ(formatted("let m = matrix([1, 0,\n       0, 1])"),
              "let m = matrix([1, 0,\n                0, 1])\n");
    EXPECT_EQ(formatted("let m = [\n1,\n\n\n2\n]"), "let m = [\n  1,\n  2\n]\n");
    EXPECT_EQ(formatted("fn f(x: number) =\n      x +\n  1"), "fn f(x: number) =\n  x +\n  1\n");
    EXPECT_EQ(formatted("if (a) {\nb\n}\nelse {\nc\n}"), "if (a) {\n  b\n} else {\n  c\n}\n");
    EXPECT_EQ(formatted("let a = b\nthen c"), "let a = b\n  then c\n");
}

TEST(Format, KeepsOneEmptyLineBetweenItems) {
    EXPECT_EQ(formatted("\n\na\n\n\n\nb\nc {\n\n  d\n\n\n  e\n\n}\n\n"), "a\n\nb\nc {\n  d\n\n  e\n}\n");
    EXPECT_EQ(formatted(""), "");
    EXPECT_EQ(formatted("\xEF\xBB\xBF \r\n a,\r\n\r\n b"), "a\n\nb\n");
}

TEST(Format, KeepsCommentsInTheirPlaces) {
    EXPECT_EQ(formatted("// head\n\n\n//  second  \na // of a\n// before b\nb\n\n// end"),
              "// head\n\n//  second\na  // of a\n// before b\nb\n\n// end\n");
    EXPECT_EQ(formatted("g { // opens\n a = 1, // one\n b = 2 // two\n // last\n}"),
              "g {  // opens\n  a = 1  // one\n  b = 2  // two\n  // last\n}\n");
    EXPECT_EQ(formatted("g { /* a */ a = 1 /* b */, /* c */ b = 2 }"),
              "g { /* a */ a = 1 /* b */, /* c */ b = 2 }\n");
    EXPECT_EQ(formatted("let a = // why\n  3"), "let a =  // why\n  3\n");
    EXPECT_EQ(formatted("let a = [ // first\n 1, // one\n // two\n 2]"),
              "let a = [  // first\n  1,  // one\n  // two\n  2]\n");
    EXPECT_EQ(formatted("/* a\n   b */ c"), "/* a\n   b */ c\n");
    EXPECT_EQ(formatted("// only"), "// only\n");
    EXPECT_EQ(formatted("g { // only\n}"), "g {  // only\n}\n");
    EXPECT_EQ(formatted("if (a) { b } // c\nelse { d }"), "if (a) { b }  // c\n  else { d }\n");
}

TEST(Format, IsStableOnEverySceneOfTheProject) {
    int scenes = 0;
    for (const char* folder : {"examples", "lang", "compiler", "validation"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::filesystem::path(SCC_SOURCE_DIR) / folder)) {
            if (entry.path().extension() != ".scn") {
                continue;
            }
            std::ifstream in(entry.path(), std::ios::binary);
            const std::string text{std::istreambuf_iterator<char>(in), {}};
            if (tree_of(text).find("error:") != std::string::npos) {
                continue;
            }
            SCOPED_TRACE(entry.path());
            expect_same_scene(text);
            ++scenes;
            if (std::string_view(folder) == "examples") {
                EXPECT_EQ(formatted(text), text);
            }
        }
    }
    EXPECT_GE(scenes, 12);
}

TEST(Format, KeepsTheTreeAndIsStableOnRandomPrograms) {
    int parsed = 0;
    for (std::uint32_t seed = 1; seed <= 1000; ++seed) {
        const std::string text = test::ProgramGenerator(seed).file();
        if (tree_of(text).find("error:") != std::string::npos) {
            continue;
        }
        ++parsed;
        SCOPED_TRACE(seed);
        expect_same_scene(text);
        if (HasFatalFailure()) {
            return;
        }
    }
    EXPECT_GT(parsed, 900);
}

} // namespace
} // namespace scc::lang
