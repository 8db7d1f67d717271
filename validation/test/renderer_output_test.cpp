#include "validation/renderer_output.h"

#include <gtest/gtest.h>

namespace scc::validation {
namespace {

TEST(LinesOf, KeepsTheLastOfLinesThatOverwriteEachOther) {
    EXPECT_EQ(lines_of("a\n10%\r20%\rdone\nb\r\nc"), (std::vector<std::string>{"a", "done", "b", "c"}));
    EXPECT_TRUE(lines_of("").empty());
}

constexpr const char* povray_talk =
    R"(povray: cannot open the user configuration file /home/x/.povray/3.7/povray.conf: No
Persistence of Vision(tm) Ray Tracer Version 3.7.0.10.unofficial (g++ @
 x86_64-pc-linux-gnu)
Parser Options
  Input file: a.pov
==== [Parsing...] ==========================================================
File 'a.pov' line 7: Parse Warning: Degenerate triangle. Please remove.
File 'a.pov' line 9: Parse Error: No matching } in 'sphere', undeclared
 identifier 'pigmentx' found instead
Fatal error in parser: Cannot parse input.
  Parse Time:       0 hours  0 minutes  1 seconds (1.250 seconds)
              using 1 thread(s) with 0.000 CPU-seconds total
  Bounding Time:    0 hours  0 minutes  0 seconds (0.125 seconds)
  Trace Time:       0 hours  1 minutes  2 seconds (62.500 seconds)
)";

TEST(PovrayOutput, TimesWarningsErrorsAndVersionAreFound) {
    const PovrayOutput output = read_povray_output(povray_talk);
    EXPECT_EQ(output.version, "POV-Ray 3.7.0.10.unofficial");
    EXPECT_EQ(output.parse, 1.25);
    EXPECT_EQ(output.bounding, 0.125);
    EXPECT_EQ(output.trace, 62.5);
    EXPECT_EQ(
        output.warnings,
        std::vector<std::string>{"File 'a.pov' line 7: Parse Warning: Degenerate triangle. Please remove."});
    EXPECT_EQ(output.errors, (std::vector<std::string>{
                                 "File 'a.pov' line 9: Parse Error: No matching } in 'sphere', undeclared "
                                 "identifier 'pigmentx' found instead",
                                 "Fatal error in parser: Cannot parse input."}));
    EXPECT_EQ(output.log.find("Parser Options"), 0U);
}

TEST(PovrayOutput, MissingTimesAreEmpty) {
    const PovrayOutput output = read_povray_output("Trace Time: soon\nParse Time: (x seconds)\n");
    EXPECT_FALSE(output.parse);
    EXPECT_FALSE(output.trace);
    EXPECT_TRUE(output.version.empty());
}

TEST(BlenderOutput, TimesAndVersionAreFoundAndProgressIsDropped) {
    const BlenderOutput output = read_blender_output("Blender 3.4.1\n"
                                                     "Fra:1 Mem:9.20M | Time:00:00.00 | Initializing\n"
                                                     "Saved: 'image.exr'\n"
                                                     " Time: 01:02.50 (Saving: 00:00.25)\n"
                                                     "\nBlender quit\n",
                                                     "note\n");
    EXPECT_EQ(output.version, "Blender 3.4.1");
    EXPECT_EQ(output.render, 62.25);
    EXPECT_EQ(output.saving, 0.25);
    EXPECT_TRUE(output.error.empty());
    EXPECT_EQ(output.log.find("Fra:"), std::string::npos);
    EXPECT_NE(output.log.find("note"), std::string::npos);
}

TEST(BlenderOutput, ErrorIsTheLastLineOfTheTraceback) {
    const BlenderOutput output = read_blender_output("Blender 3.4.1\n"
                                                     "Error: Python: Traceback (most recent call last):\n"
                                                     "  File \"e.py\", line 1, in <module>\n"
                                                     "RuntimeError: bad thing\n"
                                                     "\n"
                                                     "Error: script failed, file: 'e.py', exiting.\n",
                                                     "");
    EXPECT_EQ(output.error, "RuntimeError: bad thing");
    EXPECT_FALSE(output.render);
}

} // namespace
} // namespace scc::validation
