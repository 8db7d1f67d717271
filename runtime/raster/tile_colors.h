#pragma once

#include "runtime/image.h"
#include "runtime/raster/fill.h"
#include "runtime/raster/interleave.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
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
    /// One for each pixel.
    void store_samples(const Crop& pixels, const Crop& crop, Image& image) const {
        constexpr int row_floats = 3 * Buffer::block_width;
        for_each_block(pixels, [&](std::size_t block, int column, int row) {
            float colors[std::size_t{3} * N];
            store_interleaved(blocks_[block], colors);
            const int x = left_ + column, y = top_ + row;
            if (x >= pixels.x0 && y >= pixels.y0 && x + Buffer::block_width <= pixels.x1 &&
                y + Buffer::block_height <= pixels.y1) {
                for (int j = 0; j < Buffer::block_height; ++j) {
                    std::memcpy(image.at(x - crop.x0, y + j - crop.y0), colors + j * row_floats,
                                row_floats * sizeof(float));
                }
                return;
            }
            const int x0 = std::max(x, pixels.x0), x1 = std::min(x + Buffer::block_width, pixels.x1),
                      y0 = std::max(y, pixels.y0), y1 = std::min(y + Buffer::block_height, pixels.y1);
            for (int j = y0; j < y1; ++j) {
                std::copy_n(colors + (j - y) * row_floats + 3 * (x0 - x), 3 * (x1 - x0),
                            image.at(x0 - crop.x0, j - crop.y0));
            }
        });
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
