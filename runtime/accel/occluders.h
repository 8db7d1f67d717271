#pragma once

#include "runtime/accel/view.h"
#include "runtime/light.h"

#include <algorithm>
#include <cstddef>
#include <vector>

/// Which shapes may stand between a light and the points that it lights, for scenes that have too few shapes
/// for a hierarchy: a few operations for each, where the shapes' own tests take several times as many.
namespace scc::runtime {

namespace detail {

template <class S, class Shape>
Ball<typename S::Real> ball_of(const S& scene, const Bare<Shape>& primitive) {
    if constexpr (requires { primitive.shape.ball(); }) {
        return primitive.shape.ball();
    } else {
        return ball_around(bounds_of(scene, primitive));
    }
}
template <class S, class Shape, class R>
Ball<R> ball_of(const S& scene, const Placed<Shape, R>& primitive) {
    return ball_around(bounds_of(scene, primitive));
}

/// Rays are told apart only where they start less than `reach` away; so far the balls, larger by `pad`, hold
/// whatever rounding makes of rays and tests.
template <class R>
struct OccluderReach {
    R reach, pad;
    explicit OccluderReach(R size) : reach(256 * size), pad(16 * roundoff<R>() * reach) {}
};

} // namespace detail

/// Around a scene's bounded primitives, in the order of Candidates.
template <class S>
std::vector<Ball<typename S::Real>> primitive_balls(const S& scene) {
    std::vector<Ball<typename S::Real>> balls;
    for_each_bounded(scene, [&]<std::uint32_t>(const auto& primitive, std::uint32_t) {
        balls.push_back(detail::ball_of(scene, primitive));
    });
    return balls;
}

template <class Light>
class Occluders;

template <class R>
class Occluders<PointLight<R>> {
public:
    Occluders(const std::vector<Ball<R>>& balls, const PointLight<R>& light) {
        R size = largest_component(absolute(light.position));
        for (const Ball<R>& ball : balls) {
            size = std::max(size, length(ball.center - light.position) + ball.radius);
        }
        const detail::OccluderReach<R> grown(size);
        squared_reach_ = grown.reach * grown.reach;
        for (const Ball<R>& ball : balls) {
            const Vec3<R> center = ball.center - light.position;
            const R radius = ball.radius + grown.pad;
            const R limit = dot(center, center) * (1 - 64 * roundoff<R>()) - radius * radius;
            balls_.push_back({center, limit > 0 ? limit : -infinity<R>()});
        }
    }

    /// Of rays that end at the light. Seen from there, with d from the light to a ray's start, the ray's line
    /// is at most r away from a centre c that is not behind where d.c >= 0 and (d.c)^2 >= d.d (c.c - r^2).
    template <class L>
    Candidates before(const Ray<L>& ray, const MaskOf<L>& among) const {
        const L squared_length = dot(ray.dir, ray.dir);
        if (any(among & (squared_length > L(squared_reach_)))) {
            return all_candidates;
        }
        Candidates result = 0;
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const L along = -dot(lanes<L>(balls_[i].center), ray.dir);
            if (any(among & (along * absolute(along) >= squared_length * L(balls_[i].limit)))) {
                result |= candidate(i);
            }
        }
        return result;
    }

private:
    struct Seen {
        Vec3<R> center;
        R limit; ///< c.c - r^2, or minus infinity where the light is that near
    };
    std::vector<Seen> balls_;
    R squared_reach_;
};

template <class R>
class Occluders<DirectionalLight<R>> {
public:
    Occluders(const std::vector<Ball<R>>& balls, const DirectionalLight<R>& light) {
        const Vec3<R> z = light.to_light;
        x_ = normalize(cross(z, std::abs(z.x) < R(0.5) ? Vec3<R>{1, 0, 0} : Vec3<R>{0, 1, 0}));
        y_ = cross(z, x_);
        R size = 0;
        for (const Ball<R>& ball : balls) {
            size = std::max(size, length(ball.center) + ball.radius);
        }
        const detail::OccluderReach<R> grown(size);
        reach_ = grown.reach;
        for (const Ball<R>& ball : balls) {
            const R radius = ball.radius + grown.pad;
            balls_.push_back({dot(x_, ball.center), dot(y_, ball.center), radius * radius});
        }
    }

    /// Of rays towards the light, whose lines keep their places across its direction.
    template <class L>
    Candidates before(const Ray<L>& ray, const MaskOf<L>& among) const {
        if (any(among & (largest_component(absolute(ray.org)) > L(reach_)))) {
            return all_candidates;
        }
        const L x = dot(lanes<L>(x_), ray.org), y = dot(lanes<L>(y_), ray.org);
        Candidates result = 0;
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const L dx = x - L(balls_[i].x), dy = y - L(balls_[i].y);
            if (any(among & (dx * dx + dy * dy <= L(balls_[i].squared_radius)))) {
                result |= candidate(i);
            }
        }
        return result;
    }

private:
    struct Seen {
        R x, y, squared_radius;
    };
    std::vector<Seen> balls_;
    Vec3<R> x_, y_; ///< with the direction to the light an orthonormal frame
    R reach_;
};

} // namespace scc::runtime
