#pragma once

#include "runtime/math/vec.h"

#include <filesystem>
#include <string>
#include <vector>

/// Eric Haines' Neutral File Format, as far as the Standard Procedural Databases use it, for Tachyon's sake.
/// (The product reads it by `scc import nff`.)
namespace scc::bench {

using Vec = runtime::Vec3<double>;
using Color = runtime::Rgb<double>;

struct NffFill {
    Color color{1, 1, 1};
    double diffuse = 1, specular = 0, shine = 0, transmission = 0, index = 1;
};
struct NffLight {
    Vec position;
    Color color;
};
struct NffSphere {
    Vec center;
    double radius;
    std::size_t fill; ///< in NffScene::fills
};
/// Without its ends.
struct NffCone {
    Vec base;
    double base_radius;
    Vec apex;
    double apex_radius;
    std::size_t fill;
};
struct NffPolygon {
    std::vector<Vec> corners;
    std::vector<Vec> normals; ///< of a patch: one per corner; else none
    std::size_t fill;
};

struct NffScene {
    Color background{};
    Vec from, at, up;
    double angle = 45; ///< degrees
    double hither = 1;
    int width = 512, height = 512;
    std::vector<NffLight> lights;
    std::vector<NffFill> fills;
    std::vector<NffSphere> spheres;
    std::vector<NffCone> cones;
    std::vector<NffPolygon> polygons;
};

/// Lights without a color get 1 / sqrt(their number). Throws std::runtime_error.
NffScene read_nff(const std::filesystem::path& path);

void write_nff(const NffScene& scene, const std::filesystem::path& path);

/// Tachyon's own language: the same geometry, view, lights and materials. What differs: Tachyon has no cone,
/// so a cone becomes an open cylinder of its mean radius (the cheaper test); polygons become triangles, as
/// they do here. `bounces` mirror bounces at most.
void write_tachyon(const NffScene& scene, int bounces, const std::filesystem::path& path);

} // namespace scc::bench
