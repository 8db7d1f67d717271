#pragma once

#include "runtime/math/vec.h"

namespace scc::runtime {

/// x' = m[row][0..2] . x + m[row][3] (column vectors).
template <class R>
struct Affine {
    R m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    friend constexpr bool operator==(const Affine&, const Affine&) = default;
};

} // namespace scc::runtime
