#include "lang/test/outcome.h"

#include <gtest/gtest.h>

#include <set>

namespace scc::lang {
namespace {

using test::MemoryImporter;
using test::Scene;

const MemoryImporter::Files files{
    {"studio.scn", R"(param power: number = 2 in 0..10 "of the key light"
param size: number = 1 in 0.1..5
param tone: color = rgb(1, 1, 1)
let red = paint { gloss = power }
fn double(x: number, by: number = 2) = x * by
fn twin(s: surface) -> number = s.p.x * power
let key = lamp { tone = tone * power }
key
lamp { }
ball { radius = size }
for (i in 0..2) { ball { radius = size + i, material = red } }
eye { }
output { samples = 4 }
world { background = rgb(0, 0, 1) }
)"},
    {"nested.scn", "import \"studio.scn\" as inner with { power = 5 }\nparam p: number = 3\n"
                   "let key = inner.power + p\ninner.scene\nball { }\n"},
};

Scene scene(std::string_view text, const std::vector<Definition>& definitions = {},
            const MemoryImporter::Files& more = {}) {
    MemoryImporter::Files all = files;
    for (const auto& [name, content] : more) {
        all[name] = content;
    }
    return Scene(text, definitions, {}, false, all);
}

/// What the things are, with their names: `pile studio(ball, ball)`.
std::string shape_of(const std::vector<ThingPtr>& things) {
    std::string text;
    for (const ThingPtr& thing : things) {
        for (std::size_t i = 0; i < count_of(*thing); ++i) {
            const std::size_t in_round = thing->rows ? thing->rows->things.size() : 1;
            const ThingPtr one = thing->rows ? thing->rows->thing(i % in_round, i / in_round) : thing;
            text += (text.empty() ? "" : ", ") + std::string(one->constructor->name);
            text += one->name.empty() ? "" : " " + one->name;
            text += one->children.empty() ? "" : "(" + shape_of(one->children) + ")";
        }
    }
    return text;
}

std::string prints_of(const Scene& scene) {
    std::string text = scene.messages();
    for (const std::string& print : scene.module.prints) {
        text += print + "\n";
    }
    return text;
}

TEST(Import, AddsNothingByItself) {
    const Scene s = scene("import \"studio.scn\" as s\nprint(s.power)");
    EXPECT_EQ(s.messages(), "");
    EXPECT_TRUE(s.module.items.empty());
}

TEST(Import, SceneIsShapesInAGroupThenLightsAndCameras) {
    const Scene s = scene("import \"studio.scn\" as studio\nball { }\nstudio.scene");
    EXPECT_EQ(s.messages(), "");
    EXPECT_EQ(shape_of(s.module.items),
              "ball, pile studio(ball, ball, ball), lamp studio/key, lamp studio/lamp, eye studio/eye");
}

TEST(Import, SceneTwiceIsTwoInstancesThatShare) {
    const Scene s = scene("import \"studio.scn\" as studio\nlet all = studio.scene\nall\nstudio.scene");
    EXPECT_EQ(s.messages(), "");
    ASSERT_EQ(s.module.items.size(), 8u);
    EXPECT_EQ(s.module.items[0], s.module.items[4]);
}

TEST(Import, NamesReachLetsFunctionsAndParams) {
    EXPECT_EQ(
        prints_of(scene("import \"studio.scn\" as s\nprint(s.power)\nprint(s.tone)\nprint(s.double(4))\n"
                        "print(s.double(4, by = 3))\nlet f = s.double\nprint(f(1, 7))\n"
                        "print(map([1, 2], fn(x: number) = s.double(x)))")),
        "2\nrgb(1, 1, 1)\n8\n12\n7\n[2, 4]\n");
    EXPECT_EQ(scene("import \"studio.scn\" as s\nball { material = s.red }\ns.key").messages(), "");
    EXPECT_EQ(scene("import \"studio.scn\" as s\nball { material = paint { gloss = s.twin } }").messages(),
              "");
    EXPECT_EQ(scene("import \"studio.scn\" as s\nfor (i in 0..100) { ball { radius = s.double(i + 1) } }")
                  .messages(),
              "");
}

TEST(Import, WithSetsParams) {
    EXPECT_EQ(prints_of(scene("let a = 3\nimport \"studio.scn\" as s with { power = a + 1, size = 2 }\n"
                              "import \"studio.scn\" as t with { power = s.power * 2 }\nprint(s.power)\n"
                              "print(t.power)\nprint(t.size)\nprint(s.key)")),
              "4\n8\n1\nlamp { }\n");
}

TEST(Import, TheCommandLineComesLast) {
    const std::string text = "import \"studio.scn\" as s with { power = 4 }\nprint(s.power)";
    EXPECT_EQ(prints_of(scene(text, {{"s.power", "5"}})), "5\n");
    EXPECT_EQ(prints_of(scene(text, {{"s.power", "5"}, {"s.power", "6"}})), "6\n");
    EXPECT_EQ(prints_of(scene("import \"nested.scn\" as n\nprint(n.key)", {{"n.inner.power", "7"}})), "10\n");
    EXPECT_EQ(
        scene(text, {{"s.powr", "5"}}).messages(),
        "error: -D s.powr: the scene has no param of this name; did you mean `s.power`? [unknown-param]\n");
    EXPECT_EQ(scene(text, {{"power", "5"}}).summary(), "1 unknown-param\n");
    EXPECT_EQ(scene(text, {{"s.power", "11"}}).messages(),
              R"(-D s.power:1:1: error: the param `power` is 11; its range is 0..10 [value-out-of-range]
    1 | 11
      | ^~
)");
}

TEST(Import, WithIsCheckedWhereItStands) {
    EXPECT_EQ(
        scene("import \"studio.scn\" as s with { power = 11, size = 1deg, tonne = 3, let b = 1 }\ns.scene")
            .messages(),
        R"(a.scn:1:41: error: the param `power` is 11; its range is 0..10 [value-out-of-range]
    1 | import "studio.scn" as s with { power = 11, size = 1deg, tonne = 3, let b = 1 }
      |                                         ^~
a.scn:1:52: error: the param `size` takes a number, this is an angle [type-mismatch]
    1 | import "studio.scn" as s with { power = 11, size = 1deg, tonne = 3, let b = 1 }
      |                                                    ^~~~
a.scn:1:58: error: `s` has no param `tonne`; did you mean `tone`? [unknown-import-param]
    1 | import "studio.scn" as s with { power = 11, size = 1deg, tonne = 3, let b = 1 }
      |                                                          ^~~~~
      |                                                          tone
a.scn:1:69: error: `with` takes `param = value`, this is a `let` [unexpected-item]
    1 | import "studio.scn" as s with { power = 11, size = 1deg, tonne = 3, let b = 1 }
      |                                                                     ^~~~~~~~~
)");
    EXPECT_EQ(scene("import \"studio.scn\" as s with { power = 1, power = 2 }\ns.scene").summary(),
              "1 duplicate-field\n");
}

TEST(Import, UnknownMembersAreAnsweredWithTheNearest) {
    EXPECT_EQ(scene("import \"studio.scn\" as s\nprint(s.powr)\nprint(s.duble(2))\ns.scne").messages(),
              R"(a.scn:2:9: error: `s` has no member `powr`; did you mean `power`? [unknown-member]
    2 | print(s.powr)
      |         ^~~~
      |         power
a.scn:3:9: error: `s` has no member `duble`; did you mean `double`? [unknown-member]
    3 | print(s.duble(2))
      |         ^~~~~
      |         double
a.scn:4:3: error: `s` has no member `scne`; did you mean `scene`? [unknown-member]
    4 | s.scne
      |   ^~~~
      |   scene
)");
    EXPECT_EQ(scene("import \"nested.scn\" as n\nprint(n.inner)").summary(), "2 unknown-member\n");
}

TEST(Import, MistakesInTheFileTellWhereItIsImported) {
    const MemoryImporter::Files wrong{
        {"part.scn", "param r: number = 1\nball { radus = 2 }\nball { radius = r }\n"},
        {"room.scn", "import \"part.scn\" as part with { r = 0 }\npart.scene\n"}};
    const Scene s = scene("import \"room.scn\" as room\nroom.scene", {}, wrong);
    EXPECT_EQ(s.messages(),
              R"(part.scn:2:8: error: ball has no field `radus`; did you mean `radius`? [unknown-field]
    2 | ball { radus = 2 }
      |        ^~~~~
      |        radius
room.scn:1:8: note: in the file that is imported here
a.scn:1:8: note: in the file that is imported here
part.scn:3:17: error: radius is 0; a radius is greater than 0 [value-out-of-range]
    3 | ball { radius = r }
      |                 ^
room.scn:1:8: note: in the file that is imported here
a.scn:1:8: note: in the file that is imported here
)");
}

TEST(Import, OneMistakeInAFileImportedTwiceIsOneMessage) {
    const Scene s = scene("import \"part.scn\" as a\nimport \"part.scn\" as b\na.scene\nb.scene", {},
                          {{"part.scn", "ball { radius = true }"}});
    EXPECT_EQ(s.messages(), R"(part.scn:1:17: error: `radius` takes a number, this is a bool [type-mismatch]
    1 | ball { radius = true }
      |                 ^~~~
a.scn:1:8: note: in the file that is imported here
a.scn:2:8: note: and here
)");
}

TEST(Import, ACycleIsPrinted) {
    const Scene s =
        scene("import \"b.scn\" as b\nb.scene", {},
              {{"b.scn", "import \"c.scn\" as c\nc.scene"}, {"c.scn", "import \"b.scn\" as b\nb.scene"}});
    EXPECT_EQ(s.messages(), R"(c.scn:1:8: error: `b.scn` imports itself [cyclic-import]
    1 | import "b.scn" as b
      |        ^~~~~~~
b.scn:1:8: note: `b.scn` imports `c.scn` here
c.scn:1:8: note: `c.scn` imports `b.scn` here
b.scn:1:8: note: in the file that is imported here
a.scn:1:8: note: in the file that is imported here
)");
}

TEST(Import, AValueThatNeedsItselfByWayOfAFileIsACycle) {
    EXPECT_EQ(scene("import \"studio.scn\" as s with { power = a }\nlet a = s.power\nprint(a)").summary(),
              "1 cyclic-definition\n");
}

TEST(Import, FilesThatMultiplyAreStopped) {
    MemoryImporter::Files many{{"0.scn", "ball { }"}};
    std::string text;
    for (int i = 1; i < 14; ++i) { // 3^13 files
        many[fmt::format("{}.scn", i)] =
            fmt::format("import \"{0}.scn\" as a\nimport \"{0}.scn\" as b\nimport \"{0}.scn\" as c\n"
                        "a.scene\nb.scene\nc.scene",
                        i - 1);
    }
    EXPECT_EQ(row(scene("import \"13.scn\" as s\ns.scene", {}, many).diagnostics.sorted().at(0).kind).name,
              "too-many-imports");
    for (int i = 1; i < 50; ++i) {
        many[fmt::format("{}.scn", i)] = fmt::format("import \"{}.scn\" as a\na.scene", i - 1);
    }
    EXPECT_EQ(row(scene("import \"49.scn\" as s\ns.scene", {}, many).diagnostics.sorted().at(0).kind).name,
              "nesting-too-deep");
}

TEST(Import, AssertsAndPrintsOfTheFileAreDoneOnce) {
    EXPECT_EQ(prints_of(scene("import \"part.scn\" as p\np.scene\np.scene\nprint(2)", {},
                              {{"part.scn", "print(1)\nball { }"}})),
              "1\n2\n");
    EXPECT_EQ(scene("import \"part.scn\" as p with { n = 3 }\np.scene", {},
                    {{"part.scn", "param n: number = 1\nassert(n < 2, \"n is small\")\nball { }"}})
                  .diagnostics.error_count(),
              1u);
}

TEST(Import, ASceneOfShapesStandsInAGroup) {
    const MemoryImporter::Files part{{"part.scn", "ball { }\nball { }"}};
    const Scene s = scene("import \"part.scn\" as part\npile { part.scene }", {}, part);
    EXPECT_EQ(s.messages(), "");
    EXPECT_EQ(shape_of(s.module.items), "pile(pile part(ball, ball))");
    EXPECT_EQ(scene("import \"studio.scn\" as s\npile { s.scene }").messages(),
              R"(a.scn:2:8: error: `pile` takes shapes, this is a scene with a light [unexpected-item]
    2 | pile { s.scene }
      |        ^~~~~~~
a.scn:2:8: note: the first of 3 such values
)");
    EXPECT_EQ(scene("import \"studio.scn\" as s\nball { s.scene }").summary(), "2 unexpected-item\n");
}

TEST(Import, LengthsCountInTheFilesOwnUnit) {
    const MemoryImporter::Files parts{
        {"cm.scn", "world { unit = \"cm\" }\nlet r = 25mm\nball { radius = r }"},
        {"any.scn", "let r = 25mm\nball { radius = r }"}};
    EXPECT_EQ(prints_of(scene("world { unit = \"mm\" }\nimport \"any.scn\" as a\nprint(a.r)", {}, parts)),
              "25\n");
    EXPECT_EQ(
        prints_of(scene("import \"cm.scn\" as c\nprint(c.r)", {}, parts)),
        R"(a.scn:1:8: warning: "cm.scn" counts in cm, this file in m; a group with `transform = scale(0.01)` fits its shapes [unit-differs]
    1 | import "cm.scn" as c
      |        ^~~~~~~~
2.5
)");
}

TEST(Import, ParamsAreListedUnderTheNameOfTheImport) {
    const Scene s =
        scene("param own: number = 1\nprint(own)\nimport \"nested.scn\" as n with { p = 9 }\nn.scene");
    EXPECT_EQ(s.messages(), "");
    std::string text;
    for (const Param& param : s.module.params) {
        text +=
            fmt::format("{} = {} ({})\n", param.name, to_string(param.value), to_string(param.default_value));
    }
    EXPECT_EQ(text, "own = 1 (1)\nn.p = 9 (3)\nn.inner.power = 5 (2)\nn.inner.size = 1 (1)\n"
                    "n.inner.tone = rgb(1, 1, 1) (rgb(1, 1, 1))\n");
    std::set<std::string> paths;
    for (const FileId file : s.module.imports) {
        paths.insert(s.sources.file(file).path());
    }
    EXPECT_EQ(paths, (std::set<std::string>{"nested.scn", "studio.scn"}));
}

TEST(Import, NamesOfAFileCountAsUsedButImportsDoNot) {
    EXPECT_EQ(scene("import \"part.scn\" as p\nprint(p.a)", {},
                    {{"part.scn", "let a = 1\nlet b = 2\nparam c: number = 3\nimport \"studio.scn\" as s"}})
                  .messages(),
              R"(part.scn:4:24: warning: the import `s` is never used [unused-import]
    4 | import "studio.scn" as s
      |                        ^
a.scn:1:8: note: in the file that is imported here
)");
}

TEST(Import, WithoutAnImporterThereAreNoFiles) {
    EXPECT_EQ(test::messages_of(
                  "import \"b.scn\" as b with { k = c }\nlet c = 1\nb.scene\nprint(b.x)\nprint(b.f(1))"),
              R"(a.scn:1:8: error: cannot read `b.scn`: there are no files here [unreadable-import]
    1 | import "b.scn" as b with { k = c }
      |        ^~~~~~~
)");
}

} // namespace
} // namespace scc::lang
