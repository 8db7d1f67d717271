#pragma once

#include "runtime/math/vec.h"

namespace scc::runtime {

/// L8, w = 1. Intensity at distance d is color / (kc + kl d + kq d^2); kc, kl, kq >= 0, not all zero.
template <class R>
struct PointLight {
    Vec3<R> position{0, 0, 0};
    Rgb<R> diffuse{1, 1, 1};  ///< Id
    Rgb<R> specular{1, 1, 1}; ///< Is
    R kc = 1, kl = 0, kq = 0;
};

/// L8, w = 0.
template <class R>
struct DirectionalLight {
    Vec3<R> to_light{0, 1, 0}; ///< unit vector towards the source
    Rgb<R> diffuse{1, 1, 1};
    Rgb<R> specular{1, 1, 1};
};

} // namespace scc::runtime
