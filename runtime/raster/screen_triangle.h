#pragma once

#include "runtime/math/pack.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

/// Triangles and lines on the grid of samples, after the division.
namespace scc::runtime::raster {

/// Corners lie on a grid of 1/256 of a sample, so that what is covered can be told exactly; so do llvmpipe's.
inline constexpr int grid_bits = 8;
inline constexpr int grid = 1 << grid_bits;

/// On the grid: triangles that are no wider and no higher are narrow; their edge functions have 32 bits.
inline constexpr std::int32_t most_narrow = 32 * grid;

/// The number of a triangle in the model, with what is told of it beside.
inline constexpr std::uint32_t seen_from_back = 1U << 30;
inline constexpr std::uint32_t lets_light_through = 1U << 31;
inline constexpr std::uint32_t triangle_number = seen_from_back - 1;

/// A triangle as it is filled. Coordinates are on the grid, from the centre of the picture's first sample;
/// the corners run so that edge functions are positive inside.
template <class R>
struct ScreenTriangle {
    std::array<std::int32_t, 3> x, y;
    R z, z_x, z_y; ///< z* at the centre of sample z_sample(), and its change from sample to sample
    std::uint32_t id;

    std::int32_t z_column() const { return x[0] >> grid_bits; }
    std::int32_t z_row() const { return y[0] >> grid_bits; }
};

/// Samples [x0, x1) x [y0, y1).
struct SampleBox {
    std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

inline SampleBox intersection(const SampleBox& a, const SampleBox& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// The samples whose centres are in a triangle's bounding box.
template <class R>
SampleBox box_of(const ScreenTriangle<R>& t) {
    const std::int32_t x0 = std::min(std::min(t.x[0], t.x[1]), t.x[2]),
                       x1 = std::max(std::max(t.x[0], t.x[1]), t.x[2]),
                       y0 = std::min(std::min(t.y[0], t.y[1]), t.y[2]),
                       y1 = std::max(std::max(t.y[0], t.y[1]), t.y[2]);
    return {(x0 + grid - 1) >> grid_bits, (y0 + grid - 1) >> grid_bits, (x1 >> grid_bits) + 1,
            (y1 >> grid_bits) + 1};
}

/// What a triangle shows of samples that lie in a square, in a tile; most triangles of fine meshes are such.
template <class R>
struct SmallTriangle {
    static constexpr std::int32_t width = 4; ///< of the square

    std::int16_t column, row; ///< the square's first sample in the tile; may lie before it
    std::uint16_t covered;    ///< a bit for each sample that is shown, by rows; all are in the tile
    std::uint32_t id;
    R z, z_x, z_y; ///< z* at the first sample, and its change from sample to sample
};

/// A narrow triangle with all that filling it in a tile needs, since a setup of many at once is cheaper.
template <class R>
struct NarrowTriangle {
    std::uint32_t id;
    std::int16_t column, row;  ///< the first sample of its bounding box in the tile; may lie before it
    std::int8_t columns, rows; ///< samples in the box, which may go beyond the tile
    std::int16_t edge_x[3], edge_y[3]; ///< edge functions' changes from sample to sample
    std::int32_t edge[3];              ///< edge functions at the first sample: none is negative inside
    R z, z_x, z_y;                     ///< z* at the first sample, and its change from sample to sample
};

/// A line as it is drawn: on the same grid, and in the direction in which it runs.
template <class R>
struct ScreenLine {
    std::int32_t x0, y0, x1, y1;
    R z, z_step; ///< z* at the centre of the start's sample along the longer direction, and its change per
                 ///< sample
    std::uint32_t segment; ///< of RasterModel::segments
    std::int32_t width;    ///< in samples
};

/// More across than down.
template <class R>
bool runs_across(const ScreenLine<R>& line) {
    return std::abs(std::int64_t{line.x1} - line.x0) >= std::abs(std::int64_t{line.y1} - line.y0);
}

} // namespace scc::runtime::raster
