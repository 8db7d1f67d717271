#pragma once

#include "runtime/raster/bins.h"
#include "runtime/raster/clip.h"
#include "runtime/raster/model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

/// Lines: clipped in homogeneous coordinates, drawn by the diamond exit rule of OpenGL.
namespace scc::runtime::raster {

/// Puts a model's segments into the bin.
template <class R>
void set_up_lines(const RasterModel<R>& model, const RasterView<R>& view, const TileGrid& tiles,
                  Bin<R>& bin) {
    const ClipVolume<R> guard = ClipVolume<R>::guard(view);
    const SampleBox& window = tiles.box();
    const R one = 1;
    std::uint32_t number = 0;
    for (const RasterSegment<R>& segment : model.segments) {
        const std::uint32_t here = number++;
        ClipPoint<R> from = view.to_clip(view.to_eye(segment.from, one)),
                     to = view.to_clip(view.to_eye(segment.to, one));
        const auto is_usable = [](const ClipPoint<R>& p) {
            return absolute(p.x) < most_coordinate<R> && absolute(p.y) < most_coordinate<R> &&
                   absolute(p.z) < most_coordinate<R> && absolute(p.w) < most_coordinate<R>;
        };
        if (!is_usable(from) || !is_usable(to) || !clip_line(guard, from, to)) {
            continue;
        }
        const auto is_near = [&](const ClipPoint<R>& p) {
            return absolute(p.x / p.w - view.guard_x()) <= 2 * view.guard() &&
                   absolute(p.y / p.w - view.guard_y()) <= 2 * view.guard() &&
                   absolute(p.z / p.w) < most_coordinate<R>;
        };
        if (!is_near(from) || !is_near(to)) {
            continue;
        }
        const R width = segment.width * static_cast<R>(tiles.samples_across());
        ScreenLine<R> line{on_grid(from.x / from.w),
                           on_grid(from.y / from.w),
                           on_grid(to.x / to.w),
                           on_grid(to.y / to.w),
                           from.z / from.w,
                           to.z / to.w,
                           here,
                           0};
        line.width = std::max(1, static_cast<std::int32_t>(std::lround(std::min(width, view.guard()))));
        const std::int32_t around = line.width / 2 + 1;
        const SampleBox box{(std::min(line.x0, line.x1) >> grid_bits) - around,
                            (std::min(line.y0, line.y1) >> grid_bits) - around,
                            (std::max(line.x0, line.x1) >> grid_bits) + around + 2,
                            (std::max(line.y0, line.y1) >> grid_bits) + around + 2};
        const SampleBox seen = intersection(box, window);
        if (!seen.empty()) {
            bin.add(line, seen, tiles);
        }
    }
}

namespace detail {

constexpr std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
    return a / b - ((a % b != 0) && ((a < 0) != (b < 0)) ? 1 : 0);
}

} // namespace detail

/// f(column, row, z) for the samples of a line whose places along its longer direction are in [begin, end).
/// A sample is drawn where the line leaves the diamond |x| + |y| < 1/2 around its centre; a wide line is as
/// many of these side by side.
template <class R, class F>
void draw_line(const ScreenLine<R>& line, const SampleBox& box, F&& f) {
    const std::int64_t dx = std::int64_t{line.x1} - line.x0, dy = std::int64_t{line.y1} - line.y0;
    const bool across = std::abs(dx) >= std::abs(dy);
    const std::int64_t length = std::abs(across ? dx : dy);
    if (length == 0) {
        return;
    }
    const std::int64_t sign = (across ? dx : dy) < 0 ? -1 : 1;
    // Along: u grows from the line's start to its end. Across: v.
    const std::int64_t u0 = sign * (across ? line.x0 : line.y0), u1 = u0 + length;
    const std::int64_t v0 = across ? line.y0 : line.x0, v1 = across ? line.y1 : line.x1;
    const auto v_row = [&](std::int64_t column) {
        return detail::floor_divide(v0 * length + (v1 - v0) * (column * grid - u0) + grid / 2 * length,
                                    grid * length);
    };
    const auto in_diamond = [](std::int64_t u, std::int64_t v, std::int64_t column, std::int64_t row) {
        return std::abs(u - column * grid) + std::abs(v - row * grid) < grid / 2;
    };
    std::int64_t first = -detail::floor_divide(-u0, grid), end = -detail::floor_divide(-u1, grid);
    if (in_diamond(u0, v0, first - 1, detail::floor_divide(v0 + grid / 2, grid))) {
        --first;
    }
    if (first < end && in_diamond(u1, v1, end - 1, v_row(end - 1))) {
        --end;
    }
    // Of the box, so that long lines cost each tile its own part.
    const std::int64_t low = across ? box.x0 : box.y0, high = (across ? box.x1 : box.y1) - 1;
    const std::int64_t begin_u = std::max(first, sign > 0 ? low : -high),
                       end_u = std::min(end, (sign > 0 ? high : -low) + 1);
    for (std::int64_t u = begin_u; u < end_u; ++u) {
        const R part = static_cast<R>(u * grid - u0) / static_cast<R>(length);
        const R z = line.z0 + (line.z1 - line.z0) * part;
        const auto column = static_cast<std::int32_t>(sign * u);
        // An even number of samples lies half a sample off.
        const std::int64_t middle =
            line.width % 2 == 1
                ? v_row(u) - line.width / 2
                : detail::floor_divide(v0 * length + (v1 - v0) * (u * grid - u0), grid * length) -
                      line.width / 2 + 1;
        for (std::int32_t k = 0; k < line.width; ++k) {
            const auto row = static_cast<std::int32_t>(middle) + k;
            across ? f(column, row, z) : f(row, column, z);
        }
    }
}

} // namespace scc::runtime::raster
