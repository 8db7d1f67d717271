#include "compiler/backends/blender.h"
#include "compiler/backends/function_program.h"
#include "compiler/backends/pov.h"
#include "compiler/function_builder.h"
#include "compiler/pipeline.h"
#include "compiler/resolve_bumps.h"
#include "compiler/resolve_uv.h"
#include "compiler/test/folder.h"
#include "compiler/test/support.h"
#include "runtime/host/png.h"
#include "runtime/host/read_image.h"
#include "runtime/host/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace scc::compiler {
namespace {

using runtime::Ray;
using runtime::Vec3;

/// The results of a function at a point on a surface.
std::vector<double> values(const ir::Function& function, const runtime::SurfacePoint<double>& point) {
    const auto program = program_of<double>(function);
    const double* registers = run(program, point);
    std::vector<double> results;
    for (const std::uint32_t result : program.results) {
        results.push_back(registers[result]);
    }
    return results;
}

/// Reads uv and gives it back.
ir::Function read_uv() {
    FunctionBuilder builder;
    const std::uint32_t u = builder.input("uv.x"), v = builder.input("uv.y");
    return builder.finish({{0, u}, {0, v}, {0, u}});
}

/// A shape's uv and what is told of it from p alone agree all over the surface.
template <class Shape>
void expect_told_from_p(const Shape& shape) {
    const ir::Function function = with_uv_of(shape, read_uv());
    EXPECT_FALSE(function.reads(ir::Input::uv_x, ir::Input::uv_y));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    int met = 0;
    for (int i = 0; i < 4000 || met < 200; ++i) {
        ASSERT_LT(i, 1'000'000);
        const auto vector = [&] { return Vec3<double>{unit(random), unit(random), unit(random)}; };
        const Vec3<double> target = vector() * 2.0;
        const Ray<double> ray{target + normalize(vector()) * 9.0, vector()};
        const Ray<double> aimed{ray.org, target - ray.org};
        const auto hit = shape.intersect(aimed);
        if (!(hit.t < runtime::infinity<double>())) {
            continue;
        }
        ++met;
        const Vec3<double> p = shape.surface(aimed, hit).point;
        const runtime::Vec2<double> uv = shape.uv(aimed, hit, p);
        const std::vector<double> told = values(function, {p, p, {}, {}});
        EXPECT_NEAR(told[0], uv.x, 1e-9);
        EXPECT_NEAR(told[1], uv.y, 1e-9);
    }
}

TEST(ResolveUv, WhatIsToldFromPIsTheShapesOwn) {
    expect_told_from_p(runtime::Sphere<double>{{0.2, -0.1, 0.3}, 1.3});
    expect_told_from_p(runtime::Box<double>{{-1, -0.4, 0.1}, {1.5, 0.7, 0.9}});
    expect_told_from_p(runtime::Plane<double>{normalize(Vec3<double>{0.3, 1, -0.2}), 0.4});
    expect_told_from_p(runtime::Disc<double>{{0.1, 0.2, 0}, normalize(Vec3<double>{1, -2, 0.5}), 1.5, 0.3});
    expect_told_from_p(runtime::Cylinder<double>{{-0.3, -1, 0}, {0.4, 1, 0.5}, 0.8, true});
    expect_told_from_p(runtime::Cylinder<double>{{-0.3, -1, 0}, {0.4, 1, 0.5}, 0.8, false});
    expect_told_from_p(runtime::Cone<double>{{0, -1, 0}, {0.2, 1.2, 0}, 1.2, 0, true});
    expect_told_from_p(runtime::Cone<double>{{0, -1, 0}, {0.2, 1.2, 0}, 0.3, 1.1, true});
    runtime::Triangle<double> triangle;
    triangle.points = {{{-1, -1, 0.2}, {2, -0.5, 0}, {0, 1.5, -0.3}}};
    triangle.uvs = {{{3, 1}, {-1, 2}, {0, -4}}};
    expect_told_from_p(triangle);
}

// ---- bumps -----------------------------------------------------------------------------------------------

/// sin(2 p.x + p.y) + world.z p.x
ir::Function waves() {
    FunctionBuilder b;
    const std::uint32_t x = b.input("p.x"), y = b.input("p.y"), z = b.input("world.z");
    const std::uint32_t phase = b.apply("add", {b.apply("mul", {b.constant(2), x}), y});
    return b.finish({{0, b.apply("add", {b.apply("sin", {phase}), b.apply("mul", {z, x})})}});
}

runtime::Affine<double> oblique() {
    return {{{1.3, 0.2, 0, 0.5}, {-0.4, 0.8, 0.1, -0.2}, {0.3, 0, 1.6, 1}}};
}

/// By the point in the world, of a function of p alone.
Vec3<double> gradient(const ir::Function& function, const Vec3<double>& p,
                      const runtime::Affine<double>& place) {
    using Number = runtime::Dual<double, 3>;
    const runtime::Vec3<Number> point{Number::variable(p.x, 0), Number::variable(p.y, 1),
                                      Number::variable(p.z, 2)};
    const auto program = program_of<double>(function);
    const runtime::Vec3<Number> world = runtime::transform_point(place, point);
    const Number value = run(program, runtime::SurfacePoint<Number>{point, world, {}})[program.results[0]];
    return transform_normal(inverse(place), Vec3<double>{value.d[0], value.d[1], value.d[2]});
}

/// What goes to other renderers has the gradient of the height, along the surface or as a whole.
template <class Shape>
void expect_slopes(const Shape& shape) {
    ir::Object object{.shape = shape, .world_from_object = oblique(), .sides = {}, .path = "it", .span = {}};
    const ir::Scene scene;
    const auto along = height_along_surface(waves(), object, scene);
    const auto slope = world_slope(waves(), object.world_from_object);
    ASSERT_TRUE(along && slope) << Shape::name;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int met = 0; met < 100;) {
        const auto vector = [&] { return Vec3<double>{unit(random), unit(random), unit(random)}; };
        const Vec3<double> target = vector(), from = target + normalize(vector()) * 9.0;
        const Ray<double> ray{from, target - from};
        const auto hit = shape.intersect(ray);
        if (!(hit.t < runtime::infinity<double>())) {
            continue;
        }
        ++met;
        const runtime::Surface<double> surface = shape.surface(ray, hit);
        const Vec3<double> n = normalize(transform_normal(inverse(oblique()), surface.normal));
        const Vec3<double> whole = gradient(waves(), surface.point, oblique());
        const Vec3<double> expected = whole - n * dot(whole, n);
        EXPECT_LT(length(gradient(*along, surface.point, oblique()) - expected), 1e-8) << Shape::name;
        const std::vector<double> told = values(*slope, {surface.point, {}, {}, {}});
        EXPECT_LT(length(Vec3<double>{told[0], told[1], told[2]} - whole), 1e-10) << Shape::name;
    }
}

TEST(ResolveBumps, OtherRenderersGetTheSlopeAlongEverySurface) {
    expect_slopes(runtime::Sphere<double>{{0.2, -0.1, 0.3}, 1.3});
    expect_slopes(runtime::Box<double>{{-1, -0.4, 0.1}, {1.5, 0.7, 0.9}});
    expect_slopes(runtime::Plane<double>{normalize(Vec3<double>{0.3, 1, -0.2}), 0.4});
    expect_slopes(runtime::Disc<double>{{0.1, 0.2, 0}, normalize(Vec3<double>{1, -2, 0.5}), 1.5, 0.3});
    expect_slopes(runtime::Cylinder<double>{{-0.3, -1, 0}, {0.4, 1, 0.5}, 0.8, true});
    expect_slopes(runtime::Cone<double>{{0, -1, 0}, {0.2, 1.2, 0}, 0.3, 1.1, false});
    expect_slopes(runtime::Torus<double>{{0, 0.3, 0}, normalize(Vec3<double>{0.2, 1, 0.1}), 1, 0.3});
    expect_slopes(runtime::Quadric<double>{{1, 0.5, 2}, {0.2, 0, 0.1}, {0, 0.3, 0}, -0.5});
    runtime::Triangle<double> triangle;
    triangle.points = {{{-1, -1, 0.2}, {2, -0.5, 0}, {0, 1.5, -0.3}}};
    expect_slopes(triangle);
}

class Textures : public testing::Test {
protected:
    void save_image(const std::string& name, const runtime::Image& image, int bits = 8) const {
        test::save(folder_ / name, host::encode_png(image, bits));
    }
    /// 2 x 2: red, green over blue, white.
    void save_quarters() const {
        runtime::Image image(2, 2);
        image.pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
        save_image("q.png", image);
    }
    Loaded load_scene(const std::string& text) {
        test::save(folder_ / "s.scn", text);
        SceneOptions options;
        options.file = (folder_ / "s.scn").string();
        options.keep_meshes = false;
        return load(options, Stage::scene);
    }
    static std::string messages(const Loaded& loaded) {
        std::string text;
        for (const lang::Diagnostic& diagnostic : loaded.diagnostics.sorted()) {
            text += std::string(lang::row(diagnostic.kind).name) + "\n";
        }
        return text;
    }
    const test::Folder folder_;
};

const std::string view = "perspective_camera { }\npoint_light { position = (0, 5, 5) }\n";

TEST_F(Textures, AreKnownWhereTheirPlaceIs) {
    save_quarters();
    const Loaded loaded = load_scene(
        view + "let q = image { file = \"q.png\" }\nassert(q((0.25, 0.75)) == rgb(1, 0, 0), \"upper left\")\n"
               "assert(q((0.75, 0.25)) == rgb(1, 1, 1), \"lower right\")\n"
               "for (i in 0..100) { sphere { material = phong { diffuse = q((i / 100, 0.25)) } } }\n"
               "sphere { material = phong { shininess = 5 + luminance(q((0.25, 0.25))) } }\n");
    EXPECT_EQ(messages(loaded), "");
    EXPECT_TRUE(loaded.scene.functions.empty());
    EXPECT_FALSE(loaded.scene.traits.uv);
}

TEST_F(Textures, AreLookedUpByFunctionsOfAPoint) {
    save_quarters();
    const Loaded loaded = load_scene(
        view + "let q = image { file = \"q.png\" }\nlet again = image { file = \"q.png\" }\n"
               "plane { material = phong { diffuse = fn(s: surface) = q(s.uv) * again(s.uv) } }\n");
    EXPECT_EQ(messages(loaded), "");
    ASSERT_EQ(loaded.scene.functions.size(), 1U);
    const ir::Function& function = loaded.scene.functions[0];
    EXPECT_EQ(function.images.size(), 1U) << "the same image is one";
    EXPECT_TRUE(loaded.scene.traits.uv);
    EXPECT_EQ(values(function, {{}, {}, {}, {0.25, 0.25}}), (std::vector<double>{0, 0, 1}));
    EXPECT_EQ(values(function, {{}, {}, {}, {0.5, 0.25}}), (std::vector<double>{0.25, 0.25, 1}));
}

TEST_F(Textures, GreyStandsInAllChannelsAndCodesAreDecoded) {
    runtime::Image image(1, 1, 1);
    image.pixels = {static_cast<float>(host::decode_srgb(100 / 255.0))};
    save_image("grey.png", image);
    const Loaded loaded =
        load_scene(view + "let srgb_encoded = image { file = \"grey.png\" }\n"
                          "let linear = image { file = \"grey.png\", encoding = \"linear\" }\n"
                          "assert(linear((0, 0)) == rgb(1, 1, 1) * linear((0, 0)).g, \"grey\")\n"
                          "assert(abs(srgb_encoded((3, 4)).r - srgb(100 / 255, 0, 0).r) < 1e-7, \"srgb\")\n"
                          "assert(abs(linear((0, 0)).b - 100 / 255) < 1e-7, \"linear\")\n");
    EXPECT_EQ(messages(loaded), "");
}

TEST_F(Textures, FilesThatCannotBeReadAreTheScenesMistakes) {
    save_quarters();
    test::save(folder_ / "no.png", "this is no picture");
    const std::string whole = host::encode_png(runtime::Image(64, 64));
    test::save(folder_ / "cut.png", whole.substr(0, whole.size() / 2));
    save_image("wide.png", runtime::Image(16385, 1));
    const auto with = [&](const std::string& file) {
        return messages(load_scene(view + "let q = image { file = \"" + file +
                                   "\" }\nfn f(s: surface) -> color = q(s.uv) + q(2 * s.uv)\n"
                                   "plane { material = phong { diffuse = f } }\nprint(q((0, 0)))\n"));
    };
    EXPECT_EQ(with("q.png"), "");
    EXPECT_EQ(with("no.png"), "broken-image\n") << "said once";
    EXPECT_EQ(with("cut.png"), "broken-image\n");
    EXPECT_EQ(with("wide.png"), "broken-image\n");
    EXPECT_EQ(with("none.png"), "missing-asset\n");
    EXPECT_EQ(with("/etc/hostname"), "asset-outside\n");
    EXPECT_EQ(with("../../etc/hostname"), "asset-outside\n");
    EXPECT_EQ(with("."), "broken-image\n");
}

TEST_F(Textures, MeshesWithoutCoordinatesAreWarnedOf) {
    save_quarters();
    test::save(folder_ / "with.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    test::save(folder_ / "part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nf 1/1 2/2 3\n");
    const auto with = [&](const std::string& mesh, const std::string& field) {
        return messages(load_scene(view + "let q = image { file = \"q.png\" }\nmesh { " + mesh +
                                   ", material = phong { diffuse = fn(s: surface) = " + field + " } }\n"));
    };
    EXPECT_EQ(with("file = \"with.obj\"", "q(s.uv)"), "");
    EXPECT_EQ(with("file = \"part.obj\"", "q(s.uv)"), "mesh-without-uv\n");
    EXPECT_EQ(with("file = \"with.obj\", uv = false", "q(s.uv)"), "mesh-without-uv\n");
    EXPECT_EQ(with("file = \"part.obj\"", "q((s.p.x, s.p.y))"), "");
}

TEST_F(Textures, FieldsOfImplicitSurfacesCannotReadThem) {
    save_quarters();
    const Loaded loaded =
        load_scene(view + "let q = image { file = \"q.png\" }\nimplicit { field = fn(p: vec3) = "
                          "q((p.x, p.y)).r - 0.5, within = sphere { } }\n");
    EXPECT_EQ(messages(loaded), "not-supported-yet\n");
}

// ---- exports -------------------------------------------------------------------------------------------

TEST_F(Textures, APovExportHasThemBesideIt) {
    save_quarters();
    const Loaded loaded =
        load_scene(view + "let q = image { file = \"q.png\" }\n"
                          "sphere { material = phong { diffuse = fn(s: surface) = q(s.uv) } }\n");
    ASSERT_EQ(messages(loaded), "");
    ExportFiles files{.stem = "out"};
    Ledger ledger;
    const std::string text = emit_pov(loaded.scene, ledger, files);
    ASSERT_EQ(files.files.size(), 1U);
    EXPECT_EQ(files.files[0].name, "out_image_q.png");
    EXPECT_NE(text.find("png \"out_image_q.png\" gamma srgb interpolate 2"), std::string::npos) << text;
    test::save(folder_ / "written.png", files.files[0].bytes);
    const runtime::Image written = host::read_image((folder_ / "written.png").string());
    EXPECT_EQ(written.pixels, host::read_image((folder_ / "q.png").string()).pixels);
    for (const LedgerEntry& entry : ledger) {
        EXPECT_EQ(entry.fidelity, Fidelity::exact) << entry.how;
    }
}

TEST_F(Textures, SixteenBitsAreStretchedAndTheBoundIsSaid) {
    runtime::Image image(2, 1);
    image.pixels = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
    save_image("deep.png", image, 16);
    const Loaded loaded =
        load_scene(view + "let q = image { file = \"deep.png\", wrap = \"clamp\" }\n"
                          "plane { material = phong { diffuse = fn(s: surface) = q(s.uv) } }\n");
    ExportFiles files{.stem = "out"};
    Ledger ledger;
    const std::string text = emit_pov(loaded.scene, ledger, files);
    EXPECT_NE(text.find("gamma 1.0 interpolate 2"), std::string::npos);
    EXPECT_NE(text.find("min(max("), std::string::npos);
    const auto approximated = std::find_if(ledger.begin(), ledger.end(), [](const LedgerEntry& entry) {
        return entry.fidelity == Fidelity::approximated;
    });
    ASSERT_NE(approximated, ledger.end());
    EXPECT_NEAR(approximated->bound, 0.5 / 65535 / 2, 1e-8);
}

TEST_F(Textures, OnMeshesPovReadsUvOrThePoint) {
    save_quarters();
    test::save(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    const auto ledger_of = [&](const std::string& diffuse, std::string& text) {
        const Loaded loaded =
            load_scene(view +
                       "let q = image { file = \"q.png\" }\nmesh { file = \"m.obj\", material = phong { "
                       "diffuse = fn(s: surface) = " +
                       diffuse + " } }\n");
        EXPECT_EQ(messages(loaded), "");
        ExportFiles files{.stem = "out"};
        Ledger ledger;
        text = emit_pov(loaded.scene, ledger, files);
        int dropped = 0;
        for (const LedgerEntry& entry : ledger) {
            dropped += entry.fidelity == Fidelity::dropped ? 1 : 0;
        }
        return dropped;
    };
    std::string text;
    EXPECT_EQ(ledger_of("q(s.uv)", text), 0);
    EXPECT_NE(text.find("texture { uv_mapping m_"), std::string::npos) << text;
    EXPECT_NE(text.find("uv_vectors {\n        3, <0, 0>, <1, 0>, <0, 1>\n"), std::string::npos) << text;
    EXPECT_EQ(ledger_of("s.p.x * q(s.uv)", text), 2); // diffuse, and ambient after it
}

TEST_F(Textures, NoiseWithoutBoundsIsDroppedForPov) {
    const auto dropped = [&](const std::string& shape) {
        const Loaded loaded =
            load_scene(view + "fn f(s: surface) -> color = rgb(1, 1, 1) * noise(s.p * 3)\n" + shape);
        EXPECT_EQ(messages(loaded), "");
        ExportFiles files{.stem = "out"};
        Ledger ledger;
        emit_pov(loaded.scene, ledger, files);
        const bool has_table = !files.files.empty();
        const bool is_dropped = std::any_of(ledger.begin(), ledger.end(), [](const LedgerEntry& entry) {
            return entry.fidelity == Fidelity::dropped;
        });
        EXPECT_NE(has_table, is_dropped);
        return is_dropped;
    };
    EXPECT_FALSE(dropped("sphere { material = phong { diffuse = f } }\n"));
    EXPECT_TRUE(dropped("plane { material = phong { diffuse = f } }\n"));
    EXPECT_TRUE(dropped("sphere { radius = 1000, material = phong { diffuse = f } }\n"));
}

TEST_F(Textures, ABlenderScriptHoldsThem) {
    save_quarters();
    const Loaded loaded =
        load_scene(view + "let q = image { file = \"q.png\", wrap = \"clamp\", filter = \"nearest\" }\n"
                          "sphere { material = phong { diffuse = fn(s: surface) = q(s.uv) } }\n");
    Ledger ledger;
    const std::string text = emit_blender(loaded.scene, ledger);
    EXPECT_NE(text.find("wrap=\"EXTEND\", filter=\"Closest\""), std::string::npos);
    EXPECT_NE(text.find("g.image(\"q\", "), std::string::npos);
}

} // namespace
} // namespace scc::compiler
