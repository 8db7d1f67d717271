#pragma once

#include "runtime/camera.h"
#include "runtime/render_request.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

/// From the world to the picture's samples (L2, L3, L4, L6), in homogeneous coordinates.
namespace scc::runtime::raster {

/// A place before the division by w. x / w and y / w are in samples from the picture's top left corner, down
/// and to the right; z / w is z* of L4; w is the distance along the view axis, or 1 without perspective.
template <class L>
struct ClipPoint {
    L x, y, z, w;
};

/// A point or, with weight 0, a direction, seen from the camera.
template <class L>
struct EyePoint {
    L right, up, ahead; ///< along u, v and -n
    L weight;           ///< 1 or 0
};

/// The largest coordinates that are looked at; their products are finite.
template <class R>
inline constexpr R most_coordinate = static_cast<R>(sizeof(R) == 4 ? 1e15 : 1e60);

template <class R>
class RasterView {
public:
    RasterView(const Camera<R>& camera, const RenderSettings& settings)
        : camera_(camera), orthographic_(camera.projection == Projection::orthographic),
          clips_(settings.raster.clip), samples_across_(samples_per_axis(settings)) {
        const R n = static_cast<R>(samples_across_);
        const R width = static_cast<R>(settings.width), height = static_cast<R>(settings.height);
        const R corner = settings.point == PixelPoint::corner ? R(0.5) : R(0);
        scale_ = n * (height / 2) / camera.half_height;
        middle_x_ = n * (width / 2 - height * camera.shift_x + corner);
        middle_y_ = n * (height / 2 + height * camera.shift_y - corner);
        const R depth = camera.far - camera.near;
        if (orthographic_) {
            z_ahead_ = 2 / depth;
            z_weight_ = -(camera.far + camera.near) / depth;
        } else {
            z_ahead_ = (camera.far + camera.near) / depth;
            z_weight_ = -2 * camera.far * camera.near / depth;
        }
        const R reach = n * std::max(width, height);
        guard_ = static_cast<R>(std::bit_ceil(static_cast<unsigned>(std::max(reach, R(least_guard)))));
        guard_x_ = std::round(n * width / 2);
        guard_y_ = std::round(n * height / 2);
    }

    const Camera<R>& camera() const { return camera_; }
    bool is_orthographic() const { return orthographic_; }
    int samples_across() const { return samples_across_; } ///< a pixel
    /// Whether the near and the far plane cut.
    bool clips_depth() const { return clips_; }
    /// Where only what is behind the eye is cut off: so far in front of it, in near distances.
    static constexpr R least_ahead = R(1e-4);
    R least_w() const { return orthographic_ ? R(0) : camera_.near * least_ahead; }

    /// Polygons are cut at so many samples from the picture's middle. Powers of two, so that cutting at them
    /// rounds little, and far off, so that it is rare.
    R guard() const { return guard_; }
    R guard_x() const { return guard_x_; } ///< the middle
    R guard_y() const { return guard_y_; }

    /// `weight` 0: `p` is a direction.
    template <class L>
    EyePoint<L> to_eye(const Vec3<L>& p, const L& weight) const {
        const Vec3<L> from_eye = p - lanes<L>(camera_.eye) * weight;
        return {dot(from_eye, lanes<L>(camera_.u)), dot(from_eye, lanes<L>(camera_.v)),
                -dot(from_eye, lanes<L>(camera_.n)), weight};
    }
    /// By samples from (left, top).
    template <class L>
    ClipPoint<L> to_clip(const EyePoint<L>& p, const L& left, const L& top) const {
        const L w = orthographic_ ? p.weight : p.ahead;
        return {p.right * L(scale_) + w * (L(middle_x_) - left), w * (L(middle_y_) - top) - p.up * L(scale_),
                p.ahead * L(z_ahead_) + p.weight * L(z_weight_), w};
    }
    template <class L>
    ClipPoint<L> to_clip(const EyePoint<L>& p) const {
        return to_clip(p, L(0), L(0));
    }

    /// The ray through a place given in samples; of the perspective camera as long as its part ahead is 1.
    template <class L>
    Ray<L> ray_through(const L& x, const L& y) const {
        const L right = (x - L(middle_x_)) / L(scale_), up = (L(middle_y_) - y) / L(scale_);
        const Vec3<L> offset = lanes<L>(camera_.u) * right + lanes<L>(camera_.v) * up;
        if (orthographic_) {
            return {lanes<L>(camera_.eye) + offset, -lanes<L>(camera_.n)};
        }
        return {lanes<L>(camera_.eye), offset - lanes<L>(camera_.n)};
    }
    /// The way to a point in the world, of any length.
    template <class L>
    Vec3<L> direction_to(const Vec3<L>& point) const {
        return orthographic_ ? -lanes<L>(camera_.n) : point - lanes<L>(camera_.eye);
    }

private:
    static constexpr int least_guard = 1 << 13;

    Camera<R> camera_;
    bool orthographic_;
    bool clips_;
    int samples_across_;
    R scale_, middle_x_, middle_y_;
    R z_ahead_, z_weight_;
    R guard_, guard_x_, guard_y_;
};

} // namespace scc::runtime::raster
