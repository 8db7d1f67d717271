#include "compiler/cli/test/support.h"
#include "lang/diagnostic.h"
#include "runtime/host/exr.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

/// The diagnostics that only a whole scene or an export shows, as an author sees them; those of the front end
/// are in lang/test/check_coverage_test.cpp.
namespace scc::cli::test {
namespace {

using lang::Diag;

struct Case {
    const char* scene;
    std::vector<std::string> command = {"check", "s.scn"};
};

const std::string camera_and_light = "perspective_camera { }\npoint_light { position = (3, 4, 5) }\n";

const std::map<Diag, Case>& cases() {
    static const std::vector<std::string> export_blender{"export", "blender", "s.scn", "-o", "s.py"};
    static const std::vector<std::string> export_with_drop{"export", "blender", "s.scn",
                                                           "-o",     "s.py",    "--allow-drop"};
    static const char* tiny = "sphere { radius = 1e-9 }\npoint_light { position = (0, 1e-8, 5e-8) }\n"
                              "perspective_camera { eye = (0, 0, 5e-8), near = 1e-9, far = 1e-6 }\n";
    static const std::map<Diag, Case> rows{
        {Diag::impossible_shape, {"cylinder { from = (0, 1, 0), to = (0, 1, 0) }\n"}},
        {Diag::thin_line, {"polyline { points = [(0, 0, 0), (1, 1, 0)] }\n"}},
        {Diag::unusable_container,
         {"implicit { field = fn(p: vec3) = p.x, within = cylinder { caps = false } }\n"}},
        {Diag::unbounded_field,
         {"fn f(p: vec3) -> number = p.y + 1 / (p.x - 0.3)\nimplicit { field = f, within = sphere { } }\n"}},
        {Diag::singular_transform,
         {"group {\n  name = \"table\"\n  transform = scale(2e-8, 1, 1)\n  group {\n    transform = "
          "scale(2e-8, 1, 1)\n"
          "    sphere { transform = scale(0.1, 1, 1) }\n  }\n}\n"}},
        {Diag::endless_transform, {"sphere { transform = translate(log(0), 0, 0) }\n"}},
        {Diag::open_solid,
         {"difference {\n  box { }\n  cylinder { radius = 0.5, caps = false }\n  disc { }\n"
          "  heightfield { field = fn(uv: vec2) = uv.x, cells = (2, 2) }\n"
          "  mesh { file = \"plain.obj\" }\n}\n"}},
        {Diag::unbounded_solid, {"union {\n  sphere { }\n  plane { }\n}\n"}},
        {Diag::empty_solid,
         {"intersection {\n  sphere { }\n  sphere { center = (5, 0, 0) }\n}\nsphere { }\n"}},
        {Diag::coincident_faces,
         {"difference {\n  box { min = (-1, 0, -1), max = (1, 1, 1) }\n"
          "  cylinder { from = (0, 0, 0), to = (0, 2, 0), radius = 0.3 }\n}\n"}},
        {Diag::impossible_camera, {"sphere { }\nperspective_camera { eye = (0, 1, 0) }\n"}},
        {Diag::impossible_light,
         {"sphere { }\ndirectional_light { direction = (0, 1, 0), towards = (0, 1, 0) }\n"}},
        {Diag::impossible_sampling,
         {"sphere { }\nrender { method = ray { samples = 64, adaptive = 0.01, sampler = \"grid\" } }\n"}},
        {Diag::unknown_camera, {"let left = perspective_camera { }\nleft\nrender { camera = \"right\" }\n"}},
        {Diag::missing_asset, {"mesh { file = \"none.obj\" }\n"}},
        {Diag::asset_outside, {"mesh { file = \"/etc/passwd\" }\n"}},
        {Diag::broken_mesh, {"mesh { file = \"broken.obj\" }\n"}},
        {Diag::broken_image,
         {"let q = image { file = \"broken.png\" }\n"
          "plane { material = phong { diffuse = fn(s: surface) = q(s.uv) } }\n"}},
        {Diag::linear_image,
         {"let q = image { file = \"light.exr\", encoding = \"srgb\" }\n"
          "plane { material = phong { diffuse = q((0, 0)) } }\n"}},
        {Diag::mesh_without_uv,
         {"fn f(s: surface) -> color = rgb(s.uv.x, s.uv.y, 0)\n"
          "mesh { file = \"plain.obj\", material = phong { diffuse = f } }\n"}},
        {Diag::suspect_mesh, {"mesh { file = \"suspect.obj\" }\n"}},
        {Diag::several_iors,
         {"let a = phong { transmit = rgb(1, 1, 1), ior = 1.5 }\n"
          "difference {\n  sphere { material = a }\n"
          "  box { min = (0, 0, 0), material = phong { transmit = rgb(1, 1, 1), ior = 1.33 } }\n}\n"}},
        {Diag::bump_of_normal, {"sphere { material = phong { bump = fn(s: surface) = s.n.x } }\n"}},
        {Diag::idle_bump, {"sphere { material = phong { bump = fn(s: surface) = floor(s.p.x) } }\n"}},
        {Diag::open_refraction,
         {"disc { material = phong { transmit = rgb(1, 1, 1), ior = 1.5, diffuse = rgb(0, 0, 0) } }\n"}},
        {Diag::idle_ior, {"sphere { material = phong { ior = 1.5 } }\n"}},
        {Diag::bright_reflectance, {"sphere { material = phong { diffuse = rgb(1, 1.2, 0.5) } }\n"}},
        {Diag::depth_precision,
         {"sphere { }\nperspective_camera {\n  eye = (0, 0, 50)\n  near = 1e-6\n}\nplane { }\n"}},
        {Diag::depth_gap,
         {"plane { }\ndisc { center = (0, 0.001, 0) }\nperspective_camera {\n  eye = (0, 20, 100)\n  near = "
          "0.1\n}\nrender { method = raster { } }\n"}},
        {Diag::far_from_origin, {"for (i in 0..3) {\n  sphere { center = (1e6, i, 0) }\n}\n"}},
        {Diag::narrow_line,
         {"let line = spectrum([(589.5, 0), (589.5 + 1e-10, 1)])\nsphere { material = phong { diffuse = "
          "line } }\n"}},
        {Diag::beyond_double, {"sphere { }\northographic_camera { eye = (0, 0, 1e14), height = 4 }\n"}},
        {Diag::no_camera, {"sphere { }\n"}},
        {Diag::no_light, {"sphere { }\n"}},
        {Diag::one_frame,
         {"sphere { center = (frame, 0, 0) }\nrender { frames = 2..5 }\n",
          {"build", "s.scn", "-o", "s.ir", "--emit", "ir"}}},
        {Diag::render_left_out, {"sphere { }\nrender { }\nrender { method = raster { } }\n"}},
        {Diag::raster_needs_plane, {"sphere { }\nspherical_camera { }\nrender { method = raster { } }\n"}},
        {Diag::raster_leaves_out,
         {"sphere { }\nperspective_camera { aperture = 0.1 }\nrender { method = raster { } }\n"}},
        {Diag::raster_left_out,
         {"intersection { box { }; quadric { squares = (1, -1, 0) } }\nrender { method = raster { } }\n"}},
        {Diag::unsupported_setting,
         {"let relief = image { file = \"light.exr\", encoding = \"linear\" }\n"
          "implicit { field = fn(p: vec3) = p.z - relief((p.x, p.y)).r, within = sphere { } }\n"}},
        {Diag::not_exportable, {tiny, export_blender}},
        {Diag::dropped, {tiny, export_with_drop}},
    };
    return rows;
}

// It would take gigabytes: the limit is there because no machine has the memory.
constexpr Diag too_large_for_a_test = Diag::too_many_objects;

TEST(Messages, EveryDiagnosticOfTheWholeSceneHasACase) {
    for (int i = 0; i < static_cast<int>(Diag::unexpected_character); ++i) {
        const auto kind = static_cast<Diag>(i);
        EXPECT_TRUE(cases().contains(kind) || kind == too_large_for_a_test) << lang::row(kind).kind;
    }
}

TEST_F(CommandLine, EveryDiagnosticOfTheWholeSceneReadsAsItShould) {
    write("broken.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n");
    write("suspect.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
    write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("broken.png", "no picture");
    write("light.exr", host::encode_exr(runtime::Image(1, 1), false));
    std::string text;
    for (const auto& [kind, scene] : cases()) {
        const std::string name(lang::row(kind).name);
        const bool has_both = std::string_view(scene.scene).find("camera") != std::string_view::npos ||
                              kind == Diag::no_camera || kind == Diag::no_light;
        write("s.scn", scene.scene + (has_both ? "" : camera_and_light));
        const std::string message = scc(scene.command).err;
        EXPECT_NE(message.find("[" + name + "]\n"), std::string::npos) << name << ": " << message;
        text += fmt::format("==== {}\n{}", name, message);
    }
    const std::string file = SCC_SOURCE_DIR "/compiler/cli/test/golden/messages.txt";
    if (std::getenv("SCC_UPDATE_GOLDEN") != nullptr) {
        host::replace_file(file, text);
        return;
    }
    std::ifstream in(file, std::ios::binary);
    EXPECT_EQ(text, std::string(std::istreambuf_iterator<char>(in), {})) << "SCC_UPDATE_GOLDEN=1 rewrites it";
}

} // namespace
} // namespace scc::cli::test
