#pragma once

#include "runtime/raster/screen_triangle.h"
#include "runtime/render_request.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace scc::runtime::raster {

/// Samples across a tile, at most.
inline constexpr int most_tile_samples = 64;

/// The picture's tiles: squares of whole pixels, in the same places whatever the crop is.
class TileGrid {
public:
    TileGrid(const Crop& crop, int samples_across)
        : samples_(samples_across), pixels_(std::max(1, most_tile_samples / samples_across)),
          crop_(crop), box_{crop.x0 * samples_, crop.y0 * samples_, crop.x1 * samples_, crop.y1 * samples_},
          first_column_(crop.x0 / pixels_), first_row_(crop.y0 / pixels_),
          across_((crop.x1 + pixels_ - 1) / pixels_ - first_column_),
          down_((crop.y1 + pixels_ - 1) / pixels_ - first_row_),
          inverse_((std::uint64_t{1} << 32U) / static_cast<std::uint64_t>(pixels_ * samples_) + 1) {}

    const SampleBox& box() const { return box_; }   ///< all samples that are drawn
    int samples_across() const { return samples_; } ///< a pixel
    int pixels_across() const { return crop_.x1 - crop_.x0; }
    int count() const { return across_ * down_; }
    int across() const { return across_; }
    int tile_samples() const { return pixels_ * samples_; } ///< across a tile

    /// The pixels of a tile that are drawn.
    Crop pixels_of(int tile) const {
        const int x = (first_column_ + tile % across_) * pixels_, y = (first_row_ + tile / across_) * pixels_;
        return {std::max(x, crop_.x0), std::max(y, crop_.y0), std::min(x + pixels_, crop_.x1),
                std::min(y + pixels_, crop_.y1)};
    }
    int left_of(int tile) const { return (first_column_ + tile % across_) * tile_samples(); }
    int top_of(int tile) const { return (first_row_ + tile / across_) * tile_samples(); }

    /// f(tile, its left, its top) for each that has some of the samples, which are drawn ones.
    template <class F>
    void for_each_tile(const SampleBox& samples, F&& f) const {
        const int size = tile_samples(), column = along(samples.x0), row = along(samples.y0);
        int first = (row - first_row_) * across_ + column - first_column_;
        for (int top = row * size; top < samples.y1; top += size, first += across_) {
            int tile = first;
            for (int left = column * size; left < samples.x1; left += size) {
                f(static_cast<std::size_t>(tile++), left, top);
            }
        }
    }

private:
    /// sample / tile_samples(), exactly for samples below 2^26.
    int along(std::int32_t sample) const {
        return static_cast<int>((static_cast<std::uint64_t>(sample) * inverse_) >> 32U);
    }

    int samples_, pixels_;
    Crop crop_;
    SampleBox box_;
    int first_column_, first_row_, across_, down_;
    std::uint64_t inverse_; ///< 2^32 / tile_samples(), rounded up
};

/// What one run of triangles or lines has for each tile, in their order.
template <class R>
struct Bin {
    std::vector<ScreenTriangle<R>> triangles;
    std::vector<ScreenLine<R>> lines;
    std::vector<std::vector<SmallTriangle<R>>> small_of;   ///< of each tile
    std::vector<std::vector<NarrowTriangle<R>>> narrow_of; ///< of each tile
    std::vector<std::vector<std::uint32_t>> triangles_of;  ///< of each tile: the others
    std::vector<std::vector<std::uint32_t>> lines_of;      ///< of each tile
    std::vector<std::uint32_t> fronts_of; ///< of each surface: how many of the triangles show their front

    /// Keeps the memory.
    void clear(const TileGrid& tiles) {
        triangles.clear();
        lines.clear();
        const auto clear_lists = [&](auto& lists) {
            for (auto& list : lists) {
                list.clear();
            }
            lists.resize(static_cast<std::size_t>(tiles.count()));
        };
        clear_lists(small_of);
        clear_lists(narrow_of);
        clear_lists(triangles_of);
        clear_lists(lines_of);
        fronts_of.clear();
    }
    bool has_nothing_in(std::size_t tile) const { return count_in(tile) == 0; }
    std::size_t count_in(std::size_t tile) const {
        return small_of[tile].size() + narrow_of[tile].size() + triangles_of[tile].size() +
               lines_of[tile].size();
    }
    /// `column`, `row`: of its square's first sample, in the picture. Some drawn samples are in the square.
    void add(SmallTriangle<R> t, std::int32_t column, std::int32_t row, const TileGrid& tiles) {
        constexpr std::int32_t width = SmallTriangle<R>::width;
        const SampleBox square{column, row, column + width, row + width};
        const std::uint32_t covered = t.covered;
        tiles.for_each_tile(intersection(square, tiles.box()), [&](std::size_t tile, int left, int top) {
            const std::int32_t x = column - left, y = row - top;
            const std::uint32_t inside = covered & samples_in_tile(x, tiles.tile_samples()) * 0x1111U &
                                         rows_in_tile(y, tiles.tile_samples());
            if (inside != 0) {
                t.column = static_cast<std::int16_t>(x);
                t.row = static_cast<std::int16_t>(y);
                t.covered = static_cast<std::uint16_t>(inside);
                small_of[tile].push_back(t);
            }
        });
    }
    /// `column`, `row`: of its box's first sample, in the picture. Some drawn samples are in the box.
    void add(NarrowTriangle<R> t, std::int32_t column, std::int32_t row, const TileGrid& tiles) {
        const SampleBox box{column, row, column + t.columns, row + t.rows};
        tiles.for_each_tile(intersection(box, tiles.box()), [&](std::size_t tile, int left, int top) {
            t.column = static_cast<std::int16_t>(column - left);
            t.row = static_cast<std::int16_t>(row - top);
            narrow_of[tile].push_back(t);
        });
    }
    void add(const ScreenTriangle<R>& t, const SampleBox& box, const TileGrid& tiles) {
        const auto index = static_cast<std::uint32_t>(triangles.size());
        triangles.push_back(t);
        tiles.for_each_tile(box, [&](std::size_t tile, int, int) { triangles_of[tile].push_back(index); });
    }
    void add(const ScreenLine<R>& line, const SampleBox& box, const TileGrid& tiles) {
        const auto index = static_cast<std::uint32_t>(lines.size());
        lines.push_back(line);
        tiles.for_each_tile(box, [&](std::size_t tile, int, int) { lines_of[tile].push_back(index); });
    }

private:
    /// Of 4 samples from `first` on, a bit for each that is in [0, size).
    static std::uint32_t samples_in_tile(std::int32_t first, std::int32_t size) {
        const std::int32_t before = std::max(0, -first), beyond = std::max(0, first + 4 - size);
        return (0xFU << before) & (0xFU >> beyond);
    }
    /// The same of rows of 4 samples.
    static std::uint32_t rows_in_tile(std::int32_t first, std::int32_t size) {
        const std::int32_t before = std::max(0, -first), beyond = std::max(0, first + 4 - size);
        return (0xFFFFU << 4 * before) & (0xFFFFU >> 4 * beyond);
    }
};

/// Whole numbers beside a pack of reals.
template <class L>
using GridPack = runtime::detail::VectorType<std::int32_t, lane_count<L>>;

/// The lanes that are not 0 in what a comparison gives.
template <class L>
unsigned grid_bits_of(const GridPack<L>& compared) {
    if constexpr (lane_count<L> == 1) {
        return compared[0] != 0 ? 1U : 0U;
    } else {
        return bits(PackMask<float, lane_count<L>>(
            reinterpret_cast<typename PackMask<float, lane_count<L>>::Vector>(compared)));
    }
}

/// The nearest place on the grid, from a first sample's centre, of a coordinate in samples; of two the even
/// one.
template <class T, int N>
GridPack<Pack<T, N>> on_grid(const Pack<T, N>& x) {
    const Pack<T, N> nearest =
        runtime::detail::to_nearest_whole((x - Pack<T, N>(T(0.5))) * Pack<T, N>(T(grid)));
    return __builtin_convertvector(nearest.v, GridPack<Pack<T, N>>);
}
template <std::floating_point T>
std::int32_t on_grid(T x) {
    return on_grid(Pack<T, 2>(x))[0];
}

} // namespace scc::runtime::raster
