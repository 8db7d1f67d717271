#pragma once

#include "runtime/math/affine.h"

#include <cmath>

namespace scc::compiler {

/// The ratio of the largest to the smallest scale of the map, or down to a third of it; 1 of a similarity. By
/// the norms (Frobenius) of its linear part and of the inverse; not finite where there is none.
inline double condition(const runtime::Affine<double>& map) {
    const auto norm = [](const runtime::Affine<double>& a) {
        double sum = 0;
        for (const auto& row : a.m) {
            sum += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
        }
        return std::sqrt(sum / 3);
    };
    return norm(map) * norm(inverse(map));
}

} // namespace scc::compiler
