#include "compiler/backends/function_program.h"
#include "compiler/coincident_faces.h"
#include "compiler/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/shape_rules.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace scc::compiler {
namespace {

using test::compile;
using test::compile_shapes;
using test::Compiled;

TEST(Lower, TransformOfAGroupActsAfterTheChilds) {
    const Compiled c = compile_shapes("group { transform = translate(1, 0, 0)\n"
                                      "sphere { transform = scale(2, 2, 2) } }");
    ASSERT_TRUE(c.fine) << c.messages;
    ASSERT_EQ(c.scene.objects.size(), 1U);
    const auto& m = c.scene.objects[0].world_from_object.m;
    EXPECT_EQ(m[0][0], 2);
    EXPECT_EQ(m[0][3], 1);
}

TEST(Lower, ChildWithoutMaterialTakesTheNearestEnclosingOne) {
    const Compiled c = compile_shapes(
        "let red = phong { diffuse = rgb(1, 0, 0) }\nlet blue = phong { diffuse = rgb(0, 0, 1) }\n"
        "group { material = red\n sphere { }\n group { material = blue\n box { }\n disc { material = red } } "
        "}\n"
        "plane { }");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto name = [&](std::size_t i) { return c.scene.materials[c.scene.objects[i].sides.front].name; };
    EXPECT_EQ(name(0), "red");
    EXPECT_EQ(name(1), "blue");
    EXPECT_EQ(name(2), "red");
    EXPECT_EQ(name(3), "default");
    EXPECT_EQ(c.scene.materials[c.scene.objects[3].sides.front].phong.diffuse.value,
              (runtime::Rgb<double>{0.8, 0.8, 0.8}));
}

TEST(Lower, AmbientDefaultsToTheDiffuseValueEvenIfItIsAFunction) {
    const Compiled c =
        compile_shapes("sphere { material = phong { diffuse = fn(s: surface) = rgb(s.p.x, 0, 0) } }");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto& p = c.scene.materials[0].phong;
    EXPECT_GE(p.diffuse.function, 0);
    EXPECT_EQ(p.ambient.function, p.diffuse.function);
}

TEST(Lower, OpacityIsWorkedIntoTheOtherFields) {
    const Compiled c = compile_shapes(
        "sphere { material = phong { diffuse = rgb(0.5, 0.25, 1), specular = rgb(0.5, 0.5, 0.5), emission = "
        "rgb(0, 1, 0), reflect = rgb(0.5, 0.5, 0.5), transmit = rgb(0.5, 0, 0.25), opacity = 0.75, ior = 1.5 "
        "} }");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto& p = c.scene.materials[0].phong;
    EXPECT_EQ(p.diffuse.value, (runtime::Rgb<double>{0.375, 0.1875, 0.75}));
    EXPECT_EQ(p.ambient.value, p.diffuse.value);
    EXPECT_EQ(p.specular.value, (runtime::Rgb<double>{0.375, 0.375, 0.375}));
    EXPECT_EQ(p.emission.value, (runtime::Rgb<double>{0, 0.75, 0}));
    EXPECT_EQ(p.reflect.value, (runtime::Rgb<double>{0.5, 0.5, 0.5}));
    EXPECT_EQ(p.transmit.value, (runtime::Rgb<double>{0.75, 0.25, 0.5}));
    EXPECT_EQ(p.ior, 1.5);
    EXPECT_FALSE(p.fresnel);
}

/// The channels of a field at an object point.
runtime::Rgb<double> at(const Compiled& c, const runtime::Varying<runtime::Rgb<double>>& field,
                        const runtime::Vec3<double>& p) {
    if (field.function == runtime::no_function) {
        return field.value;
    }
    const auto program = program_of<double>(c.scene.functions[static_cast<std::size_t>(field.function)]);
    const double* v = runtime::run(program, runtime::SurfacePoint<double>{p, {}, {}});
    return {v[program.results[0]], v[program.results[1]], v[program.results[2]]};
}

TEST(Lower, OpacityMayBeAFunctionBesideOthers) {
    const Compiled c = compile_shapes("sphere { material = phong { diffuse = fn(s: surface) = rgb(s.p.x, "
                                      "0.5, 1), emission = rgb(0.5, 0, 0), "
                                      "transmit = rgb(0.25, 0, 0), opacity = fn(s: surface) = s.p.y } }");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto& p = c.scene.materials[0].phong;
    EXPECT_EQ(at(c, p.diffuse, {0.5, 0.25, 0}), (runtime::Rgb<double>{0.125, 0.125, 0.25}));
    EXPECT_EQ(at(c, p.emission, {0.5, 0.25, 0}), (runtime::Rgb<double>{0.125, 0, 0}));
    EXPECT_EQ(at(c, p.transmit, {0.5, 0.25, 0}), (runtime::Rgb<double>{1, 0.75, 0.75}));
    EXPECT_EQ(at(c, p.transmit, {0.5, 9, 0}), (runtime::Rgb<double>{0.25, 0, 0})) << "no more than opaque";
    EXPECT_EQ(at(c, p.transmit, {0.5, -9, 0}), (runtime::Rgb<double>{1.25, 1, 1}));
    EXPECT_EQ(p.specular.function, runtime::no_function) << "black stays black";
}

TEST(Lower, GlassIsADielectricWithoutAColorOfItsOwn) {
    Compiled c = compile_shapes("sphere { material = glass { tint = rgb(1, 0.5, 0.25) } }");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto& p = c.scene.materials[0].phong;
    EXPECT_EQ(p.diffuse.value, (runtime::Rgb<double>{}));
    EXPECT_EQ(p.ambient.value, (runtime::Rgb<double>{}));
    EXPECT_EQ(p.reflect.value, (runtime::Rgb<double>{1, 1, 1}));
    EXPECT_EQ(p.transmit.value, (runtime::Rgb<double>{1, 0.5, 0.25}));
    EXPECT_EQ(p.ior, 1.5);
    EXPECT_TRUE(p.fresnel);
    run_passes(c.scene);
    EXPECT_TRUE(c.scene.traits.transmission);
    EXPECT_TRUE(c.scene.traits.refraction);
    Compiled pane = compile_shapes("disc { material = phong { opacity = 0.5 } }");
    run_passes(pane.scene);
    EXPECT_TRUE(pane.scene.traits.transmission);
    EXPECT_FALSE(pane.scene.traits.refraction);
}

TEST(Lower, FunctionThatDoesNotDependOnThePointBecomesAConstant) {
    const Compiled c =
        compile_shapes("sphere { material = phong { diffuse = fn(s: surface) = rgb(0.25, 0.5, 1) } }");
    ASSERT_TRUE(c.fine) << c.messages;
    EXPECT_TRUE(c.scene.functions.empty());
    EXPECT_EQ(c.scene.materials[0].phong.diffuse.value, (runtime::Rgb<double>{0.25, 0.5, 1}));
}

TEST(Lower, PathsAreUniqueAndNumberedOnlyWhereSiblingsShareAName) {
    const Compiled c = compile_shapes("let leg = cylinder { radius = 0.1 }\n"
                                      "group { name = \"table\"\n leg\n leg\n box { } }\nsphere { name = "
                                      "\"a/b\" }\ngroup { name = \"a\"\n sphere { name = \"b\" } }");
    ASSERT_TRUE(c.fine) << c.messages;
    std::vector<std::string> paths;
    for (const ir::Object& object : c.scene.objects) {
        paths.push_back(object.path);
    }
    EXPECT_EQ(paths, (std::vector<std::string>{"table/leg[0]", "table/leg[1]", "table/box", "a/b", "a/b 2"}));
}

TEST(Lower, CameraFrameFollowsTheLecture) {
    const Compiled c = compile("perspective_camera { eye = (0, 0, 10), target = (0, 0, 0), fov_y = 90deg "
                               "}\npoint_light { }\nsphere { }");
    ASSERT_TRUE(c.fine) << c.messages;
    EXPECT_EQ(c.scene.camera.n, (runtime::Vec3<double>{0, 0, 1}));
    EXPECT_EQ(c.scene.camera.u, (runtime::Vec3<double>{1, 0, 0}));
    EXPECT_EQ(c.scene.camera.v, (runtime::Vec3<double>{0, 1, 0}));
    EXPECT_NEAR(c.scene.camera.half_height, 1, 1e-15);
}

TEST(Lower, SceneWithoutCameraAndLightGetsBothAndIsToldSo) {
    const Compiled c = compile("sphere { center = (5, 0, 0) }");
    ASSERT_TRUE(c.fine);
    EXPECT_NE(c.messages.find("[no-camera]"), std::string::npos) << c.messages;
    EXPECT_NE(c.messages.find("[no-light]"), std::string::npos) << c.messages;
    ASSERT_EQ(c.scene.lights.size(), 1U);
    // The sphere's centre lies on the line of sight.
    const auto to_center = runtime::Vec3<double>{5, 0, 0} - c.scene.camera.eye;
    EXPECT_NEAR(dot(to_center, c.scene.camera.u), 0, 1e-9);
    EXPECT_NEAR(dot(to_center, c.scene.camera.v), 0, 1e-9);
}

TEST(Lower, LightSaysWhereItIsInOneWay) {
    const Compiled both =
        compile("directional_light { direction = (0, -1, 0), towards = (0, 1, 0) }\nperspective_camera { }");
    EXPECT_EQ(both.messages, "test.scn:1:1: error: this light has both `direction` and `towards`; one of "
                             "them says where it is [impossible-light]\n"
                             "    1 | directional_light { direction = (0, -1, 0), towards = (0, 1, 0) }\n"
                             "      | ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\n");
    EXPECT_FALSE(compile("directional_light { }\nperspective_camera { }").fine);
}

/// The radiance of a white surface d away, with the light above it, is power / (4 pi) / d^2 / pi.
TEST(Lower, PowerIsOfALampThatShinesInAllDirections) {
    const Compiled c =
        compile("sphere { }\nperspective_camera { }\n"
                "point_light { position = (0, 5, 0), power = 100, color = rgb(1, 0.5, 0), specular = "
                "rgb(0, 0, 2) }\n");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto& light = std::get<runtime::PointLight<double>>(c.scene.lights.at(0).light);
    EXPECT_NEAR(light.diffuse.r, 100 / 39.478417604357434, 1e-13);
    EXPECT_NEAR(light.diffuse.g, 50 / 39.478417604357434, 1e-13);
    EXPECT_NEAR(light.specular.b, 200 / 39.478417604357434, 1e-13);
    EXPECT_EQ(light.kc, 0);
    EXPECT_EQ(light.kl, 0);
    EXPECT_EQ(light.kq, 1);
    const Compiled both =
        compile("sphere { }\nperspective_camera { }\n"
                "point_light { position = (0, 5, 0), power = 100, attenuation = (1, 0, 0) }\n");
    EXPECT_NE(both.messages.find("this light has both `attenuation` and `power`, which falls off as 1 / d^2"),
              std::string::npos)
        << both.messages;
}

TEST(Lower, SpotLightsHaveAConeAndRectangleLightsAGrid) {
    const Compiled c = compile(
        "spot_light { position = (0, 4, 0), target = (0, 1, 0), inner = 0deg, outer = 60deg }\n"
        "rectangle_light { corner = (1, 2, 3), edge_u = (2, 0, 0), edge_v = (0, 0, 1), samples = (4, 2), "
        "color = rgb(8, 8, 8) }\nperspective_camera { }\nsphere { }");
    ASSERT_TRUE(c.fine) << c.messages;
    const auto& spot = std::get<runtime::SpotLight<double>>(c.scene.lights.at(0).light);
    EXPECT_EQ(spot.axis, (runtime::Vec3<double>{0, -1, 0}));
    EXPECT_EQ(spot.cos_inner, 1);
    EXPECT_NEAR(spot.cos_outer, 0.5, 1e-15);
    const auto& rectangle = std::get<runtime::RectangleLight<double>>(c.scene.lights.at(1).light);
    std::vector<runtime::PointLight<double>> points;
    for_each_point(rectangle, [&](const auto& point) { points.push_back(point); });
    ASSERT_EQ(points.size(), 8U);
    EXPECT_EQ(points[1].position, (runtime::Vec3<double>{1.75, 2, 3.25}));
    EXPECT_EQ(points[7].position, (runtime::Vec3<double>{2.75, 2, 3.75}));
    EXPECT_EQ(points[7].diffuse, (runtime::Rgb<double>{1, 1, 1}));
    for (const char* wrong :
         {"spot_light { position = (0, 4, 0), target = (0, 4, 0) }", "spot_light { position = (0, 4, 0) }",
          "spot_light { position = (0, 4, 0), target = (0, 0, 0), inner = 30deg }",
          "rectangle_light { corner = (0, 0, 0), edge_u = (1, 1, 0), edge_v = (2, 2, 0) }"}) {
        EXPECT_FALSE(compile(std::string(wrong) + "\nperspective_camera { }\nsphere { }").fine) << wrong;
    }
}

TEST(Lower, QuadricWithinAContainerIsTheirIntersection) {
    const Compiled c =
        compile_shapes("quadric { squares = (1, 0, 1), within = box { } }\n"
                       "difference {\n sphere { }\n quadric { within = sphere { radius = 0.5 } }\n}\n"
                       "for (i in 0..2) { quadric { constant = -1 - i, within = box { } } }\n"
                       "quadric { squares = (0, 0, 0), linear = (1, 0, 0) }");
    ASSERT_TRUE(c.fine) << c.messages;
    ASSERT_EQ(c.scene.objects.size(), 5U);
    EXPECT_EQ(c.scene.objects[0].path, "quadric[0]");
    ASSERT_TRUE(std::holds_alternative<runtime::Csg<double>>(c.scene.objects[0].shape));
    EXPECT_EQ(c.scene.csg_nodes.at(0).op, runtime::CsgOp::intersect);
    EXPECT_EQ(c.scene.members.at(0).path, "quadric[0]/surface");
    EXPECT_EQ(c.scene.members.at(1).path, "quadric[0]/within");
    EXPECT_TRUE(c.scene.csg_nodes.at(6).inverted) << "the difference takes it away";
    EXPECT_TRUE(std::holds_alternative<runtime::Quadric<double>>(c.scene.objects[4].shape));
    EXPECT_NE(compile_shapes("union { quadric { squares = (1, -1, 1) } }").messages.find("[unbounded-solid]"),
              std::string::npos);
    EXPECT_TRUE(compile_shapes("union { quadric { squares = (1, 2, 1) } }").fine)
        << "an ellipsoid has bounds";
}

TEST(Lower, HeightfieldIsAMeshOfItsCells) {
    const Compiled c = compile_shapes("let land = heightfield { field = fn(uv: vec2) = uv.x + 10 * uv.y, "
                                      "size = (4, 2), height = 0.5, cells = "
                                      "(2, 4) }\nland\ngroup { transform = translate(9, 0, 0)\n land }");
    ASSERT_TRUE(c.fine) << c.messages;
    ASSERT_EQ(c.scene.meshes.size(), 1U) << "one for both";
    const ir::Mesh& mesh = c.scene.meshes[0];
    EXPECT_EQ(mesh.name, "land");
    EXPECT_EQ(mesh.indices.size(), 3U * 2 * 2 * 4);
    EXPECT_EQ(mesh.positions.size(), 3U * 3 * 5);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        const float u = mesh.positions[i] / 4 + 0.5F, v = mesh.positions[i + 2] / 2 + 0.5F;
        EXPECT_FLOAT_EQ(mesh.positions[i + 1], 0.5F * (u + 10 * v));
        EXPECT_NEAR(mesh.normals[i] / mesh.normals[i + 1], -0.125, 1e-6);
        EXPECT_NEAR(mesh.normals[i + 2] / mesh.normals[i + 1], -2.5, 1e-6);
    }
    const auto corner = [&](std::size_t k) {
        const float* p = &mesh.positions[3 * mesh.indices[k]];
        return runtime::Vec3<double>{p[0], p[1], p[2]};
    };
    EXPECT_GT(cross(corner(1) - corner(0), corner(2) - corner(0)).y, 0) << "the front is above";
}

TEST(Lower, PolylineIsBallsAndTubes) {
    const Compiled c =
        compile_shapes("let red = phong { diffuse = rgb(1, 0, 0) }\n"
                       "polyline { points = [(0, 0, 0), (1, 0, 0), (1, 0, 0), (1, 1, 0)], radius = 0.1, "
                       "color = rgb(0, 1, 0), material = red }\n"
                       "difference {\n box { }\n polyline { points = [(0, 0, 0), (0, 2, 0)], radius = 0.1 "
                       "}\n}");
    ASSERT_TRUE(c.fine) << c.messages;
    std::vector<std::string> paths;
    for (const ir::Object& object : c.scene.objects) {
        paths.push_back(object.path);
    }
    EXPECT_EQ(paths, (std::vector<std::string>{"polyline/ball[0]", "polyline/tube[0]", "polyline/ball[1]",
                                               "polyline/tube[1]", "polyline/ball[2]", "difference"}));
    EXPECT_EQ(c.scene.materials.at(c.scene.objects[0].sides.front).phong.diffuse.value,
              (runtime::Rgb<double>{0, 1, 0}));
    EXPECT_EQ(c.scene.members.size(), 4U);
    EXPECT_TRUE(std::get<runtime::Cylinder<double>>(c.scene.members.at(2).shape).caps);
}

TEST(Lower, ReportsShapesThatEncloseNothing) {
    for (const char* shape :
         {"box { min = (0, 0, 0), max = (1, 0, 1) }", "cylinder { from = (1, 1, 1), to = (1, 1, 1) }",
          "cone { from = (1, 1, 1), to = (1, 1, 1) }", "cone { radius_from = 0 }",
          "disc { radius = 1, hole = 1 }", "triangle { points = [(0, 0, 0), (1, 1, 1), (2, 2, 2)] }",
          "triangle { points = [(0, 0, 0), (1, 1, 1)] }", "sphere { transform = scale(1, 1, 0) }",
          "torus { major = 1, minor = 1.01 }", "quadric { squares = (0, 0, 0) }",
          "quadric { within = plane { } }", "polyline { points = [(1, 2, 3), (1, 2, 3)], radius = 1 }",
          "polyline { points = [(0, 0, 0), (1, 1, 1)] }",
          "heightfield { field = fn(uv: vec2) = 1 / (uv.x - 0.5), cells = (2, 2) }",
          "difference {\n box { }\n heightfield { field = fn(uv: vec2) = 0 }\n}"}) {
        const Compiled c = compile_shapes(shape);
        EXPECT_FALSE(c.fine) << shape;
    }
    EXPECT_NE(compile_shapes("disc { radius = 1, hole = 2 }").messages.find("test.scn:1:1: error: "),
              std::string::npos);
}

TEST(Lower, SolidIsOneObjectWithItsMembersAside) {
    const Compiled c = compile_shapes("let red = phong { diffuse = rgb(1, 0, 0) }\n"
                                      "let blue = phong { diffuse = rgb(0, 0, 1) }\n"
                                      "sphere { }\n"
                                      "difference {\n name = \"part\", material = red\n"
                                      " box { }\n"
                                      " for (i in 0..2) { sphere { center = (i, 1, 0), radius = 0.5 } }\n"
                                      " difference { sphere { material = blue }, box { max = (3, 3, 3) } }\n"
                                      " transform = translate(0, 0, 4)\n}\n");
    ASSERT_TRUE(c.fine) << c.messages;
    ASSERT_EQ(c.scene.objects.size(), 2U);
    ASSERT_TRUE(std::holds_alternative<runtime::Csg<double>>(c.scene.objects[1].shape));
    EXPECT_EQ(c.scene.objects[1].path, "part");
    ASSERT_EQ(c.scene.members.size(), 5U);
    const char* paths[] = {"part/box", "part/sphere[0]", "part/sphere[1]", "part/difference/sphere",
                           "part/difference/box"};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(c.scene.members[i].path, paths[i]);
        EXPECT_EQ(c.scene.members[i].world_from_object.m[2][3], 4);
        EXPECT_EQ(c.scene.materials[c.scene.members[i].sides.front].name, i == 3 ? "blue" : "red");
    }
    std::string inverted;
    for (const ir::CsgNode& node : c.scene.csg_nodes) {
        inverted += node.op == runtime::CsgOp::member ? (node.inverted ? '-' : '+') : '(';
    }
    EXPECT_EQ(inverted, "(+--(-+");
    EXPECT_EQ(c.scene.csg_nodes[0].size, 7U);
}

TEST(Lower, EmptyOperandsOfASolidCountAsNothing) {
    const std::string none = "group { for (i in 0..0) { sphere { } } }";
    const auto parts = [&](const std::string& solid) {
        const Compiled c = compile_shapes(solid + "\nsphere { }");
        EXPECT_TRUE(c.fine) << c.messages;
        return c.scene.members.size();
    };
    EXPECT_EQ(parts("difference { box { }, " + none + " }"), 1U);
    EXPECT_EQ(parts("union { " + none + ", box { } }"), 1U);
    EXPECT_EQ(parts("difference { " + none + ", box { } }"), 0U);
    EXPECT_EQ(parts("intersection { box { }, " + none + " }"), 0U);
    EXPECT_EQ(parts("union { }"), 0U);
}

TEST(Lower, PlanesBoundASolidAlongTheAxes) {
    EXPECT_TRUE(compile_shapes("intersection { plane { }, plane { normal = (0, -1, 0), offset = 1 }, "
                               "cylinder { from = (0, -9, 0), to = (0, 9, 0) } }")
                    .fine);
    const Compiled slab =
        compile_shapes("intersection { plane { }, plane { normal = (0, -1, 0), offset = 1 } }");
    EXPECT_NE(slab.messages.find("[unbounded-solid]"), std::string::npos) << slab.messages;
}

TEST(Lower, WarnsOfFacesThatCoincideOnlyWhereTheyDo) {
    const auto warned = [](const std::string& solid) {
        const Compiled c = compile_shapes(solid);
        EXPECT_TRUE(c.fine) << c.messages;
        lang::Diagnostics diagnostics;
        check_coincident_faces(c.scene, diagnostics);
        return !diagnostics.sorted().empty();
    };
    const std::string block = "box { min = (-1, 0, -1), max = (1, 1, 1) }";
    EXPECT_TRUE(warned("difference { " + block + ", box { min = (0, 0, 0), max = (2, 0.5, 2) } }"));
    EXPECT_TRUE(warned("difference { " + block +
                       ", cone { from = (0, 0.5, 0), to = (0, 1, 0), "
                       "radius_from = 0, radius_to = 0.5 } }"));
    EXPECT_FALSE(warned("difference { " + block + ", plane { } }"));
    EXPECT_TRUE(warned("intersection { " + block + ", plane { offset = 1 } }"));
    // Beside each other, facing each other, and both taken away.
    EXPECT_FALSE(warned("difference { " + block + ", box { min = (2, 0, 0), max = (3, 0.5, 2) } }"));
    EXPECT_FALSE(warned("difference { " + block + ", box { min = (0, 1, 0), max = (2, 2, 2) } }"));
    EXPECT_FALSE(warned("difference { " + block +
                        ", box { min = (-0.5, -1, -0.5), max = (0, 2, 0.5) }, "
                        "box { min = (0, -1, -0.2), max = (0.5, 2, 0.5) } }"));
    EXPECT_FALSE(warned("union { " + block + ", box { min = (0, 0, 0), max = (2, 0.5, 2) } }"));
}

TEST(Lower, ReportsImpossibleCameras) {
    EXPECT_FALSE(compile("perspective_camera { eye = (1, 1, 1), target = (1, 1, 1) }\npoint_light { }").fine);
    EXPECT_FALSE(compile("perspective_camera { eye = (0, 5, 0), up = (0, 2, 0) }\npoint_light { }").fine);
    EXPECT_FALSE(compile("perspective_camera { near = 2, far = 1 }\npoint_light { }").fine);
}

TEST(Lower, CameraIsChosenByName) {
    const std::string text = "let left = perspective_camera { eye = (-9, 0, 0) }\nlet right = "
                             "orthographic_camera { eye = (9, 0, 0) }\n"
                             "left\nright\npoint_light { }\nsphere { }\n";
    EXPECT_EQ(compile(text).scene.camera.eye.x, -9);
    EXPECT_EQ(compile(text, {.name = "", .assets = {}, .camera = "right"}).scene.camera.eye.x, 9);
    EXPECT_EQ(compile(text + "render { camera = \"right\" }").scene.camera.eye.x, 9);
    const Compiled c = compile(text + "render { camera = \"middle\" }");
    EXPECT_NE(c.messages.find("there is no camera `middle`; there is `left`, `right` [unknown-camera]"),
              std::string::npos)
        << c.messages;
}

TEST(Lower, DisabledLightsAreLeftOut) {
    const Compiled c = compile("point_light { enabled = false }\nperspective_camera { }\nsphere { }");
    ASSERT_TRUE(c.fine) << c.messages;
    EXPECT_TRUE(c.scene.lights.empty());
}

// ---- meshes --------------------------------------------------------------------------------------------

class LowerMesh : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) / ("scc_lower_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_ / "inner");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
    Compiled mesh(const std::string& name, const std::string& fields = "") {
        LowerOptions options;
        options.assets.scene_folder = folder_ / "inner";
        return compile("mesh { file = \"" + name + "\" " + fields +
                           "}\nperspective_camera { }\npoint_light { }",
                       options);
    }

    std::filesystem::path folder_;
    const std::string square_ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
};

TEST_F(LowerMesh, PolygonsBecomeTriangles) {
    write("inner/square.obj", square_);
    const Compiled c = mesh("square.obj");
    ASSERT_TRUE(c.fine) << c.messages;
    ASSERT_EQ(c.scene.meshes.size(), 1U);
    EXPECT_EQ(c.scene.meshes[0].indices.size(), 6U);
    EXPECT_TRUE(c.scene.meshes[0].normals.empty());
}

TEST_F(LowerMesh, SmoothNormalsAreAveragedAtTheVertices) {
    write("inner/roof.obj",
          "v 0 0 -1\nv 0 0 1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 -1\nv -1 -1 1\nf 1 2 4 3\nf 2 1 5 6\n");
    const Compiled c = mesh("roof.obj", ", normals = \"smooth\"");
    ASSERT_TRUE(c.fine) << c.messages;
    const ir::Mesh& m = c.scene.meshes[0];
    EXPECT_NEAR(m.normals[0], 0, 1e-6); // at the ridge the normal stands up
    EXPECT_NEAR(m.normals[1], 1, 1e-6);
    EXPECT_NEAR(m.normals[2], 0, 1e-6);
}

TEST_F(LowerMesh, MissingFileIsReportedAtItsPlace) {
    EXPECT_EQ(mesh("none.obj").messages, "test.scn:1:15: error: cannot read `none.obj`: there is no such "
                                         "file in the scene's folder [missing-asset]\n"
                                         "    1 | mesh { file = \"none.obj\" }\n"
                                         "      |               ^~~~~~~~~~\n");
}

TEST_F(LowerMesh, FilesOutsideTheScenesFolderAreNotRead) {
    write("square.obj", square_);
    EXPECT_NE(mesh("../square.obj").messages.find("[asset-outside]"), std::string::npos);
    std::filesystem::create_symlink(folder_ / "square.obj", folder_ / "inner/link.obj");
    EXPECT_NE(mesh("link.obj").messages.find("[asset-outside]"), std::string::npos);
}

TEST_F(LowerMesh, TruncatedAndBrokenFilesAreReported) {
    const std::pair<const char*, const char*> cases[] = {
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\n", "has no faces"},
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2",
         "line 4 is a face with fewer than three corners; is the file cut short?"},
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 7\n",
         "triangle 1 uses vertex 7, but there are 3; is the file cut short?"},
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 2\n", "has no triangle with an area"},
        {"", "has no faces"}};
    for (const auto& [text, message] : cases) {
        write("inner/broken.obj", text);
        const Compiled c = mesh("broken.obj");
        EXPECT_FALSE(c.fine) << text;
        EXPECT_NE(c.messages.find(std::string("`broken.obj`: ") + message), std::string::npos) << c.messages;
    }
    write("inner/half.obj", square_ + "f 1 2 3");
    EXPECT_NE(mesh("half.obj").messages.find("warning: `half.obj`: the last line has no end"),
              std::string::npos);
}

TEST_F(LowerMesh, OneFileIsReadOnceForManyObjects) {
    write("inner/square.obj", square_);
    LowerOptions options;
    options.assets.scene_folder = folder_ / "inner";
    const Compiled c =
        compile("for (i in 0..5) { mesh { file = \"square.obj\", transform = translate(i, 0, 0) } }\n"
                "perspective_camera { }\npoint_light { }",
                options);
    ASSERT_TRUE(c.fine) << c.messages;
    EXPECT_EQ(c.scene.objects.size(), 5U);
    EXPECT_EQ(c.scene.meshes.size(), 1U);
}

/// With each triangle's corners on their own, which are told apart by where they are.
std::string opening(const std::vector<std::array<int, 3>>& triangles) {
    constexpr float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    ir::MeshArrays arrays;
    for (const auto& triangle : triangles) {
        for (const int corner : triangle) {
            arrays.indices.push_back(static_cast<std::uint32_t>(arrays.indices.size()));
            arrays.positions.insert(arrays.positions.end(), corners[corner], corners[corner] + 3);
        }
    }
    return open_part(ir::make_mesh("m", std::move(arrays)));
}

TEST(MeshInSolid, IsClosedAndFacesOutwards) {
    EXPECT_EQ(opening({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}), "");
    EXPECT_EQ(opening({{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}),
              "encloses nothing: its triangles face inwards");
    EXPECT_EQ(opening({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}),
              "is open, or its triangles face to different sides: along 3 edges, one from (0, 1, 0) to "
              "(1, 0, 0)");
    EXPECT_NE(opening({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 3, 2}}), "") << "one is turned over";
    // Two bodies with an edge in common.
    EXPECT_EQ(
        opening({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}),
        "");
}

} // namespace
} // namespace scc::compiler
