#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace scc::runtime {

/// From the start of a cache line on, so that rows of pixels are written by whole lines.
template <class T>
struct CacheLineAllocator {
    using value_type = T;
    static constexpr std::align_val_t line{64};

    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
    void deallocate(T* p, std::size_t n) { ::operator delete(p, n * sizeof(T), line); }
    friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

using Pixels = std::vector<float, CacheLineAllocator<float>>;

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
