#include "compiler/backends/blender.h"
#include "compiler/backends/render.h"
#include "compiler/test/folder.h"
#include "compiler/test/support.h"
#include "runtime/host/read_image.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

/// The emitted scripts in Blender.
namespace scc::compiler {
namespace {

namespace fs = std::filesystem;
using runtime::Image;
using test::run;

class BlenderRender : public testing::Test {
protected:
    void SetUp() override {
        if (!test::has_program("blender")) {
            GTEST_SKIP() << "blender is not installed";
        }
    }

    ir::Scene scene_of(const std::string& text) {
        test::Compiled c = test::compile(text + "\nrender { size = (64, 48) }\n");
        EXPECT_TRUE(c.fine) << c.messages;
        run_passes(c.scene);
        return c.scene;
    }

    int blender(const ir::Scene& scene, const std::string& options) {
        Ledger ledger;
        test::save(folder_ / "scene.py", emit_blender(scene, ledger));
        return run("blender -b --factory-startup --python-exit-code 1 -P " + (folder_ / "scene.py").string() +
                   " -- " + options);
    }
    std::string picture() const { return (folder_ / "out.exr").string(); }

    Image drawn(const ir::Scene& scene, const std::string& options = "") {
        EXPECT_EQ(blender(scene, "--render " + picture() + " " + options), 0);
        return host::read_image(picture());
    }

    /// How many pixels differ by more than 1e-4 from our own picture: those where an outline or a shadow's
    /// edge runs right through a pixel's centre.
    int differing_pixels(const ir::Scene& scene) {
        const Image theirs = drawn(scene);
        Image ours(theirs.width, theirs.height);
        runtime::RenderRequest request;
        request.settings = scene.settings;
        request.settings.samples = 1;
        request.crop = {0, 0, ours.width, ours.height};
        make_drawable(scene, Precision::full).render(request, ours);
        int count = 0;
        for (std::size_t i = 0; i < ours.pixels.size(); i += 3) {
            const auto differs = [&](std::size_t k) {
                return !(std::abs(ours.pixels[k] - theirs.pixels[k]) < 1e-4F);
            };
            count += differs(i) || differs(i + 1) || differs(i + 2) ? 1 : 0;
        }
        return count;
    }

    test::Folder folder_;
};

TEST_F(BlenderRender, FollowsTheLecturesFormula) {
    const Image image = drawn(scene_of(R"(
world { ambient = rgb(0.2, 0.3, 0.4) }
orthographic_camera { eye = (0, 0, 5), target = (0, 0, 0), height = 3 }
point_light { position = (0.5, 0.3, 2), color = rgb(1, 0.8, 0.6), attenuation = (0.5, 0.2, 0.1) }
plane {
  normal = (0, 0, 1)
  material = phong { diffuse = rgb(0.5, 0.25, 0.1), ambient = rgb(0.3, 0.2, 0.1), specular = rgb(0.4, 0.4, 0.9),
                     shininess = 8, emission = rgb(0, 0.1, 0) }
})"));
    ASSERT_EQ(image.width, 64);
    ASSERT_EQ(image.height, 48);
    for (const auto& [column, row] : {std::pair{0, 0}, {63, 0}, {31, 23}, {42, 19}, {10, 40}}) {
        const double x = (column + 0.5 - 32) / 16, y = (24 - row - 0.5) / 16;
        const double sx = 0.5 - x, sy = 0.3 - y, d = std::sqrt(sx * sx + sy * sy + 4);
        const double cosine = 2 / d;
        const double hx = sx / d, hy = sy / d, hz = cosine + 1;
        const double lobe = std::pow(hz / std::sqrt(hx * hx + hy * hy + hz * hz), 8);
        const double fade = 0.5 + 0.2 * d + 0.1 * d * d;
        const std::array expected{0.2 * 0.3 + 0.0 + 1.0 * (0.5 * cosine + 0.4 * lobe) / fade,
                                  0.3 * 0.2 + 0.1 + 0.8 * (0.25 * cosine + 0.4 * lobe) / fade,
                                  0.4 * 0.1 + 0.0 + 0.6 * (0.1 * cosine + 0.9 * lobe) / fade};
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(image.at(column, row)[c], expected[c], 2e-6) << column << ", " << row;
        }
    }
}

const std::string things_around = R"(
plane { material = phong { diffuse = rgb(0.4, 0.5, 0.6) } }
point_light { position = (1, 4, 3) }
sphere { center = (0, 1, -2), radius = 0.7, material = phong { diffuse = rgb(0.8, 0.2, 0.1) } }
box { min = (-3, 0, 1), max = (-2, 2, 2) }
)";

const std::string floor_of_tiles = R"(
world { ambient = rgb(0.2, 0.2, 0.2), background = rgb(0.35, 0.5, 0.7) }
perspective_camera { eye = (0.5, 1.5, 5), target = (0, 0.6, 0), fov_y = 40deg }
point_light { position = (3, 6, 4), color = rgb(0.9, 0.9, 0.9) }
fn tiles(s: surface) -> color =
  if ((floor(s.p.x) + floor(s.p.z)) % 2 == 0) rgb(0.85, 0.8, 0.7) else rgb(0.15, 0.2, 0.25)
disc { radius = 6, material = phong { diffuse = tiles } }
let tinted = phong { diffuse = rgb(0.1, 0, 0), transmit = rgb(0.6, 0.4, 0.5) }
let water = phong { diffuse = rgb(0, 0, 0), transmit = rgb(0.8, 0.9, 0.95), ior = 1.33 }
)";

/// With coloured shadows. Curved bodies show their meshes where what is behind them changes.
TEST_F(BlenderRender, SeesThroughSurfacesAsWeDo) {
    struct Case {
        const char *name, *shapes;
        int differing;
    };
    for (const Case& one : {
             Case{"pane", "box { min = (-1, 0.1, -0.2), max = (1, 1.3, 0.2), material = tinted }", 0},
             Case{"mirroring pane",
                  "box { min = (-1, 0.1, -0.2), max = (1, 1.3, 0.2), material = phong { diffuse = rgb(0, 0, "
                  "0), "
                  "transmit = rgb(0.6, 0.4, 0.5), reflect = rgb(0.2, 0.2, 0.2) } }",
                  0},
             Case{"opacity",
                  "cylinder { from = (0, 0.1, 0), to = (0, 1.5, 0), radius = 0.5, material = phong { diffuse "
                  "= "
                  "rgb(0.2, 0.6, 0.25), opacity = fn(s: surface) = 0.9 - 0.35 * s.p.y } }",
                  2},
             Case{"slab",
                  "box { min = (-1, 0.1, -0.2), max = (1, 1.3, 0.2), material = water, transform = "
                  "rotate_y(20deg) }",
                  0},
             Case{"prism",
                  "box { min = (-0.5, 0.1, -0.5), max = (0.5, 1.1, 0.5), material = water, transform = "
                  "rotate_y(30deg) }",
                  3},
             Case{"ball", "sphere { center = (0, 0.9, 0), radius = 0.7, material = water }", 6},
             Case{"glass", "sphere { center = (0, 0.9, 0), radius = 0.7, material = glass { ior = 1.5 } }",
                  55},
             Case{"bubble",
                  "sphere { center = (0, 0.9, 0), radius = 0.7, material = water }\n"
                  "sphere { center = (0.1, 1, 0.1), radius = 0.3, material = phong { diffuse = rgb(0, 0, 0), "
                  "transmit = rgb(1, 1, 1) } }",
                  10},
         }) {
        const int differing = differing_pixels(scene_of(floor_of_tiles + one.shapes));
        std::printf("%s: %d pixels differ by more than 1e-4\n", one.name, differing);
        EXPECT_LE(differing, one.differing) << one.name;
    }
}

/// What bends light takes a bounce: with one, the inside of a ball is seen, and nothing through it.
TEST_F(BlenderRender, EndsWaysThroughGlassWhereWeDo) {
    ir::Scene scene = scene_of(R"(
world { background = rgb(0.35, 0.5, 0.7) }
perspective_camera { eye = (1, 2, 6), target = (0, 0.7, 0), fov_y = 38deg }
point_light { position = (4, 7, 5) }
fn stripes(s: surface) -> color = rgb(0.5 + 0.4 * sin(3 * s.p.x), 0.5, 0.2)
disc { radius = 9, material = phong { diffuse = stripes } }
sphere { center = (0, 1.05, 0), material = glass { ior = 1.5 } })");
    scene.settings.depth = 1;
    EXPECT_LE(differing_pixels(scene), 3);
}

TEST_F(BlenderRender, PanoramasAndTheCornersOfPixelsAgree) {
    ir::Scene scene = scene_of(things_around + "spherical_camera { eye = (0, 1.5, 1), target = (1, 1.2, -1), "
                                               "up = (0.1, 1, 0), fov_x = 300deg, fov_y = 170deg }");
    EXPECT_LE(differing_pixels(scene), 2);
    scene.settings.point = runtime::PixelPoint::corner;
    EXPECT_LE(differing_pixels(scene), 2);
    scene = scene_of(things_around + "perspective_camera { eye = (1, 2, 6), shift = (0.1, 0) }");
    scene.settings.point = runtime::PixelPoint::corner;
    EXPECT_LE(differing_pixels(scene), 2);
}

TEST_F(BlenderRender, LensesConvergeToTheSamePicture) {
    ir::Scene scene =
        scene_of(things_around +
                 "perspective_camera { eye = (0, 2, 6), target = (0, 0.7, 0), aperture = 0.5, focus = 5 }");
    scene.settings.samples = 1024;
    scene.settings.sampler = runtime::Sampler::low_discrepancy;
    Image ours(64, 48);
    make_drawable(scene, Precision::full)
        .render({.settings = scene.settings, .crop = {0, 0, 64, 48}, .progress = {}}, ours);
    const Image theirs = drawn(scene, "--size 128x96 --samples 64");
    double squares = 0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 3 * 64; ++x) {
            const auto from = [&](int i, int j) {
                return double{theirs.at(0, 2 * y + j)[x / 3 * 6 + 3 * i + x % 3]};
            };
            const double mean = (from(0, 0) + from(1, 0) + from(0, 1) + from(1, 1)) / 4;
            squares += std::pow(mean - double{ours.at(0, y)[x]}, 2);
        }
    }
    EXPECT_LT(std::sqrt(squares / (64 * 48 * 3)), 6e-3);
}

TEST_F(BlenderRender, MirrorsAddWhatTheySeeAndLightsLeaveShadows) {
    // Straight down onto a mirror that sees the sky, and onto a disc's shadow.
    const Image image = drawn(scene_of(R"(
world { ambient = rgb(0, 0, 0), background = rgb(2, 4, 8) }
orthographic_camera { eye = (0, 5, 0), target = (0, 0, 0), up = (0, 0, -1), height = 4.8 }
directional_light { direction = (1, -1, 0), color = rgb(1, 1, 1) }
plane { material = phong { diffuse = rgb(0.5, 0.5, 0.5), ambient = rgb(0, 0, 0), reflect = rgb(0.5, 0.25, 0.125) } }
disc { center = (-2, 2, 0), radius = 0.8, material = phong { diffuse = rgb(0, 0, 0) } })"));
    const double lit = 0.5 / std::sqrt(2.0);
    EXPECT_NEAR(image.at(31, 23)[0], 1, 1e-6) << "in the shadow: the sky alone";
    EXPECT_NEAR(image.at(60, 23)[0], 1 + lit, 1e-6);
    EXPECT_NEAR(image.at(60, 23)[1], 1 + lit, 1e-6);
    EXPECT_NEAR(image.at(60, 23)[2], 1 + lit, 1e-6);
    EXPECT_NEAR(image.at(12, 23)[0], 0, 1e-6) << "the disc hides the plane";
}

TEST_F(BlenderRender, DrawsTheLectureSceneAsWeDo) {
    EXPECT_LE(differing_pixels(scene_of(R"(
world { ambient = rgb(0.2, 0.2, 0.2), background = #202830 }
perspective_camera { eye = (4, 3, 6), target = (0, 0.5, 0), fov_y = 40deg }
point_light { position = (4, 6, 3), attenuation = (1, 0.05, 0.01) }
directional_light { direction = (-1, -2, -1), color = rgb(0.3, 0.3, 0.35) }
let red = phong { diffuse = rgb(0.7, 0.1, 0.1), specular = rgb(0.6, 0.6, 0.6), shininess = 40 }
let mirror = phong { diffuse = rgb(0.05, 0.05, 0.05), reflect = rgb(0.8, 0.8, 0.8) }
fn checker(s: surface) -> color =
  if ((floor(s.p.x) + floor(s.p.z)) % 2 == 0) rgb(0.8, 0.8, 0.8) else rgb(0.1, 0.1, 0.1)
sphere { material = red, transform = scale(1, 0.7, 1) then translate(0, 0.7, 0) }
cylinder { from = (2, 0, 0), to = (2, 1.6, 0), radius = 0.4, caps = false,
           material = two_sided { front = mirror, back = phong { diffuse = rgb(0.1, 0.2, 0.6) } } }
plane { material = phong { diffuse = checker } })")),
              3);
}

TEST_F(BlenderRender, DrawsEveryShapeUnderShearAndMirroringAsWeDo) {
    EXPECT_LE(differing_pixels(scene_of(R"(
perspective_camera { eye = (1, 4, 9), target = (0, 0.4, 0), fov_y = 40deg, shift = (0.05, -0.03) }
directional_light { towards = (2, 4, 3), color = rgb(0.8, 0.8, 0.75) }
point_light { position = (-4, 5, 6), color = rgb(0.4, 0.5, 0.6), specular = rgb(1, 0, 0) }
fn stripes(s: surface) -> color = rgb(0.5 + 0.4 * sin(3 * s.p.x), abs(s.n.y), if (s.world.y < 0.9) 0.7 else 0.2)
fn gloss(s: surface) -> number = 20 + 5 * s.p.y
let front = phong { diffuse = stripes, specular = rgb(0.4, 0.4, 0.4), shininess = gloss }
let sides = two_sided { front = front, back = phong { diffuse = rgb(0.1, 0.6, 0.2), reflect = rgb(0.3, 0.3, 0.3) } }
let mirrored = scale(-1, 1, 1)
let shear = matrix([1, 0.6, 0, 0,  0, 1, 0, 0,  0, 0.1, 1, 0,  0, 0, 0, 1])
group {
  material = sides
  sphere { center = (0.1, 0.8, 0), radius = 0.8, transform = shear then mirrored then translate(-3, 0, 0) }
  box { min = (-0.5, 0, -0.5), max = (0.5, 1, 0.5), transform = shear then rotate_y(25deg) then translate(-1, 0, 0) }
  cylinder { from = (0, 0, 0), to = (0.3, 1.4, 0), radius = 0.4, transform = mirrored then shear then translate(0.6, 0, 0) }
  cylinder { from = (0, 0, 0), to = (0.3, 1, 0.2), radius = 0.5, caps = false, transform = shear then translate(2, 0, 1) }
  cone { from = (0, 0, 0), to = (0.3, 1.1, 0), radius_from = 0.5, radius_to = 0.2, transform = mirrored then shear then translate(-3.1, 0, 2) }
  cone { from = (0, 0, 0), to = (0.2, 0.9, 0.2), radius_from = 0, radius_to = 0.5, caps = false, transform = shear then translate(2.8, 0, 2.4) }
  cone { radius_from = 0.4, transform = scale(1, 0.8, 1) then translate(0.1, 0, 2.6) }
  disc { center = (0, 0.7, 0), normal = (1, 0.3, 1), radius = 0.7, hole = 0.3, transform = mirrored then translate(3.4, 0, 0.4) }
  torus { center = (0, 0.4, 0), axis = (1, 2, 1), major = 0.4, minor = 0.15, transform = mirrored then shear then translate(-0.3, 0, 3.6) }
  triangle { points = [(0, 0, 0), (1.2, 0, 0.2), (0.5, 1.2, 0)], transform = mirrored then translate(-1.6, 0, 1.8) }
  triangle { points = [(0, 0, 0), (1.2, 0, 0.2), (0.5, 1.2, 0)], normals = [(-0.5, 0, 1), (0.5, 0, 1), (0, 0.6, 1)],
             transform = mirrored then translate(1.2, 0, 2.6) }
}
plane { normal = (0.1, 1, 0), offset = -0.1, material = phong { diffuse = rgb(0.5, 0.5, 0.5) }, transform = shear })")),
              3);
}

TEST_F(BlenderRender, DrawsSolidsAndImplicitSurfacesAsWeDo) {
    EXPECT_LE(differing_pixels(scene_of(R"(
perspective_camera { eye = (1, 3, 7), target = (0, 0.2, 0), fov_y = 40deg }
directional_light { towards = (2, 4, 3), color = rgb(0.8, 0.8, 0.75) }
point_light { position = (-4, 5, 6), color = rgb(0.4, 0.5, 0.6) }
fn stripes(s: surface) -> color = rgb(0.5 + 0.4 * sin(5 * s.p.x), abs(s.n.y), 0.3)
let striped = phong { diffuse = stripes, specular = rgb(0.4, 0.4, 0.4), shininess = 30 }
let sides = two_sided { front = phong { diffuse = rgb(0.2, 0.7, 0.2) }, back = phong { diffuse = rgb(0.7, 0.1, 0.1) } }
let shear = matrix([1, 0.6, 0, 0,  0, 1, 0, 0,  0, 0.1, 1, 0,  0, 0, 0, 1])
difference {
  transform = rotate_y(20deg) then translate(-1.4, 0, 0)
  box { material = striped, transform = shear then scale(0.9) }
  sphere { center = (0.5, 1, 0.7), radius = 0.8, material = striped, transform = scale(1, 0.9, 1.1) }
  cone { from = (-0.6, -2, 0.8), to = (-0.4, 1.2, 0.8), radius_from = 0.1, radius_to = 0.5, material = sides, transform = shear }
  cylinder { from = (-2, 0.3, 0), to = (2, 0.3, 0), radius = 0.25, material = sides }
}
implicit {
  field = fn(p: vec3) = dot(p, p) - 0.8 + 0.2 * sin(p.x * 5) * sin(p.y * 4)
  within = box { min = (-1, -0.7, -1), max = (1, 0.8, 1) }
  material = striped
  transform = scale(1, 1.2, 0.8) then rotate_z(30deg) then translate(1.5, 0.4, 0.3)
}
quadric {
  squares = (2, 3, 1)
  products = (0.3, 0, 0.4)
  linear = (0.1, 0, 0.2)
  constant = -0.2
  material = striped
  transform = shear then translate(0, 0, 2)
}
plane { normal = (0, 1, 0), offset = -1, material = phong { diffuse = rgb(0.5, 0.5, 0.5) } })")),
              14); // the outlines of meshes
}

TEST_F(BlenderRender, DrawsNothingOfWhatIsEmpty) {
    EXPECT_EQ(differing_pixels(scene_of(R"(
perspective_camera { eye = (1, 3, 7), target = (0, 0.2, 0) }
point_light { position = (-4, 5, 6) }
quadric { constant = 0 }
difference { sphere { }, box { min = (-2, -2, -2), max = (2, 2, 2) } }
plane { normal = (0, 1, 0), offset = -1 })")),
              0);
}

/// A closed mesh with normals at its vertices, from a box or a ball.
ir::Mesh bent_box(bool is_smooth) {
    ir::MeshArrays mesh;
    constexpr int n = 4;
    const auto vertex = [&](const runtime::Vec3<float>& p) { // one for each place
        const runtime::Vec3<float> place = is_smooth ? normalize(p) : p;
        for (std::uint32_t i = 0; 3 * i < mesh.positions.size(); ++i) {
            const float* const q = &mesh.positions[3 * i];
            if (std::abs(q[0] - place.x) + std::abs(q[1] - place.y) + std::abs(q[2] - place.z) < 1e-4F) {
                return i;
            }
        }
        mesh.positions.insert(mesh.positions.end(), {place.x, place.y, place.z});
        return static_cast<std::uint32_t>(mesh.positions.size() / 3 - 1);
    };
    for (int face = 0; face < 6; ++face) {
        const float side = face < 3 ? 1.0F : -1.0F;
        for (int i = 0; i < n * n; ++i) {
            const auto at = [&](int column, int row) {
                const float u = 2.0F * static_cast<float>(column) / n - 1,
                            v = (2.0F * static_cast<float>(row) / n - 1) * side;
                return vertex(face % 3 == 0   ? runtime::Vec3<float>{side, u, v}
                              : face % 3 == 1 ? runtime::Vec3<float>{v, side, u}
                                              : runtime::Vec3<float>{u, v, side});
            };
            const int column = i % n, row = i / n;
            const std::array<std::uint32_t, 4> corner{at(column, row), at(column + 1, row),
                                                      at(column + 1, row + 1), at(column, row + 1)};
            for (const std::size_t k : {0, 1, 2, 0, 2, 3}) {
                mesh.indices.push_back(corner[k]);
            }
        }
    }
    if (is_smooth) {
        mesh.normals = mesh.positions;
        mesh.normal_indices = mesh.indices;
    }
    return ir::make_mesh(is_smooth ? "ball" : "box", std::move(mesh));
}

/// Nested, mirrored, cut by what has no end, with formulas and normals of their own. Boxes and balls of size
/// 1 stand for the meshes.
TEST_F(BlenderRender, PutsSolidsWithMeshesTogetherAsWeDo) {
    ir::Scene scene = scene_of(R"(
perspective_camera { eye = (3, 3.2, 6.6), target = (0, 0.2, 0), fov_y = 34deg }
point_light { position = (3, 5, 3), color = rgb(0.9, 0.85, 0.8) }
let red = phong { diffuse = rgb(0.8, 0.2, 0.1), specular = rgb(0.3, 0.3, 0.3) }
let green = phong { diffuse = rgb(0.1, 0.7, 0.2) }
let blue = phong { diffuse = rgb(0.1, 0.2, 0.9) }
fn stripes(s: surface) -> color = rgb(0.5 + 0.4 * sin(5 * s.p.x), abs(s.n.y), 0.3)
let striped = phong { diffuse = stripes }
difference {
  transform = scale(-1, 1, 1) then rotate_y(30deg) then translate(-1.3, 0, 0)
  union {
    box { material = striped, transform = scale(0.8) }
    torus { major = 0.8, minor = 0.2, material = green }
    intersection {
      sphere { material = red, transform = scale(0.9, 0.5, 0.7) then rotate_x(20deg) then translate(0, 0.9, 0) }
      plane { normal = (0.1, 1, 0), offset = 1.4, material = blue }
    }
  }
  difference {
    sphere { center = (0.5, 0.5, 0.8), radius = 0.6, material = blue }
    box { transform = scale(0.2) then translate(0.4, 0.3, 0.5), material = green }
  }
}
intersection {
  transform = translate(1.6, 0, 0)
  quadric { squares = (1, -0.5, 1), constant = -0.4, material = green }
  box { transform = rotate_x(20deg), material = two_sided { front = striped, back = blue } }
  sphere { material = red, transform = scale(1.2) }
}
plane { normal = (0, 1, 0), offset = -1.2, material = phong { diffuse = rgb(0.5, 0.5, 0.5) } })");
    scene.meshes = {bent_box(false), bent_box(true)};
    for (ir::Object& member : scene.members) {
        if (const auto* ball = std::get_if<runtime::Sphere<double>>(&member.shape)) {
            if (ball->radius == 1) {
                member.shape = runtime::Mesh<double>{1};
            }
        } else if (std::holds_alternative<runtime::Box<double>>(member.shape)) {
            member.shape = runtime::Mesh<double>{0};
        }
    }
    derive_traits(scene);
    EXPECT_LE(differing_pixels(scene), 14); // outlines
}

TEST_F(BlenderRender, ShinesFromConesAndRectanglesAsWeDo) {
    EXPECT_LE(differing_pixels(scene_of(R"(
perspective_camera { eye = (3, 4, 7), target = (0, 0.5, 0) }
spot_light { position = (2, 4, 3), target = (0, 0.5, 0), color = rgb(0.8, 0.4, 0.3), specular = rgb(0.2, 0.6, 0.3) }
spot_light { position = (-3, 4, 3), target = (-1, 0, 1), inner = 12deg, outer = 12deg, attenuation = (0.5, 0.1, 0) }
spot_light { position = (-3, 3, -1), target = (0, 0, 1), inner = 5deg, outer = 50deg, exponent = 7 }
rectangle_light { corner = (2, 3, -2), edge_u = (1, 0, 0), edge_v = (0, 0.5, 1), samples = (3, 2) }
directional_light { towards = (2, 4, 3), color = rgb(0.2, 0.2, 0.2) }
sphere { center = (0, 1, 0), material = phong { specular = rgb(0.3, 0.2, 0.1) } }
plane { })")),
              3);
}

/// Looked up in images, with the slopes of their formulas.
TEST_F(BlenderRender, HasTheSameNoiseAsWeHave) {
    EXPECT_LE(differing_pixels(scene_of(R"(
perspective_camera { eye = (3, 3.2, 6.6), target = (0, 0.2, 0), fov_y = 34deg }
point_light { position = (3, 5, 3) }
fn marble(s: surface) -> color = rgb(0.9, 0.8, 0.6) * noise(s.p * 5) + rgb(0, 0, 0.3) * noise((2 * s.p.x, s.p.y))
fn tiles(s: surface) -> color = rgb(random(floor(s.p.x * 4.1), floor(s.p.z * 4.1)), 0.5, random(floor(s.p.x * 4.1), 3, 7))
sphere { center = (-1.2, 0, 0), material = phong { diffuse = marble, bump = fn(s: surface) = 0.03 * noise(s.p * 8) } }
box { min = (0.5, -1.05, -1.05), max = (2, 0.1, 1.1), material = phong { diffuse = tiles } }
implicit {
  field = fn(p: vec3) = p.y - 0.3 * noise((p.x * 2, p.z * 2)) - 0.3
  within = box { min = (-0.45, -0.45, -0.45), max = (0.45, 0.45, 0.45) }
  material = phong { diffuse = marble }
  transform = translate(1.2, 0.7, 0)
}
plane { normal = (0, 1, 0), offset = -1.2, material = phong { diffuse = rgb(0.5, 0.5, 0.5) } })")),
              8);
}

TEST_F(BlenderRender, DrawsMeshesAsWeDo) {
    ir::Scene scene = scene_of(R"(
perspective_camera { eye = (1, 2, 6), target = (0, 0, 0) }
point_light { position = (-4, 5, 6) }
box { min = (-3, -1.2, -3), max = (3, -1, 3) })");
    ir::MeshArrays mesh;
    constexpr std::uint32_t n = 12;
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const float x = float(i % n) / 4 - 1.4F, z = float(i / n) / 4 - 1.4F;
        mesh.positions.insert(mesh.positions.end(), {x, 0.3F * std::sin(3 * x) * std::cos(2 * z), z});
        const std::array slope{-0.9F * std::cos(3 * x) * std::cos(2 * z), 1.0F,
                               0.6F * std::sin(3 * x) * std::sin(2 * z)};
        const float length = std::sqrt(slope[0] * slope[0] + 1 + slope[2] * slope[2]);
        for (const float c : slope) {
            mesh.normals.push_back(c / length);
        }
        if (i % n < n - 1 && i / n < n - 1) {
            mesh.indices.insert(mesh.indices.end(), {i, i + n, i + 1, i + 1, i + n, i + n + 1});
        }
    }
    mesh.normal_indices = mesh.indices;
    scene.meshes.push_back(ir::make_mesh("grid", mesh));
    scene.objects.push_back({.shape = runtime::Mesh<double>{0},
                             .world_from_object = {},
                             .sides = {},
                             .path = "mesh[1]",
                             .span = {}});
    derive_traits(scene);
    EXPECT_LE(differing_pixels(scene), 3);
}

TEST_F(BlenderRender, DrawsWithoutLightsFromAmbientAndEmission) {
    ir::Scene scene = scene_of(R"(
world { ambient = rgb(0.5, 0.5, 0.5), background = rgb(0, 0, 1) }
perspective_camera { eye = (0, 0, 4), target = (0, 0, 0) }
sphere { material = phong { ambient = rgb(0.2, 0.4, 0.6), emission = rgb(0, 3, 0) } })");
    scene.lights.clear();
    const Image image = drawn(scene, "--size 32x24");
    ASSERT_EQ(image.width, 32);
    EXPECT_NEAR(image.at(16, 12)[0], 0.1, 1e-6);
    EXPECT_NEAR(image.at(16, 12)[1], 3.2, 1e-6);
    EXPECT_NEAR(image.at(0, 0)[2], 1, 1e-6);
}

TEST_F(BlenderRender, HasAnArtistsLook) {
    const Image image =
        drawn(scene_of("perspective_camera { }\npoint_light { position = (0, 2, 5) }\n"
                       "sphere { material = two_sided { front = phong { reflect = rgb(0.2, 0.2, 0.2) }, "
                       "back = phong { } } }"),
              "--look artist --samples 4");
    EXPECT_GT(image.at(32, 24)[0], 0.01F);
}

TEST_F(BlenderRender, RefusesBadOptionsAndLeavesNoPicture) {
    const ir::Scene scene = scene_of("perspective_camera { }\npoint_light { }\nsphere { }");
    EXPECT_EQ(blender(scene, "--render " + picture() + " --size 64"), 2);
    EXPECT_EQ(blender(scene, "--render " + picture() + " --look shiny"), 2);
    EXPECT_EQ(blender(scene, "--render " + (folder_ / "absent" / "out.exr").string()), 2);
    EXPECT_FALSE(fs::exists(picture()));
    EXPECT_EQ(blender(scene, "--help"), 0);
    EXPECT_EQ(blender(scene, ""), 0) << "builds only";
    EXPECT_FALSE(fs::exists(picture()));
}

} // namespace
} // namespace scc::compiler
