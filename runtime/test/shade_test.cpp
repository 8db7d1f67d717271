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

// ---- transparency and refraction
// ---------------------------------------------------------------------------

Phong<double> clear(double ior, double transmit = 1) {
    Phong<double> result = diffuse(0, 0);
    result.transmit.value = gray(transmit);
    result.ior = ior;
    return result;
}
Phong<double> glass(double ior) {
    Phong<double> result = clear(ior);
    result.reflect.value = gray(1);
    result.fresnel = true;
    return result;
}

/// A floor at y = 0 that shows where it is seen: x, z and how often it was dimmed.
Scene ruled_floor() {
    Phong<double> ruled;
    ruled.ambient.function = 0;
    ruled.diffuse.value = gray(0);
    Scene scene = floor_scene(ruled);
    scene.ambient = gray(1);
    scene.background = gray(0);
    scene.functions.push_back({{{Opcode::world_x}, {Opcode::world_z}, {Opcode::constant, {}, 1}}, {0, 1, 2}});
    return scene;
}

void add_slab(Scene& scene, double bottom, double top, const Phong<double>& material) {
    const auto id = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.add(Bare<Box<double>>{{{-1000 + bottom, bottom, -1000 + bottom}, {1000 + top, top, 1000 + top}},
                                {id, {id, id}}});
}

Rgb<double> color_seen(const Scene& scene, const V& eye, const V& dir, int depth = 5) {
    RayCounts counts;
    RenderSettings settings;
    settings.depth = depth;
    return radiance(scene, settings, counts, {eye, dir});
}

double sine(double degrees) {
    return std::sin(degrees * 3.14159265358979323846 / 180);
}
/// How far a ray goes sideways while it goes through a layer; `sine` is that of its angle in air.
double sideways(double thickness, double sine, double ior) {
    return thickness * (sine / ior) / std::sqrt(1 - sine / ior * (sine / ior));
}
/// A ray that comes down from height 10 above x = 0.
Rgb<double> seen_down(const Scene& scene, double sine, int depth = 5) {
    return color_seen(scene, {0, 10, 0}, {2 * sine, -2 * std::sqrt(1 - sine * sine), 0}, depth);
}

TEST(Optics, ASlabMovesWhatIsBehindItAside) {
    Scene scene = ruled_floor();
    add_slab(scene, 3, 5, clear(1.5, 0.5));
    for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
        const double s = sine(degrees);
        const Rgb<double> c = seen_down(scene, s);
        EXPECT_NEAR(c.r, 0.25 * (sideways(8, s, 1) + sideways(2, s, 1.5)), 1e-12) << degrees;
        EXPECT_NEAR(c.g, 0, 1e-12);
        EXPECT_DOUBLE_EQ(c.b, 0.25) << "at every surface the light is dimmed";
    }
}

TEST(Optics, NestedBodiesRefractByWhatIsAroundThem) {
    for (const double inner : {1.33, 1.0, 1.5, 2.4}) { // water, air, the same glass, diamond
        Scene scene = ruled_floor();
        add_slab(scene, 2, 6, clear(1.5));
        add_slab(scene, 3, 5, clear(inner));
        const double s = sine(50);
        EXPECT_NEAR(seen_down(scene, s).r, sideways(6, s, 1) + sideways(2, s, 1.5) + sideways(2, s, inner),
                    1e-12)
            << inner;
    }
}

TEST(Optics, WhereBodiesOverlapTheLastOneEnteredCounts) {
    Scene scene = ruled_floor();
    add_slab(scene, 4, 8, clear(1.5));
    add_slab(scene, 2, 6, clear(1.33));
    const double s = sine(50);
    EXPECT_NEAR(seen_down(scene, s).r, sideways(4, s, 1) + sideways(2, s, 1.5) + sideways(4, s, 1.33), 1e-12);
    EXPECT_EQ(seen_down(scene, s, 2).b, 0) << "after two bounces";
    EXPECT_EQ(seen_down(scene, s, 3).b, 1) << "leaving the covered body is none";
}

TEST(Optics, HundredsOfBodiesNestInEachOther) {
    Scene scene = ruled_floor();
    const double s = sine(40);
    double expected = sideways(4, s, 1);
    for (int i = 0; i < 300; ++i) {
        const double ior = i % 2 == 0 ? 1.5 : 1.2, edge = i * 0.01;
        add_slab(scene, 2 + edge, 8 - edge, clear(ior));
        expected += sideways(i < 299 ? 0.02 : 6 - 2 * edge, s, ior);
    }
    prepare(scene);
    EXPECT_NEAR(seen_down(scene, s, 1000).r, expected, 1e-9);
}

TEST(Optics, BeyondTheCriticalAngleSurfacesAreMirrorsThatNothingDims) {
    Phong<double> material = clear(1.5, 0.5);
    material.reflect.value = gray(0.125);
    Scene scene = ruled_floor();
    add_slab(scene, 3, 5, material);
    const double critical = std::asin(1 / 1.5);
    const auto looking_up = [&](double angle) {
        return color_seen(scene, {0, 4, 0}, {std::sin(angle), std::cos(angle), 0}, 2);
    };
    EXPECT_NEAR(looking_up(critical - 1e-6).b, 0.125 * 0.5, 1e-12) << "mirrored, then out of the other face";
    EXPECT_EQ(looking_up(critical + 1e-6).b, 0) << "mirrored to and fro";
    scene = ruled_floor();
    scene.add(Bare<Plane<double>>{{{0, 1, 0}, 5}, {1, {1, 1}}});
    scene.materials.push_back(material);
    const Rgb<double> total = color_seen(scene, {0, 4, 0}, {1, 1, 0});
    EXPECT_DOUBLE_EQ(total.b, 1);
    EXPECT_NEAR(total.r, 1 + 5, 1e-12);
}

/// By the formula of Cook and Torrance.
double fresnel(double ior, double cosine) {
    const double g = std::sqrt(ior * ior + cosine * cosine - 1);
    const double ratio = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1);
    return 0.5 * (g - cosine) * (g - cosine) / ((g + cosine) * (g + cosine)) * (1 + ratio * ratio);
}

TEST(Optics, GlassMirrorsByFresnelsEquations) {
    for (const double degrees : {0.0, 45.0, 80.0}) {
        Scene scene = floor_scene(diffuse(0.5, 0));
        scene.ambient = gray(1);
        scene.background = gray(8);
        scene.materials.push_back(glass(1.5));
        scene.materials[1].transmit.value = {1, 0.5, 0};
        scene.add(Bare<Plane<double>>{{{0, 1, 0}, 5}, {1, {1, 1}}});
        const double s = sine(degrees), f = fresnel(1.5, std::sqrt(1 - s * s));
        const Rgb<double> c = seen_down(scene, s, 1);
        EXPECT_NEAR(c.r, 8 * f + 0.5 * (1 - f), 1e-13) << degrees;
        EXPECT_NEAR(c.g, 8 * f + 0.25 * (1 - f), 1e-13) << degrees;
        EXPECT_NEAR(c.b, 8 * f, 1e-13) << degrees;
    }
    EXPECT_NEAR(fresnel(1.5, 1), 0.04, 1e-15);
}

TEST(Optics, InsideOutReflectancesAreThoseOfTheRefractedAngle) {
    Scene scene = floor_scene(diffuse(0.5, 0));
    scene.ambient = gray(1);
    scene.background = gray(8);
    scene.materials.push_back(glass(1.5));
    scene.add(Bare<Plane<double>>{{{0, 1, 0}, 5}, {1, {1, 1}}});
    const double s = sine(60) / 1.5, f = fresnel(1.5, std::cos(std::asin(sine(60))));
    const Rgb<double> c = color_seen(scene, {0, 4, 0}, {s, std::sqrt(1 - s * s), 0}, 1);
    EXPECT_NEAR(c.r, 8 * (1 - f) + 0.5 * f, 1e-13);
}

TEST(Optics, ABallGathersParallelLightInItsFocus) {
    for (const double ior : {1.5, 1.33, 1.8}) {
        Scene scene = ruled_floor();
        scene.materials.push_back(clear(ior));
        const double focus = ior / (2 * (ior - 1)); // from the centre, for radius 1
        scene.add(Bare<Sphere<double>>{{{0, focus, 0}, 1}, {1, {1, 1}}});
        const double off = 1e-3; // the rest is of third order
        EXPECT_NEAR(color_seen(scene, {off, 9, 0}, down).r, 0, 5e-9) << ior;
        EXPECT_NEAR(color_seen(scene, {0, 9, off}, down).g, 0, 5e-9) << ior;
    }
}

TEST(Optics, ACameraMayStandInTransparentBodies) {
    const double s = sine(30);
    const auto from = [&](const Scene& scene, double height) {
        return color_seen(scene, {0, height, 0}, {s, -std::sqrt(1 - s * s), 0}).r;
    };
    Scene scene = ruled_floor();
    add_slab(scene, 3, 5, clear(1.5));
    EXPECT_NEAR(from(scene, 4), sideways(1, s, 1) + sideways(3, 1.5 * s, 1), 1e-12);
    scene.materials.push_back(clear(1.33));
    scene.add(Bare<Sphere<double>>{{{0, 4, 0}, 0.5}, {2, {2, 2}}});
    EXPECT_NEAR(color_seen(scene, {0, 4, 0}, {s, -std::sqrt(1 - s * s), 0}).r,
                sideways(1, s, 1) + sideways(3, 1.5 * s, 1), 1e-12)
        << "from the ball's centre nothing bends at its surface";
    Scene sea = ruled_floor(); // water without end, above the floor, below which it goes on
    sea.materials.push_back(clear(1.33));
    sea.add(Bare<Plane<double>>{{{0, -1, 0}, -2}, {1, {1, 1}}}); // everything above y = 2
    EXPECT_NEAR(from(sea, 5), sideways(3, s, 1) + sideways(2, 1.33 * s, 1), 1e-12);
    Scene sheet = ruled_floor(); // an open surface has no inside
    sheet.materials.push_back(clear(1.5));
    sheet.add(Bare<Disc<double>>{{{0, 2, 0}, {0, 1, 0}, 100, 0}, {1, {1, 1}}});
    EXPECT_NEAR(from(sheet, 5), sideways(3, s, 1) + sideways(2, s, 1.5), 1e-12);
}

TEST(Optics, SolidsAreOneBody) {
    Scene scene = ruled_floor();
    scene.materials.push_back(clear(1.5));
    const auto member = [&](std::uint32_t id, double bottom, double top, bool inverted) {
        scene.add(
            Member<Bare<Box<double>>>{{{{-500, bottom, -500}, {500, top, 500}}, {id, {1, 1}}}, inverted, 1});
    };
    scene.add(Bare<Csg<double>>{{0}, {1, {1, 1}}});
    constexpr std::uint32_t box = 2; // two kinds per row of Shapes
    scene.csg_nodes = {{CsgOp::subtract, 3, {}}, {CsgOp::member, 1, {box, 0}}, {CsgOp::member, 1, {box, 1}}};
    member(2, 2, 6, false);
    member(3, 3, 5, true);
    const double s = sine(50);
    EXPECT_NEAR(seen_down(scene, s).r, sideways(8, s, 1) + sideways(2, s, 1.5), 1e-12);
}

TEST(Optics, WhereNothingBendsNoBounceIsTaken) {
    Scene scene = ruled_floor();
    for (int i = 0; i < 4; ++i) {
        add_slab(scene, 2 * i + 1, 2 * i + 2, clear(1, 0.5));
    }
    EXPECT_DOUBLE_EQ(seen_down(scene, 0, 0).b, std::pow(0.5, 8));
    Scene bent = ruled_floor();
    add_slab(bent, 3, 5, clear(1.5));
    EXPECT_EQ(seen_down(bent, 0, 1).b, 0);
    EXPECT_EQ(seen_down(bent, 0, 2).b, 1);
}

TEST(Optics, WhatAPaneShowsIsItsOwnColorWhatItMirrorsAndWhatIsBehind) {
    Phong<double> pane = diffuse(0.3, 0.2);
    pane.reflect.value = gray(0.125);
    pane.transmit.value = {0.5, 0.25, 0};
    Scene scene = floor_scene(diffuse(0.4, 0));
    scene.materials.push_back(pane);
    scene.add(Bare<Disc<double>>{{{0, 5, 0}, {0, 1, 0}, 1, 0}, {1, {1, 1}}});
    scene.directional_lights.push_back({{0, 1, 0}, gray(1), gray(1)});
    const Rgb<double> c = color_seen(scene, {0, 10, 0}, down);
    const double own = 0.5 * 0.3 + 0.2, mirrored = 0.125 * 0.25, floor = 0.5 * 0.4;
    EXPECT_DOUBLE_EQ(c.r, own + mirrored + 0.5 * floor);
    EXPECT_DOUBLE_EQ(c.g, own + mirrored + 0.25 * floor);
    EXPECT_DOUBLE_EQ(c.b, own + mirrored);
}

TEST(Optics, ShadowsHaveTheColorOfWhatTheLightGoesThrough) {
    const auto lit = [](const auto& light, double ior) {
        Scene scene = floor_scene(diffuse(0, 1));
        scene.background = gray(0);
        scene.materials.push_back(clear(ior));
        scene.materials[1].transmit.value = {0.9, 0.5, 0};
        scene.materials.push_back(clear(1, 0.5));
        scene.materials[2].reflect.value = gray(0.5);
        if constexpr (requires { light.position; }) {
            scene.point_lights.push_back(light);
        } else {
            scene.directional_lights.push_back(light);
        }
        scene.add(Bare<Box<double>>{{{-1, 2, -1}, {1, 3, 1}}, {1, {1, 1}}});
        scene.add(Bare<Disc<double>>{{{0, 1, 0}, {0, 1, 0}, 0.5, 0}, {2, {2, 2}}});
        return color_seen(scene, {2, 2, 0}, {-2, -2, 0});
    };
    for (const double ior : {1.0, 1.5}) { // no matter
        for (const Rgb<double>& c :
             {lit(lamp({0, 5, 0}), ior), lit(DirectionalLight<double>{{0, 1, 0}, gray(1), gray(1)}, ior)}) {
            EXPECT_DOUBLE_EQ(c.r, 0.9 * 0.9 * 0.5);
            EXPECT_DOUBLE_EQ(c.g, 0.5 * 0.5 * 0.5);
            EXPECT_DOUBLE_EQ(c.b, 0);
        }
        EXPECT_DOUBLE_EQ(lit(lamp({0, 2.5, 0}), ior).r, 0.9 * 0.5) << "a lamp in the glass";
        EXPECT_DOUBLE_EQ(lit(lamp({0, 1.5, 0}), ior).b, 0.5) << "a lamp in front of it";
    }
}

TEST(Optics, TransmissionMayDifferFromPointToPoint) {
    Scene scene = ruled_floor();
    add_slab(scene, 3, 5, clear(1));
    scene.materials[1].transmit.function = 1;
    scene.functions.push_back({{{Opcode::world_x}}, {0, 0, 0}});
    EXPECT_DOUBLE_EQ(color_seen(scene, {0.25, 9, 0}, down).b, 0.0625);
}

TEST(Optics, CountsRefractedAndMirroredRays) {
    Scene scene = floor_scene(diffuse(0.5, 0));
    scene.materials.push_back(glass(1.5));
    scene.add(Bare<Box<double>>{{{-9, 2, -9}, {9, 3, 9}}, {1, {1, 1}}});
    RayCounts counts;
    RenderSettings settings;
    settings.depth = 2;
    radiance(scene, settings, counts, {{0, 5, 0}, down});
    EXPECT_EQ(counts.refracted, 2U);
    EXPECT_EQ(counts.reflected, 2U);
}

// ---- bumps -----------------------------------------------------------------------------------------------

/// `0.3 q` of one input, q.
FunctionProgram<double> ramp(Opcode input) {
    FunctionProgram<double> program;
    program.instructions = {{input}, {Opcode::constant, {}, 0.3}, {Opcode::mul, {0, 1, 0}}};
    program.results = {2};
    return program;
}

Scene bumped_floor(Opcode input) {
    Scene scene = floor_scene(diffuse(0, 1));
    scene.ambient = gray(0);
    scene.materials[0].bump = 0;
    scene.functions.push_back(ramp(input));
    return scene;
}

DirectionalLight<double> sun(const V& to_light) {
    return {normalize(to_light), gray(1), gray(1)};
}

TEST(Bump, TiltsTheNormalByTheSlope) {
    Scene scene = bumped_floor(Opcode::world_x);
    scene.directional_lights.push_back(sun({1, 2, 0}));
    EXPECT_NEAR(seen(scene, {0, 2, 0}, down), dot(normalize(V{-0.3, 1, 0}), normalize(V{1, 2, 0})), 1e-15);
}

TEST(Bump, IsADentFromBehind) {
    Scene scene = bumped_floor(Opcode::world_x);
    scene.directional_lights.push_back(sun({1, -2, 0}));
    // The mould of what stands on the other side: its normal is the other's, turned over.
    EXPECT_NEAR(seen(scene, {0, -2, 0}, -down), dot(normalize(V{0.3, -1, 0}), normalize(V{1, -2, 0})), 1e-15);
}

TEST(Bump, IsNotLitThroughTheSurface) {
    Scene scene = bumped_floor(Opcode::world_x);
    scene.directional_lights.push_back(sun({-1, -0.1, 0})); // from below, where the bump faces
    EXPECT_EQ(seen(scene, {0, 2, 0}, down, 5, false), 0);
}

TEST(Bump, HeightIsInWorldUnitsWhateverTheTransform) {
    // Object coordinates are stretched by (2, 1, 4), sheared, and turned about y.
    const double c = std::cos(0.4), s = std::sin(0.4);
    const Affine<double> place{{{2 * c, 0.1, 4 * s, 1}, {0, 1, 0, 0}, {-2 * s, 0.2, 4 * c, 2}}};
    Scene scene = bumped_floor(Opcode::p_x);
    std::get<std::vector<Bare<Plane<double>>>>(scene.shapes.tables).clear();
    scene.add(Placed<Plane<double>, double>{{{0, 1, 0}, 0}, place, inverse(place), {0, {0, 0}}});
    scene.directional_lights.push_back(sun({1, 2, 0.5}));
    const V slope = V{c / 2, 0, -s / 2} * 0.3; // of p.x by the world, along the floor
    EXPECT_NEAR(seen(scene, {0.3, 2, 0.7}, down), dot(normalize(V{0, 1, 0} - slope), normalize(V{1, 2, 0.5})),
                1e-14);
}

TEST(Bump, MirrorsByTheTiltedNormalButNotIntoTheSurface) {
    const V normal = normalize(V{-0.3, 1, 0}), facing{0, 1, 0};
    EXPECT_EQ(reflect_bumped(down, normal, facing), reflect(down, normal));
    for (const V& dir : {V{1, -0.1, 0}, V{-1, -0.1, 0}, V{0.3, -1, 2}}) {
        const V mirrored = reflect_bumped(normalize(dir), normal, facing);
        EXPECT_GE(mirrored.y, 0);
        EXPECT_NEAR(length(mirrored), 1, 1e-15);
    }
}

/// Slopes of uv by the point, against differences along the surface.
template <class Shape>
void expect_uv_slopes(const Shape& shape, const Ray<double>& ray) {
    const Scene scene;
    const Bare<Shape> bare{shape, {}};
    const ShapeHit<double> hit = shape.intersect(ray);
    ASSERT_LT(hit.t, infinity<double>());
    const Surface<double> surface = shape.surface(ray, hit);
    const auto slopes = uv_slopes_of(scene, bare, ray, hit, true, surface.point);
    for (const V& axis : {V{1, 0, 0}, V{0, 1, 0}, V{0, 0, 1}}) {
        const V along = axis - surface.normal * dot(axis, surface.normal);
        const auto uv_at = [&](double distance) {
            const V point = surface.point + along * distance;
            const Ray<double> there{point - ray.dir, ray.dir, ray.t_min, ray.t_max};
            return shape.uv(there, hit, point);
        };
        const double step = 1e-5;
        const Vec2<double> ahead = uv_at(step), behind = uv_at(-step);
        EXPECT_NEAR(dot(slopes.x, along), (ahead.x - behind.x) / (2 * step), 1e-8) << Shape::name;
        EXPECT_NEAR(dot(slopes.y, along), (ahead.y - behind.y) / (2 * step), 1e-8) << Shape::name;
    }
}

TEST(Bump, KnowsTheSlopesOfCoordinatesOnEveryShape) {
    const Ray<double> ray{{0.3, 0.2, 5}, normalize(V{0.02, 0.03, -1})};
    expect_uv_slopes(Sphere<double>{{0.1, 0, 0}, 1}, ray);
    expect_uv_slopes(Box<double>{{-1, -1, -1}, {1, 2, 1}}, ray);
    expect_uv_slopes(Cylinder<double>{{0, -1, 0}, {0.2, 1, 0}, 1}, ray);
    expect_uv_slopes(Cone<double>{{0, -1, 0}, {0.2, 1, 0}, 1, 0.3}, ray);
    expect_uv_slopes(Torus<double>{{0, 0, 0}, normalize(V{0, 1, 0.2}), 1, 0.3}, ray);
    expect_uv_slopes(Plane<double>{normalize(V{0.1, 0.2, 1}), 0}, ray);
    expect_uv_slopes(Disc<double>{{0, 0, 0}, normalize(V{0.1, 0.2, 1}), 2, 0}, ray);
    expect_uv_slopes(Quadric<double>{{1, 1, 2}}, ray);
    Triangle<double> triangle;
    triangle.points = {V{-2, -1, 0}, V{2, -1, 0.3}, V{0, 3, 0}};
    triangle.uvs = {Vec2<double>{0.1, 0.2}, {0.9, 0.3}, {0.4, 0.8}};
    expect_uv_slopes(triangle, ray);
}

} // namespace
