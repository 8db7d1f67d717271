#include "lang/diagnostic.h"
#include "lang/fixes.h"

#include <gtest/gtest.h>

#include <map>

namespace scc::lang {
namespace {

class RenderText : public testing::Test {
protected:
    std::string render(std::string text, std::uint32_t begin, std::uint32_t end) {
        return render_text(sources, at(std::move(text), begin, end), false);
    }
    Diagnostic at(std::string text, std::uint32_t begin, std::uint32_t end) {
        const FileId file = sources.add("table.scn", std::move(text));
        return {Diag::unexpected_character, Severity::error, {file, begin, end}, "text", {}, {}};
    }
    /// The lines below the headline.
    std::string excerpt(std::string text, std::uint32_t begin, std::uint32_t end) {
        const std::string whole = render(std::move(text), begin, end);
        return whole.substr(whole.find('\n') + 1);
    }

    SourceSet sources;
};

TEST_F(RenderText, ShowsPlaceLineRangeReplacementAndNotes) {
    Diagnostic diagnostic = at("phong {\n  diffuze = 1\n}\n", 10, 17);
    diagnostic.message = "phong has no field `diffuze`; did you mean `diffuse`?";
    diagnostic.suggest(diagnostic.span, "diffuse").note({diagnostic.span.file, 0, 5}, "in this phong");
    EXPECT_EQ(
        render_text(sources, diagnostic, false),
        "table.scn:2:3: error: phong has no field `diffuze`; did you mean `diffuse`? [unexpected-character]\n"
        "    2 |   diffuze = 1\n"
        "      |   ^~~~~~~\n"
        "      |   diffuse\n"
        "table.scn:1:1: note: in this phong\n");
}

TEST_F(RenderText, ReplacementStandsWhereItGoes) {
    Diagnostic diagnostic = at("a b", 2, 3);
    diagnostic.suggest({diagnostic.span.file, 1, 1}, ",");
    EXPECT_EQ(render_text(sources, diagnostic, false), "table.scn:1:3: error: text [unexpected-character]\n"
                                                       "    1 | a b\n"
                                                       "      |   ^\n"
                                                       "      |  ,\n");
}

TEST_F(RenderText, FixOnAnotherLineOrOfSeveralLinesIsNotShown) {
    Diagnostic diagnostic = at("a\nb\n", 2, 3);
    diagnostic.suggest({diagnostic.span.file, 0, 1}, "x");
    EXPECT_EQ(render_text(sources, diagnostic, false).find('x', 40), std::string::npos);
    diagnostic.suggest(diagnostic.span, "two\nlines");
    EXPECT_EQ(render_text(sources, diagnostic, false).find("two"), std::string::npos);
}

TEST_F(RenderText, EmptyRangeHasACaretOnly) {
    EXPECT_EQ(excerpt("ab", 2, 2), "    1 | ab\n      |   ^\n");
}

TEST_F(RenderText, RangeOverSeveralLinesMarksTheFirst) {
    EXPECT_EQ(excerpt("a {\n  b\n}\n", 2, 9), "    1 | a {\n      |   ^\n");
    EXPECT_EQ(excerpt("a b c\r\nd\n", 2, 8), "    1 | a b c\n      |   ^~~\n");
}

TEST_F(RenderText, TabsCountToTheNextStop) {
    EXPECT_EQ(excerpt("\tx\ty", 3, 4), "    1 |     x   y\n      |         ^\n");
}

TEST_F(RenderText, Utf8TakesAsManyColumnsAsATerminal) {
    EXPECT_EQ(excerpt("\xC3\xA9 x", 3, 4), "    1 | \xC3\xA9 x\n      |   ^\n");
    EXPECT_EQ(excerpt("\xE5\x90\x8D x", 0, 3), "    1 | \xE5\x90\x8D x\n      | ^~\n"); // wide
    EXPECT_EQ(excerpt("e\xCC\x81 x", 4, 5), "    1 | e\xCC\x81 x\n      |   ^\n");      // combining
}

TEST_F(RenderText, BytesATerminalShouldNotSeeAreReplaced) {
    EXPECT_EQ(excerpt("\x1b\xff x", 3, 4), "    1 | \xEF\xBF\xBD\xEF\xBF\xBD x\n      |    ^\n");
}

TEST_F(RenderText, LongLinesAreCutAroundTheRange) {
    const std::string text = excerpt(std::string(1000, 'a') + "bc" + std::string(1000, 'd'), 1000, 1002);
    EXPECT_EQ(text, "    1 | ..." + std::string(40, 'a') + "bc" + std::string(58, 'd') + "...\n      | " +
                        std::string(43, ' ') + "^~\n");
}

TEST_F(RenderText, LongLinesAreCutBetweenCharacters) {
    std::string line;
    for (int i = 0; i < 200; ++i) {
        line += "\xE2\x82\xAC"; // three bytes each
    }
    const std::string text = excerpt(line, 300, 303);
    EXPECT_EQ(text.find("\xEF\xBF\xBD"), std::string::npos);
}

TEST_F(RenderText, LineNumbersWiderThanTheGutterMoveIt) {
    EXPECT_EQ(excerpt(std::string(123455, '\n') + "x", 123455, 123456), "123456 | x\n       | ^\n");
}

TEST_F(RenderText, NoPlaceIsNotPrinted) {
    Diagnostic diagnostic{Diag::unexpected_character, Severity::error, {}, "text", {}, {}};
    EXPECT_EQ(render_text(SourceSet{}, diagnostic, false), "error: text [unexpected-character]\n");
    sources.add("table.scn", "sphere");
    EXPECT_EQ(render_text(sources, diagnostic, false), "error: text [unexpected-character]\n");
}

TEST_F(RenderText, SpanPastTheEndOfTheFileMarksTheEnd) {
    EXPECT_EQ(render("ab", 90, 95),
              "table.scn:1:3: error: text [unexpected-character]\n    1 | ab\n      |   ^\n");
}

TEST_F(RenderText, ColourOnlyIfAsked) {
    const Diagnostic diagnostic = at("ab", 0, 1);
    EXPECT_EQ(render_text(sources, diagnostic, false).find('\x1b'), std::string::npos);
    EXPECT_NE(render_text(sources, diagnostic, true).find("\x1b[1;31merror"), std::string::npos);
}

TEST(Diagnostics, AreSortedByFileAndPosition) {
    Diagnostics diagnostics;
    diagnostics.report(Diag::bad_number, {1, 0, 1}, "c");
    diagnostics.report(Diag::bad_number, {0, 5, 6}, "b");
    diagnostics.report(Diag::bad_number, {0, 2, 9}, "a");
    diagnostics.report(Diag::bad_hex_color, {0, 5, 7}, "reported later at the same place");
    std::string order;
    for (const Diagnostic& diagnostic : diagnostics.sorted()) {
        order += diagnostic.message[1];
    }
    EXPECT_EQ(order, "abrc");
}

TEST(Diagnostics, ExactRepeatsAreDroppedAndOthersKept) {
    Diagnostics diagnostics;
    diagnostics.report(Diag::bad_number, {0, 1, 2}, "x");
    diagnostics.report(Diag::bad_number, {0, 1, 2}, "y");
    diagnostics.report(Diag::bad_number, {0, 1, 2}, "x");
    diagnostics.report(Diag::bad_number, {0, 1, 3}, "x");
    EXPECT_EQ(diagnostics.sorted().size(), 3u);
}

TEST(Diagnostics, CountErrorsAndPromoteWarnings) {
    const auto& rows = diagnostic_rows();
    std::size_t warning = 0;
    while (warning < rows.size() && rows[warning].severity != Severity::warning) {
        ++warning;
    }
    ASSERT_LT(warning, rows.size());

    Diagnostics diagnostics;
    EXPECT_FALSE(diagnostics.has_errors());
    diagnostics.report(static_cast<Diag>(warning), {}, "a", "b", "c", "d");
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(diagnostics.warning_count(), 1u);
    diagnostics.report(Diag::bad_number, {}, "x");
    EXPECT_EQ(diagnostics.error_count(), 1u);
    diagnostics.promote_warnings();
    EXPECT_EQ(diagnostics.error_count(), 2u);
    EXPECT_EQ(diagnostics.warning_count(), 0u);
}

TEST(Fixes, AreMadeTogetherUnlessTheyTouch) {
    const std::string text = "abcdef";
    Diagnostics diagnostics;
    const auto fix = [&](FileId file, std::uint32_t begin, std::uint32_t end, const char* replacement) {
        diagnostics.report(Diag::bad_number, {file, begin, end}, "x")
            .suggest({file, begin, end}, replacement);
    };
    fix(0, 4, 5, "E");
    fix(0, 1, 3, "BC");
    fix(0, 2, 4, "overlaps");
    fix(0, 0, 0, "<");
    fix(0, 0, 0, "inserted at the same place");
    fix(0, 5, 5, "-");
    fix(1, 5, 6, "in another file");
    diagnostics.report(Diag::bad_number, {0, 5, 6}, "without a fix");
    EXPECT_EQ(with_fixes(text, fixes_for(0, diagnostics.sorted())), "<aBCdE-f");
    EXPECT_EQ(with_fixes(text, {}), text);
}

TEST(DiagnosticRows, KeepTheHouseStyle) {
    for (const DiagnosticRow& row : diagnostic_rows()) {
        SCOPED_TRACE(row.kind);
        EXPECT_FALSE(row.message.ends_with('.'));
        EXPECT_EQ(row.message.find('\n'), std::string_view::npos);
        EXPECT_EQ(row.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"),
                  std::string_view::npos);
    }
}

// Two stages may find the same mistake: then it has one name, and is equally grave.
TEST(DiagnosticRows, OfTheSameNameAreOfTheSameSeverity) {
    std::map<std::string_view, Severity> severities;
    for (const DiagnosticRow& row : diagnostic_rows()) {
        EXPECT_EQ(severities.try_emplace(row.name, row.severity).first->second, row.severity) << row.name;
    }
}

TEST(Nearest, FindsMisspelledWords) {
    const std::vector<std::string_view> fields = {"diffuse", "specular", "shininess", "ior"};
    EXPECT_EQ(nearest("diffuze", fields), "diffuse");
    EXPECT_EQ(nearest("specualr", fields), "specular");
    EXPECT_EQ(nearest("Diffuse", fields), "diffuse");
    EXPECT_EQ(nearest("shinines", fields), "shininess");
    EXPECT_EQ(nearest("iro", fields), "ior");
}

TEST(Nearest, DoesNotGuessWildly) {
    const std::vector<std::string_view> names = {"x", "ior", "diffuse"};
    EXPECT_EQ(nearest("y", names), std::nullopt);
    EXPECT_EQ(nearest("radius", names), std::nullopt);
    EXPECT_EQ(nearest("", names), std::nullopt);
    EXPECT_EQ(nearest(std::string(100000, 'd'), names), std::nullopt);
}

TEST(Nearest, TakesTheClosestAndOfEqualsTheFirst) {
    EXPECT_EQ(nearest("radios", {"radium_", "radius"}), "radius");
    EXPECT_EQ(nearest("cat", {"bat", "hat"}), "bat");
}

} // namespace
} // namespace scc::lang
