#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace scc::runtime {

/// L11. Which point of a pixel is the middle of what it shows: its centre, or its lower left corner, as in
/// the lecture's formula.
enum class PixelPoint { center, corner };
/// Where a pixel's samples lie: at the centres of n x n sub-pixels, or at scrambled Sobol points
/// (sampling.h).
enum class Sampler { grid, low_discrepancy };
/// By what weights the samples around a pixel's centre become its value (sampling.h).
enum class PixelFilter { box, mitchell, gaussian, blackman_harris };

/// How a picture is drawn: by rays, or by triangles and lines through the pipeline of L1 to L6
/// (raster/draw.h).
enum class Method { ray, raster };
/// L10. What a raster picture shows of surfaces: one colour per face (that at its last vertex, as OpenGL's
/// GL_FLAT), the colours at its vertices interpolated, the normals interpolated and each pixel lit, the edges
/// alone, or the edges that no surface hides.
enum class RasterShading { flat, gouraud, phong, wireframe, hidden_line };
/// Which triangles are left out: none, or those of which the back is seen.
enum class Cull { none, back };

/// The words that scenes and command lines have for them.
inline constexpr auto pixel_point_names = std::to_array<std::string_view>({"center", "corner"});
inline constexpr auto sampler_names = std::to_array<std::string_view>({"grid", "low_discrepancy"});
inline constexpr auto filter_names =
    std::to_array<std::string_view>({"box", "mitchell", "gaussian", "blackman_harris"});

inline constexpr auto method_names = std::to_array<std::string_view>({"ray", "raster"});
inline constexpr auto raster_shading_names =
    std::to_array<std::string_view>({"flat", "gouraud", "phong", "wireframe", "hidden_line"});
inline constexpr auto cull_names = std::to_array<std::string_view>({"none", "back"});

template <class Choice, std::size_t n>
constexpr std::string_view word(const std::array<std::string_view, n>& names, Choice choice) {
    return names[static_cast<std::size_t>(choice)];
}
/// The reverse; the word must be one of them.
template <class Choice, std::size_t n>
constexpr Choice choice_of(const std::array<std::string_view, n>& names, std::string_view word) {
    std::size_t i = 0;
    while (names[i] != word) {
        ++i;
    }
    return static_cast<Choice>(i);
}

/// Whether it shows the edges of polygons.
constexpr bool shows_edges(RasterShading shading) {
    return shading == RasterShading::wireframe || shading == RasterShading::hidden_line;
}

/// What Method::raster is told beside.
struct RasterSettings {
    RasterShading shading = RasterShading::phong;
    Cull cull = Cull::none;
    /// Against the near and the far plane. Without, everything in front of the eye is seen: depths beyond
    /// both planes are drawn as they are.
    bool clip = true;
    /// How far triangles may be from the surfaces that they stand for, in picture heights at their nearest
    /// place.
    double tessellation = 0.001;
};

/// The picture's settings that a scene states and a command line may override.
struct RenderSettings {
    int width = 800;
    int height = 600;
    int samples = 1; ///< per pixel, of a grid a square number; with `adaptive` at most
    int depth = 5;   ///< mirrors and refractions one after the other
    bool shadows = true;
    PixelPoint point = PixelPoint::center;
    Sampler sampler = Sampler::grid;
    PixelFilter filter = PixelFilter::box;
    /// The standard error that a pixel's mean may have, in linear light; 0: all samples are taken.
    double adaptive = 0;
    Method method = Method::ray;
    RasterSettings raster;
    /// Where the origin of the scene's coordinates is in the world: not at 0 for what stands far from it.
    std::array<double, 3> origin{};
};

inline constexpr int most_samples = 4096;
inline constexpr int most_bounces = 256; ///< of RenderSettings::depth

/// n of n x n; the nearest one for what is no square number.
inline int samples_per_axis(const RenderSettings& settings) {
    return static_cast<int>(std::lround(std::sqrt(settings.samples)));
}

/// Whether the sampler can give a pixel so many samples.
inline bool fits_sampler(const RenderSettings& settings) {
    const int n = samples_per_axis(settings);
    return settings.sampler != Sampler::grid || n * n == settings.samples;
}

/// The mean of a regular grid: what every other renderer can be asked for.
constexpr bool is_plain_grid(const RenderSettings& settings) {
    return settings.sampler == Sampler::grid && settings.filter == PixelFilter::box && settings.adaptive == 0;
}

/// The same picture by a plain grid, of as many samples or a few less or more.
inline RenderSettings with_plain_grid(RenderSettings settings) {
    const int n = samples_per_axis(settings);
    settings.samples = n * n;
    settings.sampler = Sampler::grid;
    settings.filter = PixelFilter::box;
    settings.adaptive = 0;
    return settings;
}

} // namespace scc::runtime
