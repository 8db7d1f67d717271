#include "validation/bench/own_scenes.h"

#include <cstdint>

namespace scc::bench {

namespace {

/// In [0, 1): the same sequence everywhere (a 32-bit linear congruential generator, high bits only).
class Random {
public:
    double operator()() {
        state_ = state_ * 1664525U + 1013904223U;
        return static_cast<double>(state_ >> 8) / (1U << 24);
    }

private:
    std::uint32_t state_ = 1;
};

NffScene scene_seen_from(const Vec& from, const Vec& at) {
    NffScene scene;
    scene.background = {0.4, 0.6, 0.9};
    scene.from = from;
    scene.at = at;
    scene.up = {0, 0, 1};
    return scene;
}

void add_ground(NffScene& scene, double reach, std::size_t fill) {
    scene.polygons.push_back(
        {{{-reach, -reach, 0}, {reach, -reach, 0}, {reach, reach, 0}, {-reach, reach, 0}}, {}, fill});
}

/// Its four walls and its roof.
void add_house(NffScene& scene, double x, double y, double half, double height, std::size_t fill) {
    const double x0 = x - half, x1 = x + half, y0 = y - half, y1 = y + half, z = height;
    const auto add = [&](std::vector<Vec> corners) {
        scene.polygons.push_back({std::move(corners), {}, fill});
    };
    add({{x0, y0, 0}, {x1, y0, 0}, {x1, y0, z}, {x0, y0, z}});
    add({{x1, y0, 0}, {x1, y1, 0}, {x1, y1, z}, {x1, y0, z}});
    add({{x1, y1, 0}, {x0, y1, 0}, {x0, y1, z}, {x1, y1, z}});
    add({{x0, y1, 0}, {x0, y0, 0}, {x0, y0, z}, {x0, y1, z}});
    add({{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
}

} // namespace

NffScene cones_and_spheres() {
    NffScene scene = scene_seen_from({-6, -30, 14}, {0, 0, 0});
    scene.lights = {{{-30, -40, 60}, {0.7, 0.7, 0.7}}, {{50, -20, 40}, {0.4, 0.4, 0.4}}};
    scene.fills = {{{0.6, 0.55, 0.45}, 0.9, 0, 1, 0, 1},
                   {{0.3, 0.7, 0.3}, 0.8, 0, 1, 0, 1},
                   {{0.9, 0.8, 0.7}, 0.4, 0.5, 40, 0, 1}};
    add_ground(scene, 60, 0); // wider, Tachyon's grid needs minutes
    constexpr int side = 50;
    constexpr double step = 0.5;
    Random random;
    for (int i = 0; i < side * side; ++i) {
        const double x = (i % side - side / 2 + 0.6 * random()) * step;
        const double y = (i / side - side / 2 + 0.6 * random()) * step;
        const double height = 0.4 + 0.6 * random(), radius = 0.14 + 0.05 * random();
        scene.cones.push_back({{x, y, 0}, radius, {x, y, height}, 0.3 * radius, 1});
        scene.spheres.push_back({{x, y, height + radius}, radius, 2});
    }
    return scene;
}

NffScene many_lights() {
    NffScene scene = scene_seen_from({-26, -30, 20}, {0, 0, 0});
    for (int i = 0; i < 5; ++i) {
        scene.lights.push_back({{-40.0 + 20 * i, -30.0 + 15 * (i % 3), 25.0 + 5 * i}, {0.3, 0.3, 0.3}});
    }
    scene.fills = {{{0.5, 0.5, 0.5}, 0.9, 0, 1, 0, 1},
                   {{0.8, 0.5, 0.4}, 0.8, 0, 1, 0, 1},
                   {{0.5, 0.6, 0.8}, 0.5, 0.4, 30, 0, 1}};
    add_ground(scene, 60, 0);
    constexpr int side = 40;
    Random random;
    for (int i = 0; i < side * side; ++i) {
        const double tall = random();
        add_house(scene, i % side - side / 2, i / side - side / 2, 0.25 + 0.15 * random(),
                  0.3 + 3 * tall * tall * tall, random() < 0.2 ? 2 : 1);
    }
    return scene;
}

} // namespace scc::bench
