#include "lang/test/front.h"

#include <gtest/gtest.h>

namespace scc::lang {
namespace {

using test::Front;
using namespace std::string_literals;

/// The spellings of the tokens with one blank between, for text that has no mistakes.
std::string split(std::string_view text) {
    Front front(text);
    std::string out;
    for (const Token& token : front.lex()) {
        out += front.sources.text(token.span);
        out += ' ';
    }
    EXPECT_EQ(front.messages(), "");
    return out;
}

/// The only token besides the end of the file.
Token only(Front& front) {
    const std::vector<Token> tokens = front.lex();
    EXPECT_EQ(tokens.size(), 2u);
    return tokens[0];
}

std::string string_of(std::string_view text) {
    Front front(text);
    const Token token = only(front);
    EXPECT_EQ(token.kind, TokenKind::string);
    EXPECT_EQ(front.messages(), "");
    return string_value(front.sources.text(token.span));
}

std::string lexer_summary(std::string_view text) {
    Front front(text);
    front.lex();
    return front.summary();
}

double number_of(std::string_view text) {
    Front front(text);
    const Token token = only(front);
    EXPECT_EQ(token.kind, TokenKind::number);
    EXPECT_EQ(front.messages(), "");
    return token.number;
}

TEST(Lexer, EmptyFileIsItsEnd) {
    Front front("");
    const std::vector<Token> tokens = front.lex();
    ASSERT_EQ(tokens.size(), 1u);
    EXPECT_EQ(tokens[0].kind, TokenKind::end_of_file);
}

TEST(Lexer, EverySpellingOfTheTableIsItsOwnKind) {
    for (auto i = static_cast<std::size_t>(TokenKind::kw_language);
         i <= static_cast<std::size_t>(TokenKind::caret); ++i) {
        const auto kind = static_cast<TokenKind>(i);
        Front front(spelling(kind));
        EXPECT_EQ(only(front).kind, kind) << spelling(kind);
    }
}

TEST(Lexer, SeventeenWordsAreReserved) {
    EXPECT_EQ(static_cast<int>(TokenKind::kw_false) - static_cast<int>(TokenKind::kw_language) + 1, 17);
}

TEST(Lexer, WordsThatOnlyBeginLikeReservedOnesAreNames) {
    for (const char* word : {"lets", "le", "inn", "forest", "Let", "_in", "true1", "languages", "o", "a"}) {
        Front front(word);
        EXPECT_EQ(only(front).kind, TokenKind::name) << word;
    }
}

TEST(Lexer, RangeIsTwoNumbersAndTwoDots) {
    EXPECT_EQ(split("100..200"), "100 .. 200  ");
    EXPECT_EQ(split("0.5..1.5"), "0.5 .. 1.5  ");
    EXPECT_EQ(split("0..n"), "0 .. n  ");
}

TEST(Lexer, MembersAreSeparateTokens) {
    EXPECT_EQ(split("s.p.x2"), "s . p . x2  ");
}

TEST(Lexer, LongestOperatorWins) {
    EXPECT_EQ(split("a<=b<c==d=e!=f->g-h>=i"), "a <= b < c == d = e != f -> g - h >= i  ");
}

TEST(Lexer, NumbersHaveFractionsAndExponents) {
    EXPECT_EQ(number_of("100"), 100);
    EXPECT_EQ(number_of("1e-3"), 1e-3);
    EXPECT_EQ(number_of("2.5E+2"), 250);
    EXPECT_EQ(number_of("137.50776"), 137.50776);
    EXPECT_EQ(number_of("0.1"), 0.1);
    EXPECT_EQ(number_of("123456789012345678901234567890"), 123456789012345678901234567890.0);
}

TEST(Lexer, UnitsBelongToTheirNumber) {
    const std::pair<const char*, ast::Unit> cases[] = {{"40deg", ast::Unit::deg},  {"0.5rad", ast::Unit::rad},
                                                       {"3mm", ast::Unit::mm},     {"3cm", ast::Unit::cm},
                                                       {"3m", ast::Unit::m},       {"3km", ast::Unit::km},
                                                       {"3inch", ast::Unit::inch}, {"1e2m", ast::Unit::m}};
    for (const auto& [text, unit] : cases) {
        Front front(text);
        const Token token = only(front);
        EXPECT_EQ(token.unit, unit) << text;
        EXPECT_EQ(front.sources.text(token.span), text);
    }
}

TEST(Lexer, UnknownUnitsNameTheLikelyOne) {
    Front front("40degrees");
    front.lex();
    EXPECT_EQ(front.messages(),
              "a.scn:1:3: error: `degrees` is not a unit; did you mean `deg`? [unknown-unit]\n"
              "    1 | 40degrees\n"
              "      |   ^~~~~~~\n"
              "      |   deg\n");
    EXPECT_EQ(lexer_summary("40\xC2\xB0 1e 0x10 3parsec"),
              "1 unknown-unit\n1 unknown-unit\n1 unknown-unit\n1 unknown-unit\n");
}

TEST(Lexer, MalformedNumbersAreOneMistake) {
    EXPECT_EQ(lexer_summary("1.2.3"), "1 bad-number\n");
    EXPECT_EQ(lexer_summary(".5deg"), "1 bad-number\n");
    EXPECT_EQ(lexer_summary("1e999"), "1 number-out-of-range\n");
}

TEST(Lexer, HexColours) {
    Front front("#c83232");
    const Token token = only(front);
    EXPECT_EQ(token.kind, TokenKind::hex_color);
    EXPECT_EQ(token.number, 0xc83232);
    EXPECT_EQ(lexer_summary("#C83232"), "");
    EXPECT_EQ(lexer_summary("#c8323 #c832322 #c8323g #"),
              "1 bad-hex-color\n1 bad-hex-color\n1 bad-hex-color\n1 bad-hex-color\n");
}

TEST(Lexer, ShortHexColoursAreSpelledOut) {
    Front front("#fa0");
    front.lex();
    EXPECT_EQ(front.messages(),
              "a.scn:1:1: error: `#fa0` is not a colour; a colour is written #rrggbb [bad-hex-color]\n"
              "    1 | #fa0\n"
              "      | ^~~~\n"
              "      | #ffaa00\n");
}

TEST(Lexer, StringsResolveTheirEscapes) {
    EXPECT_EQ(string_of(R"("a \"b\" \\ \n \t c")"), "a \"b\" \\ \n \t c");
    EXPECT_EQ(string_of("\"\""), "");
    EXPECT_EQ(string_of("\"gr\xC3\xBC\xC3\x9F\""), "gr\xC3\xBC\xC3\x9F");
}

TEST(Lexer, UnknownEscapesSuggestADoubledBackslash) {
    Front front(R"("C:\dir")");
    front.lex();
    EXPECT_EQ(front.messages(),
              R"(a.scn:1:4: error: `\d` is not an escape; a string knows \" \\ \n \t [bad-escape]
    1 | "C:\dir"
      |    ^~
      |    \
)");
}

TEST(Lexer, StringsEndWithTheirLine) {
    Front front("name = \"red\nnext");
    const std::vector<Token> tokens = front.lex();
    EXPECT_EQ(front.messages(),
              "a.scn:1:8: error: this string has no closing `\"` on its line [unterminated-string]\n"
              "    1 | name = \"red\n"
              "      |        ^~~~\n"
              "      |            \"\n");
    EXPECT_EQ(front.sources.text(tokens[3].span), "next");
    EXPECT_EQ(lexer_summary("\"a\\"), "1 unterminated-string\n");
    EXPECT_EQ(lexer_summary("\"a\r\nb"), "1 unterminated-string\n");
}

TEST(Lexer, UnterminatedStringLeavesTheBracketsAroundIt) {
    Front front("image { file = \"a.png }");
    const std::vector<Token> tokens = front.lex();
    EXPECT_EQ(tokens[tokens.size() - 2].kind, TokenKind::right_brace);
    EXPECT_EQ(string_value(front.sources.text(tokens[tokens.size() - 3].span)), "a.png");
}

TEST(Lexer, CommentsAreBlanks) {
    EXPECT_EQ(split("a // b\nc /* d\n e */ f /**/ g"), "a c f g  ");
    EXPECT_EQ(lexer_summary("a\n/* b * /"), "2 unterminated-comment\n");
    EXPECT_EQ(lexer_summary("/*/"), "1 unterminated-comment\n");
}

TEST(Lexer, FirstTokenOfALineKnowsIt) {
    Front front("a b\nc /*\n*/ d // e\n\nf");
    std::string starts;
    for (const Token& token : front.lex()) {
        starts += token.starts_line ? '1' : '0';
    }
    EXPECT_EQ(starts, "101110");
}

TEST(Lexer, CarriageReturnsBeforeLineEndsAreBlanks) {
    EXPECT_EQ(split("a\r\nb\r\n"), "a b  ");
}

TEST(Lexer, ByteOrderMarkAtTheBeginningIsSkipped) {
    EXPECT_EQ(split("\xEF\xBB\xBFsphere"), "sphere  ");
    EXPECT_EQ(lexer_summary("a \xEF\xBB\xBF"), "1 unexpected-character\n");
}

TEST(Lexer, FileThatIsNotUtf8IsReportedOnce) {
    EXPECT_EQ(lexer_summary("a\nb \xff \xfe\n\xfd \x01"), "2 bad-utf8\n");
    Front front("\"caf\xe9\"");
    front.lex();
    EXPECT_EQ(front.messages(),
              "a.scn:1:5: error: byte 0xe9 is not UTF-8 text; a scene is a UTF-8 file [bad-utf8]\n"
              "    1 | \"caf\xEF\xBF\xBD\"\n"
              "      |     ^\n");
}

TEST(Lexer, CharactersWithoutMeaningAreNamed) {
    Front front("a @\n\0b\n"s);
    front.lex();
    EXPECT_EQ(front.messages(), "a.scn:1:3: error: unexpected character `@` [unexpected-character]\n"
                                "    1 | a @\n"
                                "      |   ^\n"
                                "a.scn:2:1: error: unexpected character U+0000 [unexpected-character]\n"
                                "    2 | \xEF\xBF\xBD"
                                "b\n"
                                "      | ^\n");
    EXPECT_EQ(lexer_summary("\"a\0b\""s), "1 unexpected-character\n");
}

TEST(Lexer, RunsOfMeaninglessCharactersAreOneMistake) {
    EXPECT_EQ(lexer_summary("@@@@ gr\xC3\xB6\xC3\x9F"
                            "e"),
              "1 unexpected-character\n1 unexpected-character\n");
}

TEST(Lexer, OperatorsOfOtherLanguagesAreReadAsMeant) {
    Front front("a && b || !c");
    std::string kinds;
    for (const Token& token : front.lex()) {
        kinds += spelling(token.kind).substr(0, 3);
        kinds += ' ';
    }
    EXPECT_EQ(kinds, "a n and a n or not a n the ");
    EXPECT_EQ(front.diagnostics.sorted()[2].fix->replacement, "not ");
}

TEST(Lexer, WrongQuotesAreReportedWithTheRightOnes) {
    for (const char* text : {"'red'", "\xE2\x80\x9Cred\xE2\x80\x9D", "\xE2\x80\x98red\xE2\x80\x99"}) {
        Front front(text);
        front.lex();
        const std::vector<Diagnostic> found = front.diagnostics.sorted();
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].fix->replacement, "\"red\"");
    }
}

TEST(Lexer, LookAlikesOfAsciiAreReplaced) {
    Front front("3 \xE2\x88\x92 4");
    front.lex();
    EXPECT_EQ(front.diagnostics.sorted().at(0).fix->replacement, "-");
}

TEST(Lexer, LongTextIsShortInMessages) {
    Front front("1" + std::string(100000, 'q'));
    front.lex();
    EXPECT_LT(front.diagnostics.sorted().at(0).message.size(), 200u);
}

TEST(DumpTokens, ShowsPlaceKindAndValue) {
    Front front("let a =\n  40deg // b");
    EXPECT_EQ(dump_tokens(front.sources, front.lex()), "1:1 line `let`\n"
                                                       "1:5 a name `a`\n"
                                                       "1:7 `=`\n"
                                                       "2:3 line a number `40deg` = 40\n"
                                                       "2:13 the end of the file ``\n");
}

} // namespace
} // namespace scc::lang
