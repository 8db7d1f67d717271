#pragma once

#include "runtime/ray.h"

#include <cstdint>

namespace scc::runtime {

inline constexpr std::uint32_t no_kind = ~0U;

/// What a ray meets in a scene.
template <class L>
struct Hit {
    ShapeHit<L> shape;
    IndexOf<L> kind{no_kind}; ///< of the primitive; that of a solid's member is member_kinds more
    IndexOf<L> index{0U};     ///< in the table of its kind
    IndexOf<L> id{~0U};       ///< Tag::id
};

template <class L>
Hit<RealOf<L>> lane(const Hit<L>& hit, int i) {
    return {{lane(hit.shape.t, i), lane(hit.shape.part, i)},
            lane(hit.kind, i),
            lane(hit.index, i),
            lane(hit.id, i)};
}
template <class L>
void set_lane(Hit<L>& hit, int i, const Hit<RealOf<L>>& value) {
    set_lane(hit.shape.t, i, value.shape.t);
    set_lane(hit.shape.part, i, value.shape.part);
    set_lane(hit.kind, i, value.kind);
    set_lane(hit.index, i, value.index);
    set_lane(hit.id, i, value.id);
}

} // namespace scc::runtime
