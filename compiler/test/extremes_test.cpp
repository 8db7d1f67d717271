#include "compiler/backends/render.h"
#include "compiler/test/support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace scc::compiler {
namespace {

/// The ends of what numbers can be, and what is no number by arithmetic.
constexpr std::string_view numbers[] = {"-0",
                                        "5e-324",
                                        "-5e-324",
                                        "2.2e-308",
                                        "1e-308 / 1e10",
                                        "1e-300",
                                        "1e-160",
                                        "1e160",
                                        "1e300",
                                        "-1e308",
                                        "1e308",
                                        "1e400",
                                        "1.797e308",
                                        "1 / 0",
                                        "0 / 0",
                                        "log(0)",
                                        "log(-1)",
                                        "sqrt(-1)",
                                        "(-8) ^ 0.5",
                                        "0 ^ -1",
                                        "5 % 0",
                                        "1e308*2",
                                        "1e308*2 - 1e308*2",
                                        "-1e308*1e308",
                                        "exp(1000)",
                                        "0 * exp(1000)",
                                        "asin(2) / 1rad"};

/// Each stands at X.
constexpr std::string_view shapes[] = {
    "sphere { radius = X }",
    "sphere { center = (X, 0, 0) }",
    "sphere { transform = scale(X) }",
    "sphere { transform = scale(1, 1, X) }",
    "sphere { transform = translate(0, X, 0) }",
    "sphere { transform = rotate_x(X * 1rad) }",
    "sphere { transform = rotate((X, X, 1), 1rad) }",
    "sphere { transform = matrix([1, X, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]) }",
    "group { transform = scale(1e150), sphere { transform = translate(X, 0, 0) } }",
    "box { min = (-1, -1, -1), max = (1, 1, X) }",
    "box { min = (X, -1, -1), max = (1, 1, 1) }",
    "cylinder { from = (0, 0, 0), to = (0, X, 0), radius = 0.5 }",
    "cone { from = (0, 0, 0), to = (0, 1, 0), radius_from = 0.5, radius_to = X }",
    "torus { major = 1, minor = X }",
    "torus { major = X, minor = 0.2 }",
    "disc { radius = 2, hole = X }",
    "disc { normal = (X, X, X) }",
    "plane { offset = X }",
    "plane { normal = (X, 1, 0) }",
    "triangle { points = [(0, 0, 0), (X, 0, 0), (0, 1, 0)] }",
    "triangle { points = [(0, 0, X), (1, 0, X), (0, 1, X)] }",
    "quadric { squares = (1, 1, X), constant = -1 }",
    "quadric { squares = (1, 1, 1), constant = X }",
    "quadric { squares = (X, 1, 1), constant = -1, within = box { } }",
    "implicit { field = fn(p: vec3) = dot(p, p) - X, within = sphere { } }",
    "implicit { field = fn(p: vec3) = X * (dot(p, p) - 0.5), within = sphere { } }",
    "implicit { field = fn(p: vec3) = p.x * p.x / X + p.y - 0.2, within = sphere { } }",
    "implicit { field = fn(p: vec3) = dot(p, p) - 0.5, within = sphere { radius = X } }",
    "polyline { points = [(0, 0, 0), (X, 1, 0)], radius = 0.1 }",
    "polyline { points = [(0, 0, 0), (1, 1, 0)], radius = X }",
    "difference { box { }, sphere { radius = X } }",
    "for (i in 0..3) { sphere { center = (i * X, 0, 0), radius = 0.3 } }",
};
constexpr std::string_view materials[] = {
    "diffuse = rgb(X, 0.5, 0.5)",
    "emission = rgb(X, 0, 0)",
    "specular = rgb(1, 1, 1), shininess = X",
    "transmit = rgb(1, 1, 1), ior = X",
    "transmit = rgb(X, X, X), ior = 1.5",
    "reflect = rgb(X, 0, X)",
    "diffuse = spectrum([(500, X), (600, 0.5)])",
    "diffuse = fn(s: surface) = rgb(1, 1, 1) * sin(s.p.x * X)",
    "emission = fn(s: surface) = rgb(1, 1, 1) * (s.p.x / X)",
    "emission = fn(s: surface) = rgb(1, 1, 1) * (s.p.x ^ X)",
    "emission = fn(s: surface) = rgb(1, 0, 1) * log(s.p.x)",
    "reflect = fn(s: surface) = rgb(1, 0, 1) / (s.p.x - s.p.x)",
    "specular = rgb(1, 1, 1), shininess = fn(s: surface) = sqrt(s.p.x) * X",
    "bump = fn(s: surface) = sin(s.p.x * X)",
};
constexpr std::string_view views[] = {
    "point_light { position = (X, 3, 3) }",
    "point_light { position = (2, 3, 3), color = rgb(X, 1, 1) }",
    "point_light { position = (2, 3, 3), attenuation = (X, 0, 0) }",
    "point_light { position = (2, 3, 3), attenuation = (0, 0, X) }",
    "directional_light { towards = (X, 1, 1) }",
    "directional_light { towards = (X, X, X) }",
    "spot_light { position = (2, 3, 3), target = (X, 0, 0) }",
    "rectangle_light { corner = (1, 3, 1), edge_u = (X, 0, 0), edge_v = (0, 0, 1) }",
    "world { ambient = rgb(X, X, X), background = rgb(X, 0, 0) }",
    "perspective_camera { eye = (X, 2, 4) }",
    "perspective_camera { eye = (0, 0, X) }",
    "perspective_camera { eye = (1, 2, 4), target = (X, 0, 0) }",
    "perspective_camera { eye = (1, 2, 4), up = (0, X, 0) }",
    "perspective_camera { eye = (1, 2, 4), fov_y = X * 1rad }",
    "perspective_camera { eye = (1, 2, 4), aperture = X }",
    "perspective_camera { eye = (1, 2, 4), aperture = 0.1, focus = X }",
    "perspective_camera { eye = (1, 2, 4), near = X }\nrender { method = raster { } }",
    "perspective_camera { eye = (1, 2, 4), far = X }\nrender { method = raster { } }",
    "orthographic_camera { eye = (1, 2, 4), height = X }",
};

std::string with(std::string text, std::string_view number) {
    for (std::size_t at = text.find('X'); at != std::string::npos; at = text.find('X', at)) {
        text.replace(at, 1, "(" + std::string(number) + ")");
    }
    return text;
}

/// A picture, or an error: no exception, and no pixel that is not a number. Whether it is a picture.
bool draw_or_refuse(const std::string& text) {
    SCOPED_TRACE(text);
    test::Compiled compiled = test::compile(text);
    if (!compiled.fine) {
        EXPECT_NE(compiled.messages.find("error: "), std::string::npos);
        return false;
    }
    run_passes(compiled.scene);
    runtime::RenderRequest request;
    request.settings = compiled.scene.settings;
    request.settings.width = request.settings.height = 8;
    request.crop = {0, 0, 8, 8};
    request.threads = 1;
    for (const Precision precision : {Precision::single, Precision::full}) {
        runtime::Image image(8, 8);
        make_drawable(compiled.scene, precision).render(request, image);
        EXPECT_TRUE(std::none_of(image.pixels.begin(), image.pixels.end(), [](float value) {
            return std::isnan(value);
        })) << name_of(precision);
    }
    return true;
}

/// How many numbers give a picture.
int draw_or_refuse_with_each_number(const std::string& text) {
    int drawn = 0;
    for (const std::string_view number : numbers) {
        EXPECT_NO_THROW(drawn += draw_or_refuse(with(text, number)) ? 1 : 0) << with(text, number);
    }
    return drawn;
}

constexpr const char* camera = "\nperspective_camera { eye = (1, 2, 4), fov_y = 40deg }";
constexpr const char* light = "\npoint_light { position = (3, 4, 5) }";

TEST(Extremes, OfShapesAreDrawnOrRefused) {
    int drawn = 0;
    for (const std::string_view shape : shapes) {
        drawn += draw_or_refuse_with_each_number(std::string(shape) + camera + light);
    }
    EXPECT_GT(drawn, 100);
}

TEST(Extremes, OfMaterialsAreDrawnOrRefused) {
    int drawn = 0;
    for (const std::string_view fields : materials) {
        const std::string text = "sphere { material = phong { " + std::string(fields) + " } }";
        drawn += draw_or_refuse_with_each_number(text + camera + light);
    }
    EXPECT_GT(drawn, 100);
}

TEST(Extremes, OfLightsAndCamerasAreDrawnOrRefused) {
    int drawn = 0;
    for (const std::string_view thing : views) {
        const bool is_camera = thing.find("camera") != thing.npos;
        drawn += draw_or_refuse_with_each_number("sphere { }\n" + std::string(thing) +
                                                 (is_camera ? light : camera));
    }
    EXPECT_GT(drawn, 100);
}

} // namespace
} // namespace scc::compiler
