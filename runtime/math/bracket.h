#pragma once

#include "runtime/math/lane.h"

#include <limits>

namespace scc::runtime {

/// The zero between low and high, at which f has different signs and between which it has no other, to within
/// `finest`: Newton's steps, or halving where they lead outside. f(t, slope) gives the value and sets the
/// slope. In the other lanes than `active` anything.
template <class L, class F>
L bracketed_root(const F& f, L low, L high, const MaskOf<L>& negative_at_low, MaskOf<L> active,
                 const L& finest) {
    constexpr int most_steps = 2 * std::numeric_limits<RealOf<L>>::digits;
    const L half = L(RealOf<L>(0.5));
    L t = (low + high) * half;
    for (int i = 0; i < most_steps && any(active); ++i) {
        L slope;
        const L value = f(t, slope);
        const MaskOf<L> before = MaskOf<L>((value < 0) == negative_at_low);
        low = choose(active & before, t, low);
        high = choose(active & !before, t, high);
        const L newton = t - value / slope;
        const L next = choose((newton >= low) & (newton <= high), newton, (low + high) * half);
        const L change = absolute(next - t);
        t = choose(active, next, t);
        active = active & (change > finest);
    }
    return t;
}

} // namespace scc::runtime
