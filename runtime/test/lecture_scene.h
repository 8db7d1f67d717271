#pragma once

#include "runtime/render.h"

#include <cmath>

/// The first sample of the language: once as a compiled scene would be written, once as the generic scene.
namespace scc::runtime::test {

template <class R_>
struct LectureScene : SceneBase<R_> {
    using R = R_;
    static constexpr SceneTraits traits{.bare_shapes = 1U << 2 | 1U << 3,
                                        .placed_shapes = 1U << 0,
                                        .point_lights = true,
                                        .directional_lights = true,
                                        .attenuation = true,
                                        .specular = true,
                                        .reflection = true,
                                        .two_sided = true,
                                        .functions = true,
                                        .shadows = true,
                                        .perspective = true};
    using SceneBase<R>::primitives;

    static constexpr Affine<double> squash{{{1, 0, 0, 0}, {0, 0.7, 0, 0.7}, {0, 0, 1, 0}}};
    static constexpr std::array<Placed<Sphere<R>, R>, 1> placed_sphere{
        {{Sphere<R>{{0, 0, 0}, 1}, affine_cast<R>(squash), affine_cast<R>(inverse(squash)), Tag{0, {0, 0}}}}};
    static constexpr std::array<Bare<Cylinder<R>>, 1> bare_cylinder{
        {{Cylinder<R>{{2, 0, 0}, {2, R(1.6), 0}, R(0.4), false}, Tag{1, {1, 2}}}}};
    static constexpr std::array<Bare<Plane<R>>, 1> bare_plane{{{Plane<R>{{0, 1, 0}, 0}, Tag{2, {3, 3}}}}};
    static constexpr const auto& primitives(Of<Placed<Sphere<R>, R>>) { return placed_sphere; }
    static constexpr const auto& primitives(Of<Bare<Cylinder<R>>>) { return bare_cylinder; }
    static constexpr const auto& primitives(Of<Bare<Plane<R>>>) { return bare_plane; }

    static constexpr Rgb<R> gray(double v) { return {R(v), R(v), R(v)}; }
    static constexpr std::array<Phong<R>, 4> materials{{
        {.ambient = {{R(0.2), R(0.02), R(0.02)}},
         .diffuse = {{R(0.7), R(0.1), R(0.1)}},
         .specular = {gray(0.6)},
         .shininess = {40}},
        {.ambient = {gray(0.05)}, .diffuse = {gray(0.05)}, .reflect = {gray(0.8)}},
        {.ambient = {{R(0.1), R(0.2), R(0.6)}}, .diffuse = {{R(0.1), R(0.2), R(0.6)}}},
        {.ambient = {{}, 0}, .diffuse = {{}, 0}},
    }};
    static constexpr std::array<PointLight<R>, 1> point_lights{
        {{{4, 6, 3}, {1, 1, 1}, {1, 1, 1}, 1, R(0.05), R(0.01)}}};
    static constexpr std::array<DirectionalLight<R>, 1> directional_lights{
        {{{R(0.40824829046386302), R(0.81649658092772603), R(0.40824829046386302)},
          {R(0.3), R(0.3), R(0.35)},
          {R(0.3), R(0.3), R(0.35)}}}};
    static constexpr Camera<R> camera{
        .projection = Projection::perspective,
        .eye = {4, 3, 6},
        .u = {R(0.83205029433784372), 0, R(-0.55470019622522915)},
        .v = {R(-0.18181818181818182 * 1.0482848367219182), R(0.94491118252306805), R(-0.28590694784506764)},
        .n = {R(0.52414241836095915), R(0.32758901147559946), R(0.78621362754143878)},
        .half_height = R(0.36397023426620234)};
    static constexpr Rgb<R> ambient = gray(0.2);
    static constexpr Rgb<R> background{R(0.014443843596092545), R(0.031896033073011532),
                                       R(0.021219010376003555)};

    template <class L>
    static Rgb<L> color_function(std::int32_t, const SurfacePoint<L>& s) {
        const L v0 = s.p.x;
        const L v1 = round_down(v0);
        const L v2 = s.p.z;
        const L v3 = round_down(v2);
        const L v4 = v1 + v3;
        const L v5 = L(R(2));
        const L v6 = floored_mod(v4, v5);
        const L v7 = L(R(0));
        const L v8 = truth(v6 == v7);
        const L v9 = L(R(0.8));
        const L v10 = L(R(0.1));
        const L v11 = choose(v8 != 0, v9, v10);
        return {v11, v11, v11};
    }
};

/// The same through tables and the interpreter.
template <class R>
DynamicScene<R> generic_lecture_scene() {
    using Source = LectureScene<R>;
    DynamicScene<R> scene;
    scene.add(Source::placed_sphere[0]);
    scene.add(Source::bare_cylinder[0]);
    scene.add(Source::bare_plane[0]);
    scene.materials.assign(Source::materials.begin(), Source::materials.end());
    scene.point_lights.assign(Source::point_lights.begin(), Source::point_lights.end());
    scene.directional_lights.assign(Source::directional_lights.begin(), Source::directional_lights.end());
    scene.camera = Source::camera;
    scene.ambient = Source::ambient;
    scene.background = Source::background;
    scene.functions.push_back({{{Opcode::p_x},
                                {Opcode::floor, {0}},
                                {Opcode::p_z},
                                {Opcode::floor, {2}},
                                {Opcode::add, {1, 3}},
                                {Opcode::constant, {}, R(2)},
                                {Opcode::mod, {4, 5}},
                                {Opcode::constant, {}, R(0)},
                                {Opcode::eq, {6, 7}},
                                {Opcode::constant, {}, R(0.8)},
                                {Opcode::constant, {}, R(0.1)},
                                {Opcode::select, {8, 9, 10}}},
                               {11, 11, 11}});
    prepare(scene);
    return scene;
}

inline RenderRequest request(int width, int height, int threads = 1) {
    RenderRequest result;
    result.settings.width = width;
    result.settings.height = height;
    result.settings.depth = 4;
    result.crop = {0, 0, width, height};
    result.threads = threads;
    return result;
}

} // namespace scc::runtime::test
