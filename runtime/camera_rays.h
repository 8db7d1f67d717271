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
        : scene_(scene), width_(settings.width), height_(settings.height) {
        if (settings.point == PixelPoint::corner) {
            shift_x_ = R(-0.5);
            shift_y_ = R(0.5);
        }
    }

    /// Where a sample lies in the window: its pixel, and where in the pixel. What is no whole pixel is added
    /// last, so that rounding does not depend on where a tile begins.
    template <class L>
    L window_x(const L& pixel, const L& within) const {
        return runtime::window_x(scene_.camera, projection(), pixel + (within + L(shift_x_)), width_, height_);
    }
    template <class L>
    L window_y(const L& pixel, const L& within) const {
        return runtime::window_y(scene_.camera, pixel + (within + L(shift_y_)), height_);
    }

    /// Through a point of the window. `sample(lane)` gives what has a point of the lens: a pixel with the
    /// number of a sample in it.
    template <class L, class Sample>
    Ray<L> ray(const L& x, const L& y, Sample&& sample) const {
        const Ray<L> middle = camera_ray(scene_.camera, projection(), x, y);
        if constexpr (S::traits.lens) {
            if (has_lens()) {
                L a, b;
                for (int lane = 0; lane < lane_count<L>; ++lane) {
                    const auto [pixel, number] = sample(lane);
                    const SquarePoint point = SobolPoints(pixel, PointUse::lens)[number];
                    set_lane(a, lane, part_of_unit<R>(point.x));
                    set_lane(b, lane, part_of_unit<R>(point.y));
                }
                const Vec2<L> on_lens = in_disc(a, b);
                return lens_ray(scene_.camera, middle, on_lens.x, on_lens.y);
            }
        }
        return middle;
    }

    Apex apex() const {
        return projection() == Projection::orthographic || has_lens() ? Apex::none : Apex::origin;
    }
    /// Whether the rays of a rectangle of the picture lie between those through its corners.
    bool is_straight() const { return projection() != Projection::spherical && !has_lens(); }

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
    bool has_lens() const {
        if constexpr (S::traits.lens) {
            return scene_.camera.lens_radius > 0;
        } else {
            return false;
        }
    }

    const S& scene_;
    int width_, height_;
    R shift_x_ = 0, shift_y_ = 0; ///< of what a pixel shows
};

/// A sample of the picture.
struct Sample {
    Pixel pixel;
    int number = 0; ///< in the pixel, from 0 on
};

} // namespace scc::runtime
