#pragma once

#include "lang/value.h"

#include <array>
#include <optional>

/// Affine maps in double, composed at compile time.
namespace scc::lang {

using Point = std::array<double, 3>;

TransformValue translation(const Point& by);
TransformValue scaling(const Point& by);
/// Right-handed about a unit axis through the origin.
TransformValue rotation(const Point& axis, double radians);
/// The lecture's view transformation (L2, gluLookAt): the eye comes to the origin, the target onto the
/// negative z axis. None if the eye is the target or the way to it is along `up`.
std::optional<TransformValue> look_at(const Point& eye, const Point& target, const Point& up);
/// What does `first`, then `second`.
TransformValue then(const TransformValue& first, const TransformValue& second);
/// None if the linear part is singular within rounding.
std::optional<TransformValue> inverse(const TransformValue& transform);
/// Largest over smallest stretch of the linear part, within a factor of 3; infinite if it is singular.
double condition(const TransformValue& transform);

} // namespace scc::lang
