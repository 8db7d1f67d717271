#include "runtime/render.h"
#include "runtime/test/lecture_scene.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

template <class S>
Image draw(const S& scene, RenderRequest request) {
    Image image(request.crop.x1 - request.crop.x0, request.crop.y1 - request.crop.y0);
    EXPECT_TRUE(render(scene, request, image).complete);
    return image;
}

bool same_bits(const Image& a, const Image& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

bool is_varied(const Image& image) {
    const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
    return *low >= 0 && *high > *low + 0.3F;
}

/// Every kind of shape, bare and placed, with meshes, functions and every kind of light.
template <class R>
struct Crowd {
    MeshStorage mesh = ball_mesh(2, 1, {0, 0, 0});
    DynamicScene<R> scene;

    explicit Crowd(int per_kind) {
        Random<R> random(21);
        fill_materials(random);
        scene.meshes.push_back(mesh.data());
        std::uint32_t id = 0;
        const auto put = [&]<class Shape>(Shape shape) {
            for (int i = 0; i < 2 * per_kind; ++i, ++id) {
                if constexpr (requires { shape.normals; }) {
                    shape.smooth = i % 3 == 0;
                    shape.normals = {random.direction(), random.direction(), random.direction()};
                }
                const Tag tag{id, {id % 4, (id / 2) % 4}};
                if (i % 2 == 0) {
                    randomize_near(shape, random, 4);
                    add_field(shape, scene);
                    scene.add(Bare<Shape>{shape, tag});
                } else {
                    randomize_near(shape, random, 1);
                    add_field(shape, scene);
                    const Affine<double> map = random.map(4);
                    scene.add(
                        Placed<Shape, R>{shape, affine_cast<R>(map), affine_cast<R>(inverse(map)), tag});
                }
            }
        };
        for_each_shape(Primitives<R>{}, put);
        scene.point_lights.push_back(
            {{5, 9, 7}, {1, R(0.9), R(0.8)}, {R(0.5), R(0.5), 1}, 1, R(0.02), R(0.01)});
        scene.directional_lights.push_back(
            {normalize(Vec3<R>{-1, 2, 1}), {R(0.4), R(0.4), R(0.4)}, {R(0.4), R(0.4), R(0.4)}});
        SpotLight<R> spot{{{-6, 5, 8}, {R(0.5), R(0.5), R(0.4)}, {R(0.5), R(0.5), R(0.4)}}};
        spot.axis = normalize(Vec3<R>{6, -5, -8});
        spot.cos_inner = R(0.97);
        spot.cos_outer = R(0.9);
        spot.exponent = 3;
        scene.spot_lights.push_back(spot);
        RectangleLight<R> window{{{3, 6, 4}, {R(0.4), R(0.4), R(0.4)}, {R(0.2), R(0.3), R(0.4)}}};
        window.nu = 2;
        window.nv = 2;
        scene.rectangle_lights.push_back(window);
        scene.camera.eye = {0, 1, 14};
        scene.camera.half_height = R(0.5);
        scene.ambient = {R(0.3), R(0.3), R(0.3)};
        scene.background = {R(0.1), R(0.2), R(0.3)};
        prepare(scene);
    }

    template <class... Shape, class F>
    static void for_each_shape(TypeList<Shape...>, F&& f) {
        (f(Shape{}), ...);
    }
    template <class Shape>
    static void randomize_near(Shape& shape, Random<R>& random, double distance) {
        if constexpr (requires { shape.offset; }) {
            shape = {random.direction(), -60};
        } else if constexpr (requires { shape.squares; }) {
            // An ellipsoid: others would hide the rest.
            const Vec3<R> squares{random.number(1, 4), random.number(1, 4), random.number(1, 4)};
            const Vec3<R> center = random.vector(distance);
            const Vec3<R> weighted{squares.x * center.x, squares.y * center.y, squares.z * center.z};
            shape = {squares, random.vector(0.5), R(-2) * weighted, dot(weighted, center) - 1};
        } else if constexpr (!is_mesh<Shape>) {
            randomize(shape, random, distance);
        }
    }
    void fill_materials(Random<R>& random) {
        for (int i = 0; i < 4; ++i) {
            const auto color = [&](double most) {
                return Rgb<R>{random.number(0, most), random.number(0, most), random.number(0, most)};
            };
            Phong<R> material;
            material.ambient.value = color(0.5);
            material.diffuse.value = color(0.8);
            material.specular.value = i == 0 ? Rgb<R>{} : color(0.5);
            material.reflect.value = i == 1 ? color(0.6) : Rgb<R>{};
            material.emission.value = i == 2 ? color(0.2) : Rgb<R>{};
            material.transmit.value = i == 1 || i == 3 ? color(0.9) : Rgb<R>{};
            material.ior = i == 1 ? R(1.4) : 1;
            scene.materials.push_back(material);
        }
        scene.materials[3].diffuse.function = 0;
        scene.materials[2].shininess.function = 1;
        scene.functions.push_back(
            {{{Opcode::world_x}, {Opcode::sin, {0}}, {Opcode::abs, {1}}, {Opcode::n_y}, {Opcode::abs, {3}}},
             {2, 4, 2}});
        scene.functions.push_back(
            {{{Opcode::p_z}, {Opcode::constant, {}, R(5)}, {Opcode::pow, {1, 0}}}, {2}});
    }
};

/// A scene compiled with fewer traits than its tables' generic twin.
template <class R, SceneTraits narrow>
struct Restricted : DynamicScene<R> {
    static constexpr SceneTraits traits = narrow;
    explicit Restricted(const DynamicScene<R>& scene) : DynamicScene<R>(scene) {}
};

template <class T>
class Rendering : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Rendering, Reals);

TYPED_TEST(Rendering, CompiledSceneDrawsTheGenericImage) {
    RenderRequest wanted = request(203, 117);
    wanted.settings.samples = 4;
    const Image compiled = draw(LectureScene<TypeParam>{}, wanted);
    EXPECT_TRUE(is_varied(compiled));
    EXPECT_TRUE(same_bits(compiled, draw(generic_lecture_scene<TypeParam>(), wanted)));
}

TYPED_TEST(Rendering, LeavingOutWhatASceneLacksChangesNothing) {
    constexpr SceneTraits narrow = [] {
        SceneTraits result = everything;
        result.bare_shapes = 1U << 0 | 1U << 1;
        result.placed_shapes = 1U << 0 | 1U << 7;
        result.directional_lights = result.attenuation = result.separate_specular = result.emission = false;
        result.reflection = result.two_sided = result.functions = result.smooth_normals = false;
        result.transmission = result.refraction = false;
        result.accelerator = result.orthographic = false;
        return result;
    }();
    const Crowd<TypeParam> crowd(2);
    DynamicScene<TypeParam> scene;
    scene.meshes = crowd.scene.meshes;
    for (MeshData& mesh : scene.meshes) {
        mesh.normals = nullptr;
    }
    scene.materials = {crowd.scene.materials[0]};
    scene.materials[0].specular.value = {1, 1, 1};
    scene.camera = crowd.scene.camera;
    scene.ambient = crowd.scene.ambient;
    scene.point_lights.push_back({{5, 9, 7}});
    const auto add_all = [&](auto of) {
        for (auto primitive : crowd.scene.primitives(of)) {
            primitive.tag.sides = {};
            scene.add(primitive);
        }
    };
    add_all(Of<Bare<Sphere<TypeParam>>>{});
    add_all(Of<Bare<Box<TypeParam>>>{});
    add_all(Of<Placed<Sphere<TypeParam>, TypeParam>>{});
    add_all(Of<Placed<Mesh<TypeParam>, TypeParam>>{});
    prepare(scene);
    const RenderRequest wanted = request(160, 120);
    const Image generic = draw(scene, wanted);
    EXPECT_TRUE(is_varied(generic));
    EXPECT_TRUE(same_bits(generic, draw(Restricted<TypeParam, narrow>(scene), wanted)));
}

TYPED_TEST(Rendering, HierarchyDrawsTheImageOfTheLoop) {
    const Crowd<TypeParam> crowd(3);
    ASSERT_FALSE(crowd.scene.accelerator.nodes.empty());
    DynamicScene<TypeParam> plain = crowd.scene;
    plain.accelerator = {};
    const RenderRequest wanted = request(160, 120);
    const Image image = draw(crowd.scene, wanted);
    EXPECT_TRUE(is_varied(image));
    EXPECT_TRUE(same_bits(image, draw(plain, wanted)));
}

TYPED_TEST(Rendering, SingleLanesDrawTheImageOfFullRegisters) {
    const Crowd<TypeParam> crowd(3);
    RenderRequest wanted = request(101, 75);
    const Image image = draw(crowd.scene, wanted);
    Image one_by_one(101, 75);
    render_with_lanes<TypeParam>(crowd.scene, wanted, one_by_one);
    EXPECT_TRUE(same_bits(image, one_by_one));
}

/// A ball of glass with a bubble before a checker, and a tinted pane.
template <class R>
DynamicScene<R> glass_scene() {
    DynamicScene<R> scene;
    const auto material = [&](R transmit, R ior, bool fresnel) {
        Phong<R>& made = scene.materials.emplace_back();
        made.transmit.value = {transmit, transmit, R(0.9)};
        made.ior = ior;
        made.fresnel = fresnel;
        made.reflect.value = fresnel ? Rgb<R>{1, 1, 1} : Rgb<R>{};
    };
    material(0, 1, false);
    scene.materials[0].transmit.value = {};
    scene.materials[0].diffuse.value = {R(0.3), R(0.5), R(0.7)};
    material(1, R(1.5), true);
    material(1, 1, true);
    material(R(0.5), 1, false);
    scene.add(Bare<Plane<R>>{{{0, 1, 0}, -1}, {0, {0, 0}}});
    scene.add(Bare<Sphere<R>>{{{0, 0, 0}, 1}, {1, {1, 1}}});
    scene.add(Bare<Sphere<R>>{{{R(0.2), R(0.1), 0}, R(0.4)}, {2, {2, 2}}});
    scene.add(Bare<Box<R>>{{{1, -1, -1}, {R(1.2), 1, 1}}, {3, {3, 3}}});
    scene.point_lights.push_back({{3, 5, 4}, {1, 1, 1}, {1, 1, 1}});
    scene.background = {R(0.1), R(0.2), R(0.3)};
    scene.ambient = {R(0.3), R(0.3), R(0.3)};
    scene.camera.eye = {0, R(0.5), 5};
    prepare(scene);
    return scene;
}

TYPED_TEST(Rendering, BranchingRaysDrawTheSameInAnyPackAndInNarrowKernels) {
    constexpr SceneTraits narrow{.bare_shapes = 1U << 0 | 1U << 1 | 1U << 2,
                                 .point_lights = true,
                                 .reflection = true,
                                 .transmission = true,
                                 .refraction = true,
                                 .shadows = true,
                                 .perspective = true};
    const DynamicScene<TypeParam> scene = glass_scene<TypeParam>();
    const RenderRequest wanted = request(101, 75);
    const Image generic = draw(scene, wanted);
    EXPECT_TRUE(is_varied(generic));
    EXPECT_TRUE(same_bits(generic, draw(Restricted<TypeParam, narrow>(scene), wanted)));
    Image one_by_one(101, 75);
    render_with_lanes<TypeParam>(scene, wanted, one_by_one);
    EXPECT_TRUE(same_bits(generic, one_by_one));
}

TYPED_TEST(Rendering, ThreadsAndCropsDoNotChangeThePixels) {
    const LectureScene<TypeParam> scene;
    const Image whole = draw(scene, request(203, 117));
    EXPECT_TRUE(same_bits(whole, draw(scene, request(203, 117, 2))));
    EXPECT_TRUE(same_bits(whole, draw(scene, request(203, 117, 7))));
    RenderRequest part = request(203, 117, 3);
    part.crop = {53, 31, 190, 112};
    const Image cropped = draw(scene, part);
    for (int y = 0; y < cropped.height; ++y) {
        EXPECT_EQ(std::memcmp(cropped.at(0, y), whole.at(53, 31 + y), sizeof(float) * 3 * 137), 0) << y;
    }
}

RenderRequest free_request(PixelFilter filter, int samples, double adaptive = 0) {
    RenderRequest wanted = request(43, 35);
    wanted.settings.sampler = Sampler::low_discrepancy;
    wanted.settings.samples = samples;
    wanted.settings.filter = filter;
    wanted.settings.adaptive = adaptive;
    return wanted;
}

TYPED_TEST(Rendering, FreeSamplesDependOnNeitherTilesNorCropsNorThreadsNorLanes) {
    DynamicScene<TypeParam> scene = glass_scene<TypeParam>();
    scene.camera.lens_radius = TypeParam(0.1);
    for (RenderRequest wanted :
         {free_request(PixelFilter::mitchell, 3), free_request(PixelFilter::blackman_harris, 24, 0.02)}) {
        const Image whole = draw(scene, wanted);
        EXPECT_TRUE(is_varied(whole));
        Image one_by_one(43, 35);
        render_with_lanes<TypeParam>(scene, wanted, one_by_one);
        EXPECT_TRUE(same_bits(whole, one_by_one));
        wanted.threads = 3;
        wanted.crop = {5, 3, 41, 34};
        const Image cropped = draw(scene, wanted);
        for (int y = 0; y < cropped.height; ++y) {
            EXPECT_EQ(std::memcmp(cropped.at(0, y), whole.at(5, 3 + y), sizeof(float) * 3 * 36), 0) << y;
        }
    }
}

TYPED_TEST(Rendering, HierarchiesDrawThroughALensWhatTheLoopDoes) {
    Crowd<TypeParam> crowd(1);
    ASSERT_FALSE(crowd.scene.accelerator.nodes.empty());
    crowd.scene.camera.lens_radius = TypeParam(0.3);
    crowd.scene.camera.focus = 11;
    DynamicScene<TypeParam> plain = crowd.scene;
    plain.accelerator = {};
    const RenderRequest wanted = request(43, 35);
    const Image image = draw(crowd.scene, wanted);
    EXPECT_TRUE(is_varied(image));
    EXPECT_TRUE(same_bits(image, draw(plain, wanted)));
    crowd.scene.camera.projection = plain.camera.projection = Projection::spherical;
    crowd.scene.camera.half_width = plain.camera.half_width = 3;
    crowd.scene.camera.lens_radius = plain.camera.lens_radius = 0;
    EXPECT_TRUE(same_bits(draw(crowd.scene, wanted), draw(plain, wanted)));
}

TYPED_TEST(Rendering, AdaptiveSamplingEndsBetweenItsBounds) {
    const DynamicScene<TypeParam> scene = glass_scene<TypeParam>();
    const auto drawn = [&](double tolerance, std::uint64_t& samples) {
        Image image(43, 35);
        samples = render(scene, free_request(PixelFilter::box, 40, tolerance), image).rays.primary;
        return image;
    };
    std::uint64_t all = 0, some = 0, least = 0;
    const Image exact = drawn(1e-30, all), near = drawn(0.01, some), rough = drawn(100, least);
    EXPECT_EQ(least, 43U * 35 * 16);
    EXPECT_TRUE(same_bits(rough, draw(scene, free_request(PixelFilter::box, 16))));
    EXPECT_GT(some, least);
    EXPECT_LT(some, all);
    EXPECT_LE(all, 43U * 35 * 40);
    const Image whole = draw(scene, free_request(PixelFilter::box, 40));
    int differing = 0; // pixels whose first 16 samples see but one colour end there
    double squares = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        differing += std::abs(exact.pixels[i] - whole.pixels[i]) > 1e-6F ? 1 : 0;
        squares += std::pow(double{near.pixels[i]} - double{whole.pixels[i]}, 2);
    }
    EXPECT_LT(differing, 43 * 35 * 3 / 50);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(near.pixels.size())), 0.01);
}

TEST(Render, FiltersKeepASteadyPictureAndAreSymmetric) {
    const DynamicScene<double> scene = generic_lecture_scene<double>();
    DynamicScene<double> empty;
    empty.background = {0.25, 0.5, 1};
    prepare(empty);
    RenderRequest small = request(5, 4);
    for (const PixelFilter filter :
         {PixelFilter::box, PixelFilter::mitchell, PixelFilter::gaussian, PixelFilter::blackman_harris}) {
        small.settings.filter = filter;
        small.settings.samples = 4;
        for (const Image image = draw(empty, small); const std::size_t i : {0U, 3U, 57U}) {
            EXPECT_NEAR(image.pixels[i], 0.25F, 1e-7F);
            EXPECT_NEAR(image.pixels[i + 2], 1, 1e-7F);
        }
    }
    // Weighted sums of a picture three times larger, away from its border.
    RenderRequest wanted = request(40, 30);
    wanted.settings.samples = 9;
    wanted.settings.filter = PixelFilter::mitchell;
    const Image filtered = draw(scene, wanted), fine = draw(scene, request(120, 90));
    int differing = 0;
    for (int y = 3; y < 27; ++y) {
        for (int x = 3; x < 37; ++x) {
            double sum = 0, weights = 0;
            for (int j = 3 * (y - 2); j < 3 * (y + 3); ++j) {
                for (int i = 3 * (x - 2); i < 3 * (x + 3); ++i) {
                    const double weight = filter_weight(PixelFilter::mitchell, (i + 0.5) / 3 - x - 0.5) *
                                          filter_weight(PixelFilter::mitchell, (j + 0.5) / 3 - y - 0.5);
                    sum += weight * double{fine.at(i, j)[1]};
                    weights += weight;
                }
            }
            differing += std::abs(double{filtered.at(x, y)[1]} - sum / weights) > 2e-6 ? 1 : 0;
        }
    }
    EXPECT_LE(differing, 50); // a sample exactly on an edge may fall to either side, for 25 pixels
}

TEST(Render, CornersAreTheCentresOfAWindowShiftedByHalfAPixel) {
    const LectureScene<double> scene;
    RenderRequest wanted = request(64, 48);
    wanted.settings.point = PixelPoint::corner;
    const Image corners = draw(scene, wanted);
    DynamicScene<double> moved = generic_lecture_scene<double>();
    moved.camera.shift_x = -0.5 / 48;
    moved.camera.shift_y = -0.5 / 48;
    const Image shifted = draw(moved, request(64, 48));
    int differing = 0;
    for (std::size_t i = 0; i < corners.pixels.size(); ++i) {
        differing += std::abs(corners.pixels[i] - shifted.pixels[i]) > 1e-5F ? 1 : 0;
    }
    EXPECT_LE(differing, 3);
}

/// A lens spreads a point at the distance d over a disc: on the plane in focus, at the distance f, its
/// diameter is A |d - f| / d.
TEST(Render, BlurCirclesHaveTheDiameterOfTheThinLens) {
    constexpr int side = 100;
    constexpr double radius = 0.05, aperture = 1.2, half_height = 0.25;
    for (const auto& [distance, focus] : {std::pair{8.0, 6.0}, {3.0, 4.5}}) {
        DynamicScene<double> scene;
        scene.materials.emplace_back().emission.value = {1, 1, 1};
        scene.materials[0].ambient.value = scene.materials[0].diffuse.value = {};
        scene.camera.eye = {0, 0, distance};
        scene.camera.half_height = half_height;
        scene.camera.lens_radius = aperture / 2;
        scene.camera.focus = focus;
        scene.add(Bare<Sphere<double>>{{{0, 0, 0}, radius}, {0, {0, 0}}});
        prepare(scene);
        RenderRequest wanted = request(side, side);
        wanted.settings.sampler = Sampler::low_discrepancy;
        wanted.settings.samples = 200;
        constexpr int start = 32, part = 36;
        wanted.crop = {start, start, start + part, start + part};
        const Image image = draw(scene, wanted);
        double sum = 0, squares = 0;
        for (int i = 0; i < part * part; ++i) {
            const double x = i % part - (part - 1) / 2.0, y = i / part - (part - 1) / 2.0;
            const double value = double{image.at(i % part, i / part)[0]};
            sum += value;
            squares += value * (x * x + y * y) / 2;
        }
        // Of a disc the variance in one direction is the 16th part of its diameter's square; that of the
        // sphere's own picture and of a pixel come in addition.
        const double pixels = side / (2 * half_height);
        const double own = 2 * radius / distance * pixels;
        const double blurred = std::sqrt(16 * (squares / sum - 1.0 / 12) - own * own);
        const double expected = aperture * std::abs(distance - focus) / distance / focus * pixels;
        EXPECT_NEAR(blurred, expected, 0.03 * expected) << distance << ", " << focus;
    }
}

/// Through each point of the lens a pinhole camera sees what the lens shows there, its window shifted so that
/// the plane in focus stays in place.
TEST(Render, LensesAreTheMeanOfShearedPinholes) {
    DynamicScene<double> scene = glass_scene<double>();
    scene.camera.lens_radius = 0.2;
    scene.camera.focus = 5;
    const Camera<double> lens = scene.camera;
    RenderRequest wanted = request(24, 18);
    wanted.settings.samples = 400;
    const Image blurred = draw(scene, wanted);
    constexpr int pinholes = 64;
    std::vector<double> mean(blurred.pixels.size());
    wanted.settings.samples = 4;
    for (int i = 0; i < pinholes; ++i) {
        const SquarePoint point = SobolPoints({7, 3}, PointUse::lens)[i];
        const Vec2<double> at = in_disc(part_of_unit<double>(point.x), part_of_unit<double>(point.y));
        scene.camera = lens;
        scene.camera.lens_radius = 0;
        scene.camera.eye = lens.eye + 0.2 * (at.x * lens.u + at.y * lens.v);
        scene.camera.shift_x = -0.2 * at.x / lens.focus / (2 * lens.half_height);
        scene.camera.shift_y = -0.2 * at.y / lens.focus / (2 * lens.half_height);
        const Image sharp = draw(scene, wanted);
        for (std::size_t k = 0; k < mean.size(); ++k) {
            mean[k] += double{sharp.pixels[k]} / pinholes;
        }
    }
    double squares = 0;
    for (std::size_t k = 0; k < mean.size(); ++k) {
        squares += std::pow(mean[k] - double{blurred.pixels[k]}, 2);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(mean.size())), 5e-3);
}

TEST(Render, CompiledSceneDrawsTheGenericImageInTheReferencePrecision) {
    const RenderRequest wanted = request(61, 43);
    EXPECT_TRUE(same_bits(draw(LectureScene<long double>{}, wanted),
                          draw(generic_lecture_scene<long double>(), wanted)));
}

TEST(Render, SamplesAreTheCentresOfSubPixelsWithABoxFilter) {
    const LectureScene<double> scene;
    RenderRequest wanted = request(64, 48);
    wanted.settings.samples = 9;
    const Image sampled = draw(scene, wanted), fine = draw(scene, request(192, 144));
    int differing = 0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            double sum = 0;
            for (int i = 0; i < 9; ++i) {
                sum += static_cast<double>(fine.at(3 * x + i % 3, 3 * y + i / 3)[0]);
            }
            differing += std::abs(sum / 9 - static_cast<double>(sampled.at(x, y)[0])) > 1e-6 ? 1 : 0;
        }
    }
    EXPECT_LE(differing, 3); // a sample exactly on an edge may fall to either side
}

TEST(Render, CountsItsRays) {
    const LectureScene<double> scene;
    Image image(50, 40);
    RenderRequest wanted = request(50, 40, 2);
    wanted.settings.samples = 4;
    const RenderResult result = render(scene, wanted, image);
    EXPECT_EQ(result.rays.primary, 50U * 40 * 4);
    EXPECT_GT(result.rays.shadow, result.rays.primary / 2);
    EXPECT_GT(result.rays.reflected, 0U);
    Image other(50, 40);
    const RenderResult generic = render_with_lanes<double>(generic_lecture_scene<double>(), wanted, other);
    EXPECT_EQ(generic.rays.shadow, result.rays.shadow);
    EXPECT_EQ(generic.rays.reflected, result.rays.reflected);
}

TEST(Render, ProgressCanEndItEarly) {
    const LectureScene<double> scene;
    RenderRequest wanted = request(640, 480, 2);
    wanted.settings.samples = 900;
    int calls = 0;
    double part = -1;
    wanted.progress = [&](double done) {
        part = done;
        return ++calls < 2;
    };
    Image image(640, 480);
    EXPECT_FALSE(render(scene, wanted, image).complete);
    EXPECT_EQ(calls, 2);
    EXPECT_GT(part, 0);
    EXPECT_LT(part, 1);
}

TEST(Camera, PixelCentresAndTheWindowsShift) {
    Camera<double> camera; // at (0, 0, 5), looking down -z
    camera.half_height = 0.5;
    const auto first_ray = [&](Projection projection) {
        return camera_ray(camera, projection, window_x(camera, projection, 0.5, 4, 2),
                          window_y(camera, 0.5, 2));
    };
    const Ray<double> first = first_ray(Projection::perspective);
    EXPECT_EQ(first.org, (Vec3<double>{0, 0, 5}));
    EXPECT_EQ(first.dir, (Vec3<double>{-0.75, 0.25, -1}));
    camera.shift_x = 0.5;
    camera.shift_y = -1;
    const Ray<double> shifted = first_ray(Projection::perspective);
    EXPECT_EQ(shifted.dir, (Vec3<double>{-0.25, -0.75, -1}));
    const Ray<double> parallel = first_ray(Projection::orthographic);
    EXPECT_EQ(parallel.org, (Vec3<double>{-0.25, -0.75, 5}));
    EXPECT_EQ(parallel.dir, (Vec3<double>{0, 0, -1}));
}

} // namespace
