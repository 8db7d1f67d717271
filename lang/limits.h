#pragma once

#include "lang/schema.h"

#include <cmath>

namespace scc::lang {

inline bool is_square(double value) {
    const double root = std::round(std::sqrt(value));
    return root * root == value;
}

/// Of one number or component; `nonzero_vector` is about all of them.
inline bool component_within(const Limits& limits, double value) {
    const bool above = limits.min_excluded ? value > limits.min : value >= limits.min;
    return above && value <= limits.max && (!limits.integer || std::floor(value) == value) &&
           (!limits.square || is_square(value));
}

} // namespace scc::lang
