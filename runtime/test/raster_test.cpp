#include "runtime/raster/draw.h"
#include "runtime/raster/explain.h"
#include "runtime/render.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <vector>

namespace scc::runtime::test {

namespace {

/// What the scenes here need; kernels are compiled for nothing else.
template <class R_, bool has_functions = true>
struct RasterScene : SceneBase<R_> {
    using R = R_;
    static constexpr SceneTraits traits{.bare_shapes = 1U << 0 | 1U << 2 | 1U << 6,
                                        .placed_shapes = 1U << 7,
                                        .point_lights = true,
                                        .specular = true,
                                        .transmission = true,
                                        .two_sided = true,
                                        .functions = has_functions,
                                        .smooth_normals = true,
                                        .perspective = true,
                                        .raster = true,
                                        .lines = true};
    template <class Primitive>
    const std::vector<Primitive>& primitives(Of<Primitive>) const {
        return std::get<std::vector<Primitive>>(tables.tables);
    }
    template <class Primitive>
    void add(const Primitive& primitive) {
        std::get<std::vector<Primitive>>(tables.tables).push_back(primitive);
    }
    using SceneBase<R>::members;
    /// A chequer of the object's own space.
    template <class L>
    Rgb<L> color_function(std::int32_t, const SurfacePoint<L>& s) const {
        const L odd = floored_mod(round_down(s.p.x * 2) + round_down(s.p.z * 2), L(2));
        return {odd, odd * L(R(0.5)), L(R(0.5))};
    }

    PrimitiveTables<R> tables;
    std::vector<Phong<R>> materials;
    std::vector<PointLight<R>> point_lights;
    std::vector<MeshData> meshes;
    std::vector<LineSegment<R>> line_segments;
    Camera<R> camera;
    Rgb<R> ambient{R(0.3), R(0.3), R(0.3)}, background{R(0.1), R(0.2), R(0.3)};
};

template <class R>
Phong<R> phong(double red, double green, double blue) {
    const Rgb<R> color{static_cast<R>(red), static_cast<R>(green), static_cast<R>(blue)};
    return {
        .ambient = {color}, .diffuse = {color}, .specular = {{R(0.4), R(0.4), R(0.4)}}, .shininess = {20}};
}

template <class R>
Camera<R> camera_at(const Vec3<R>& eye, const Vec3<R>& target) {
    Camera<R> camera;
    camera.eye = eye;
    camera.n = normalize(eye - target);
    camera.u = normalize(cross(Vec3<R>{0, 1, 0}, camera.n));
    camera.v = cross(camera.n, camera.u);
    return camera;
}

/// A smooth, a flat and a clear surface, lines, and a plane without end.
template <class R>
RasterScene<R> varied_scene() {
    RasterScene<R> scene;
    scene.camera = camera_at<R>({1, 2, 6}, {0, R(0.3), 0});
    scene.materials = {phong<R>(0.8, 0.3, 0.2), phong<R>(0.2, 0.5, 0.3), phong<R>(0.3, 0.3, 0.1)};
    scene.materials[1].diffuse.function = 0;
    scene.materials[2].transmit.value = {R(0.6), R(0.6), R(0.6)};
    scene.point_lights = {{.position = {3, 4, 5}}};
    scene.add(Bare<Sphere<R>>{{{0, R(0.5), 0}, 1}, {0, {0, 0}}});
    scene.add(Bare<Plane<R>>{{{0, 1, 0}, -1}, {1, {1, 1}}});
    Triangle<R> clear;
    clear.points = {Vec3<R>{-2, -1, 1}, {2, R(-0.5), 2}, {R(0.5), 2, 1}};
    scene.add(Bare<Triangle<R>>{clear, {2, {2, 2}}});
    scene.line_segments = {{{-2, 0, 2}, {0, R(1.5), R(1.2)}, {1, 1, 0}, 3},
                           {{0, R(1.5), R(1.2)}, {2, 0, -3}, {1, 1, 0}, 3}};
    return scene;
}

RenderRequest request(int width, int height, RasterShading shading = RasterShading::phong) {
    RenderRequest result;
    result.settings.width = width;
    result.settings.height = height;
    result.settings.shadows = false;
    result.settings.raster.shading = shading;
    result.settings.raster.tessellation = 0.002;
    result.crop = {0, 0, width, height};
    return result;
}

template <class L, class Scene>
Image draw_with(const Scene& scene, const RenderRequest& wanted) {
    Image image(wanted.crop.x1 - wanted.crop.x0, wanted.crop.y1 - wanted.crop.y0);
    draw_raster_with_lanes<L>(scene, raster_model(scene, wanted.settings), wanted, image);
    return image;
}
template <class R>
Image draw(const RasterScene<R>& scene, const RenderRequest& wanted) {
    return draw_with<WidestLane<R>>(scene, wanted);
}
/// Without shadows and mirrors, which raster pictures lack.
template <class R>
Image draw_by_rays(const RasterScene<R>& scene, const RenderRequest& wanted) {
    Image image(wanted.settings.width, wanted.settings.height);
    render(scene, wanted, image);
    return image;
}

constexpr std::array<RasterShading, 5> all_shadings{RasterShading::flat, RasterShading::gouraud,
                                                    RasterShading::phong, RasterShading::wireframe,
                                                    RasterShading::hidden_line};

TEST(Raster, DrawsTheSameBitsWithAnyLanesThreadsAndCrop) {
    using Other = Pack<float, lane_count<WidestLane<float>> == 8 ? 4 : 8>;
    const auto scene = varied_scene<float>();
    for (const RasterShading shading : all_shadings) {
        RenderRequest wanted = request(150, 97, shading);
        wanted.settings.samples = 4;
        const Image whole = draw(scene, wanted);
        EXPECT_EQ(draw_with<Other>(scene, wanted).pixels, whole.pixels);
        wanted.threads = 3;
        EXPECT_EQ(draw(scene, wanted).pixels, whole.pixels);
        wanted.crop = {37, 11, 103, 80};
        const Image part = draw_with<Other>(scene, wanted);
        for (int y = 0; y < part.height; ++y) {
            for (int x = 0; x < part.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    ASSERT_EQ(part.at(x, y)[c], whole.at(x + 37, y + 11)[c]) << x << ' ' << y;
                }
            }
        }
    }
}

double root_mean_square(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        sum += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2);
    }
    return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

/// The slope of log y over log x by least squares.
double fitted_order(const std::vector<double>& x, const std::vector<double>& y) {
    double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double a = std::log(x[i]), b = std::log(y[i]);
        sum_x += a;
        sum_y += b;
        sum_xx += a * a;
        sum_xy += a * b;
    }
    const auto n = static_cast<double>(x.size());
    return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

/// Colours of a sphere by interpolated normals: their error goes down with the square of the triangles' size,
/// as does the distance that the tolerance bounds.
TEST(Raster, ComesNearToRaysWithTheTolerance) {
    RasterScene<double> scene;
    scene.camera = camera_at<double>({1, 2, 6}, {0, 0, 0});
    scene.materials = {phong<double>(0.8, 0.3, 0.2)};
    scene.point_lights = {{.position = {3, 4, 5}}};
    scene.add(Bare<Sphere<double>>{{{0, 0, 0}, 4}, {0, {0, 0}}}); // fills the picture: no silhouette
    RenderRequest wanted = request(120, 90);
    const Image rays = draw_by_rays(scene, wanted);
    std::printf("tessellation  triangles  error against rays (root mean square)\n");
    std::vector<double> tolerances, errors;
    for (double tessellation = 0.004; tessellation > 2e-4; tessellation /= 2) {
        wanted.settings.raster.tessellation = tessellation;
        tolerances.push_back(tessellation);
        errors.push_back(root_mean_square(draw(scene, wanted), rays));
        std::printf("%12g  %9u  %.3g\n", tessellation, raster_model(scene, wanted.settings).triangle_count,
                    errors.back());
    }
    EXPECT_LT(errors.back(), 2e-4);
    const double order = fitted_order(tolerances, errors);
    std::printf("order %.3f in the tolerance\n", order);
    EXPECT_NEAR(order, 1, 0.15);
}

TEST(Raster, ExplainsSamplesAsTheyAreDrawn) {
    const auto scene = varied_scene<double>();
    for (const RasterShading shading : {RasterShading::flat, RasterShading::gouraud, RasterShading::phong}) {
        RenderRequest wanted = request(150, 97, shading);
        std::size_t through = 0, lines = 0, triangles = 0;
        const Image image = draw(scene, wanted);
        const RasterModel<double> model = raster_model(scene, wanted.settings);
        for (int i = 0; i < 150; ++i) {
            const int x = i, y = (i * 37) % 97;
            wanted.crop = {x, y, x + 1, y + 1};
            const RasterExplanation told = explain_raster(scene, model, wanted, 0, 0);
            EXPECT_NEAR(told.sample.r, image.at(x, y)[0], 2e-6) << x << ' ' << y;
            EXPECT_NEAR(told.sample.g, image.at(x, y)[1], 2e-6) << x << ' ' << y;
            std::size_t seen = 0;
            for (const DrawnTerms& drawn : told.drawn) {
                seen += drawn.verdict == DrawnTerms::Verdict::seen ? 1U : 0U;
                through += drawn.verdict == DrawnTerms::Verdict::through ? 1U : 0U;
                lines += drawn.is_line ? 1U : 0U;
                if (!drawn.is_line) {
                    EXPECT_NEAR(drawn.weights[0] + drawn.weights[1] + drawn.weights[2], 1, 1e-9);
                    const Camera<double>& c = scene.camera;
                    EXPECT_NEAR(drawn.pseudodepth,
                                ((c.far + c.near) * drawn.w - 2 * c.far * c.near) /
                                    ((c.far - c.near) * drawn.w),
                                1e-5);
                    ++triangles;
                }
            }
            EXPECT_LE(seen, 1U);
        }
        EXPECT_GT(through, 5U);
        EXPECT_GT(lines, 0U);
        EXPECT_GT(triangles, 50U);
    }
}

TEST(Raster, SeesEndlessPlanesAndFunctionsAsRaysDo) {
    RasterScene<double> scene;
    scene.camera = camera_at<double>({1, 2, 6}, {0, 0.3, 0});
    scene.camera.far = 1e6;
    scene.materials = {phong<double>(0.8, 0.3, 0.2)};
    scene.point_lights = {{.position = {3, 4, 5}}};
    scene.add(Bare<Plane<double>>{{{0, 1, 0}, -1}, {0, {0, 0}}});
    const RenderRequest wanted = request(120, 90);
    const Image rays = draw_by_rays(scene, wanted);
    EXPECT_LT(root_mean_square(draw(scene, wanted), rays), 1e-6);
}

TEST(Raster, BlendsWhatLetsLightThroughAsRaysDo) {
    RasterScene<double> scene;
    scene.camera = camera_at<double>({0, 0, 5}, {0, 0, 0});
    scene.materials = {phong<double>(0.8, 0.3, 0.2), phong<double>(0.2, 0.5, 0.3)};
    scene.materials[0].transmit.value = {0.5, 0.3, 0.2};
    scene.materials[1].transmit.value = {0.2, 0.6, 0.6};
    scene.point_lights = {{.position = {3, 4, 5}}};
    Triangle<double> one, other; // that cross each other
    one.points = {Vec3<double>{-2, -1.5, 1}, {2, -1, -1}, {0.1, 1.7, 0.2}};
    other.points = {Vec3<double>{-2, -1, -1}, {2, -1.3, 1}, {0.2, 1.6, 0.1}};
    scene.add(Bare<Triangle<double>>{one, {0, {0, 1}}});
    scene.add(Bare<Triangle<double>>{other, {1, {1, 0}}});
    const RenderRequest wanted = request(120, 90);
    const Image rays = draw_by_rays(scene, wanted);
    const Image drawn = draw(scene, wanted);
    int differing = 0;
    for (std::size_t i = 0; i < rays.pixels.size(); ++i) {
        differing += std::abs(drawn.pixels[i] - rays.pixels[i]) > 1e-5F;
    }
    EXPECT_LE(differing, 12); // where an edge is put on the grid
}

/// A grid of triangles that fills the picture: where edges are shared, each sample is drawn once. Each lets a
/// part of the light through, so that twice would show.
TEST(Raster, DrawsSharedEdgesOnce) {
    RasterScene<float> scene;
    scene.camera = camera_at<float>({0, 0, 5}, {0, 0, 0});
    scene.materials = {phong<float>(0, 0, 0)};
    scene.materials[0].specular.value = {};
    scene.materials[0].transmit.value = {0.5F, 0.5F, 0.5F};
    Random<float> random(7);
    constexpr int cells = 9;
    std::array<std::array<Vec3<float>, cells + 1>, cells + 1> points;
    for (int i = 0; i <= cells; ++i) {
        for (int k = 0; k <= cells; ++k) {
            // Some corners lie on samples' centres.
            const bool inner = i > 0 && k > 0 && i < cells && k < cells && (i + k) % 3 != 0;
            const float away = inner ? 0.15F : 0.0F;
            points[std::size_t(i)][std::size_t(k)] = {float(i) - 4.5F + random.number(-1, 1) * away,
                                                      float(k) - 4.5F + random.number(-1, 1) * away, 0};
        }
    }
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        for (std::size_t k = 0; k < cells; ++k) {
            const Vec3<float>&a = points[i][k], &b = points[i + 1][k], &c = points[i + 1][k + 1],
                  &d = points[i][k + 1];
            Triangle<float> triangle;
            triangle.points = {a, b, c};
            scene.add(Bare<Triangle<float>>{triangle, {id++, {0, 0}}});
            triangle.points = {c, a, d}; // seen from behind
            scene.add(Bare<Triangle<float>>{triangle, {id++, {0, 0}}});
        }
    }
    const Image image = draw(scene, request(160, 160));
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        ASSERT_NEAR(image.pixels[i], 0.05F, 1e-6F) << i / 3 % 160 << ' ' << i / 3 / 160;
    }
}

TEST(Raster, LeavesOutBacksIfTold) {
    auto scene = varied_scene<float>();
    RenderRequest wanted = request(60, 40);
    const Image all = draw(scene, wanted);
    wanted.settings.raster.cull = Cull::back;
    EXPECT_EQ(draw(scene, wanted).pixels, all.pixels);      // all fronts are seen
    scene.camera = camera_at<float>({1, -3, 6}, {0, 0, 0}); // below the plane
    EXPECT_NE(draw(scene, wanted).pixels, draw(scene, request(60, 40)).pixels);
}

/// Of a mesh in its place, mirrored, against the same triangles in the world.
TEST(Raster, DrawsMirroredMeshesFromTheirFront) {
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F};
    const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3};
    const MeshStorage mesh = build_mesh(positions, indices);
    Affine<double> map;
    map.m[0][0] = -2;
    map.m[1][1] = 1.5;
    map.m[0][3] = 1;
    RasterScene<double> placed, in_world;
    for (auto* scene : {&placed, &in_world}) {
        scene->camera = camera_at<double>({0, 0.5, 5}, {0, 0.5, 0});
        scene->materials = {phong<double>(0.8, 0.3, 0.2), phong<double>(0.1, 0.2, 0.9)};
        scene->point_lights = {{.position = {3, 4, 5}}};
    }
    placed.meshes = {mesh.data()};
    placed.add(Placed<Mesh<double>, double>{{0}, map, inverse(map), {0, {0, 1}}});
    for (std::size_t t = 0; t < 2; ++t) {
        Triangle<double> triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const float* p = &positions[3 * indices[3 * t + k]];
            triangle.points[k] = transform_point(map, Vec3<double>{p[0], p[1], p[2]});
        }
        std::swap(triangle.points[1], triangle.points[2]);
        in_world.add(Bare<Triangle<double>>{triangle, {static_cast<std::uint32_t>(t), {0, 1}}});
    }
    for (const RasterShading shading : {RasterShading::phong, RasterShading::gouraud}) {
        const RenderRequest wanted = request(60, 40, shading);
        EXPECT_LT(root_mean_square(draw(placed, wanted), draw(in_world, wanted)), 1e-7);
    }
}

/// A wavy square of (side - 1)^2 x 2 triangles across the view.
struct WavySquare {
    static constexpr std::uint32_t side = 24;
    std::vector<float> positions, normals;
    std::vector<std::uint32_t> indices;

    WavySquare() {
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const float x = static_cast<float>(i % side) / (side - 1) * 4 - 2,
                        y = static_cast<float>(i / side) / (side - 1) * 4 - 2;
            positions.insert(positions.end(), {x, y, 0.8F * std::sin(3 * x) * std::cos(2 * y)});
            const Vec3<float> normal{-2.4F * std::cos(3 * x) * std::cos(2 * y),
                                     1.6F * std::sin(3 * x) * std::sin(2 * y), 1};
            normals.insert(normals.end(), {normal.x, normal.y, normal.z});
        }
        for (std::uint32_t i = 0; i + side < side * side; ++i) {
            if (i % side + 1 < side) {
                indices.insert(indices.end(), {i, i + 1, i + side, i + 1, i + side + 1, i + side});
            }
        }
    }
    MeshStorage mesh(std::vector<float> vertex_normals, std::vector<std::uint32_t> normal_indices) const {
        return build_mesh(positions, indices, vertex_normals, normal_indices);
    }
    /// Each corner with a normal of its own.
    MeshStorage mesh_of_corners() const {
        std::vector<float> own;
        std::vector<std::uint32_t> numbers;
        for (const std::uint32_t i : indices) {
            own.insert(own.end(), &normals[3 * i], &normals[3 * i] + 3);
            numbers.push_back(static_cast<std::uint32_t>(numbers.size()));
        }
        return mesh(own, numbers);
    }
};

using PlainScene = RasterScene<float, false>;

/// Two of the mesh, the nearer one clear, seen from both sides.
PlainScene scene_of_squares(const MeshStorage& mesh) {
    PlainScene scene;
    scene.camera = camera_at<float>({3, 1, 5}, {0, 0, 0});
    scene.materials = {phong<float>(0.8, 0.3, 0.2), phong<float>(0.1, 0.2, 0.9), phong<float>(0.3, 0.3, 0.1)};
    scene.materials[2].transmit.value = {0.6F, 0.5F, 0.4F};
    scene.point_lights = {{.position = {3, 4, 5}}, {.position = {-3, 1, -5}}};
    scene.meshes = {mesh.data()};
    Affine<float> map;
    map.m[0][0] = -1.2F; // mirrored
    map.m[1][1] = 0.9F;
    map.m[1][2] = 0.4F;
    scene.add(Placed<Mesh<float>, float>{{0}, map, inverse(map), {0, {0, 1}}});
    map.m[0][0] = 0.5F;
    map.m[2][3] = 1.5F;
    scene.add(Placed<Mesh<float>, float>{{0}, map, inverse(map), {1, {2, 2}}});
    return scene;
}

TEST(Raster, LightsSharedVerticesOnce) {
    const WavySquare square;
    const MeshStorage shared = square.mesh(square.normals, square.indices), apart = square.mesh_of_corners();
    const PlainScene scene = scene_of_squares(shared), other = scene_of_squares(apart);
    const RenderRequest wanted = request(200, 150, RasterShading::gouraud);
    using Lane = WidestLane<float>;
    const auto lit = [&](const PlainScene& s) {
        const RasterModel<float> model = raster_model(s, wanted.settings);
        raster::VertexLights<PlainScene, Lane> lights(s, model);
        raster::Bin<float> bin;
        bin.fronts_of = {static_cast<std::uint32_t>(square.indices.size() / 6), 0};
        lights.update({s.camera, wanted.settings}, {bin}, RasterShading::gouraud, 1);
        return std::pair{lights.has(model.surfaces[0]), lights.has(model.surfaces[1])};
    };
    EXPECT_EQ(lit(scene), (std::pair{true, false})); // by how much is seen of them
    EXPECT_EQ(lit(other), (std::pair{false, false}));
    EXPECT_EQ(draw_with<Lane>(scene, wanted).pixels, draw_with<Lane>(other, wanted).pixels);
}

TEST(Raster, SharesNoVerticesOfNormalsAtSeveralPlaces) {
    const WavySquare square;
    const RasterSettings gouraud = request(1, 1, RasterShading::gouraud).settings.raster;
    RenderSettings settings = request(1, 1).settings;
    settings.raster = gouraud;
    const auto vertices = [&](const MeshStorage& mesh) {
        const PlainScene scene = scene_of_squares(mesh);
        return raster_model(scene, settings).mesh_vertices.at(0).positions.size();
    };
    EXPECT_EQ(vertices(square.mesh(square.normals, square.indices)), square.normals.size());
    const std::vector<std::uint32_t> one_normal(square.indices.size(), 0);
    EXPECT_EQ(vertices(square.mesh(square.normals, one_normal)), 0U);
    std::vector<float> none = square.normals;
    std::fill(none.begin(), none.begin() + 3, 0.0F);
    EXPECT_EQ(vertices(square.mesh(none, square.indices)), 0U);
}

TEST(Raster, TellsWhatPixelsShow) {
    auto scene = varied_scene<double>();
    const RenderRequest wanted = request(80, 60);
    AovImage values(80, 60, ~AovSet{0});
    ASSERT_TRUE(draw_raster_aovs(scene, raster_model(scene, wanted.settings), wanted, values));
    const CameraRays<RasterScene<double>> rays(scene, wanted.settings);
    for (const auto& [x, y] : {std::pair{20, 30}, {40, 25}, {40, 40}, {10, 55}}) {
        const std::size_t i = static_cast<std::size_t>(y * 80 + x);
        const Ray<double> ray =
            rays.straight_ray(rays.window_x(double(x), 0.5), rays.window_y(double(y), 0.5));
        const Hit<double> hit = closest_hit<RasterScene<double>, double>(scene, ray);
        EXPECT_EQ(values.object[i], hit.id + 1);
        EXPECT_NEAR(values.depth[i], hit.shape.t * length(ray.dir), 0.01);
        EXPECT_NEAR(values.planar[i], hit.shape.t, 0.01);
        EXPECT_EQ(values.material[i], hit.id + 1);
        const Vec3<double> point = ray.org + ray.dir * hit.shape.t;
        EXPECT_NEAR(values.position[1][i], point.y, 0.01);
        const double size = std::pow(values.normal[0][i], 2) + std::pow(values.normal[1][i], 2) +
                            std::pow(values.normal[2][i], 2);
        EXPECT_NEAR(size, 1, 1e-5);
    }
}

/// Corners of all kinds that have no place on a picture. What they do not touch stays as it is.
TEST(Raster, SurvivesWildVertices) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
    const std::array<float, 14> wild{nan, inf, -inf,    1e30F, -1e30F, 3e38F, 1e-40F,
                                     0,   5,   4.9999F, 1e7F,  -1e15F, 1e10F, 0.5F};
    std::mt19937 engine(3);
    const auto number = [&] {
        const auto choice = engine() % 20;
        return choice < wild.size() ? wild[choice] : static_cast<float>(engine() % 2000) / 500 - 2;
    };
    for (const RasterShading shading : all_shadings) {
        RasterScene<float> scene;
        scene.camera = camera_at<float>({0, 0, 5}, {0, 0, 0});
        scene.materials = {phong<float>(0.8, 0.3, 0.2), phong<float>(0.2, 0.5, 0.3)};
        scene.materials[1].transmit.value = {0.5F, 0.5F, 0.5F};
        scene.point_lights = {{.position = {3, 4, 5}}};
        std::vector<float> positions;
        std::vector<std::uint32_t> indices;
        for (std::uint32_t i = 0; i < 600; ++i) {
            Triangle<float> triangle;
            for (Vec3<float>& p : triangle.points) {
                p = {number(), number(), number()};
            }
            scene.add(Bare<Triangle<float>>{triangle, {i, {i % 2, 0}}});
            for (std::size_t corner = 1; corner < 3; ++corner) {
                scene.line_segments.push_back(
                    {triangle.points[corner - 1], triangle.points[corner], {1, 1, 1}, float(i % 4)});
            }
        }
        RenderRequest wanted = request(70, 50, shading);
        wanted.settings.raster.clip = shading != RasterShading::flat;
        draw(scene, wanted);
        wanted.crop = {3, 5, 66, 44};
        draw(scene, wanted);
    }
    // One good triangle among those that lie behind the eye or nowhere.
    RasterScene<float> good, among;
    for (auto* scene : {&good, &among}) {
        scene->camera = camera_at<float>({0, 0, 5}, {0, 0, 0});
        scene->materials = {phong<float>(0.8, 0.3, 0.2)};
        scene->point_lights = {{.position = {3, 4, 5}}};
    }
    Triangle<float> triangle;
    triangle.points = {Vec3<float>{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    good.add(Bare<Triangle<float>>{triangle, {0, {0, 0}}});
    among.add(Bare<Triangle<float>>{triangle, {0, {0, 0}}});
    std::uint32_t id = 1;
    for (const float x : {nan, inf, -inf, 3e38F}) {
        triangle.points = {Vec3<float>{x, 0, 0}, {1, x, 0}, {0, 1, x}};
        among.add(Bare<Triangle<float>>{triangle, {id++, {0, 0}}});
        triangle.points = {Vec3<float>{x, 0, 5}, {x, 0, 5}, {x, 0, 5}};
        among.add(Bare<Triangle<float>>{triangle, {id++, {0, 0}}});
    }
    const RenderRequest wanted = request(70, 50, RasterShading::gouraud);
    EXPECT_EQ(draw(among, wanted).pixels, draw(good, wanted).pixels);
}

} // namespace

} // namespace scc::runtime::test
