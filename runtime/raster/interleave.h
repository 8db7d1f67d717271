#pragma once

#include "runtime/math/pack.h"
#include "runtime/math/vec.h"

#include <cstddef>
#include <cstring>
#include <utility>

/// From packs of colours to a picture's memory.
namespace scc::runtime::raster {

namespace detail {

/// Float number j N + i of colours one after the other, red first.
template <std::size_t j, int N, std::size_t... i>
void store_third(const runtime::detail::VectorType<float, N>& r,
                 const runtime::detail::VectorType<float, N>& g,
                 const runtime::detail::VectorType<float, N>& b, float* to, std::index_sequence<i...>) {
    constexpr auto lane = [](std::size_t k) { return static_cast<int>((j * N + k) / 3); };
    constexpr auto channel = [](std::size_t k) { return static_cast<int>((j * N + k) % 3); };
    const auto red_green = __builtin_shufflevector(r, g,
                                                   (channel(i) == 1   ? N + lane(i)
                                                    : channel(i) == 0 ? lane(i)
                                                                      : 0)...);
    const auto all =
        __builtin_shufflevector(red_green, b, (channel(i) == 2 ? N + lane(i) : static_cast<int>(i))...);
    std::memcpy(to + j * N, &all, sizeof all);
}

} // namespace detail

/// The lanes' colours, one after the other, as 3 floats each. + 0 as in ray pictures: no -0.
template <class T, int N>
void store_interleaved(const Rgb<Pack<T, N>>& color, float* to) {
    using Floats = runtime::detail::VectorType<float, N>;
    const auto channel = [](const Pack<T, N>& c) { return __builtin_convertvector(c.v, Floats) + 0.0F; };
    const Floats r = channel(color.r), g = channel(color.g), b = channel(color.b);
    constexpr auto lanes = std::make_index_sequence<static_cast<std::size_t>(N)>{};
    detail::store_third<0, N>(r, g, b, to, lanes);
    detail::store_third<1, N>(r, g, b, to, lanes);
    detail::store_third<2, N>(r, g, b, to, lanes);
}

} // namespace scc::runtime::raster
