#pragma once

#include "runtime/picture_allocator.h"

#include <cstddef>
#include <vector>

namespace scc::runtime {

using Pixels = std::vector<float, PictureAllocator<float>>;

/// A picture of `channels` floats per pixel, linear light, rows from the top.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 3;
    Pixels pixels; ///< width * height * channels

    Image() = default;
    Image(int w, int h, int c = 3)
        : width(w), height(h), channels(c),
          pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

    float* at(int x, int y) {
        return &pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x)) *
                       static_cast<std::size_t>(channels)];
    }
    const float* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

} // namespace scc::runtime
