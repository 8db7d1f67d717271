#pragma once

#include "runtime/math/pack.h"
#include "runtime/math/vec.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

/// From packs of colours to a picture's memory.
namespace scc::runtime::raster {

namespace detail {

/// N floats, from number `begin` on, of colours one after the other, red first; beyond the last colour, any.
template <std::size_t begin, int N, std::size_t... i>
void store_from(const runtime::detail::VectorType<float, N>& r,
                const runtime::detail::VectorType<float, N>& g,
                const runtime::detail::VectorType<float, N>& b, float* to, std::index_sequence<i...>) {
    constexpr auto lane = [](std::size_t k) { return std::min(static_cast<int>((begin + k) / 3), N - 1); };
    constexpr auto channel = [](std::size_t k) { return static_cast<int>((begin + k) % 3); };
    const auto red_green = __builtin_shufflevector(r, g,
                                                   (channel(i) == 1   ? N + lane(i)
                                                    : channel(i) == 0 ? lane(i)
                                                                      : 0)...);
    const auto all =
        __builtin_shufflevector(red_green, b, (channel(i) == 2 ? N + lane(i) : static_cast<int>(i))...);
    std::memcpy(to, &all, sizeof all);
}

} // namespace detail

/// The lanes' colours in rows of `width`, as 3 floats each: a row begins at to(row). Up to N floats behind it
/// are overwritten. + 0 as in ray pictures: no -0.
template <int width, class T, int N, class To>
void store_rows(const Rgb<Pack<T, N>>& color, To&& to) {
    using Floats = runtime::detail::VectorType<float, N>;
    const auto channel = [](const Pack<T, N>& c) { return __builtin_convertvector(c.v, Floats) + 0.0F; };
    const Floats r = channel(color.r), g = channel(color.g), b = channel(color.b);
    constexpr auto lanes = std::make_index_sequence<static_cast<std::size_t>(N)>{};
    constexpr std::size_t row_floats = 3 * width, pieces = (row_floats + N - 1) / N;
    const auto store_row = [&]<std::size_t row, std::size_t... piece>(std::index_sequence<piece...>) {
        float* const begin = to(static_cast<int>(row));
        (detail::store_from<row * row_floats + piece * N, N>(r, g, b, begin + piece * N, lanes), ...);
    };
    [&]<std::size_t... row>(std::index_sequence<row...>) {
        (store_row.template operator()<row>(std::make_index_sequence<pieces>{}), ...);
    }
    (std::make_index_sequence<static_cast<std::size_t>(N / width)>{});
}

} // namespace scc::runtime::raster
