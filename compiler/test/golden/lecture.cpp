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
    static constexpr SceneTraits traits{.bare_shapes = 0xc, .placed_shapes = 0x1, .point_lights = true, .directional_lights = true, .attenuation = true, .specular = true, .reflection = true, .two_sided = true, .functions = true, .shadows = true, .perspective = true};
    using SceneBase<R>::primitives;
    static constexpr std::array<Placed<Sphere<R>, R>, 1> placed_sphere{{
        {{{0.0, 0.0, 0.0}, 1.0}, {{{1.0, 0.0, 0.0, 0.0}, {0.0, 0.7, 0.0, 0.7}, {0.0, 0.0, 1.0, 0.0}}}, {{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.4285714285714286, 0.0, -1.0}, {0.0, 0.0, 1.0, 0.0}}}, {0, {0, 0}}},
    }};
    const auto& primitives(Of<Placed<Sphere<R>, R>>) const { return placed_sphere; }
    static constexpr std::array<Bare<Plane<R>>, 1> bare_plane{{
        {{{0.0, 1.0, 0.0}, 0.0}, {2, {3, 3}}},
    }};
    const auto& primitives(Of<Bare<Plane<R>>>) const { return bare_plane; }
    static constexpr std::array<Bare<Cylinder<R>>, 1> bare_cylinder{{
        {{{2.0, 0.0, 0.0}, {2.0, 1.6, 0.0}, 0.4, false}, {1, {1, 2}}},
    }};
    const auto& primitives(Of<Bare<Cylinder<R>>>) const { return bare_cylinder; }
    static constexpr std::array<Phong<R>, 4> materials{{
        {{{0.2, 0.02, 0.02}, -1}, {{0.7, 0.1, 0.1}, -1}, {{0.6, 0.6, 0.6}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {40.0, -1}, 1.0, false, -1},
        {{{0.05, 0.05, 0.05}, -1}, {{0.05, 0.05, 0.05}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.8, 0.8, 0.8}, -1}, {{0.0, 0.0, 0.0}, -1}, {32.0, -1}, 1.0, false, -1},
        {{{0.1, 0.2, 0.6}, -1}, {{0.1, 0.2, 0.6}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {32.0, -1}, 1.0, false, -1},
        {{{0.0, 0.0, 0.0}, 0}, {{0.0, 0.0, 0.0}, 0}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {{0.0, 0.0, 0.0}, -1}, {32.0, -1}, 1.0, false, -1},
    }};
    static constexpr std::array<PointLight<R>, 1> point_lights{{
        {{4.0, 6.0, 3.0}, {1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, 1.0, 0.05, 0.01},
    }};
    static constexpr std::array<DirectionalLight<R>, 1> directional_lights{{
        {{0.4082482904638631, 0.8164965809277261, 0.4082482904638631}, {0.3, 0.3, 0.35}, {0.3, 0.3, 0.35}},
    }};
    static constexpr Rgb<R> ambient{0.2, 0.2, 0.2};
    static constexpr Rgb<R> background{0.014443843596092545, 0.021219010376003555, 0.0295568344378088};
    static constexpr Camera<R> camera{Projection::perspective, {4.0, 3.0, 6.0}, {0.8320502943378436, 0.0, -0.554700196225229}, {-0.1816980905357149, 0.9448300707857176, -0.27254713580357237}, {0.5240974256643347, 0.3275608910402092, 0.7861461384965021}, 0.36397023426620234, 0.0, 0.0, 0.0, 0.0, 7.632168761236874, 0.1, 100.0};
    template <class L>
    Rgb<L> color_function(std::int32_t index, const SurfacePoint<L>& s) const {
        switch (index) {
        case 0: { // checker
            const L v0 = s.p.x;
            const L v1 = s.p.z;
            const L v2 = round_down(v0);
            const L v3 = round_down(v1);
            const L v4 = v2 + v3;
            const L v5 = L(R(2.0));
            const L v6 = floored_mod(v4, v5);
            const L v7 = L(R(0.0));
            const L v8 = truth(v6 == v7);
            const L v9 = L(R(0.8));
            const L v10 = L(R(0.1));
            const L v11 = choose(v8 != 0, v9, v10);
            return {v11, v11, v11};
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
    static constexpr const char* features[] = {"plane", "cylinder", "sphere (transformed)", "point_lights", "directional_lights", "attenuation", "specular", "reflection", "two_sided", "functions", "shadows", "perspective", nullptr};
    return scc::host::run_program({.precision = "double", .isa = scc::host::compiled_isa, .features = features, .load = load, .draw = draw, .scene = "lecture", .settings = {640, 480, 16, 4, true, PixelPoint::center, Sampler::grid, PixelFilter::box, 0.0}}, argc, argv);
}
