#include "lang/source.h"
#include "lang/utf8.h"

#include <gtest/gtest.h>

namespace scc::lang {
namespace {

std::pair<std::uint32_t, std::uint32_t> at(const SourceFile& file, std::uint32_t offset) {
    const Position position = file.position(offset);
    return {position.line, position.column};
}

using Place = std::pair<std::uint32_t, std::uint32_t>;

TEST(SourceFile, PositionsCountLinesAndBytesFromOne) {
    const SourceFile file("a.scn", "ab\nc\n\nd");
    EXPECT_EQ(at(file, 0), Place(1, 1));
    EXPECT_EQ(at(file, 2), Place(1, 3)); // the line end belongs to its line
    EXPECT_EQ(at(file, 3), Place(2, 1));
    EXPECT_EQ(at(file, 5), Place(3, 1));
    EXPECT_EQ(at(file, 6), Place(4, 1));
}

TEST(SourceFile, PositionPastTheEndIsTheEnd) {
    const SourceFile file("a.scn", "ab");
    EXPECT_EQ(at(file, 2), Place(1, 3));
    EXPECT_EQ(at(file, 99), Place(1, 3));
    EXPECT_EQ(at(SourceFile("empty.scn", ""), 5), Place(1, 1));
}

TEST(SourceFile, LinesComeWithoutTheirEnds) {
    const SourceFile file("a.scn", "unix\ndos\r\n\nlast");
    EXPECT_EQ(file.line(1), "unix");
    EXPECT_EQ(file.line(2), "dos");
    EXPECT_EQ(file.line(3), "");
    EXPECT_EQ(file.line(4), "last");
}

TEST(SourceFile, LinesOutsideTheFileAreEmpty) {
    const SourceFile file("a.scn", "text");
    EXPECT_EQ(file.line(0), "");
    EXPECT_EQ(file.line(2), "");
}

TEST(SourceSet, ReferencesStayValidWhileFilesAreAdded) {
    SourceSet sources;
    const FileId first = sources.add("first.scn", "short");
    const SourceFile& file = sources.file(first);
    for (int i = 0; i < 100; ++i) {
        sources.add("more.scn", "text");
    }
    EXPECT_EQ(&file, &sources.file(first));
    EXPECT_EQ(file.text(), "short");
}

TEST(SourceSet, TextOfASpanIsCutAtTheEnd) {
    SourceSet sources;
    const FileId file = sources.add("a.scn", "sphere");
    EXPECT_EQ(sources.text({file, 1, 4}), "phe");
    EXPECT_EQ(sources.text({file, 4, 99}), "re");
    EXPECT_EQ(sources.text({file, 99, 100}), "");
}

TEST(SourceSet, NoPlaceHasNoText) {
    SourceSet sources;
    sources.add("a.scn", "sphere");
    EXPECT_FALSE(sources.contains(Span{}.file));
    EXPECT_EQ(sources.text(Span{}), "");
}

TEST(Utf8, EveryLengthOfCharacterIsDecodedAndEncoded) {
    for (const char32_t code : {U'\0', U'a', U'\u00e9', U'\u20ac', U'\uffff', U'\U0001F600', U'\U0010FFFF'}) {
        const std::string text = encode(code);
        const Character c = decode(text, 0);
        EXPECT_TRUE(c.valid);
        EXPECT_EQ(c.code, code);
        EXPECT_EQ(c.length, text.size());
    }
}

TEST(Utf8, MalformedBytesAreFoundWhereTheyAre) {
    using namespace std::string_view_literals;
    EXPECT_EQ(find_malformed("plain text that is longer than a word, \xC3\xA9"), std::string_view::npos);
    EXPECT_EQ(find_malformed("0123456789\xC3"), 10u);          // cut off
    EXPECT_EQ(find_malformed("0123456789\xC0\xAF rest"), 10u); // overlong
    EXPECT_EQ(find_malformed("\xE0\x80\x80"), 0u);             // overlong
    EXPECT_EQ(find_malformed("\xED\xA0\x80"), 0u);             // surrogate
    EXPECT_EQ(find_malformed("\xF4\x90\x80\x80"), 0u);         // past U+10FFFF
    EXPECT_EQ(find_malformed("a\x80"), 1u);                    // a tail alone
}

TEST(Utf8, PrintableTextHasNoControlOrOverrideCharacters) {
    EXPECT_EQ(printable("a\x1b[31m\xffz"), "a\xEF\xBF\xBD[31m\xEF\xBF\xBDz");
    EXPECT_EQ(printable("\xE2\x80\xAE"), "\xEF\xBF\xBD"); // right-to-left override
    EXPECT_EQ(printable("gr\xC3\xBC\xC3\x9F"), "gr\xC3\xBC\xC3\x9F");
}

TEST(Utf8, ShortenedTextIsCutBetweenCharacters) {
    EXPECT_EQ(shortened("short"), "short");
    EXPECT_EQ(shortened(std::string(39, 'x') + "\xC3\xA9 and more"), std::string(39, 'x') + "...");
}

} // namespace
} // namespace scc::lang
