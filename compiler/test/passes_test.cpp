#include "compiler/ir/verify.h"
#include "compiler/passes/passes.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace scc::compiler {
namespace {

using runtime::Affine;
using test::compile_shapes;

ir::Scene passed(const std::string& shapes) {
    test::Compiled c = compile_shapes(shapes);
    EXPECT_TRUE(c.fine) << c.messages;
    run_passes(c.scene);
    return c.scene;
}

TEST(FlattenTransforms, BakesASimilarityIntoASphere) {
    const ir::Scene scene = passed(
        "sphere { center = (1, 0, 0), transform = scale(2) then rotate_z(90deg) then translate(0, 0, 3) }");
    const auto& sphere = std::get<runtime::Sphere<double>>(scene.objects[0].shape);
    EXPECT_EQ(scene.objects[0].world_from_object, Affine<double>{});
    EXPECT_DOUBLE_EQ(sphere.radius, 2);
    EXPECT_NEAR(sphere.center.x, 0, 1e-15);
    EXPECT_NEAR(sphere.center.y, 2, 1e-15);
    EXPECT_DOUBLE_EQ(sphere.center.z, 3);
}

TEST(FlattenTransforms, BakesASimilarityIntoACone) {
    const ir::Scene scene = passed("cone { radius_from = 0.5, radius_to = 0.25, caps = false, transform = "
                                   "scale(2) then rotate_z(90deg) then translate(0, 0, 3) }");
    const auto& cone = std::get<runtime::Cone<double>>(scene.objects[0].shape);
    EXPECT_EQ(scene.objects[0].world_from_object, Affine<double>{});
    EXPECT_DOUBLE_EQ(cone.radius_from, 1);
    EXPECT_DOUBLE_EQ(cone.radius_to, 0.5);
    EXPECT_DOUBLE_EQ(cone.to.x, -2);
    EXPECT_DOUBLE_EQ(cone.to.z, 3);
    EXPECT_FALSE(cone.caps);
}

TEST(FlattenTransforms, KeepsWhatTheFormCannotExpress) {
    const ir::Scene scene =
        passed("sphere { transform = scale(1, 2, 1) }\nbox { transform = rotate_y(30deg) }\n"
               "cylinder { transform = scale(1, 1, 2) }\ncone { transform = scale(1, 1, 2) }");
    for (const ir::Object& object : scene.objects) {
        EXPECT_NE(object.world_from_object, Affine<double>{}) << object.path;
    }
}

TEST(FlattenTransforms, PlaneKeepsItsPointsUnderAnyMap) {
    const ir::Scene scene = passed("plane { normal = (1, 1, 0), offset = 2, transform = scale(1, 3, 0.5) "
                                   "then rotate_x(20deg) then translate(1, 2, 3) }");
    const auto& plane = std::get<runtime::Plane<double>>(scene.objects[0].shape);
    EXPECT_EQ(scene.objects[0].world_from_object, Affine<double>{});
    // (sqrt(8), 0, 1) lies on the plane; where the map takes it, by hand: scaled (sqrt(8), 0, 0.5), turned
    // about x, moved.
    const double s = std::sin(M_PI / 9);
    const double c = std::cos(M_PI / 9);
    const runtime::Vec3<double> moved{std::sqrt(8.0) + 1, -0.5 * s + 2, 0.5 * c + 3};
    EXPECT_NEAR(dot(normalize(plane.normal), moved), plane.offset, 1e-12);
}

TEST(FlattenTransforms, MirroredTriangleKeepsItsFront) {
    const ir::Scene scene =
        passed("triangle { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], transform = scale(-1, 1, 1) }");
    const auto& t = std::get<runtime::Triangle<double>>(scene.objects[0].shape);
    const auto normal = cross(t.points[1] - t.points[0], t.points[2] - t.points[0]);
    EXPECT_GT(normal.z, 0); // the mirror in x leaves the normal (0, 0, 1)
}

TEST(FlattenTransforms, KeepsTheTransformThatAPerPointFunctionReads) {
    const ir::Scene scene = passed("sphere { transform = translate(1, 0, 0), material = phong { diffuse = "
                                   "fn(s: surface) = rgb(s.p.x, 0, 0) } }\n"
                                   "sphere { transform = translate(1, 0, 0), material = phong { diffuse = "
                                   "fn(s: surface) = rgb(s.world.x, 0, 0) } }");
    EXPECT_NE(scene.objects[0].world_from_object, Affine<double>{});
    EXPECT_EQ(scene.objects[1].world_from_object, Affine<double>{});
}

TEST(DropUnused, LeavesOutBlackLightsAndUnusedMaterials) {
    test::Compiled c = compile_shapes("point_light { color = rgb(0, 0, 0) }\nsphere { }");
    c.scene.materials.push_back({.name = "unused", .phong = {}, .span = {}});
    run_passes(c.scene);
    EXPECT_EQ(c.scene.lights.size(), 1U);
    EXPECT_EQ(c.scene.materials.size(), 1U);
}

TEST(DeriveTraits, NeedsWhatTheSceneUsesAndNothingElse) {
    const ir::Scene plain = passed("sphere { }");
    EXPECT_EQ(plain.traits.bare_shapes, 1U);
    EXPECT_EQ(plain.traits.placed_shapes, 0U);
    EXPECT_TRUE(plain.traits.point_lights);
    EXPECT_TRUE(plain.traits.perspective);
    EXPECT_TRUE(plain.traits.shadows);
    EXPECT_FALSE(plain.traits.directional_lights || plain.traits.attenuation || plain.traits.specular ||
                 plain.traits.reflection || plain.traits.two_sided || plain.traits.functions ||
                 plain.traits.accelerator || plain.traits.orthographic);

    const ir::Scene rich = passed("box { transform = rotate_x(10deg), material = phong { specular = rgb(1, "
                                  "1, 1), reflect = rgb(0.5, 0, 0) } }\n"
                                  "point_light { attenuation = (0, 1, 0), specular = rgb(1, 0, 0) }");
    EXPECT_EQ(rich.traits.placed_shapes, 2U);
    EXPECT_TRUE(rich.traits.specular && rich.traits.reflection && rich.traits.attenuation &&
                rich.traits.separate_specular);
}

TEST(DeriveTraits, MirrorsAreLeftOutAtDepthZero) {
    const ir::Scene scene = passed(
        "sphere { material = phong { reflect = rgb(1, 1, 1) } }\nrender { method = ray { depth = 0 } }");
    EXPECT_FALSE(scene.traits.reflection);
}

TEST(Verify, RejectsWhatABackendCouldNotDraw) {
    ir::Scene scene = passed("sphere { }");
    scene.objects[0].sides.front = 7;
    EXPECT_THROW(ir::verify(scene), std::logic_error);
}

} // namespace
} // namespace scc::compiler
