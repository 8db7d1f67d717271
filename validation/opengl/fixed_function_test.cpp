#include "runtime/raster/draw.h"
#include "runtime/test/random_scene.h"
#include "validation/opengl/fixed_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

/// Raster pictures against OpenGL's, which has the same formulas in 32-bit numbers.
namespace scc::validation {

namespace {

using namespace scc::runtime;
using Dynamic = DynamicScene<double>;

/// What the scenes here need of the runtime, which is compiled for nothing else.
struct OpenGlScene : SceneBase<double> {
    using R = double;
    static constexpr SceneTraits traits{.bare_shapes = 1U << 0 | 1U << 6,
                                        .point_lights = true,
                                        .directional_lights = true,
                                        .spot_lights = true,
                                        .rectangle_lights = true,
                                        .attenuation = true,
                                        .separate_specular = true,
                                        .specular = true,
                                        .emission = true,
                                        .transmission = true,
                                        .two_sided = true,
                                        .smooth_normals = true,
                                        .perspective = true,
                                        .orthographic = true,
                                        .raster = true,
                                        .lines = true};
    explicit OpenGlScene(const Dynamic& scene)
        : dynamic(scene), materials(scene.materials), point_lights(scene.point_lights),
          directional_lights(scene.directional_lights), spot_lights(scene.spot_lights),
          rectangle_lights(scene.rectangle_lights), line_segments(scene.line_segments), camera(scene.camera),
          ambient(scene.ambient), background(scene.background) {}

    template <class Primitive>
    const std::vector<Primitive>& primitives(Of<Primitive> table) const {
        return dynamic.primitives(table);
    }
    using SceneBase<double>::members;

    const Dynamic& dynamic;
    const std::vector<Phong<double>>& materials;
    const std::vector<PointLight<double>>& point_lights;
    const std::vector<DirectionalLight<double>>& directional_lights;
    const std::vector<SpotLight<double>>& spot_lights;
    const std::vector<RectangleLight<double>>& rectangle_lights;
    const std::vector<LineSegment<double>>& line_segments;
    Camera<double> camera;
    Rgb<double> ambient, background;
};

Camera<double> camera_at(const Vec3<double>& eye, const Vec3<double>& target, double fov_y) {
    Camera<double> camera;
    camera.eye = eye;
    camera.n = normalize(eye - target);
    camera.u = normalize(cross(Vec3<double>{0, 1, 0}, camera.n));
    camera.v = cross(camera.n, camera.u);
    camera.half_height = std::tan(fov_y / 2);
    camera.near = 0.5;
    camera.far = 50;
    return camera;
}

Phong<double> phong(const Rgb<double>& color, double highlight = 0, double shininess = 40) {
    return {.ambient = {color * 0.3},
            .diffuse = {color},
            .specular = {{highlight, highlight, highlight}},
            .shininess = {shininess}};
}
/// With this opacity, as the compiler works it in.
Phong<double> clear(const Rgb<double>& color, double opacity) {
    const double through = 1 - opacity;
    return {.ambient = {color * (0.3 * opacity)},
            .diffuse = {color * opacity},
            .transmit = {{through, through, through}}};
}

struct Comparison {
    Dynamic scene;
    RenderSettings settings;

    Comparison() {
        settings.width = 160;
        settings.height = 120;
        settings.raster.shading = RasterShading::gouraud;
        settings.raster.tessellation = 0.02;
        scene.camera = camera_at({1, 2, 6}, {0, 0.2, 0}, 0.7);
        scene.ambient = {0.2, 0.2, 0.25};
        scene.background = {0.05, 0.1, 0.15};
        scene.materials = {phong({0.4, 0.5, 0.7}, 0.8), phong({0.7, 0.3, 0.2})};
        scene.point_lights = {{.position = {-1, 2, 3}, .diffuse = {1, 0.9, 0.8}, .specular = {1, 0.9, 0.8}}};
    }
    void add(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, Sides sides = {0, 0}) {
        Triangle<double> triangle;
        triangle.points = {a, b, c};
        add(triangle, sides);
    }
    template <class Shape>
    void add(const Shape& shape, Sides sides = {0, 0}) {
        scene.add(Bare<Shape>{shape, {next_++, sides}});
    }
    void line(const Vec3<double>& from, const Vec3<double>& to, double width = 1) {
        scene.line_segments.push_back({from, to, {0.2, 0.9, 0.4}, width});
    }

    void expect_agreement() const {
#ifdef SCC_HAS_OSMESA
        const OpenGlScene ours(scene);
        const RasterModel<double> model = raster_model(ours, settings);
        const OpenGlPicture theirs = draw_by_opengl(scene, model, settings);
        ASSERT_EQ(theirs.error, "");
        RenderRequest request;
        request.settings = settings;
        request.crop = {0, 0, settings.width, settings.height};
        Image image(settings.width, settings.height);
        std::vector<double> depth;
        draw_raster(ours, model, request, image, &depth);
        int mismatches = 0, covered = 0;
        double color_error = 0, depth_error = 0;
        for (std::size_t i = 0; i < depth.size(); ++i) {
            const bool drawn = depth[i] < 1, expected = theirs.depth[i] < 1 - 1e-9;
            covered += expected;
            mismatches += drawn != expected;
            if (drawn == expected) {
                // Of window coordinates, from 0 to 1.
                depth_error = std::max(depth_error, std::abs(depth[i] - theirs.depth[i]) / 2);
                for (std::size_t c = 0; c < 3; ++c) {
                    color_error = std::max(color_error, std::abs(double(image.pixels[3 * i + c]) -
                                                                 double(theirs.image.pixels[3 * i + c])));
                }
            }
        }
        std::printf("covered %d, mismatches %d, color %.3g, depth %.3g\n", covered, mismatches, color_error,
                    depth_error);
        EXPECT_GT(covered, 100);
        EXPECT_EQ(mismatches, 0);
        EXPECT_LE(color_error, 5e-6);
        EXPECT_LE(depth_error, 1e-6);
#else
        GTEST_SKIP() << "built without OSMesa (libosmesa6-dev)";
#endif
    }

private:
    std::uint32_t next_ = 0;
};

TEST(OpenGl, Gouraud) {
    Comparison c;
    c.add(Sphere<double>{{0, 0.2, 0}, 1.1});
    c.expect_agreement();
}

TEST(OpenGl, Flat) {
    Comparison c;
    c.settings.raster.shading = RasterShading::flat;
    c.add(Sphere<double>{{0, 0.2, 0}, 1.1});
    c.expect_agreement();
}

TEST(OpenGl, TwoLightsWithFullAttenuation) {
    Comparison c;
    c.scene.point_lights = {{.position = {-1, 2, 3},
                             .diffuse = {1, 0.9, 0.8},
                             .specular = {0.5, 0.4, 0.3},
                             .kc = 1,
                             .kl = 0.1,
                             .kq = 0.05},
                            {.position = {3, 1, 2.5},
                             .diffuse = {0.3, 0.4, 1},
                             .specular = {0.2, 0.3, 0.5},
                             .kc = 0.5,
                             .kl = 0.2,
                             .kq = 0.02}};
    c.scene.directional_lights = {{normalize(Vec3<double>{0.3, 1, 0.2}), {0.2, 0.2, 0.2}, {0.1, 0.1, 0.1}}};
    c.scene.materials[0] = phong({0.4, 0.5, 0.7}, 0.5, 12); // 32 bits tell sharper highlights less exactly
    c.add(Sphere<double>{{0, 0.2, 0}, 1.2});
    c.expect_agreement();
}

TEST(OpenGl, Orthographic) {
    Comparison c;
    c.scene.camera.projection = Projection::orthographic;
    c.scene.camera.half_height = 2;
    c.add(Sphere<double>{{0.3, 0.2, 0}, 1.3});
    c.add({-2.1, -1, 1}, {1.9, -1.2, -1}, {0.2, 1.9, -0.5}, {1, 1});
    c.expect_agreement();
}

TEST(OpenGl, PolygonsThroughTheNearPlane) {
    Comparison c;
    c.scene.camera = camera_at({0, 0.31, 3.07}, {0, 0.13, 0}, 1.1);
    c.add({-0.13, 0.09, 3.3}, {0.93, -0.71, 0.23}, {-0.83, 0.67, -1.1});
    c.add({0.17, 0.33, 3.9}, {0.87, 0.93, 1.3}, {0.41, -0.37, 0.7}, {1, 1});
    c.expect_agreement();
}

TEST(OpenGl, LinesBeyondEachPlane) {
    Comparison c;
    c.scene.camera = camera_at({0, 0, 6}, {0, 0, 0}, 0.7);
    c.scene.camera.far = 9;
    c.line({-0.8, -0.31, 0.1}, {0.9, 0.57, -0.2}); // inside
    c.line({-5.1, 0.33, 0.1}, {0.9, 0.77, -0.2});  // left
    c.line({5.3, -0.41, 0.1}, {0.3, 0.27, -0.2});  // right
    c.line({0.21, -4.7, 0.1}, {-0.4, 0.93, 0.3});  // bottom
    c.line({0.57, 4.9, 0.1}, {1.1, -0.63, 0.3});   // top
    c.line({0.11, 0.07, 7.5}, {-1.3, 0.81, 0.3});  // near
    c.line({0.31, -0.27, 0.5}, {1.7, -1.1, -7.5}); // far
    c.line({-4, 5, 0}, {-3, 6, 0});                // outside
    c.expect_agreement();
}

TEST(OpenGl, WideLines) {
    Comparison c;
    c.scene.camera = camera_at({0, 0, 6}, {0, 0, 0}, 0.7);
    c.line({-1.8, -0.31, 0.1}, {0.9, 0.57, -0.2}, 2); // across
    c.line({0.31, -1.7, 0.1}, {0.9, 1.57, 0.4}, 3);   // down
    c.line({1.9, 1.1, 0.1}, {-1.2, 1.3, 0.3}, 5);
    c.line({-0.6, 1.5, 0.2}, {-1.1, -1.4, -0.7}, 6);
    c.expect_agreement();
}

TEST(OpenGl, SamplesAtCorners) {
    Comparison c;
    c.settings.point = PixelPoint::corner;
    c.add(Sphere<double>{{0, 0.2, 0}, 1.1});
    c.expect_agreement();
}

TEST(OpenGl, SpotLights) {
    Comparison c;
    SpotLight<double> spot;
    spot.position = {-1, 2, 3};
    spot.diffuse = spot.specular = {1, 0.9, 0.8};
    spot.axis = normalize(Vec3<double>{1, -1.7, -3});
    spot.cos_inner = spot.cos_outer = std::cos(0.31);
    spot.exponent = 4;
    spot.kq = 0.03;
    c.scene.point_lights.clear();
    c.scene.spot_lights = {spot};
    c.add(Sphere<double>{{0, 0.2, 0}, 1.1});
    c.expect_agreement();
}

TEST(OpenGl, RectangleLights) {
    Comparison c;
    RectangleLight<double> light;
    light.position = {-2, 2.5, 3};
    light.edge_u = {1.5, 0.2, 0};
    light.edge_v = {0, 0.3, -1};
    light.nu = 3;
    light.nv = 2;
    light.kl = 0.05;
    c.scene.rectangle_lights = {light};
    c.add(Sphere<double>{{0, 0.2, 0}, 1.1});
    c.expect_agreement();
}

TEST(OpenGl, FanWithSharedEdges) {
    Comparison c;
    for (int i = 0; i < 11; ++i) {
        const auto rim = [](int k) {
            const double angle = 0.571 * k;
            return Vec3<double>{1.3 * std::cos(angle), 0.2 + 1.2 * std::sin(angle), 0.1 * k};
        };
        c.add({0.05, 0.25, 0.3}, rim(i), rim(i + 1), {static_cast<std::uint32_t>(i % 2), 0});
    }
    c.expect_agreement();
}

TEST(OpenGl, TwoSides) {
    Comparison c;
    c.add({-1.2, -0.9, 0.3}, {1.1, -0.8, 0.1}, {-0.9, 1.2, 0}, {0, 1});
    c.add({1.4, -0.7, 0.2}, {-0.8, 1.4, 0.1}, {1.3, 1.3, 0.4}, {0, 1});
    Triangle<double> smooth;
    smooth.points = {Vec3<double>{-0.4, -0.5, 1.2}, {0.3, 0.6, 1.1}, {0.6, -0.4, 1.3}};
    smooth.normals = {Vec3<double>{-0.3, 0.2, -1}, {0.3, 0.1, -1}, {0.1, -0.4, -1}};
    smooth.smooth = true;
    c.add(smooth, {0, 1});
    c.expect_agreement();
}

TEST(OpenGl, ThinAndFar) {
    Comparison c;
    c.scene.camera = camera_at({0, 0.3, 0}, {0, 0.3, -1}, 0.5);
    for (int i = 0; i < 12; ++i) {
        const double x = -9 + 1.53 * i, y = -4 + 0.71 * i;
        c.add({x, y, -45}, {x + 4.1, y + 0.07, -44}, {x + 2.3, y + 0.11, -46.7},
              {static_cast<std::uint32_t>(i % 2), 0});
        c.add({x, -y, -40}, {x + 0.05, 2 - y, -41.3}, {x + 0.02, 4.3 - y, -42},
              {static_cast<std::uint32_t>(i % 2), 0});
    }
    c.expect_agreement();
}

TEST(OpenGl, Alpha) {
    Comparison c;
    c.scene.materials.push_back(clear({0.3, 0.8, 0.3}, 0.4));
    c.scene.materials.push_back(clear({0.8, 0.7, 0.2}, 0.7));
    c.add({-1.2, -0.9, 0.3}, {1.1, -0.8, 0.1}, {-0.1, 1.2, 0});
    c.add({-1.3, 0.9, 1.1}, {-0.9, -0.8, 1.2}, {1.2, 0.3, 1}, {2, 2});
    c.add({1.3, 0.8, 2.1}, {-0.7, 0.6, 1.9}, {0.2, -1.1, 2}, {3, 3});
    c.expect_agreement();
}

} // namespace

} // namespace scc::validation
