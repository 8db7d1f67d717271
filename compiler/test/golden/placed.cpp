#include "runtime/accel/build.h"
#include "runtime/host/program.h"
#include "runtime/render.h"
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace {

using namespace scc::runtime;

struct Scene : SceneBase<double> {
    using R = double;
    static constexpr SceneTraits traits{.bare_shapes = 0x60, .placed_shapes = 0x1, .point_lights = true, .attenuation = true, .separate_specular = true, .specular = true, .functions = true, .smooth_normals = true, .orthographic = true};
    using SceneBase<R>::primitives;
    static constexpr std::array<Placed<Sphere<R>, R>, 1> placed_sphere{{
        {{{0.0, 0.0, 0.0}, 1.0}, {{{0.8660254037844387, 0.0, 0.49999999999999994, 0.0}, {0.0, 0.5, 0.0, 1.0}, {-0.49999999999999994, 0.0, 0.8660254037844387, 0.0}}}, {{{0.8660254037844387, 0.0, -0.49999999999999994, 0.0}, {0.0, 2.0, 0.0, -2.0}, {0.49999999999999994, 0.0, 0.8660254037844387, 0.0}}}, {0, {0, 0}}},
    }};
    const auto& primitives(Of<Placed<Sphere<R>, R>>) const { return placed_sphere; }
    static constexpr std::array<Bare<Disc<R>>, 1> bare_disc{{
        {{{0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}, 3.0, 0.5}, {2, {1, 1}}},
    }};
    const auto& primitives(Of<Bare<Disc<R>>>) const { return bare_disc; }
    static constexpr std::array<Bare<Triangle<R>>, 1> bare_triangle{{
        {{{{{0.0, 0.0, 0.0}, {0.8660254037844387, 0.0, -0.49999999999999994}, {0.0, 1.0, 0.0}}}, {{{0.49999999999999994, 0.0, 0.8660254037844387}, {0.3535533905932737, 0.7071067811865475, 0.6123724356957945}, {0.9659258262890682, 0.0, 0.2588190451025208}}}, true, {{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}}, false}, {1, {1, 1}}},
    }};
    const auto& primitives(Of<Bare<Triangle<R>>>) const { return bare_triangle; }
    static constexpr std::array<Phong<R>, 2> materials{{
        {{{0.0, 0.0, 0.0}, 0}, {{0.0, 0.0, 0.0}, 0}, {{0.5, 0.5, 0.5}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {0.0, 1}, 1.0, false, -1},
        {{{0.8, 0.8, 0.8}, -1}, {{0.8, 0.8, 0.8}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {32.0, -1}, 1.0, false, -1},
    }};
    static constexpr std::array<PointLight<R>, 1> point_lights{{
        {{2.0, 5.0, 3.0}, {0.9, 0.9, 0.9}, {1.0, 0.5, 0.5}, 0.5, 0.1, 0.0},
    }};
    static constexpr Rgb<R> ambient{0.1, 0.1, 0.1};
    static constexpr Rgb<R> background{0.0, 0.0, 0.0};
    static constexpr Camera<R> camera{Projection::orthographic, {3.0, 4.0, 5.0}, {0.8574929257125442, 0.0, -0.5144957554275266}, {-0.2910427500435996, 0.824621125123532, -0.48507125007266594}, {0.4242640687119285, 0.565685424949238, 0.7071067811865475}, 3.0, 0.1, -0.05, 0.0, 0.0, 1.0, 0.1, 1000.0};
    template <class L>
    Rgb<L> color_function(std::int32_t index, const SurfacePoint<L>& s) const {
        switch (index) {
        case 0: { // bands diffuse
            const L v0 = s.p.y;
            const L v1 = L(R(8.0));
            const L v2 = v1 * v0;
            const L v3 = sine(v2);
            const L v4 = L(R(0.5));
            const L v5 = v4 * v3;
            const L v6 = v4 + v5;
            const L v7 = L(R(1.0));
            const L v8 = v7 - v6;
            const L v9 = L(R(0.9));
            const L v10 = v9 * v8;
            const L v11 = L(R(0.2));
            const L v12 = v11 * v8;
            const L v13 = L(R(0.1));
            const L v14 = v13 * v8;
            const L v15 = v13 * v6;
            const L v16 = v11 * v6;
            const L v17 = v9 * v6;
            const L v18 = v10 + v15;
            const L v19 = v12 + v16;
            const L v20 = v14 + v17;
            return {v18, v19, v20};
        }
        default: return {};
        }
    }
    template <class L>
    L number_function(std::int32_t index, const SurfacePoint<L>& s) const {
        switch (index) {
        case 1: { // bands shininess
            const L v0 = s.world.x;
            const L v1 = absolute(v0);
            const L v2 = L(R(10.0));
            const L v3 = v2 + v1;
            return {v3};
        }
        default: return {};
        }
    }
};

Scene scene;

void load([[maybe_unused]] scc::host::Values& values) {
    prepare(scene);
}

RenderResult draw(const RenderRequest& request, Image& image) {
    return render(scene, request, image);
}

} // namespace

int main(int argc, char** argv) {
    static constexpr const char* features[] = {"disc", "triangle", "sphere (transformed)", "point_lights", "attenuation", "separate_specular", "specular", "functions", "smooth_normals", "orthographic", nullptr};
    return scc::host::run_program({.precision = "double", .isa = scc::host::compiled_isa, .features = features, .load = load, .draw = draw, .scene = "placed", .settings = {320, 240, 1, 0, false, PixelPoint::center, Sampler::grid, PixelFilter::box, 0.0}}, argc, argv);
}
