#include "lang/test/toy_schema.h"

#include <gtest/gtest.h>

namespace scc::lang {
namespace {

using test::messages_of;
using test::Scene;

std::string printed(std::string_view text, std::optional<std::int64_t> frame = {},
                    const test::MemoryImporter::Files& files = {}) {
    const Scene scene(text, {}, {}, false, files, frame);
    std::string all = scene.messages();
    for (const std::string& print : scene.module.prints) {
        all += print + "\n";
    }
    return all;
}

TEST(Frames, TellTheFrameAndItsTime) {
    const char* text = "render { frames = 3..51, frame_rate = 12 }\nlet t = time\nprint(frame)\nprint(t)";
    EXPECT_EQ(printed(text), "3\n0.25\n");
    EXPECT_EQ(printed(text, 48), "48\n4\n");
    EXPECT_EQ(printed("render { frames = 12..13 }\nprint(time)"), "0.5\n");
    EXPECT_EQ(printed("param n: number = 12\nrender { frames = n..n + 5 }\nprint(frame)"), "12\n");
}

TEST(Frames, AreKnownToTheCaller) {
    const Scene animated("render { frames = -3..51 }");
    ASSERT_TRUE(animated.module.frames);
    EXPECT_EQ(animated.module.frames->begin, -3);
    EXPECT_EQ(animated.module.frames->end, 51);
    EXPECT_EQ(animated.module.frames->chosen, -3);
    EXPECT_FALSE(Scene("render { }").module.frames);
}

TEST(Frames, ImportedFilesHaveThem) {
    EXPECT_EQ(printed("import \"p.scn\" as p\nrender { frames = 5..9 }\nprint(p.x)", 6,
                      {{"p.scn", "let x = frame * 2"}}),
              "12\n");
}

TEST(Frames, AreNeededWhereTheyAreUsed) {
    EXPECT_EQ(
        messages_of("ball { radius = 1 + time }\nrender { frame_rate = 2 }"),
        R"(a.scn:1:21: error: `time` is known in a scene whose `render` has `frames` [frame-without-frames]
    1 | ball { radius = 1 + time }
      |                     ^~~~
a.scn:2:9: note: it has them with `frames = 0..48` here
)");
    EXPECT_EQ(messages_of("let frame = 2\nprint(frame)"), "");
    EXPECT_EQ(Scene("render { frames = 0..2 }\nlet frame = 2\nprint(frame)").summary(), "2 shadowed-name\n");
}

TEST(Frames, AreWholeAndAtLeastOne) {
    EXPECT_EQ(Scene("render { frames = 0..0.5 }").summary(), "1 fractional-range\n");
    EXPECT_EQ(Scene("render { frames = 5..5 }").summary(), "1 value-out-of-range\n");
    EXPECT_EQ(Scene("render { frames = 0..1e9 }").summary(), "1 value-out-of-range\n");
    EXPECT_EQ(Scene("render { frames = 0..2, frame_rate = 0 }").summary(), "1 value-out-of-range\n");
    EXPECT_EQ(Scene("render { frames = 3 }").summary(), "1 type-mismatch\n");
}

} // namespace
} // namespace scc::lang
