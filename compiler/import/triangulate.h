#pragma once

#include "runtime/math/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scc::compiler {

/// A polygon as triangles of its own corners (by index), which run round as the polygon does.
struct Triangulation {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool crosses_itself = false; ///< then the triangles cover it only roughly
};

/// Cuts ears off. The outline is simple, in a plane or nearly so, convex or not, of either orientation;
/// corners may lie on a line, and those that add no area are left out. n corners, r of them reflex, take
/// n r steps. An outline without area has no triangles.
Triangulation triangulate(std::span<const runtime::Vec3<double>> corners);

} // namespace scc::compiler
