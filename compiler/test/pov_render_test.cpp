#include "compiler/backends/pov.h"
#include "compiler/backends/render.h"
#include "compiler/test/folder.h"
#include "compiler/test/support.h"
#include "runtime/host/read_image.h"
#include "runtime/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

/// The emitted SDL in POV-Ray.
namespace scc::compiler {
namespace {

using runtime::Image;

class PovRender : public testing::Test {
protected:
    void SetUp() override {
        if (!test::has_program("povray")) {
            GTEST_SKIP() << "povray is not installed";
        }
    }

    static ir::Scene scene_of(const std::string& text) {
        test::Compiled c = test::compile(text);
        EXPECT_TRUE(c.fine) << c.messages;
        c.scene.settings.width = 96;
        c.scene.settings.height = 72;
        run_passes(c.scene);
        return c.scene;
    }

    /// With the exposure that keeps the brightest pixel below 1, undone afterwards.
    Image theirs(const ir::Scene& scene, double exposure) {
        Ledger ledger;
        ExportFiles beside{.stem = "scene"};
        test::save(folder_ / "scene.pov", emit_pov(scene, ledger, beside));
        for (const ExportFiles::File& file : beside.files) {
            test::save(folder_ / file.name, file.bytes);
        }
        const std::string picture = (folder_ / "scene.png").string();
        const std::string command =
            "cd " + (folder_ / "").string() + " && povray +Iscene.pov +Oscene.png +W" +
            std::to_string(scene.settings.width) + " +H" + std::to_string(scene.settings.height) +
            " +FN16 File_Gamma=1.0 -A -D +WT1 Declare=scc_exposure=" + std::to_string(exposure);
        EXPECT_EQ(test::run(command), 0) << command;
        return host::read_image(picture, true);
    }

    static Image ours(const ir::Scene& scene) {
        Image image(scene.settings.width, scene.settings.height);
        runtime::RenderRequest request;
        request.settings = scene.settings;
        request.settings.samples = 1;
        request.crop = {0, 0, image.width, image.height};
        make_drawable(scene, Precision::full).render(request, image);
        return image;
    }

    /// Half a step of the 16-bit file and POV-Ray's own float colours, times the exposure; nothing for edges.
    void expect_same_picture(const std::string& text, int outliers = 0) {
        const ir::Scene scene = scene_of(text);
        const Image expected = ours(scene);
        const float peak = *std::max_element(expected.pixels.begin(), expected.pixels.end());
        ASSERT_GT(peak, 0.1F) << "nothing to be seen";
        const double exposure = std::min(1.0, std::exp2(std::floor(-std::log2(double{peak}))));
        const Image found = theirs(scene, exposure);
        ASSERT_EQ(found.width, expected.width);
        ASSERT_EQ(found.height, expected.height);
        int differing = 0;
        double worst = 0;
        for (int y = 0; y < found.height; ++y) {
            for (int x = 0; x < found.width; ++x) {
                double difference = 0;
                for (int c = 0; c < 3; ++c) {
                    difference = std::max(
                        difference, std::abs(found.at(x, y)[c] / exposure - double{expected.at(x, y)[c]}));
                }
                differing += difference * exposure > 2e-5 ? 1 : 0;
                worst = std::max(worst, difference);
            }
        }
        EXPECT_LE(differing, outliers) << "worst " << worst;
    }

    test::Folder folder_;
};

const std::string room = R"(
world { ambient = rgb(0.2, 0.25, 0.3), background = rgb(0.1, 0.15, 0.2) }
plane { material = phong { diffuse = rgb(0.4, 0.5, 0.6) } }
)";
const std::string camera = "perspective_camera { eye = (3, 4, 7), target = (0, 0.5, 0), fov_y = 45deg }\n";
const std::string lamp = "point_light { position = (3, 6, 4), color = rgb(0.8, 0.7, 0.6) }\n";

TEST_F(PovRender, PanoramasAndTheCornersOfPixelsAgree) {
    const std::string things = room + lamp +
                               "sphere { center = (0, 1, -2), radius = 0.7, material = phong { diffuse = "
                               "rgb(0.8, 0.2, 0.1), reflect = rgb(0.3, 0.3, 0.3) } }\n"
                               "box { min = (-3, 0, 1), max = (-2, 2, 2) }\n";
    const std::string corners = "render { sampling = \"corner\" }\n";
    expect_same_picture(things +
                        "spherical_camera { eye = (0, 1.5, 1), target = (1, 1.2, -1), up = (0.1, 1, 0) }");
    expect_same_picture(things + "spherical_camera { eye = (0, 1.5, 1), fov_x = 120deg, fov_y = 70deg }");
    expect_same_picture(things + camera + corners);
    expect_same_picture(things + "orthographic_camera { eye = (1, 3, 5), height = 5 }\n" + corners);
}

/// POV-Ray draws what each of a few points of the lens sees by a pinhole camera, its window shifted so that
/// the plane in focus stays in place; their mean comes near to the lens.
TEST_F(PovRender, LensesAreTheMeanOfItsPinholes) {
    constexpr int pinholes = 16;
    ir::Scene scene = scene_of(room + lamp + R"(
perspective_camera { eye = (0, 2, 6), target = (0, 0.7, 0), aperture = 0.5, focus = 5 }
sphere { center = (-1, 1, 1), material = phong { diffuse = rgb(0.8, 0.2, 0.1) } }
sphere { center = (1, 1, -4), material = phong { diffuse = rgb(0.2, 0.3, 0.8) } }
)");
    scene.settings.samples = 256;
    scene.settings.sampler = runtime::Sampler::low_discrepancy;
    Image lens(scene.settings.width / 2, scene.settings.height / 2);
    runtime::RenderRequest request{
        .settings = scene.settings, .crop = {0, 0, lens.width, lens.height}, .progress = {}};
    request.settings.width = lens.width;
    request.settings.height = lens.height;
    make_drawable(scene, Precision::full).render(request, lens);

    const runtime::Camera<double> camera_with_lens = scene.camera;
    std::vector<double> mean(lens.pixels.size());
    for (int i = 0; i < pinholes; ++i) {
        const runtime::SquarePoint point = runtime::SobolPoints({7, 3}, runtime::PointUse::lens)[i];
        const runtime::Vec2<double> at =
            runtime::in_disc(runtime::part_of_unit<double>(point.x), runtime::part_of_unit<double>(point.y));
        runtime::Camera<double>& c = scene.camera = camera_with_lens;
        c.lens_radius = 0;
        c.eye = c.eye + camera_with_lens.lens_radius * (at.x * c.u + at.y * c.v);
        const double shift = -camera_with_lens.lens_radius / c.focus / (2 * c.half_height);
        c.shift_x = shift * at.x;
        c.shift_y = shift * at.y;
        const Image seen = theirs(scene, 1);
        for (int y = 0; y < seen.height; ++y) {
            for (int x = 0; x < 3 * seen.width; ++x) {
                const int to = y / 2 * 3 * lens.width + x / 6 * 3 + x % 3;
                mean[static_cast<std::size_t>(to)] += double{seen.at(0, y)[x]} / (4 * pinholes);
            }
        }
    }
    double squares = 0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        squares += std::pow(mean[i] - double{lens.pixels[i]}, 2);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(mean.size())), 6e-3);
}

/// A row per shape, and where each stands in the picture.
struct PlacedShape {
    const char *shape, *place;
};
constexpr PlacedShape every_shape[] = {
    {"sphere { center = (0.1, 0, 0), radius = 0.5", "(-3, 0.9, -1)"},
    {"box { min = (-0.4, -0.5, -0.3), max = (0.5, 0.4, 0.6)", "(-1.5, 0.9, -1)"},
    {"cylinder { from = (0, -0.5, 0), to = (0.2, 0.5, 0), radius = 0.4", "(0, 0.9, -1)"},
    {"cylinder { from = (0, -0.5, 0), to = (0.2, 0.5, 0), radius = 0.4, caps = false", "(1.5, 0.9, -1)"},
    {"disc { normal = (0.3, 0.4, 1), radius = 0.6, hole = 0.2", "(3, 0.9, -1)"},
    {"cone { from = (0, -0.5, 0), to = (0.2, 0.5, 0), radius_from = 0.4, radius_to = 0.15", "(-2.6, 0.9, 1)"},
    {"cone { from = (0, -0.5, 0), to = (0.2, 0.5, 0), radius_from = 0, radius_to = 0.4, caps = false",
     "(-1.3, 0.9, 1)"},
    {"cone { from = (0, -0.3, 0), to = (0.1, 0.3, 0), radius_from = 0.3", "(0, 0.9, 1)"},
    {"torus { center = (0, 0.1, 0), axis = (0.3, 0.5, 1), major = 0.45, minor = 0.15", "(1.3, 0.9, 1)"},
    {"quadric { squares = (2, 3, 4), products = (0.5, 0, 1), linear = (0.2, 0, 0), constant = -0.8",
     "(2.6, 0.9, 1)"},
    {"triangle { points = [(-0.5, -0.4, 0), (0.6, -0.3, 0.1), (0, 0.6, 0)]", "(-2, 0.9, 2.6)"},
    {"triangle { points = [(-0.5, -0.4, 0), (0, 0.6, 0), (0.6, -0.3, 0.1)]", "(-0.8, 0.9, 2.6)"},
    {"quadric { squares = (1, -0.8, 1), constant = -0.05, within = box { min = (-0.4, -0.5, -0.4), max = "
     "(0.4, "
     "0.5, 0.4) }",
     "(0.5, 0.9, 2.6)"},
    {"heightfield { field = fn(uv: vec2) = 0.2 * sin(9 * uv.x) * cos(7 * uv.y), cells = (6, 5)",
     "(1.8, 0.9, 2.6)"},
    {"polyline { points = [(-0.3, -0.3, 0), (0.3, 0, 0.2), (-0.1, 0.4, 0)], radius = 0.12", "(-3, 0.9, 2.6)"},
};
/// From the identity to a mirror image.
constexpr std::pair<const char*, const char*> transforms[] = {
    {"identity", "scale(1)"},
    {"rotated", "rotate((1, 2, 3), 40deg)"},
    {"stretched", "scale(1.2, 0.7, 0.9) then rotate((1, 2, 3), 40deg)"},
    {"sheared", "matrix([1, 0.3, 0, 0, 0, 0.8, 0.2, 0, 0.1, 0, 1, 0, 0, 0, 0, 1])"},
    {"mirrored", "matrix([-1, 0.3, 0, 0, 0, 0.8, 0.2, 0, 0.1, 0, 1, 0, 0, 0, 0, 1])"},
};

/// All with their own material on either side.
std::string shapes_under(const std::string& transform) {
    std::string text = room + lamp + R"(
perspective_camera { eye = (3, 6, 8), target = (0, 0.6, 0.8), fov_y = 45deg }
let front = phong { diffuse = rgb(0.7, 0.3, 0.2), specular = rgb(0.3, 0.1, 0.2), shininess = 20 }
let back = phong { diffuse = rgb(0.2, 0.3, 0.8), specular = rgb(0.2, 0.2, 0.2) }
let sides = two_sided { front = front, back = back }
)";
    for (const auto& [shape, place] : every_shape) {
        text += std::string(shape) + ", material = sides, transform = " + transform + " then translate" +
                place + " }\n";
    }
    return text;
}

TEST_F(PovRender, DrawsEveryShapeUnderEveryTransform) {
    for (const auto& [name, transform] : transforms) {
        SCOPED_TRACE(name);
        expect_same_picture(shapes_under(transform), 1);
    }
}

TEST_F(PovRender, CutsSolids) {
    const std::string sides = R"(
let red = phong { diffuse = rgb(0.7, 0.3, 0.2), specular = rgb(0.3, 0.1, 0.2), shininess = 20 }
let blue = phong { diffuse = rgb(0.2, 0.3, 0.8) }
let sides = two_sided { front = red, back = blue }
difference {
  material = red
  transform = rotate((1, 2, 3), 40deg) then scale(1, 0.8, 1) then translate(-1.2, 1.2, 0)
  union { box { min = (-0.8, -0.8, -0.8), max = (0.8, 0.6, 0.8) }, sphere { center = (0, 0.6, 0), radius = 0.7 } }
  cylinder { from = (0, -2, 0), to = (0.2, 2, 0), radius = 0.3, material = blue }
  difference { sphere { center = (0.8, 0, 0.8), radius = 0.7, material = sides }, box { min = (0.6, -1, -1), max = (0.7, 1, 2) } }
  plane { normal = (-1, -1, -1), offset = -0.8 }
}
intersection {
  material = blue
  transform = translate(1.3, 1, 0.5)
  sphere { radius = 0.9 }
  cone { from = (0, -1, 0), to = (0, 1, 0), radius_from = 1, radius_to = 0.3, material = sides }
  plane { normal = (0.5, 0, 1), offset = 0.3, material = red }
}
difference {
  material = red
  transform = scale(1, 0.8, 1) then translate(-1.5, 0.5, 2.6)
  torus { major = 0.6, minor = 0.3 }
  torus { center = (0, 0.2, 0), axis = (1, 0.2, 0), major = 0.5, minor = 0.12, material = blue }
  quadric { squares = (9, -6, 9), products = (0, 2, 0), constant = -1, material = sides }
}
union { sphere { center = (0, 0.4, 2.5), radius = 0.4, material = red }, box { min = (0, 0, 2), max = (1, 0.5, 2.6), material = blue } }
)";
    expect_same_picture(room + camera + lamp + sides);
}

/// Whose bounding box POV-Ray gets right only where their constant is -1.
TEST_F(PovRender, CutsHyperboloids) {
    expect_same_picture(room + camera + lamp + R"(
let red = phong { diffuse = rgb(0.7, 0.3, 0.2), specular = rgb(0.3, 0.1, 0.2), shininess = 20 }
intersection {
  material = red
  transform = translate(-1.2, 1, 0)
  quadric { squares = (1, -0.5, 1), constant = -0.4 }
  box { min = (-1.2, -0.9, -1.2), max = (1.2, 0.9, 1.2) }
}
intersection {
  material = red
  transform = translate(1.4, 1, 0)
  box { min = (-0.8, -0.8, -0.8), max = (0.8, 0.8, 0.8) }
  quadric { squares = (4, 6, -3), linear = (0.1, 0, 4), constant = -1.5 }
}
)");
}

TEST_F(PovRender, ShowsSolidsFromWithin) {
    expect_same_picture(room + lamp + R"(
perspective_camera { eye = (0, 1, 0), target = (0.3, 0.9, -1), fov_y = 70deg }
let red = phong { ambient = rgb(1, 0.5, 0.4), diffuse = rgb(0.7, 0.3, 0.2) }
union { box { min = (-1, -1, -3), max = (1, 2, 1), material = red }, sphere { center = (0, 1, -1), radius = 0.8 } }
)");
}

TEST_F(PovRender, InterpolatesNormals) {
    const std::string smooth = R"(
let m = phong { diffuse = rgb(0.6, 0.6, 0.5), specular = rgb(0.5, 0.5, 0.5), shininess = 15 }
let stretched = scale(1.5, 1, 0.7) then rotate_x(-20deg) then translate(0, 1, 0)
triangle { points = [(-1, -0.5, 0), (1, -0.5, 0), (0, 1, 0)], normals = [(-0.4, 0, 1), (0.4, 0.1, 2), (0, 0.5, 1)], material = m, transform = stretched }
triangle { points = [(1, -0.5, 0), (2, 1, 0), (0, 1, 0)], normals = [(-0.3, 0, 1), (0.4, 0.1, 1), (1, 0.5, -0.1)], material = m, transform = stretched }
)";
    expect_same_picture(room + camera + lamp + smooth, 1);
}

TEST_F(PovRender, DrawsLayeredMaterials) {
    std::string text = room + camera + lamp;
    const char* materials[] = {
        "diffuse = rgb(0.6, 0.3, 0.2), specular = rgb(0.3, 0.3, 0.3)",
        "diffuse = rgb(0.6, 0.3, 0), specular = rgb(0.3, 0, 0.1), ambient = rgb(0.5, 0.5, 0.5)",
        "diffuse = rgb(0.5, 0, 0.5), specular = rgb(0.1, 0.2, 0.1), shininess = 80, ambient = rgb(1, 1, 1), "
        "emission = "
        "rgb(0.1, 0.2, 0.3), reflect = rgb(0.2, 0.3, 0.4)",
        "diffuse = rgb(0, 0, 0), ambient = rgb(0, 0, 0), specular = rgb(0.4, 0.2, 0.1), shininess = 5",
        "diffuse = rgb(0, 0, 0), ambient = rgb(0, 0, 0), reflect = rgb(0.9, 0.5, 0.3)",
        "diffuse = rgb(0.6, 0.3, 0.2), ambient = rgb(0.1, 0.5, 0.2), emission = rgb(0.3, 0, 0)"};
    for (int i = 0; i < 6; ++i) {
        text += "sphere { center = (" + std::to_string(1.3 * i - 3.2) +
                ", 0.6, 0), radius = 0.6, material = phong { " + materials[i] + " } }\n";
    }
    expect_same_picture(text);
}

TEST_F(PovRender, EndsMirrorsAtTheDepth) {
    for (const char* depth : {"0", "1", "3"}) {
        expect_same_picture(room + camera + lamp + "render { method = ray { depth = " + depth + R"( } }
let mirror = phong { diffuse = rgb(0.1, 0.1, 0.1), reflect = rgb(0.8, 0.7, 0.9) }
sphere { center = (-1, 1, 0), radius = 1, material = mirror }
box { min = (0.5, 0, -1), max = (2, 2, 1), material = mirror }
)",
                            1);
    }
}

TEST_F(PovRender, FadesLights) {
    for (const char* law :
         {"(2, 0, 0)", "(1, 0, 0.05)", "(1, 0.5, 0)", "(0, 0, 0.1)", "(0, 0.3, 0)", "(0, 0.3, 0.1)",
          "(1, 1, 0.1)", "(1, 1, 0.25)", "(1, 0.05, 0.01)", "(1, 0.3, 0.08)"}) {
        SCOPED_TRACE(law);
        expect_same_picture(room + camera +
                            "sphere { center = (0, 1, 0) }\npoint_light { position = (2, 4, 3), color = "
                            "rgb(3, 2, 2), attenuation = " +
                            std::string(law) + " }\n");
    }
}

TEST_F(PovRender, ShinesFromConesAndRectangles) {
    expect_same_picture(room + camera + R"(
sphere { center = (0, 1, 0), material = phong { specular = rgb(0.3, 0.2, 0.1) } }
spot_light { position = (2, 4, 3), target = (0, 0.5, 0), color = rgb(0.8, 0.4, 0.3) }
spot_light { position = (-3, 4, 3), target = (-1, 0, 1), inner = 12deg, outer = 12deg, color = rgb(0.3, 0.6, 0.3), attenuation = (0.5, 0.1, 0) }
spot_light { position = (-3, 3, -1), target = (0, 0, 1), inner = 5deg, outer = 50deg, exponent = 7, color = rgb(0.2, 0.3, 0.7), attenuation = (1, 0.3, 0.08) }
rectangle_light { corner = (2, 3, -2), edge_u = (1, 0, 0), edge_v = (0, 0.5, 1), samples = (3, 2), color = rgb(0.4, 0.4, 0.4) }
)");
    expect_same_picture(room + camera + R"(
sphere { center = (0, 1, 0) }
rectangle_light { corner = (1, 3, 2), edge_u = (2, 0, 0), edge_v = (0, 0.5, 1), samples = (2, 3), color = rgb(4, 3, 2), attenuation = (1, 0.3, 0.08) }
)");
}

TEST_F(PovRender, GivesHighlightsTheirOwnColor) {
    for (const char* shadows : {"true", "false"}) {
        expect_same_picture(room + camera + "render { method = ray { shadows = " + shadows + R"( } }
let shiny = phong { diffuse = rgb(0.5, 0.4, 0.3), specular = rgb(0.5, 0.6, 0.4), shininess = 10 }
point_light { position = (3, 6, 4), color = rgb(0.6, 0.5, 0.4), specular = rgb(0.1, 0.9, 0.3), attenuation = (1, 0.1, 0) }
directional_light { towards = (-1, 2, 1), color = rgb(0.2, 0.2, 0.2), specular = rgb(0.4, 0, 0) }
sphere { center = (-1, 1, 0), material = shiny }
box { min = (0.5, 0, -1), max = (2, 1.2, 1), material = shiny }
)");
    }
}

TEST_F(PovRender, CalculatesPerPointFunctions) {
    expect_same_picture(room + camera + lamp + R"(
fn checker(s: surface) -> color = if ((floor(s.p.x + 0.3) + floor(s.p.y * 2) + floor(s.p.z)) % 2 == 0) rgb(0.8, 0.2, 0.1) else rgb(0.1, 0.3, 0.9)
fn waves(s: surface) -> color = rgb(0.5 + 0.4 * sin(9 * s.world.x), 0.3, 0.5 + 0.5 * cos(5 * s.world.y))
fn both(s: surface) -> color = mix(rgb(0.1, 0.2, 0.3), rgb(0.9, 0.5, 0.2), (s.p.x + 3 * s.world.z) % 1)
fn gloss(s: surface) -> number = if (s.p.y > 0.1) 60 else 4
fn polish(s: surface) -> number = 30 + 20 * sin(3 * s.p.y)
let turned = rotate((1, 2, 3), 40deg)
sphere { radius = 0.8, material = phong { diffuse = checker, specular = waves }, transform = turned then translate(-2, 0.8, 0) }
box { min = (-0.6, -0.6, -0.6), max = (0.6, 0.6, 0.6), material = phong { diffuse = waves }, transform = turned then translate(0, 0.9, 0) }
sphere { radius = 0.6, material = phong { diffuse = both, reflect = both }, transform = turned then translate(1.7, 0.7, 0) }
triangle { points = [(-0.5, -0.4, 0), (0.6, -0.3, 0.1), (0, 0.6, 0)], material = phong { diffuse = checker }, transform = turned then translate(0, 0.8, 2) }
sphere { radius = 0.4, material = phong { specular = rgb(0.5, 0.5, 0.5), shininess = gloss }, transform = translate(1.4, 0.5, 2) }
sphere { radius = 0.4, material = phong { specular = rgb(0.5, 0.5, 0.5), shininess = polish }, transform = translate(-1.4, 0.5, 2) }
)",
                        1);
}

TEST_F(PovRender, KeepsTinyHugeAndDistantScenes) {
    const auto scene = [](const std::string& size, const std::string& at) {
        return "world { ambient = rgb(0.2, 0.2, 0.2) }\nlet k = " + size + "\nlet o = " + at + R"(
perspective_camera { eye = o + k * (3, 3, 6), target = o + k * (0, 0.5, 0) }
point_light { position = o + k * (3, 6, 4), color = rgb(2, 2, 2), attenuation = (1, 0.3 / k, 0.08 / (k * k)) }
fn checker(s: surface) -> color = if ((floor((s.world.x - o.x) / k + 0.3) + floor((s.world.z - o.z) / k)) % 2 == 0) rgb(0.8, 0.2, 0.1) else rgb(0.1, 0.3, 0.9)
group {
    transform = scale(k) then translate(o)
    box { min = (-9, -1, -9), max = (9, 0, 9), material = phong { diffuse = checker } }
    sphere { center = (-1, 1, 0), material = phong { diffuse = rgb(0.6, 0.5, 0.4), specular = rgb(0.3, 0.3, 0.3) } }
    disc { center = (1, 1, 0), normal = (1, 0, 1), material = phong { diffuse = rgb(0.6, 0.5, 0.4) } }
    triangle { points = [(0, 0.5, 2), (1, 0.5, 2), (0.5, 1, 2)], material = phong { diffuse = rgb(0.2, 0.5, 0.4) } }
}
)";
    };
    expect_same_picture(scene("0.00001", "(0, 0, 0)"), 1);
    expect_same_picture(scene("1000000", "(0, 0, 0)"), 1);
    expect_same_picture(scene("1", "(1000000, 2000000, -3000000)"), 1);
}

TEST_F(PovRender, ShiftsTheWindow) {
    const std::string ball = room + lamp + "sphere { center = (0, 1, 0) }\n";
    expect_same_picture(ball +
                        "perspective_camera { eye = (3, 4, 7), target = (0, 0.5, 0), shift = (0.2, -0.1) }");
    expect_same_picture(
        ball +
        "orthographic_camera { eye = (3, 4, 7), target = (0, 0.5, 0), height = 6, shift = (0.2, 0.1) }");
}

TEST_F(PovRender, AcceptsNamesThatAreCode) {
    test::Compiled c = test::compile(room + camera + lamp + "box { }\n");
    ASSERT_TRUE(c.fine) << c.messages;
    run_passes(c.scene);
    const std::string bad = "x\" } #error \"out\" */ /* \\\n#error \"out\"\r sphere";
    c.scene.name = c.scene.objects[0].path = c.scene.materials[0].name = c.scene.lights[0].name = bad;
    c.scene.settings.width = 8;
    c.scene.settings.height = 6;
    theirs(c.scene, 1);
}

TEST_F(PovRender, NoiseAndRandomComeFromTables) {
    expect_same_picture(camera + lamp + R"(
world { ambient = rgb(0.3, 0.3, 0.3) }
fn worn(s: surface) -> color = rgb(0.8, 0.6, 0.3) * (1 - 0.7 * noise(s.p * 6))
fn windy(s: surface) -> color = rgb(noise(s.world * 3), noise((4 * s.p.x, -2 * s.p.y)), 0.5)
fn tiled(s: surface) -> color = rgb(1, 1, 1) * random(floor(4 * s.p.x), floor(4 * s.p.y) + 0 * 3, 7)
sphere { radius = 1.1, material = phong { diffuse = worn }, transform = scale(1, 0.8, 1) then translate(-2, 0.8, 0) }
box { max = (1, 1.01, 1), material = phong { diffuse = tiled }, transform = rotate_y(20deg) then translate(0.6, 0.6, -0.5) }
cone { radius_from = 1, material = phong { diffuse = windy }, transform = scale(1, 1.5, 1) then translate(2.6, 0, 1) }
)",
                        4);
}

TEST_F(PovRender, Transparency) {
    expect_same_picture(
        room + camera + lamp +
            "sphere { center = (-1.5, 1, 0), material = phong { diffuse = rgb(0.6, 0.2, 0.1), specular = "
            "rgb(0.4, "
            "0.2, 0.1), opacity = 0.4, transmit = rgb(0, 0.2, 0.1), reflect = rgb(0.1, 0.1, 0.2) } }\n"
            "box { min = (0.2, 0.01, -1), max = (0.4, 2, 1), material = phong { diffuse = rgb(0, 0, 0), "
            "specular "
            "= "
            "rgb(0.6, 0, 0.2), transmit = rgb(0.9, 0.5, 0) } }\n"
            "disc { center = (2, 1, 0), normal = (1, 0, 2), material = phong { diffuse = fn(s: surface) = "
            "rgb(0.5, "
            "0.4 * s.p.y, 0.1), specular = rgb(0.3, 0.3, 0.3), opacity = fn(s: surface) = 0.5 + 0.4 * sin(5 "
            "* "
            "s.p.x) } }\n"
            "render { method = ray { depth = 12 } }\n",
        4);
}

TEST_F(PovRender, Refraction) {
    expect_same_picture(
        room + camera + lamp +
            "let wet = phong { diffuse = rgb(0.05, 0, 0), transmit = rgb(0.8, 0.9, 0.95), ior = 1.33, "
            "specular = "
            "rgb(0.5, 0.3, 0.1), reflect = rgb(0.1, 0.1, 0.1) }\n"
            "let bubble = phong { diffuse = rgb(0, 0, 0), transmit = rgb(1, 1, 1), ior = 1 }\n"
            "sphere { center = (-1.5, 1.1, 0), material = glass { tint = rgb(1, 0.9, 0.8), specular = "
            "rgb(0.4, 0, "
            "0.3) } }\n"
            "sphere { center = (-1.4, 1.3, 0.1), radius = 0.4, material = bubble }\n"
            "box { min = (0.2, 0.1, -1), max = (1.8, 1.6, 0.6), material = glass { } }\n"
            "box { min = (0.3, 0.2, -0.9), max = (1.7, 1.2, 0.5), material = wet }\n"
            "difference {\n  material = glass { ior = 1.4, specular = rgb(0.2, 0.2, 0.2) }\n"
            "  sphere { center = (2.6, 0.9, 1.5), radius = 0.8 }\n  sphere { center = (2.6, 1.5, 1.8), "
            "radius = 0.6 "
            "}\n}\n"
            "render { method = ray { depth = 7 } }\n",
        4);
}

TEST_F(PovRender, CameraInGlassAndInWater) {
    expect_same_picture(
        room + camera + lamp +
            "let wet = phong { diffuse = rgb(0, 0, 0), transmit = rgb(0.9, 1, 0.9), ior = 1.5 }\n"
            "sphere { center = (0, 2, 2), radius = 9, material = phong { diffuse = rgb(0, 0, 0), transmit = "
            "rgb(0.9, 0.9, 1), ior = 1.33 } }\n"
            "box { min = (2, 3, 6), max = (4, 5, 8), material = wet }\n"
            "sphere { center = (0, 1, 0), material = wet }\n",
        4);
}

} // namespace
} // namespace scc::compiler
