#pragma once

#include "runtime/raster/view.h"

#include <array>
#include <cstddef>
#include <cstdint>

/// Clipping before the division (L5).
namespace scc::runtime::raster {

/// Bits of an outcode: beyond which planes a point is.
enum : std::uint32_t {
    outside_left = 1,
    outside_right = 2,
    outside_bottom = 4,
    outside_top = 8,
    outside_near = 16,
    outside_far = 32
};

/// A box of the picture's samples, and the depths that are seen, as homogeneous half spaces.
template <class R>
class ClipVolume {
public:
    static constexpr int planes = 6;

    /// The samples from (left, top) to (right, bottom).
    ClipVolume(const RasterView<R>& view, R left, R top, R right, R bottom)
        : left_(left), top_(top), right_(right), bottom_(bottom), clips_depth_(view.clips_depth()),
          least_w_(view.least_w()) {}

    /// What polygons are cut at: depths, and coordinates that are too large to calculate with.
    static ClipVolume guard(const RasterView<R>& view) {
        const R x = view.guard_x(), y = view.guard_y(), g = view.guard();
        return {view, x - g, y - g, x + g, y + g};
    }

    /// Distance from a plane, by its number, that is negative outside; scaled.
    template <class L>
    L inside(int plane, const ClipPoint<L>& p) const {
        switch (plane) {
        case 0:
            return p.x - p.w * L(left_);
        case 1:
            return p.w * L(right_) - p.x;
        case 2:
            return p.w * L(bottom_) - p.y;
        case 3:
            return p.y - p.w * L(top_);
        case 4:
            return clips_depth_ ? p.z + p.w : p.w - L(least_w_);
        default:
            return clips_depth_ ? p.w - p.z : L(0);
        }
    }
    /// Of a scalar.
    std::uint32_t outcode(const ClipPoint<R>& p) const {
        std::uint32_t code = 0;
        for (int plane = 0; plane < planes; ++plane) {
            code |= (inside(plane, p) < 0 ? 1U : 0U) << plane;
        }
        return code;
    }

private:
    R left_, top_, right_, bottom_;
    bool clips_depth_;
    R least_w_;
};

template <class R>
ClipPoint<R> between(const ClipPoint<R>& a, const ClipPoint<R>& b, R part) {
    return {a.x + (b.x - a.x) * part, a.y + (b.y - a.y) * part, a.z + (b.z - a.z) * part,
            a.w + (b.w - a.w) * part};
}

/// A convex polygon of a triangle's part.
template <class R>
struct ClippedPolygon {
    std::array<ClipPoint<R>, 3 + ClipVolume<R>::planes> corners;
    std::size_t count = 0;
};

/// By Sutherland and Hodgman ("Reentrant polygon clipping", 1974), against the planes in `codes` alone. A
/// crossing is calculated from the corner inside, so that neighbours that share the edge get the same one.
template <class R>
ClippedPolygon<R> clip_triangle(const ClipVolume<R>& volume, const std::array<ClipPoint<R>, 3>& triangle,
                                std::uint32_t codes) {
    ClippedPolygon<R> polygon;
    polygon.count = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        polygon.corners[i] = triangle[i];
    }
    for (int plane = 0; plane < ClipVolume<R>::planes && polygon.count != 0; ++plane) {
        if ((codes >> plane & 1U) == 0) {
            continue;
        }
        ClippedPolygon<R> cut;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const ClipPoint<R>&a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
            const R inside_a = volume.inside(plane, a), inside_b = volume.inside(plane, b);
            if (inside_a >= 0) {
                cut.corners[cut.count++] = a;
            }
            if ((inside_a >= 0) != (inside_b >= 0) && cut.count < cut.corners.size()) {
                cut.corners[cut.count++] = inside_a >= 0 ? between(a, b, inside_a / (inside_a - inside_b))
                                                         : between(b, a, inside_b / (inside_b - inside_a));
            }
        }
        polygon = cut;
    }
    return polygon;
}

/// The part of a line inside; false if there is none. By outcodes: trivial accept and reject, else a cut at
/// each plane that an end is beyond (Cohen and Sutherland).
template <class R>
bool clip_line(const ClipVolume<R>& volume, ClipPoint<R>& from, ClipPoint<R>& to) {
    const std::uint32_t code_from = volume.outcode(from), code_to = volume.outcode(to);
    if ((code_from & code_to) != 0) {
        return false;
    }
    R first = 0, last = 1;
    for (int plane = 0; plane < ClipVolume<R>::planes; ++plane) {
        if (((code_from | code_to) >> plane & 1U) == 0) {
            continue;
        }
        const R a = volume.inside(plane, from), b = volume.inside(plane, to);
        if (a < 0) {
            first = std::max(first, a / (a - b));
        } else {
            last = std::min(last, a / (a - b));
        }
    }
    if (!(first < last)) {
        return false;
    }
    const ClipPoint<R> a = from, b = to;
    if (first > 0) {
        from = between(a, b, first);
    }
    if (last < 1) {
        to = between(a, b, last);
    }
    return true;
}

} // namespace scc::runtime::raster
