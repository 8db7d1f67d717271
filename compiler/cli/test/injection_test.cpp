#include "compiler/cli/test/support.h"

#include <gtest/gtest.h>

/// What an author writes in names and strings stays text in everything that scc generates.
namespace scc::cli::test {
namespace {

// Each would do something if it left its literal or its comment: the marker file would exist, or the text
// would not compile.
const char* const hostile[] = {
    "\\\"; system(\\\"touch marker\\\"); //",
    "*/ int main() { return 7; } /*",
    "\\n#error injected\\n",
    "\\n#include \\\"none.inc\\\"\\n",
    "\\\"\\\"\\\"\\nopen('marker', 'w')\\n\\\"\\\"\\\"",
    "'''\\nopen('marker', 'w')\\n'''",
    "back\\\\slash at the end\\\\",
    "}} sphere { 0 1 } {{",
    "{} {0} %s %n",
};

class Injection : public CommandLine, public testing::WithParamInterface<const char*> {
protected:
    void SetUp() override {
        const std::string text = GetParam();
        write("s.scn",
              "sphere { name = \"" + text +
                  "\", material = phong { diffuse = fn(s: surface) = rgb(0.5 + 0.2 * sin(s.p.x), 0.5, 0.5) } "
                  "}\n"
                  "box { name = \"" +
                  text +
                  "\" }\n"
                  "perspective_camera { }\npoint_light { position = (3, 4, 5) }\nrender { file = \"" +
                  text + "\", size = (32, 24) }\n");
    }
};

INSTANTIATE_TEST_SUITE_P(All, Injection, testing::ValuesIn(hostile));

TEST_P(Injection, DoesNotReachTheGeneratedProgram) {
    const auto built = scc({"build", "s.scn", "-o", "prog"});
    ASSERT_TRUE(built.ok()) << built.err;
    EXPECT_TRUE(start(path("prog"), {"-o", "a.png"}).ok());
    EXPECT_FALSE(exists("marker"));
}

TEST_P(Injection, DoesNotReachPovRay) {
    ASSERT_TRUE(scc({"export", "pov", "s.scn", "-o", "s.pov"}).ok());
    EXPECT_EQ(read("s.pov").find("\n#error"), std::string::npos);
    EXPECT_EQ(read("s.pov").find("\n#include"), std::string::npos);
    if (!validation::find_program("povray")) {
        GTEST_SKIP() << "povray is not installed";
    }
    const auto drawn =
        start("povray", {"+Is.pov", "+Oa.png", "+W32", "+H24", "+FN16", "File_Gamma=1.0", "-A", "-D"});
    EXPECT_TRUE(drawn.ok()) << drawn.err;
    EXPECT_FALSE(exists("marker"));
}

TEST_P(Injection, DoesNotReachPython) {
    ASSERT_TRUE(scc({"export", "blender", "s.scn", "-o", "s.py"}).ok());
    if (!validation::find_program("blender")) {
        GTEST_SKIP() << "blender is not installed";
    }
    const auto drawn = start("blender", {"-b", "--factory-startup", "--python-exit-code", "1", "-P", "s.py",
                                         "--", "--render", "a.exr", "--size", "32x24"});
    EXPECT_TRUE(drawn.ok()) << drawn.out << drawn.err;
    EXPECT_TRUE(exists("a.exr"));
    EXPECT_FALSE(exists("marker"));
}

// The scene's file name reaches the generated texts too.
TEST_F(CommandLine, FileNamesAreTextAsWell) {
    const std::string name = "a\"b';#{}\\ $(touch marker) é.scn";
    write(name, small_scene);
    ASSERT_TRUE(scc({"build", name, "-o", "prog"}).ok());
    EXPECT_TRUE(start(path("prog"), {"-o", "a.png", "--size", "8x8"}).ok());
    EXPECT_TRUE(scc({"export", "pov", name, "-o", "s.pov"}).ok());
    EXPECT_TRUE(scc({"export", "blender", name, "-o", "s.py"}).ok());
    EXPECT_FALSE(exists("marker"));
}

} // namespace
} // namespace scc::cli::test
