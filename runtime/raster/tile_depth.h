#pragma once

#include "runtime/raster/fill.h"

#include <algorithm>
#include <cstddef>
#include <vector>

/// From a tile's z* to those of a picture's pixels.
namespace scc::runtime::raster {

template <class R>
void store_no_depth(const Crop& pixels, const Crop& crop, int width, std::vector<R>& to) {
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        const auto first = to.begin() + std::ptrdiff_t{y - crop.y0} * width + (pixels.x0 - crop.x0);
        std::fill(first, first + (pixels.x1 - pixels.x0), R(1));
    }
}

/// Of the sample at the pixel's centre, or of `n` across, if even, right below it; 1 where nothing is shown.
template <class L>
void store_depth(const TileBuffer<L>& buffer, int n, const Crop& pixels, const Crop& crop, int width,
                 std::vector<RealOf<L>>& to) {
    using R = RealOf<L>;
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const int column = x * n + n / 2 - buffer.left(), row = y * n + n / 2 - buffer.top();
            const bool is_shown = buffer.entry(TileBuffer<L>::sample_of(column, row)) != no_entry;
            to[static_cast<std::size_t>(y - crop.y0) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x - crop.x0)] = is_shown ? buffer.depth(column, row) : R(1);
        }
    }
}

} // namespace scc::runtime::raster
