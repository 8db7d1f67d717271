#include "runtime/accel/build.h"
#include "runtime/raster/draw.h"
#include "validation/bench/bench_mesh.h"
#include "validation/bench/series.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// The raster pipeline against llvmpipe in one process: lit meshes shaded by vertices, and layers that fill
/// the picture, at 1920 x 1080. Prints JSON.
namespace {

using namespace scc::bench;
namespace runtime = scc::runtime;
using nlohmann::json;
using runtime::Rgb;
using runtime::Vec3;

constexpr int width = 1920, height = 1080;

/// A mesh with normals at its vertices.
struct SmoothMesh {
    TriangleMesh mesh;
    std::vector<float> normals; ///< x y z for each of the mesh's positions
};

SmoothMesh smoothed(TriangleMesh mesh) {
    std::vector<Vec3<double>> sums(mesh.positions.size() / 3);
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const auto corner = [&](std::size_t k) {
            return runtime::lanes<double>(mesh.position(mesh.indices[3 * t + k]));
        };
        const Vec3<double> normal = cross(corner(1) - corner(0), corner(2) - corner(0));
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3<double>& sum = sums[mesh.indices[3 * t + k]];
            sum = sum + normal;
        }
    }
    SmoothMesh result{std::move(mesh), {}};
    for (const Vec3<double>& sum : sums) {
        const double size = length(sum);
        const Vec3<double> unit = size > 0 ? sum * (1 / size) : Vec3<double>{0, 1, 0};
        for (const double x : {unit.x, unit.y, unit.z}) {
            result.normals.push_back(static_cast<float>(x));
        }
    }
    return result;
}

/// Squares across the whole view, one behind the other, the nearest last.
SmoothMesh layers(int count) {
    SmoothMesh result;
    for (int i = 0; i < count; ++i) {
        const float z = -1 + 0.05F * static_cast<float>(i);
        const auto first = static_cast<std::uint32_t>(result.mesh.positions.size() / 3);
        for (const auto& [x, y] : {std::pair{-4.0F, -3.0F}, {4.0F, -3.0F}, {4.0F, 3.0F}, {-4.0F, 3.0F}}) {
            result.mesh.positions.insert(result.mesh.positions.end(), {x, y, z});
            result.normals.insert(result.normals.end(), {0, 0, 1});
        }
        for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
            result.mesh.indices.push_back(first + corner);
        }
    }
    return result;
}

/// As the compiler writes a scene of one mesh and one light.
struct Scene : runtime::SceneBase<float> {
    using R = float;
    static constexpr runtime::SceneTraits traits{.bare_shapes = 1U << 7,
                                                 .point_lights = true,
                                                 .specular = true,
                                                 .smooth_normals = true,
                                                 .perspective = true,
                                                 .raster = true};
    using Mesh = runtime::Bare<runtime::Mesh<float>>;
    using SceneBase<float>::primitives;
    std::array<Mesh, 1> mesh_table{{{{0}, {0, {0, 0}}}}};
    const auto& primitives(runtime::Of<Mesh>) const { return mesh_table; }
    using SceneBase<float>::members;
    std::array<runtime::Phong<float>, 1> materials{{{.ambient = {{0.2F, 0.1F, 0.1F}},
                                                     .diffuse = {{0.7F, 0.4F, 0.3F}},
                                                     .specular = {{0.5F, 0.5F, 0.5F}},
                                                     .shininess = {32}}}};
    std::array<runtime::PointLight<float>, 1> point_lights{{{.position = {3, 4, 5}}}};
    std::vector<runtime::MeshData> meshes;
    runtime::Camera<float> camera;
    Rgb<float> ambient{0.2F, 0.2F, 0.2F};
};

Scene scene_for(const runtime::MeshStorage& mesh) {
    Scene scene;
    scene.meshes = {mesh.data()};
    auto& camera = scene.camera;
    camera.eye = {0.4F, 1.1F, 3};
    camera.n = normalize(camera.eye);
    camera.u = normalize(cross(Vec3<float>{0, 1, 0}, camera.n));
    camera.v = cross(camera.n, camera.u);
    camera.half_height = 0.3F;
    camera.near = 0.5F;
    camera.far = 20;
    return scene;
}

/// llvmpipe, with vertices and indices in its own buffers.
class Peer {
public:
    Peer(const Scene& scene, const SmoothMesh& mesh)
        : context_(OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, nullptr)),
          pixels_(std::size_t{4} * width * height) {
        if (context_ == nullptr ||
            OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, width, height) == GL_FALSE) {
            throw std::runtime_error("no OpenGL context");
        }
        set_state(scene);
        std::array<GLuint, 2> buffers{};
        glGenBuffers(2, buffers.data());
        glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
        const std::size_t bytes = mesh.mesh.positions.size() / 3 * 3 * sizeof(float);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(2 * bytes), nullptr, GL_STATIC_DRAW);
        glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes), mesh.mesh.positions.data());
        glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(bytes), static_cast<GLsizeiptr>(bytes),
                        mesh.normals.data());
        glVertexPointer(3, GL_FLOAT, 0, nullptr);
        glNormalPointer(GL_FLOAT, 0, reinterpret_cast<const void*>(bytes));
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_NORMAL_ARRAY);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                     static_cast<GLsizeiptr>(mesh.mesh.indices.size() * sizeof(std::uint32_t)),
                     mesh.mesh.indices.data(), GL_STATIC_DRAW);
        count_ = static_cast<GLsizei>(mesh.mesh.indices.size());
    }
    ~Peer() { OSMesaDestroyContext(context_); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    void draw() {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
        glFinish();
    }
    /// From 0 to 255; rows from the top.
    int red(int x, int y) const {
        return pixels_[4 * (static_cast<std::size_t>(height - 1 - y) * width + static_cast<std::size_t>(x))];
    }
    static std::string version() { return reinterpret_cast<const char*>(glGetString(GL_VERSION)); }

private:
    static void set_state(const Scene& scene) {
        const auto& camera = scene.camera;
        glViewport(0, 0, width, height);
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_LIGHTING);
        glEnable(GL_LIGHT0);
        glMatrixMode(GL_PROJECTION);
        const double top = static_cast<double>(camera.half_height * camera.near), side = top * width / height;
        glFrustum(-side, side, -top, top, static_cast<double>(camera.near), static_cast<double>(camera.far));
        glMatrixMode(GL_MODELVIEW);
        const auto &u = camera.u, &v = camera.v, &n = camera.n, &e = camera.eye;
        const std::array<float, 16> view{u.x, v.x, n.x, 0, u.y,        v.y,        n.y,        0,
                                         u.z, v.z, n.z, 0, -dot(u, e), -dot(v, e), -dot(n, e), 1};
        glLoadMatrixf(view.data());
        const auto four = [](const Rgb<float>& c) { return std::array<float, 4>{c.r, c.g, c.b, 1}; };
        const auto& light = scene.point_lights[0];
        glLightfv(GL_LIGHT0, GL_POSITION,
                  std::array<float, 4>{light.position.x, light.position.y, light.position.z, 1}.data());
        glLightfv(GL_LIGHT0, GL_DIFFUSE, four(light.diffuse).data());
        glLightfv(GL_LIGHT0, GL_SPECULAR, four(light.specular).data());
        glLightModelfv(GL_LIGHT_MODEL_AMBIENT, four(scene.ambient).data());
        glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, 1);
        glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, 1);
        // Else it cuts vertices' colours at 1 before they are interpolated.
        glClampColor(GL_CLAMP_VERTEX_COLOR, GL_FALSE);
        const auto& material = scene.materials[0];
        glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT, four(material.ambient.value).data());
        glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, four(material.diffuse.value).data());
        glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, four(material.specular.value).data());
        glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, material.shininess.value);
    }

    OSMesaContext context_;
    std::vector<unsigned char> pixels_;
    GLsizei count_ = 0;
};

/// Pixels that one of them has drawn on and the other has not, and those whose red differs by more than a
/// rounding.
json difference(const runtime::Image& ours, const Peer& theirs) {
    std::size_t covered = 0, colored = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float red = std::min(1.0F, ours.at(x, y)[0]) * 255;
            covered += (red != 0) != (theirs.red(x, y) != 0) ? 1U : 0U;
            colored += std::abs(red - static_cast<float>(theirs.red(x, y))) > 2 ? 1U : 0U;
        }
    }
    return {{"covered", covered}, {"colored", colored}};
}

struct Measurement {
    int threads = 1, repeat = 5;
    int frames = 0; ///< if not 0: so many are drawn and nothing is measured
};

json compare(const std::string& name, const SmoothMesh& source, const Measurement& measurement) {
    const auto [threads, repeat, frames] = measurement;
    const runtime::MeshStorage mesh =
        runtime::build_mesh(source.mesh.positions, source.mesh.indices, source.normals, source.mesh.indices);
    const Scene scene = scene_for(mesh);
    runtime::RenderRequest request;
    request.settings.width = width;
    request.settings.height = height;
    request.settings.raster.shading = runtime::RasterShading::gouraud;
    request.crop = {0, 0, width, height};
    request.threads = threads;
    using Lane = runtime::WidestLane<float>;
    double model_seconds = 0;
    runtime::RasterModel<float> model;
    model_seconds = time_of(Clock::wall, [&] { model = raster_model(scene, request.settings); });
    runtime::raster::RasterPainter<Scene, Lane> painter(scene, model);
    runtime::Image image(width, height);
    for (int i = 0; i < frames; ++i) {
        draw_raster(painter, request, image);
    }
    if (frames != 0) {
        return {{"mesh", name}, {"frames", frames}};
    }
    Peer peer(scene, source);
    // Alone, by the time of the processor: other processes on the machine matter less.
    const Clock clock = threads == 1 ? Clock::processor : Clock::wall;
    Series ours, theirs;
    for (int i = -1; i < repeat; ++i) { // the first round does not count
        const double own = time_of(clock, [&] { draw_raster(painter, request, image); });
        const double other = time_of(clock, [&] { peer.draw(); });
        if (i >= 0) {
            ours.add(own);
            theirs.add(other);
        }
    }
    return {{"mesh", name},
            {"triangles", source.mesh.triangles()},
            {"threads", threads},
            {"ratio", ratio(theirs, ours).json()},
            {"ours", ours.json()},
            {"llvmpipe", theirs.json()},
            {"model_seconds", model_seconds},
            {"differing", difference(image, peer)},
            {"version", Peer::version()}};
}

/// The process and all its threads get so many processors, and llvmpipe so many threads.
void limit_to(int threads) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (int i = 0; i < threads; ++i) {
        CPU_SET(static_cast<std::size_t>(i), &set);
    }
    sched_setaffinity(0, sizeof set, &set);
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"The raster pipeline against llvmpipe"};
    Measurement measurement;
    std::string meshes = SCC_MESH_DIR, only;
    app.add_option("--threads", measurement.threads, "Of both, on as many processors")
        ->check(CLI::Range(1, 256));
    app.add_option("--repeat", measurement.repeat, "Measured rounds")->check(CLI::Range(1, 1000));
    app.add_option("--meshes", meshes, "Folder of the meshes");
    app.add_option("--only", only, "One of the cases, by its name");
    app.add_option("--profile", measurement.frames,
                   "Draw so many frames alone and measure nothing, for a profiler");
    CLI11_PARSE(app, argc, argv);
    limit_to(measurement.threads);
    struct Case {
        const char *name, *file;
        int subdivisions;
    };
    constexpr Case cases[] = {{"teapot", "teapot.obj", 0},
                              {"bunny", "stanford-bunny.obj", 0},
                              {"teapot x16", "teapot.obj", 2},
                              {"teapot x64", "teapot.obj", 3},
                              {"teapot x256", "teapot.obj", 4}};
    json rows = json::array();
    try {
        for (const Case& one : cases) {
            if (!only.empty() && only != one.name) {
                continue;
            }
            TriangleMesh mesh = load_mesh(std::filesystem::path(meshes) / one.file);
            if (one.subdivisions > 0) {
                mesh = subdivide(std::move(mesh), one.subdivisions);
            }
            mesh.positions.resize(3 * (*std::max_element(mesh.indices.begin(), mesh.indices.end()) + 1));
            rows.push_back(compare(one.name, smoothed(std::move(mesh)), measurement));
        }
        if (only.empty() || only == "10 layers") {
            rows.push_back(compare("10 layers", layers(10), measurement));
        }
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    std::cout << json{{"rows", rows}}.dump(2) << '\n';
}
