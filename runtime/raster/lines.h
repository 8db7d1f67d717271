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

namespace detail {

/// The depth is that of the line before its ends are put on the grid, and changes along its longer direction.
template <class R>
ScreenLine<R> divided(const ClipPoint<R>& from, const ClipPoint<R>& to) {
    const R x0 = from.x / from.w, y0 = from.y / from.w, z0 = from.z / from.w;
    const R x1 = to.x / to.w, y1 = to.y / to.w, z1 = to.z / to.w;
    ScreenLine<R> line{on_grid(x0), on_grid(y0), on_grid(x1), on_grid(y1), z0, R(0), 0, 0};
    const bool across = runs_across(line);
    const R length = across ? x1 - x0 : y1 - y0;
    if (absolute(length) > R(1) / grid) {
        const R centre = static_cast<R>((across ? line.x0 : line.y0) >> grid_bits) + R(0.5);
        line.z_step = (z1 - z0) / length;
        line.z = z0 + line.z_step * (centre - (across ? x0 : y0));
    }
    return line;
}

} // namespace detail

/// Puts a model's segments into the bin.
template <class R>
void set_up_lines(const RasterModel<R>& model, const RasterView<R>& view, const TileGrid& tiles,
                  Bin<R>& bin) {
    const ClipVolume<R> guard = ClipVolume<R>::guard(view);
    const SampleBox& window = tiles.box();
    const R one = 1;
    std::uint32_t number = 0;
    for (const LineSegment<R>& segment : model.segments) {
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
        ScreenLine<R> line = detail::divided(from, to);
        line.segment = here;
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

/// f(column, row, z) for the samples of a line, of those in the box and a few around it. A sample is drawn
/// where the line leaves the diamond |x| + |y| < 1/2 around its centre; a wide line is as many of these side
/// by side, across its longer direction.
template <class R, class F>
void draw_line(const ScreenLine<R>& line, const SampleBox& box, F&& f) {
    const std::int64_t dx = std::int64_t{line.x1} - line.x0, dy = std::int64_t{line.y1} - line.y0;
    const bool across = runs_across(line);
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
    const std::int64_t z_place = (across ? line.x0 : line.y0) >> grid_bits;
    // Of the box, so that long lines cost each tile its own part.
    const std::int64_t low = across ? box.x0 : box.y0, high = (across ? box.x1 : box.y1) - 1;
    const std::int64_t begin_u = std::max(first, sign > 0 ? low : -high),
                       end_u = std::min(end, (sign > 0 ? high : -low) + 1);
    for (std::int64_t u = begin_u; u < end_u; ++u) {
        const auto column = static_cast<std::int32_t>(sign * u);
        const R z = line.z + line.z_step * static_cast<R>(column - z_place);
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
