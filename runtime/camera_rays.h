#pragma once

#include "runtime/accel/beam.h"
#include "runtime/camera.h"
#include "runtime/render_request.h"
#include "runtime/sampling.h"
#include "runtime/scene.h"

namespace scc::runtime {

/// The rays of a picture's samples (L11).
template <SceneModel S>
class CameraRays {
public:
    using R = typename S::Real;

    CameraRays(const S& scene, const RenderSettings& settings)
        : scene_(scene), width_(settings.width), height_(settings.height),
          is_straight_(projection() != Projection::spherical && !has_lens()) {
        if (settings.point == PixelPoint::corner) {
            shift_x_ = R(-0.5);
            shift_y_ = R(0.5);
        }
    }

    /// Where a sample lies in the window: its pixel, and where in the pixel. What is no whole pixel is added
    /// last, so that rounding does not depend on where a tile begins.
    template <class L>
    L window_x(const L& pixel, const L& within) const {
        return runtime::window_x(scene_.camera, projection(), pixel + (within + L(shift_x_)), width_,
                                 height_);
    }
    template <class L>
    L window_y(const L& pixel, const L& within) const {
        return runtime::window_y(scene_.camera, pixel + (within + L(shift_y_)), height_);
    }

    /// Through a point of the window, before it is bent.
    template <class L>
    Ray<L> straight_ray(const L& x, const L& y) const {
        return camera_ray(scene_.camera,
                          projection() == Projection::perspective ? Projection::perspective
                                                                  : Projection::orthographic,
                          x, y);
    }
    /// Bends one through that point where rays are not straight. `sample(lane)` gives what has a point of the
    /// lens: a pixel with the number of a sample in it. Apart, so that straight ones are not slowed down.
    template <class L, class Sample>
    void bend(const L& x, const L& y, Sample&& sample, Ray<L>& ray) const {
        if (projection() == Projection::spherical) {
            ray = camera_ray(scene_.camera, Projection::spherical, x, y);
        } else if (has_lens()) {
            L a, b;
            for (int lane = 0; lane < lane_count<L>; ++lane) {
                const auto [pixel, number] = sample(lane);
                const SquarePoint point = SobolPoints(pixel, PointUse::lens)[number];
                set_lane(a, lane, part_of_unit<R>(point.x));
                set_lane(b, lane, part_of_unit<R>(point.y));
            }
            const Vec2<L> on_lens = in_disc(a, b);
            ray = lens_ray(scene_.camera, ray, on_lens.x, on_lens.y);
        }
    }

    /// Through that point and the middle of the lens.
    template <class L>
    Ray<L> middle_ray(const L& x, const L& y) const {
        return camera_ray(scene_.camera, projection(), x, y);
    }

    Apex apex() const {
        return projection() == Projection::orthographic || has_lens() ? Apex::none : Apex::origin;
    }
    /// Whether the rays of a rectangle of the picture lie between those through its corners: so they do
    /// without a lens and in a flat window.
    bool is_straight() const {
        if constexpr (S::traits.lens || S::traits.spherical) {
            return is_straight_;
        } else {
            return true;
        }
    }

    /// That of the scene; a constant where it has but one.
    Projection projection() const {
        constexpr SceneTraits traits = S::traits;
        if constexpr (traits.perspective + traits.orthographic + traits.spherical == 1) {
            return traits.perspective    ? Projection::perspective
                   : traits.orthographic ? Projection::orthographic
                                         : Projection::spherical;
        } else {
            return scene_.camera.projection;
        }
    }

private:
    bool has_lens() const { return S::traits.lens && scene_.camera.lens_radius > 0; }

    const S& scene_;
    int width_, height_;
    bool is_straight_;
    R shift_x_ = 0, shift_y_ = 0; ///< of what a pixel shows
};

/// A sample of the picture.
struct Sample {
    Pixel pixel;
    int number = 0; ///< in the pixel, from 0 on
};

} // namespace scc::runtime
