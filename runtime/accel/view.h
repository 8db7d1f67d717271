#pragma once

#include "runtime/camera.h"
#include "runtime/primitive.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Which shapes a part of the picture can show at all, for scenes that have too few for a hierarchy.
namespace scc::runtime {

/// A bit per bounded primitive, in the order of for_each_bounded, the lowest first; those beyond the 32nd
/// share its bit.
using Candidates = std::int32_t;
inline constexpr Candidates all_candidates = -1;

inline Candidates candidate(std::size_t i) {
    return static_cast<Candidates>(1U << std::min<std::size_t>(i, 31));
}
/// Takes the next primitive's bit.
inline bool next_is_candidate(Candidates& left) {
    const bool result = (left & 1) != 0;
    left >>= 1;
    return result;
}

/// The boxes of a scene's bounded primitives, in the order of Candidates.
template <class S>
std::vector<Bounds<typename S::Real>> primitive_boxes(const S& scene) {
    std::vector<Bounds<typename S::Real>> boxes;
    for_each_bounded(scene, [&]<std::uint32_t>(const auto& primitive, std::uint32_t) {
        boxes.push_back(bounds_of(scene, primitive));
    });
    return boxes;
}

/// The rays between four, given around: those through the corners of a rectangle of the picture.
template <class R>
class ViewPart {
public:
    explicit ViewPart(const std::array<Ray<R>, 4>& corners) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Ray<R>&one = corners[i], &next = corners[(i + 1) % 4], &opposite = corners[(i + 2) % 4];
            const Vec3<R> normal = cross(one.dir, next.org + next.dir - one.org);
            const bool inwards = dot(normal, opposite.org + opposite.dir - one.org) >= 0;
            sides_[i] = {one.org, inwards ? normal : -normal};
        }
    }

    /// False only for a box that none of the rays comes near. The box grows by more than what the rays and
    /// the primitives' tests lose by rounding (see SlabRay).
    bool may_meet(const Bounds<R>& box) const {
        for (const Side& side : sides_) {
            const Vec3<R> low = box.min - side.point, high = box.max - side.point;
            const R pad = 64 * roundoff<R>() * largest_component(maximum(absolute(low), absolute(high)));
            const Vec3<R>& n = side.normal;
            const Vec3<R> innermost{n.x > 0 ? high.x : low.x, n.y > 0 ? high.y : low.y,
                                    n.z > 0 ? high.z : low.z};
            if (dot(n, innermost) + pad * (absolute(n).x + absolute(n).y + absolute(n).z) < 0) {
                return false;
            }
        }
        return true;
    }

private:
    struct Side {
        Vec3<R> point, normal; ///< a plane; the normal points inwards
    };
    std::array<Side, 4> sides_;
};

/// Those of the boxes (see primitive_boxes) that a part of the picture may show.
template <class R>
Candidates candidates_in(const std::vector<Bounds<R>>& boxes, const ViewPart<R>& part) {
    Candidates result = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (part.may_meet(boxes[i])) {
            result |= candidate(i);
        }
    }
    return result;
}

} // namespace scc::runtime
