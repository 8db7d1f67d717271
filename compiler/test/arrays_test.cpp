#include "compiler/ir/objects.h"
#include "compiler/ir/print.h"
#include "compiler/passes/passes.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

namespace scc::compiler {
namespace {

using test::compile_shapes;
using test::Compiled;

/// Objects that are made alike stand in arrays; everything that looks at a scene sees the same as without.
std::string printed(const std::string& shapes, std::size_t arrays) {
    Compiled c = compile_shapes(shapes);
    EXPECT_TRUE(c.fine) << c.messages;
    EXPECT_EQ(c.scene.arrays.size(), arrays) << shapes;
    run_passes(c.scene);
    return ir::print(c.scene);
}

std::string unrolled(int begin, int end, const std::string& body) {
    std::string text;
    for (int i = begin; i < end; ++i) {
        std::string one = body;
        for (std::size_t at = one.find('i'); at != std::string::npos; at = one.find('i', at)) {
            const auto is_letter = [&](std::size_t k) { return k < one.size() && std::isalpha(one[k]) != 0; };
            const bool is_name = !is_letter(at + 1) && (at == 0 || !is_letter(at - 1));
            const std::string value = "(" + std::to_string(i) + ")";
            one.replace(at, 1, is_name ? value : "i");
            at += is_name ? value.size() : 1;
        }
        text += one + "\n";
    }
    return text;
}

void expect_same(const std::string& before, const std::string& body, const std::string& after) {
    EXPECT_EQ(printed(fmt::format("{}for (i in -3..40) {{ {} }}\n{}", before, body, after), 1),
              printed(before + unrolled(-3, 40, body) + after, 0));
}

TEST(Arrays, AreTheObjectsThatTheyStandFor) {
    expect_same("let red = phong { diffuse = rgb(1, 0, 0) }\n",
                "sphere { center = (i, i * i, 0.1 * i), radius = 4 + i, material = red }", "");
    expect_same("", "triangle { points = [(i, 0, 0), (0, 1, i), (1, i, 1)] }", "");
    expect_same("", "disc { center = (i, 0, 0), normal = (1, i, 2), radius = 2 }", "");
}

TEST(Arrays, StandInTheOrderOfTheSource) {
    expect_same("sphere { }\nbox { }\n",
                "sphere { radius = i + 4 }\nbox { max = (2, i + 4, 2) }\nsphere { center = (i, 1, 1) }",
                "box { }\nsphere { }\n");
}

TEST(Arrays, AreMovedByTheTransformsAroundThem) {
    for (const char* transform : {"rotate_y(30deg) then translate(1, 2, 3)", "scale(1, 2, 3)", "scale(2)"}) {
        expect_same(
            fmt::format("group {{ transform = {}, material = phong {{ }}, name = \"cloud\"\n", transform),
            "cylinder { from = (0, i, 0), to = (i, 50, 1), radius = 4 + i, transform = rotate_x(10deg) }",
            "}\n");
    }
}

TEST(Arrays, ShareMaterialsOfTheSameNumbers) {
    const Compiled c =
        compile_shapes("let tones = [#ff0000, #00ff00, #0000ff]\n"
                       "for (i in 0..90) { sphere { material = phong { diffuse = tones[i % 3] } } }");
    ASSERT_EQ(c.scene.arrays.size(), 1U);
    EXPECT_EQ(c.scene.materials.size(), 3U);
    const ir::ObjectColumn& column = c.scene.arrays[0].columns[0];
    for (std::size_t i = 0; i < 90; ++i) {
        const runtime::Rgb<double> diffuse = c.scene.materials[column.sides_of(i).front].phong.diffuse.value;
        EXPECT_EQ(diffuse,
                  (runtime::Rgb<double>{i % 3 == 0 ? 1.0 : 0, i % 3 == 1 ? 1.0 : 0, i % 3 == 2 ? 1.0 : 0}));
    }
    EXPECT_EQ(ir::object_of(column, 4).path, "sphere[4]");
    EXPECT_EQ(ir::object_count(c.scene), 90U);
}

TEST(Arrays, AreTakenApartWherePathsMayMeet) {
    const Compiled c =
        compile_shapes("sphere { name = \"box[3]\" }\nfor (i in 0..40) { box { max = (1, 2, i + 2) } }");
    EXPECT_EQ(c.scene.objects.size(), 41U);
    EXPECT_EQ(c.scene.objects[4].path, "box[3] 2");
}

TEST(Arrays, ReportShapesThatEncloseNothing) {
    EXPECT_EQ(compile_shapes("for (i in 0..40) { box { max = (1, 2, i - 3) } }").messages,
              R"(test.scn:1:20: error: this box is flat or inside out; each component of `min` is less than that of `max` [impossible-shape]
    1 | for (i in 0..40) { box { max = (1, 2, i - 3) } }
      |                    ^~~~~~~~~~~~~~~~~~~~~~~~~~~
)");
}

} // namespace
} // namespace scc::compiler
