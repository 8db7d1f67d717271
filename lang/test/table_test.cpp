#include "lang/test/outcome.h"
#include "lang/text_table.h"

#include <gtest/gtest.h>

#include <random>

namespace scc::lang {
namespace {

using test::outcome;
using test::Scene;

/// The same scene read line by line and as tables; how many things came from tables.
std::size_t expect_same(const std::string& text) {
    const Scene plain(text);
    const Scene quick(text, {}, {}, true);
    EXPECT_EQ(outcome(quick), outcome(plain)) << text.substr(0, 500);
    std::size_t count = 0;
    const auto add = [&](const auto& self, const std::vector<ThingPtr>& things) -> void {
        for (const ThingPtr& thing : things) {
            count += thing->rows ? count_of(*thing) : 0;
            self(self, thing->children);
        }
    };
    add(add, quick.module.items);
    return count;
}

/// Lines with the row's number in the place of `#`.
std::string lines(int count, std::string_view line) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        for (const char c : line) {
            text += c == '@' ? std::to_string(i) : std::string(1, c);
        }
        text += '\n';
    }
    return text;
}

TEST(Table, ReadsLinesThatDifferInNumbers) {
    EXPECT_EQ(expect_same(lines(100, "ball { center = (@, -@.5, 1e-@), radius = 1.@ }")), 99U);
    EXPECT_EQ(expect_same("let red = paint { gloss = 3 }\n" +
                          lines(50, "ball { radius = 1@, material = red }") + "ball { }\n" +
                          lines(50, "  wall { normal = (@, 1, 0) }") + "wall { normal = (1, 0, 0) }"),
              98U);
    EXPECT_EQ(expect_same("pile {\n" + lines(40, "  ball { radius = 1@ }") + "}\n"), 39U);
    std::string with_returns = lines(40, "ball { radius = 1@ }\r");
    EXPECT_EQ(expect_same(with_returns), 39U);
    with_returns.pop_back(); // the last line's end
    EXPECT_EQ(expect_same(with_returns), 39U);
}

TEST(Table, LeavesOtherLinesToTheParser) {
    EXPECT_EQ(expect_same(lines(31, "ball { radius = 1@ }")), 0U); // too few
    EXPECT_EQ(expect_same(lines(50, "ball { radius = 1@mm }")), 0U);
    EXPECT_EQ(expect_same(lines(50, "ball { radius = 1 + @ }")), 0U);
    EXPECT_EQ(expect_same(lines(50, "ball { radius = 1@ } // @")), 0U);
    EXPECT_EQ(expect_same(lines(40, "ball { material = paint { gloss = @, tone = #ff0000 } }")), 0U);
    EXPECT_EQ(expect_same("let r = -1\n" + lines(40, "ball { center = (@, 1, 1), radius = r }")), 0U);
    EXPECT_EQ(expect_same(lines(50, "ball { name = \"b @ \" }")), 0U);
    EXPECT_EQ(expect_same("/*\n" + lines(50, "ball { radius = 1@ }") + "*/ ball { }"), 0U);
    EXPECT_EQ(expect_same("for (i in 0..2) {\n" + lines(50, "ball { radius = 1@ }") + "}"), 0U);
    EXPECT_EQ(expect_same("let a = pile {\n" + lines(50, "ball { radius = 1@ }") + "}\na"), 0U);
    EXPECT_EQ(expect_same(lines(50, "ball { radius = 1@ }, ball { radius = 2 }")), 0U);
}

TEST(Table, ReportsEachRowAtItsPlace) {
    std::string text = lines(100, "ball { center = (0, @, 0), radius = 1@ }");
    text.replace(text.find("radius = 150"), 12, "radius = -50");
    EXPECT_EQ(Scene(text, {}, {}, true).messages(),
              R"(a.scn:51:38: error: radius is -50; a radius is greater than 0 [value-out-of-range]
   51 | ball { center = (0, 50, 0), radius = -50 }
      |                                      ^~~
)");
    EXPECT_EQ(expect_same(text), 98U);
    EXPECT_EQ(expect_same(lines(50, "ball { radius = @ }")), 0U);      // the first one is wrong
    EXPECT_EQ(expect_same(lines(50, "ball { radius = -@ }")), 0U);     // all are
    EXPECT_EQ(expect_same(lines(50, "ball { radios = @ }")), 0U);      // the field is
    EXPECT_EQ(expect_same(lines(50, "ball { center = (1, @) }")), 0U); // the type is
    EXPECT_EQ(expect_same(lines(50, "ball { radius = 1@ }") + "ball {"), 0U);
    EXPECT_EQ(expect_same(lines(50, "ball { material = red, radius = 1@ }")), 0U);
    EXPECT_EQ(expect_same(lines(50, "bowl { radius = 1@ }")), 0U);
    EXPECT_EQ(expect_same("let a = 3\n" + lines(50, "wall { normal = (@, -@, 0) }")), 0U);
}

TEST(Table, ReadsNumbersToTheLastBit) {
    std::mt19937_64 random(7);
    std::string text;
    for (int i = 0; i < 2000; ++i) {
        double value = std::bit_cast<double>(random());
        value = std::isfinite(value) ? value : 0.1;
        text += fmt::format("ball {{ center = ({}, {:.{}f}, {}) }}\n", value, std::fmod(value, 1e6), i % 20,
                            random());
    }
    EXPECT_EQ(expect_same(text), 1999U);
}

} // namespace
} // namespace scc::lang
