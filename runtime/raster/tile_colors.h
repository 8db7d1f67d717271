#pragma once

#include "runtime/image.h"
#include "runtime/raster/fill.h"
#include "runtime/raster/interleave.h"
#include "runtime/raster/stream.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace scc::runtime::raster {

/// The light of a tile's samples, block by block as TileBuffer has them, and its way into a picture.
template <class L>
class TileColors {
    using R = RealOf<L>;
    static constexpr int N = lane_count<L>;
    using Buffer = TileBuffer<L>;

public:
    explicit TileColors(const TileGrid& tiles) : tiles_(tiles), blocks_(Buffer::samples / N) {}

    /// The tile that begins at this sample.
    void start(int left, int top) {
        left_ = left;
        top_ = top;
    }
    Rgb<L>& operator[](std::size_t block) { return blocks_[block]; }

    /// The blocks that have some of the pixels: f(block, its first column and row in the tile).
    template <class F>
    void for_each_block(const Crop& pixels, F&& f) const {
        const int n = tiles_.samples_across();
        const int x0 = (pixels.x0 * n - left_) / Buffer::block_width * Buffer::block_width,
                  y0 = (pixels.y0 * n - top_) / Buffer::block_height * Buffer::block_height,
                  x1 = pixels.x1 * n - left_, y1 = pixels.y1 * n - top_;
        for (int y = y0; y < y1; y += Buffer::block_height) {
            for (int x = x0; x < x1; x += Buffer::block_width) {
                f(Buffer::block_of(x, y), x, y);
            }
        }
    }

    /// The means of the pixels' samples, into a picture of the crop's size. + 0 as in ray pictures: no -0.
    void store(const Crop& pixels, const Crop& crop, Image& image) const {
        if (tiles_.samples_across() == 1) {
            store_samples(pixels, crop, image);
            return;
        }
        const int n = tiles_.samples_across();
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            float* to = image.at(pixels.x0 - crop.x0, y - crop.y0);
            for (int x = pixels.x0; x < pixels.x1; ++x, to += 3) {
                Rgb<R> sum{};
                for (int j = 0; j < n; ++j) {
                    for (int i = 0; i < n; ++i) {
                        sum = sum + at(x * n + i - left_, y * n + j - top_);
                    }
                }
                const R count = static_cast<R>(n * n);
                to[0] = static_cast<float>(sum.r / count) + 0.0F;
                to[1] = static_cast<float>(sum.g / count) + 0.0F;
                to[2] = static_cast<float>(sum.b / count) + 0.0F;
            }
        }
    }

private:
    /// One for each pixel, a row of blocks at a time.
    void store_samples(const Crop& pixels, const Crop& crop, Image& image) const {
        alignas(64) float rows[Buffer::block_height][std::size_t{3} * Buffer::size + std::size_t{N}];
        const int x1 = pixels.x1 - left_, y1 = pixels.y1 - top_;
        for (int row = 0; row < y1; row += Buffer::block_height) {
            for (int column = 0; column < x1; column += Buffer::block_width) {
                store_rows<Buffer::block_width>(blocks_[Buffer::block_of(column, row)],
                                                [&](int j) { return rows[j] + 3 * column; });
            }
            const int x0 = std::max(pixels.x0 - left_, 0), y0 = std::max(pixels.y0 - top_ - row, 0);
            for (int j = y0; j < std::min(Buffer::block_height, y1 - row); ++j) {
                stream(rows[j] + 3 * x0, static_cast<std::size_t>(3 * (x1 - x0)),
                       image.at(left_ + x0 - crop.x0, top_ + row + j - crop.y0));
            }
        }
        streams_end();
    }
    Rgb<R> at(int column, int row) const {
        const std::size_t sample = Buffer::sample_of(column, row);
        const Rgb<L>& light = blocks_[sample / N];
        const int k = static_cast<int>(sample % N);
        return {lane(light.r, k), lane(light.g, k), lane(light.b, k)};
    }

    const TileGrid& tiles_;
    std::vector<Rgb<L>> blocks_;
    int left_ = 0, top_ = 0;
};

} // namespace scc::runtime::raster
