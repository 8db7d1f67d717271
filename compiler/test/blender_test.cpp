#include "compiler/backends/blender.h"
#include "compiler/backends/blender_function.h"
#include "compiler/backends/blender_library.h"
#include "compiler/backends/blender_mesh.h"
#include "compiler/backends/blender_needs.h"
#include "compiler/test/folder.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scc::compiler {
namespace {

constexpr std::string_view view = "perspective_camera { eye = (0, 1, 6), target = (0, 1, 0) }\n";
constexpr std::string_view lamp = "point_light { position = (2, 5, 4), attenuation = (1, 0.1, 0) }\n";
constexpr std::string_view mirror = "let mirror = phong { reflect = rgb(0.5, 0.5, 0.5) }\n";
constexpr std::string_view checker = "fn checker(s: surface) -> color = if ((floor(s.p.x) + floor(s.p.z)) % "
                                     "2 == 0) rgb(1, 1, 1) else rgb(0, 0, 0)\n";

ir::Scene scene_of(const std::string& text) {
    test::Compiled c = test::compile(std::string(view) + text);
    EXPECT_TRUE(c.fine) << c.messages;
    return c.scene;
}

std::string script_of(const ir::Scene& scene) {
    Ledger ledger;
    return emit_blender(scene, ledger);
}
std::string script_of(const std::string& text) {
    return script_of(scene_of(text));
}

int bounces_of(const std::string& text) {
    return blender_needs(scene_of(std::string(mirror) + text)).bounces;
}

const LedgerEntry* find(const Ledger& ledger, std::string_view feature) {
    const auto found =
        std::find_if(ledger.begin(), ledger.end(), [&](const auto& e) { return e.feature == feature; });
    return found == ledger.end() ? nullptr : &*found;
}

std::string rich_scene() {
    return std::string(lamp) + std::string(mirror) + std::string(checker) + R"(
directional_light { direction = (-1, -2, -1), color = rgb(0.3, 0.3, 0.35) }
let shiny = phong { diffuse = checker, specular = rgb(1, 1, 1), emission = rgb(0.1, 0, 0) }
sphere { material = two_sided { front = mirror, back = shiny }, transform = scale(1, 2, 1) then rotate_x(20deg) }
cylinder { material = shiny }
cylinder { caps = false, material = mirror }
cone { material = shiny }
cone { radius_to = 0.5, caps = false, material = mirror }
box { material = shiny }
disc { hole = 0.5 }
triangle { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], normals = [(0, 0, 1), (0, 1, 1), (1, 0, 1)] }
plane { material = shiny }
)";
}

TEST(BlenderLibrary, KeepsWhatOneOfTheFeaturesAsksFor) {
    const std::string_view text = "a\n#: x y\nb\n    #: z\n    c\n    #: end\nd\n#: end\ne\n";
    EXPECT_EQ(select_features(text, {}), "a\ne\n");
    EXPECT_EQ(select_features(text, {"y"}), "a\nb\nd\ne\n");
    EXPECT_EQ(select_features(text, {"x", "z"}), "a\nb\n    c\nd\ne\n");
    EXPECT_EQ(select_features(text, {"z"}), "a\ne\n");
}

TEST(Blender, LeavesOutWhatTheSceneDoesNotNeed) {
    const std::string script = script_of("box { }\n" + std::string(lamp));
    for (const char* absent :
         {"sphere", "cylinder", "cone", "taper", "plane_", "disc", "triangle", "Glossy", "Translucent", "SUN",
          "curved", "FUNCTIONS", "select", "MESHES", "base64", "circle", "#:"}) {
        EXPECT_EQ(script.find(absent), std::string::npos) << absent;
    }
    EXPECT_NE(script.find("def box_mesh"), std::string::npos);
}

TEST(Blender, WritesOnlyMaterialsInUse) {
    const std::string script =
        script_of("let red = phong { }\nlet unused = phong { diffuse = rgb(1, 0, 0) }\n"
                  "box { material = red }\n" +
                  std::string(lamp));
    EXPECT_NE(script.find("\"red\": dict("), std::string::npos);
    EXPECT_EQ(script.find("unused"), std::string::npos);
}

TEST(BlenderBounces, AreNoMoreThanCanBeSeen) {
    EXPECT_EQ(bounces_of("box { }"), 0);
    EXPECT_EQ(bounces_of("box { min = (-9, -9, -9), max = (9, 9, 9), material = mirror }"), 5)
        << "seen from inside";
    EXPECT_EQ(bounces_of("box { material = mirror }"), 1)
        << "a ray that leaves a convex mirror does not return";
    EXPECT_EQ(
        bounces_of("cylinder { caps = false, material = two_sided { front = mirror, back = phong { } } }"),
        1);
    EXPECT_EQ(bounces_of("cylinder { caps = false, material = mirror }"), 5) << "the inside reflects itself";
    EXPECT_EQ(bounces_of("cone { material = mirror }"), 1);
    EXPECT_EQ(bounces_of("cone { caps = false, material = mirror }"), 5);
    EXPECT_EQ(bounces_of("box { material = mirror }\nplane { offset = -2, material = mirror }"), 5);
    EXPECT_EQ(
        bounces_of("box { material = mirror }\nbox { min = (3, 0, 0), max = (4, 1, 1), material = mirror }\n"
                   "render { method = ray { depth = 0 } }"),
        0);
}

TEST(BlenderBounces, EndWhereNothingArrivesAnyMore) {
    ir::Scene scene =
        scene_of(std::string(mirror) + "box { material = mirror }\nplane { offset = -2, material = mirror }");
    scene.settings.depth = 500;
    const BlenderNeeds needs = blender_needs(scene);
    EXPECT_EQ(needs.bounces, 27) << "0.5^27 < 1e-8";
    EXPECT_NEAR(needs.cut_off, std::pow(0.5, 28), 1e-12);
    Ledger ledger;
    emit_blender(scene, ledger);
    ASSERT_NE(find(ledger, "depth"), nullptr);
    EXPECT_EQ(find(ledger, "depth")->fidelity, Fidelity::approximated);
}

TEST(BlenderPaths, FollowWhatCountsMost) {
    const auto paths = [](const std::string& shapes) {
        return blender_paths(scene_of(shapes + "\nrender { method = ray { depth = 4 } }")).paths;
    };
    const std::string pane = "box { material = phong { transmit = rgb(0.5, 0.5, 0.5) } }";
    // Light that has left the only body meets no other.
    EXPECT_EQ(paths(pane), (std::vector<std::string>{"", "T", "TT"}));
    const std::vector<std::string> ball = paths("sphere { material = glass { } }");
    for (const char* const path : {"", "T", "R", "TT", "TRT", "TRRT"}) {
        EXPECT_NE(std::find(ball.begin(), ball.end(), path), ball.end()) << path;
    }
    EXPECT_EQ(std::find(ball.begin(), ball.end(), "TTT"), ball.end());
    EXPECT_EQ(std::find(ball.begin(), ball.end(), "TRRRT"), ball.end()) << "each takes a bounce";
    const std::vector<std::string> two = paths(pane + "\n" + pane);
    EXPECT_NE(std::find(two.begin(), two.end(), "TTTT"), two.end());
    EXPECT_LE(paths("sphere { material = glass { } }\nbox { material = glass { } }").size(), 100U);
}

TEST(BlenderPaths, KnowWhatLiesInWhat) {
    const std::string water = "let water = phong { transmit = rgb(1, 1, 1), ior = 1.33 }\n"
                              "let air = phong { transmit = rgb(1, 1, 1) }\n";
    const auto inside = blender_paths(scene_of(
        water +
        "sphere { name = \"drop\", material = water }\n"
        "sphere { name = \"bubble\", radius = 0.5, material = air }\n"
        "group { name = \"tank\", transform = rotate_y(30deg) then translate(5, 0, 0)\n"
        "  box { name = \"glass\", material = glass { ior = 1.5 } }\n"
        "  box { name = \"water\", min = (-0.9, -0.9, -0.9), max = (0.9, 0.9, 0.9), material = water }\n"
        "  sphere { name = \"ice\", radius = 0.5, material = phong { transmit = rgb(1, 1, 1), ior = 1.31 } "
        "}\n"
        "}\n"));
    EXPECT_EQ(inside.obstacle, "");
    EXPECT_EQ(inside.outside,
              (std::map<std::string, double>{{"bubble", 1.33}, {"tank/water", 1.5}, {"tank/ice", 1.33}}));
    const auto obstacle = [&](const std::string& shapes) {
        return blender_paths(scene_of(water + shapes)).obstacle;
    };
    EXPECT_EQ(
        obstacle("sphere { material = water }\nbox { min = (0, 0, 0), max = (2, 2, 2), material = water }"),
        "`sphere` and `box` may overlap");
    EXPECT_EQ(obstacle("disc { material = water }"), "`disc` bends rays and encloses nothing");
    EXPECT_EQ(obstacle("sphere { material = air }\nbox { material = air }"), "");
    EXPECT_EQ(obstacle("sphere { material = water }\nsphere { center = (1.5, 1.5, 0), material = water }"),
              "");
}

TEST(BlenderLedger, TellsHowEachFeatureGoesOver) {
    Ledger ledger;
    const ir::Scene scene = scene_of(rich_scene());
    emit_blender(scene, ledger);
    for (const auto& [feature, fidelity] : {std::pair{"sphere", Fidelity::approximated},
                                            {"cylinder", Fidelity::approximated},
                                            {"cone", Fidelity::approximated},
                                            {"box", Fidelity::exact},
                                            {"plane", Fidelity::approximated},
                                            {"triangle", Fidelity::exact},
                                            {"transform", Fidelity::exact},
                                            {"two_sided", Fidelity::exact},
                                            {"point_light", Fidelity::exact},
                                            {"attenuation", Fidelity::exact},
                                            {"reflect", Fidelity::exact},
                                            {"per-point diffuse", Fidelity::approximated},
                                            {"perspective_camera", Fidelity::exact},
                                            {"shadows", Fidelity::exact}}) {
        const LedgerEntry* entry = find(ledger, feature);
        ASSERT_NE(entry, nullptr) << feature;
        EXPECT_EQ(entry->fidelity, fidelity) << feature;
        EXPECT_FALSE(entry->how.empty()) << feature;
        EXPECT_EQ(entry->fidelity == Fidelity::approximated, entry->bound > 0) << feature;
    }
    EXPECT_EQ(find(ledger, "sphere")->span, scene.objects[0].span);
}

constexpr std::string_view solids = R"(
implicit { name = "egg", field = fn(p: vec3) = dot(p, p) - 0.5 + 0.1 * p.y, within = sphere { } }
difference {
  name = "cut"
  material = phong { diffuse = rgb(1, 0, 0) }
  box { }
  sphere { center = (1, 1, 1), material = phong { diffuse = rgb(0, 1, 0) } }
  cone { radius_from = 0.5, material = two_sided { front = phong { }, back = phong { diffuse = rgb(0, 0, 1) } } }
}
)";

TEST(BlenderSolids, AreMeshesWithAFaceForEachFormulaAndMaterial) {
    const ir::Scene scene = scene_of(std::string(lamp) + std::string(solids));
    Ledger ledger;
    const std::string script = emit_blender(scene, ledger);
    for (const char* feature : {"implicit", "difference"}) {
        ASSERT_NE(find(ledger, feature), nullptr);
        EXPECT_EQ(find(ledger, feature)->fidelity, Fidelity::approximated);
        EXPECT_TRUE(find(ledger, feature)->is_refined_mesh);
        EXPECT_GT(find(ledger, feature)->bound, 0);
        EXPECT_LT(find(ledger, feature)->bound, 0.01);
    }
    EXPECT_NE(find(ledger, "two_sided"), nullptr);
    const BlenderSolids made = blender_solids(scene);
    ASSERT_EQ(made.size(), 2U);
    EXPECT_EQ(made.at("egg").faces.size(), 1U); // all inside the container
    EXPECT_EQ(made.at("egg").faces[0].formula, BlenderFace::Formula::field);
    EXPECT_EQ(made.at("cut").faces.size(), 4U); // the box's, the sphere's, the cone's and its base
    EXPECT_EQ(std::count_if(made.at("cut").faces.begin(), made.at("cut").faces.end(),
                            [](const BlenderFace& face) { return face.inverted; }),
              2);
    EXPECT_NE(script.find("def field_"), std::string::npos);
    EXPECT_NE(script.find("kind=\"round\", radius=(0.5, -0.5)"), std::string::npos);
    EXPECT_EQ(script.find("def sphere_hit"), std::string::npos) << "what is not needed is left out";
}

TEST(BlenderSolids, HaveFormulasOfRingsAndQuadrics) {
    const ir::Scene scene = scene_of(std::string(lamp) + R"(
quadric { name = "egg", squares = (2, 3, 4), linear = (0.5, 0, 0), transform = scale(2) }
intersection { name = "cut", torus { major = 0.8, minor = 0.2 }, box { } }
quadric { name = "endless", squares = (1, 0, 1) }
)");
    const BlenderSolids made = blender_solids(scene);
    ASSERT_EQ(made.size(), 2U);
    ASSERT_EQ(made.at("egg").faces.size(), 1U);
    EXPECT_EQ(made.at("egg").faces[0].formula, BlenderFace::Formula::quadric);
    EXPECT_EQ(made.at("egg").faces[0].quadric.squares.z, 4);
    EXPECT_EQ(made.at("egg").faces[0].quadric.linear.x, 0.5);
    EXPECT_EQ(made.at("cut").faces[0].formula, BlenderFace::Formula::ring);
    Ledger ledger;
    const std::string script = emit_blender(scene, ledger);
    EXPECT_NE(script.find("kind=\"ring\", radius=(0.8, 0.2)"), std::string::npos);
    EXPECT_NE(script.find("squares=(2.0, 3.0, 4.0), products=(0.0, 0.0, 0.0), linear=(0.5, 0.0, 0.0)"),
              std::string::npos);
    const auto dropped = std::find_if(ledger.begin(), ledger.end(),
                                      [](const auto& e) { return e.fidelity == Fidelity::dropped; });
    ASSERT_NE(dropped, ledger.end());
    EXPECT_EQ(dropped->subject, "endless");
}

TEST(BlenderSolids, AreMadeByBlenderWhereMeshesAreInThem) {
    ir::Scene scene = scene_of(std::string(lamp) + R"(
difference {
  name = "cut"
  box { transform = scale(-2, 1, 1) }
  union { sphere { center = (1, 0, 0) }, torus { } }
  intersection { box { transform = scale(0.5) }, plane { } }
}
)");
    scene.meshes.push_back(ir::make_mesh(
        "tetrahedron",
        {{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {}, {}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, {}, {}}));
    for (ir::Object& member : scene.members) {
        if (std::holds_alternative<runtime::Box<double>>(member.shape)) {
            member.shape = runtime::Mesh<double>{0};
        }
    }
    derive_traits(scene);
    const BlenderSolids made = blender_solids(scene);
    const BlenderSolid& base = made.at("cut");
    EXPECT_TRUE(base.is_part);
    EXPECT_EQ(base.slots.size(), 4U);
    EXPECT_EQ(std::vector(base.mesh.indices.begin(), base.mesh.indices.begin() + 3),
              (std::vector<std::uint32_t>{0, 1, 2}))
        << "a mirrored mesh is turned over";
    ASSERT_EQ(base.cuts.size(), 2U); // the union has no meshes and is one
    EXPECT_EQ(base.cuts[0].op, runtime::CsgOp::subtract);
    EXPECT_TRUE(base.cuts[0].solid.cuts.empty());
    for (const BlenderFace& face : base.cuts[0].solid.faces) {
        EXPECT_TRUE(face.inverted);
    }
    const BlenderSolid& other = base.cuts[1].solid;
    ASSERT_EQ(other.cuts.size(), 1U);
    EXPECT_EQ(other.cuts[0].op, runtime::CsgOp::intersect);
    EXPECT_GT(other.cuts[0].solid.slots.size(), 4U) << "half of space has an end there";
    const std::string script = script_of(scene);
    EXPECT_NE(script.find("cuts=[(\"DIFFERENCE\", dict(type=\"solid\", name=\"cut part 2\""),
              std::string::npos);
    EXPECT_NE(script.find("(\"INTERSECT\", dict(type=\"solid\", name=\"cut part 4\""), std::string::npos);
    EXPECT_EQ(script.find("normals_split_custom_set(normals"),
              script.rfind("normals_split_custom_set(normals"));
}

TEST(BlenderSolids, ComeAsTheMeshIsWhereNodesCannotCalculateTheField) {
    std::string field = "dot(p, p) - 0.5";
    for (int i = 0; i < 60; ++i) {
        field += " + 1e-4 * sin(p.x * " + std::to_string(i) + ".5)";
    }
    const ir::Scene scene = scene_of("implicit { field = fn(p: vec3) = " + field + ", within = sphere { } }");
    const BlenderSolids made = blender_solids(scene);
    ASSERT_EQ(made.begin()->second.faces.size(), 1U);
    EXPECT_EQ(made.begin()->second.faces[0].formula, BlenderFace::Formula::none);
}

ir::Function function_of(ir::Op op, int operands) {
    ir::Function f;
    f.name = "f";
    for (int i = 0; i < operands; ++i) {
        f.nodes.push_back({.kind = ir::Node::Kind::input, .input = static_cast<ir::Input>(i)});
    }
    f.nodes.push_back({.kind = ir::Node::Kind::apply, .op = op, .operands = {0, 1, 2}});
    f.results = {static_cast<std::uint32_t>(operands)};
    return f;
}

std::string written(const ir::Function& function) {
    Writer out;
    write_function(out, function, "f", {});
    return out.take();
}

TEST(BlenderFunction, ComposesWhatMathNodesLack) {
    EXPECT_EQ(
        written(function_of(ir::Op::mod, 2)),
        "def f(g, p) -> \"Float\":\n"
        "    t2 = g.f(\"SUBTRACT\", p.x, g.f(\"MULTIPLY\", p.y, g.f(\"FLOOR\", g.f(\"DIVIDE\", p.x, p.y))))\n"
        "    return t2\n");
    EXPECT_NE(
        written(function_of(ir::Op::le, 2)).find("g.f(\"SUBTRACT\", 1.0, g.f(\"GREATER_THAN\", p.x, p.y))"),
        std::string::npos);
    EXPECT_NE(written(function_of(ir::Op::select, 3)).find("g.f(\"GREATER_THAN\", p.x, 0.0)), p.y, p.z)"),
              std::string::npos);
}

TEST(BlenderFunction, TakesEveryOperator) {
    const ir::Op all[] = {
#define SCC_OPERATOR(name, arity, value, cpp, sdl, blender) ir::Op::name,
#include "runtime/operators.def"
#undef SCC_OPERATOR
    };
    for (const ir::Op op : all) {
        const std::string text = written(function_of(op, row(op).arity));
        EXPECT_NE(text.find(" = g."), std::string::npos) << row(op).name;
    }
}

TEST(BlenderFunction, LooksAllChannelsOfAnImageUpAtOnce) {
    ir::Function f = function_of(ir::Op::sin, 1);
    for (std::uint8_t channel = 0; channel < 3; ++channel) {
        f.nodes.push_back({.kind = ir::Node::Kind::image, .channel = channel, .operands = {0, 1, 0}});
    }
    f.results = {2, 3, 4};
    Writer out;
    write_function(out, f, "f", {"wood"});
    EXPECT_EQ(out.take(), "def f(g, p) -> \"Color\":\n"
                          "    t1 = g.f(\"SINE\", p.x)\n"
                          "    i0 = g.image(\"wood\", p.x, t1)\n"
                          "    return i0.x, i0.y, i0.z\n");
}

TEST(BlenderFunction, LeavesOutNodesWithoutUse) {
    ir::Function f = function_of(ir::Op::sin, 1);
    f.results = {0};
    EXPECT_EQ(written(f), "def f(g, p) -> \"Float\":\n    return p.x\n");
}

TEST(BlenderMesh, EncodesByRfc4648) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(BlenderMesh, ListsSmallArraysAndPacksLargeOnes) {
    ir::MeshArrays mesh;
    mesh.positions = {0.1F, 2, -3};
    mesh.indices.assign(150, 0);
    mesh.indices[1] = 258;
    Writer out;
    write_mesh(out, ir::make_mesh("m", mesh), false);
    EXPECT_NE(out.text().find("points=[0.1, 2.0, -3.0]"), std::string::npos) << out.text();
    EXPECT_NE(out.text().find("indices=unpacked(\"<u2\", \"\"\"\n    AAACAQ"), std::string::npos)
        << out.text();
}

constexpr std::string_view hostile = "\"\"\"'''\\\n\"); import os; os.abort() #\t\x01";

ir::Scene hostile_scene() {
    ir::Scene scene = scene_of(rich_scene());
    scene.name = hostile;
    const auto spoil = [&](auto& things, auto member) {
        for (std::size_t i = 0; i < things.size(); ++i) {
            things[i].*member =
                std::string(hostile) + std::to_string(i) + (i == 0 ? std::string(100, 'x') : "\xc3\xa9");
        }
    };
    spoil(scene.materials, &ir::Material::name);
    spoil(scene.objects, &ir::Object::path);
    spoil(scene.lights, &ir::Light::name);
    spoil(scene.functions, &ir::Function::name);
    return scene;
}

TEST(BlenderScript, IsPythonWhateverTheNames) {
    using test::run, test::save;
    if (!test::has_program("python3")) {
        GTEST_SKIP() << "python3 is not installed";
    }
    const test::Folder folder;
    save(folder / "rich.py", script_of(rich_scene()));
    save(folder / "hostile.py", script_of(hostile_scene()));
    save(folder / "solids.py", script_of(std::string(solids)));
    save(folder / "empty.py", script_of("render { size = (8, 8) }"));
    for (const char* name : {"rich.py", "hostile.py", "solids.py", "empty.py"}) {
        EXPECT_EQ(run("python3 -m py_compile " + (folder / name).string()), 0) << name;
    }
    // Reads the names back from the syntax tree: they are constants, and those of the scene.
    save(folder / "names.py", R"(
import ast, sys
tree = ast.parse(open(sys.argv[1]).read())
table = {t.targets[0].id: t.value for t in tree.body if isinstance(t, ast.Assign) and hasattr(t.targets[0], "id")}
hostile = "\"\"\"'''\\\n\"); import os; os.abort() #\t\x01"
assert ast.literal_eval(table["NAME"]) == hostile
assert any(isinstance(k, ast.Constant) and k.value.startswith(hostile + "0") for k in table["LIGHTS"].keys)
assert not any(isinstance(node, ast.Attribute) and node.attr == "abort" for node in ast.walk(tree))
)");
    EXPECT_EQ(run("python3 " + (folder / "names.py").string() + " " + (folder / "hostile.py").string()), 0);
}

} // namespace
} // namespace scc::compiler
