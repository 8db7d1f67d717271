#include "runtime/accel/build.h"
#include "runtime/shade.h"

#include <gtest/gtest.h>

#include <cmath>

/// Scenes whose colours are known on paper.
using namespace scc::runtime;

namespace {

using Scene = DynamicScene<double>;
using V = Vec3<double>;

constexpr Rgb<double> gray(double v) {
    return {v, v, v};
}

Phong<double> diffuse(double ra, double rd) {
    Phong<double> result;
    result.ambient.value = gray(ra);
    result.diffuse.value = gray(rd);
    return result;
}

PointLight<double> lamp(const V& position, double intensity = 1) {
    PointLight<double> light;
    light.position = position;
    light.diffuse = light.specular = gray(intensity);
    return light;
}

/// A floor at y = 0 with material 0.
Scene floor_scene(const Phong<double>& material) {
    Scene scene;
    scene.materials.push_back(material);
    scene.ambient = gray(0.5);
    scene.background = gray(0.25);
    scene.add(Bare<Plane<double>>{{{0, 1, 0}, 0}, {0, {0, 0}}});
    return scene;
}

Rgb<double> radiance(const Scene& scene, const RenderSettings& settings, RayCounts& counts, Ray<double> ray) {
    std::array<Ray<double>, 1> rays{ray};
    std::array<Rgb<double>, 1> colors;
    detail::Shader<Scene, double>(scene, settings, counts)
        .radiance(rays, Apex::none, all_candidates, {true}, colors);
    return colors[0];
}

double seen(const Scene& scene, const V& eye, const V& dir, int depth = 5, bool shadows = true) {
    RayCounts counts;
    RenderSettings settings;
    settings.depth = depth;
    settings.shadows = shadows;
    const Rgb<double> c = radiance(scene, settings, counts, {eye, dir});
    EXPECT_EQ(c.r, c.g);
    EXPECT_EQ(c.r, c.b);
    return c.r;
}

const V down{0, -1, 0};

TEST(Shade, AmbientAndLambert) {
    Scene scene = floor_scene(diffuse(0.4, 0.6));
    scene.point_lights.push_back(lamp({3, 4, 0}, 2));
    EXPECT_DOUBLE_EQ(seen(scene, {0, 2, 0}, down), 0.5 * 0.4 + 2 * 0.6 * 0.8);
}

TEST(Shade, LengthOfTheRaysDirectionDoesNotMatter) {
    Scene scene = floor_scene(diffuse(0.4, 0.6));
    scene.materials[0].specular.value = gray(0.5);
    scene.point_lights.push_back(lamp({3, 4, 0}, 2));
    EXPECT_DOUBLE_EQ(seen(scene, {1, 2, 1}, {-0.1, -1, 0.2}), seen(scene, {1, 2, 1}, {-0.7, -7, 1.4}));
}

TEST(Shade, HighlightIsNotWeakenedByTheAngleOfTheLight) {
    Phong<double> material = diffuse(0, 0);
    material.specular.value = gray(0.7);
    material.shininess.value = 20;
    Scene scene = floor_scene(material);
    scene.point_lights.push_back(lamp({-3, 4, 0}, 2));
    EXPECT_NEAR(seen(scene, {3, 4, 0}, {-3, -4, 0}), 0.7 * 2, 1e-14); // h = m
    const double half_angle = std::atan2(3, 4) / 2;
    EXPECT_NEAR(seen(scene, {0, 2, 0}, down), 0.7 * 2 * std::pow(std::cos(half_angle), 20), 1e-14);
}

TEST(Shade, DistanceDividesDiffuseAndSpecularOnly) {
    Phong<double> material = diffuse(0.4, 0.6);
    material.specular.value = gray(0.3);
    material.emission.value = gray(0.125);
    Scene scene = floor_scene(material);
    PointLight<double> light = lamp({0, 5, 0}, 2);
    light.kc = 1;
    light.kl = 0.5;
    light.kq = 0.25;
    scene.point_lights.push_back(light);
    const double divisor = 1 + 0.5 * 5 + 0.25 * 25;
    EXPECT_NEAR(seen(scene, {0, 2, 0}, down), 0.5 * 0.4 + 0.125 + 2 * (0.6 + 0.3) / divisor, 1e-14);
}

TEST(Shade, SpecularLightMayDiffer) {
    Phong<double> material = diffuse(0, 0.6);
    material.specular.value = gray(0.3);
    Scene scene = floor_scene(material);
    scene.directional_lights.push_back({{0, 1, 0}, gray(2), gray(5)});
    EXPECT_NEAR(seen(scene, {0, 2, 0}, down), 2 * 0.6 + 5 * 0.3, 1e-14);
}

TEST(Shade, LightBehindTheSurfaceAddsNothing) {
    Phong<double> material = diffuse(0.4, 0.6);
    material.specular.value = gray(0.3);
    material.shininess.value = 1;
    Scene scene = floor_scene(material);
    scene.point_lights.push_back(lamp({3, -0.1, 0}));
    scene.directional_lights.push_back({{0, -1, 0}, gray(1), gray(1)});
    EXPECT_DOUBLE_EQ(seen(scene, {0, 2, 0}, down, 5, false), 0.2);
}

TEST(Shade, BothSidesAreLitFromTheViewersSide) {
    Scene scene = floor_scene(diffuse(0.4, 0.6));
    scene.point_lights.push_back(lamp({0, -3, 0}));
    EXPECT_DOUBLE_EQ(seen(scene, {0, 2, 0}, down), 0.2);
    EXPECT_DOUBLE_EQ(seen(scene, {0, -2, 0}, {0, 1, 0}), 0.2 + 0.6);
}

TEST(Shade, BackMaterialIsOnTheSideAwayFromTheNormal) {
    Scene scene;
    scene.materials = {diffuse(0.4, 0), diffuse(0.8, 0)};
    scene.ambient = gray(1);
    scene.add(Bare<Sphere<double>>{{{0, 0, 0}, 1}, {0, {0, 1}}});
    EXPECT_DOUBLE_EQ(seen(scene, {0, 3, 0}, down), 0.4);
    EXPECT_DOUBLE_EQ(seen(scene, {0, 0, 0}, down), 0.8);
}

TEST(Shade, OnlyWhatIsBetweenPointAndLightCastsAShadow) {
    const double lit = 0.2 + 0.6, dark = 0.2;
    const auto with_disc_at = [](double y, const auto& light) {
        Scene scene = floor_scene(diffuse(0.4, 0.6));
        if constexpr (requires { light.position; }) {
            scene.point_lights.push_back(light);
        } else {
            scene.directional_lights.push_back(light);
        }
        scene.add(Bare<Disc<double>>{{{0, y, 0}, {0, 1, 0}, 1, 0}, {1, {0, 0}}});
        return seen(scene, {2, 1, 0}, {-2, -1, 0});
    };
    const PointLight<double> point = lamp({0, 4, 0});
    EXPECT_DOUBLE_EQ(with_disc_at(3, point), dark);
    EXPECT_DOUBLE_EQ(with_disc_at(5, point), lit);
    EXPECT_DOUBLE_EQ(with_disc_at(4, point), lit) << "the light's own place is not between";
    EXPECT_DOUBLE_EQ(with_disc_at(-1, point), lit);
    const DirectionalLight<double> sun{{0, 1, 0}, gray(1), gray(1)};
    EXPECT_DOUBLE_EQ(with_disc_at(1e6, sun), dark);
    EXPECT_DOUBLE_EQ(with_disc_at(-1, sun), lit);
}

TEST(Shade, SpotLightsFadeFromTheInnerConeToTheOuter) {
    Scene scene = floor_scene(diffuse(0, 1));
    SpotLight<double> spot{lamp({0, 4, 0}, 3)};
    spot.axis = normalize(V{1, -4, 0});
    spot.cos_inner = std::cos(0.2);
    spot.cos_outer = std::cos(0.3);
    const auto at_angle = [&](double angle, double exponent) {
        spot.exponent = exponent;
        scene.spot_lights = {spot};
        const V foot{4 * std::tan(std::atan2(1, 4) + angle), 0, 0};
        const double cosine = 4 / std::hypot(foot.x, 4);
        return seen(scene, foot + V{0, 1, 0}, down) / (3 * cosine);
    };
    EXPECT_NEAR(at_angle(0, 0), 1, 1e-14);
    EXPECT_NEAR(at_angle(-0.19, 0), 1, 1e-14);
    EXPECT_NEAR(at_angle(0.19, 5), std::pow(std::cos(0.19), 5), 1e-14);
    const double q = (std::cos(0.26) - std::cos(0.3)) / (std::cos(0.2) - std::cos(0.3));
    EXPECT_NEAR(at_angle(0.26, 0), q * q * (3 - 2 * q), 1e-13);
    EXPECT_NEAR(at_angle(-0.26, 2), q * q * (3 - 2 * q) * std::cos(0.26) * std::cos(0.26), 1e-13);
    EXPECT_EQ(at_angle(0.31, 0), 0);
    spot.cos_inner = spot.cos_outer;
    EXPECT_NEAR(at_angle(0.29, 0), 1, 1e-14) << "a hard edge";
    EXPECT_EQ(at_angle(0.31, 0), 0);
}

TEST(Shade, RectangleLightsAreTheirGridOfPointLights) {
    RectangleLight<double> rectangle{lamp({-1, 4, -1}, 6)};
    rectangle.kl = 0.3;
    rectangle.edge_u = {2, 0, 0};
    rectangle.edge_v = {0, 0.5, 2};
    rectangle.nu = 3;
    rectangle.nv = 2;
    const auto lit = [](auto lights) {
        Scene scene = floor_scene(diffuse(0, 1));
        scene.add(Bare<Disc<double>>{{{0, 2, 0}, {0, 1, 0}, 0.5, 0}, {1, {0, 0}}}); // hides five of them
        scene.spot_lights.push_back({lamp({0, 1, 0}, 0)});
        if constexpr (requires { lights.nu; }) {
            scene.rectangle_lights.push_back(lights);
        } else {
            scene.point_lights = lights;
        }
        return seen(scene, {0.2, 1, 0.1}, down);
    };
    std::vector<PointLight<double>> points;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 3; ++i) {
            const double u = (i + 0.5) / 3, v = (j + 0.5) / 2;
            points.push_back(lamp({-1 + 2 * u, 4 + 0.5 * v, -1 + 2 * v}, 1));
            points.back().kl = 0.3;
        }
    }
    EXPECT_NEAR(lit(rectangle), lit(points), 1e-14);
    points.clear();
    EXPECT_GT(lit(rectangle), lit(points));
}

TEST(Shade, ShadowsCanBeTurnedOff) {
    Scene scene = floor_scene(diffuse(0.4, 0.6));
    scene.point_lights.push_back(lamp({0, 4, 0}));
    scene.add(Bare<Disc<double>>{{{0, 3, 0}, {0, 1, 0}, 1, 0}, {1, {0, 0}}});
    EXPECT_DOUBLE_EQ(seen(scene, {2, 1, 0}, {-2, -1, 0}, 5, false), 0.8);
}

TEST(Shade, MirrorAddsWhatItSeesAndABackgroundWhereItSeesNothing) {
    Phong<double> mirror = diffuse(0.4, 0);
    mirror.reflect.value = gray(0.5);
    Scene scene = floor_scene(mirror);
    EXPECT_DOUBLE_EQ(seen(scene, {0, 1, 0}, {1, -1, 0}), 0.2 + 0.5 * 0.25);
    scene.materials.push_back(diffuse(0.8, 0));
    scene.add(Bare<Sphere<double>>{{{4, 2, 0}, 1}, {1, {1, 1}}});
    EXPECT_DOUBLE_EQ(seen(scene, {0, 1, 0}, {1, -1, 0}), 0.2 + 0.5 * 0.4);
}

TEST(Shade, MirrorsAreFollowedForTheGivenNumberOfBouncesThenBlack) {
    Phong<double> mirror = diffuse(0.4, 0);
    mirror.reflect.value = gray(0.5);
    Scene scene = floor_scene(mirror);
    scene.add(Bare<Plane<double>>{{{0, -1, 0}, -2}, {1, {0, 0}}}); // between two mirrors for ever
    double expected = 0, weight = 1;
    for (int depth = 0; depth < 6; ++depth) {
        expected += weight * 0.2;
        weight *= 0.5;
        EXPECT_DOUBLE_EQ(seen(scene, {0, 1, 0}, {0.1, -1, 0}, depth), expected) << depth;
    }
}

TEST(Shade, FunctionsReadObjectAndWorldSpace) {
    Scene scene;
    Phong<double> material;
    material.ambient.function = 0;
    scene.materials = {material};
    scene.ambient = gray(1);
    const Affine<double> move{{{1, 0, 0, 10}, {0, 1, 0, 20}, {0, 0, 1, 0}}};
    scene.add(Placed<Sphere<double>, double>{{{0, 0, 0}, 1}, move, inverse(move), {0, {0, 0}}});
    scene.functions.push_back({{{Opcode::p_y}, {Opcode::world_y}, {Opcode::n_y}}, {0, 1, 2}});
    RayCounts counts;
    const RenderSettings settings;
    const Rgb<double> c = radiance(scene, settings, counts, {{10, 25, 0}, {0, -1, 0}});
    EXPECT_DOUBLE_EQ(c.r, 1);
    EXPECT_DOUBLE_EQ(c.g, 21);
    EXPECT_DOUBLE_EQ(c.b, 1);
}

TEST(Shade, SmoothNormalsShadeAndGeometricNormalsChooseTheSide) {
    Scene scene;
    scene.materials = {diffuse(0, 1), diffuse(0, 0)};
    Triangle<double> triangle{{{{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}}}};
    triangle.smooth = true;
    triangle.normals = {{{0.6, 0.8, 0}, {0.6, 0.8, 0}, {0.6, 0.8, 0}}};
    scene.add(Bare<Triangle<double>>{triangle, {0, {0, 1}}});
    scene.directional_lights.push_back({{0, 1, 0}, gray(1), gray(1)});
    EXPECT_NEAR(seen(scene, {0, 2, 0}, down), 0.8, 1e-15);
    // From the front by the flat normal, from behind by the interpolated one: it turns to the viewer, away
    // from the light. The material is still that of the front.
    EXPECT_EQ(seen(scene, {-4, 1, 0}, {4, -1, 0}), 0);
    scene.directional_lights[0].to_light = {0, -1, 0};
    scene.directional_lights.push_back({{-0.6, -0.8, 0}, gray(1), gray(1)});
    EXPECT_NEAR(seen(scene, {-4, 1, 0}, {4, -1, 0}, 5, false), 0.8 + 1, 1e-15);
    scene.directional_lights = {{{0, 1, 0}, gray(1), gray(1)}};
    EXPECT_EQ(seen(scene, {0, -2, 0}, {0, 1, 0}), 0);
}

} // namespace
