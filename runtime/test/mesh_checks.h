#pragma once

#include "runtime/tessellate/triangles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

/// What must be true of triangle meshes, seen from their corners alone.
namespace scc::runtime::test {

struct EdgeCounts {
    std::size_t open = 0;  ///< edges of one triangle
    std::size_t wrong = 0; ///< edges of more than two, or of two that do not run along them in opposite ways
};

template <class R>
EdgeCounts edges_of(const Triangles<R>& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;
    for (const Triangle3& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t.positions[i], b = t.positions[(i + 1) % 3];
            auto& [up, down] = uses[std::minmax(a, b)];
            (a < b ? up : down) += 1;
        }
    }
    EdgeCounts counts;
    for (const auto& [edge, ways] : uses) {
        const auto [up, down] = ways;
        if (edge.first == edge.second || up > 1 || down > 1) {
            ++counts.wrong;
        } else if (up + down == 1) {
            ++counts.open;
        }
    }
    return counts;
}

/// Points whose triangles do not make one ring around them: two sheets that touch in a point.
template <class R>
std::size_t pinched_points(const Triangles<R>& mesh) {
    std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.positions.size());
    for (const Triangle3& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            next[t.positions[i]][t.positions[(i + 1) % 3]] = t.positions[(i + 2) % 3];
        }
    }
    std::size_t pinched = 0;
    for (const auto& ring : next) {
        if (ring.empty()) {
            continue;
        }
        std::size_t length = 0;
        auto at = ring.begin();
        do {
            at = ring.find(at->second);
            ++length;
        } while (at != ring.end() && at != ring.begin() && length <= ring.size());
        pinched += length != ring.size() ? 1 : 0;
    }
    return pinched;
}

/// Six times, positive where the triangles face outwards.
template <class R>
R signed_volume(const Triangles<R>& mesh) {
    R sum = 0;
    for (const Triangle3& t : mesh.triangles) {
        const Vec3<R>&a = mesh.positions[t.positions[0]], &b = mesh.positions[t.positions[1]],
              &c = mesh.positions[t.positions[2]];
        sum += dot(a, cross(b, c));
    }
    return sum / 6;
}

/// f(point, triangle) for corners, middles of edges and points within.
template <class R, class F>
void for_samples(const Triangles<R>& mesh, F&& f) {
    constexpr R weights[][2] = {{0, 0},
                                {1, 0},
                                {0, 1},
                                {R(0.5), R(0.5)},
                                {0, R(0.5)},
                                {R(0.5), 0},
                                {R(1) / 3, R(1) / 3},
                                {R(0.6), R(0.2)},
                                {R(0.2), R(0.6)},
                                {R(0.2), R(0.2)}};
    for (const Triangle3& t : mesh.triangles) {
        const Vec3<R>&a = mesh.positions[t.positions[0]], &b = mesh.positions[t.positions[1]],
              &c = mesh.positions[t.positions[2]];
        for (const auto& w : weights) {
            f(a + (b - a) * w[0] + (c - a) * w[1], t);
        }
    }
}

/// From the nearest triangle.
template <class R>
R distance_to(const Triangles<R>& mesh, const Vec3<R>& p) {
    const auto to_segment = [&](const Vec3<R>& a, const Vec3<R>& b) {
        const Vec3<R> along = b - a;
        const R squared = dot(along, along);
        const R t = squared > 0 ? std::clamp(dot(p - a, along) / squared, R(0), R(1)) : R(0);
        return length(p - a - along * t);
    };
    R least = infinity<R>();
    for (const Triangle3& t : mesh.triangles) {
        const Vec3<R>&a = mesh.positions[t.positions[0]], &b = mesh.positions[t.positions[1]],
              &c = mesh.positions[t.positions[2]];
        const R reach = length(b - a) + length(c - a);
        if (length(p - a) - reach > least) {
            continue;
        }
        const Vec3<R> n = cross(b - a, c - a);
        const auto left = [&](const Vec3<R>& from, const Vec3<R>& to) {
            return dot(cross(to - from, p - from), n) >= 0;
        };
        const bool above = dot(n, n) > 0 && left(a, b) && left(b, c) && left(c, a);
        least = std::min(least, above ? std::abs(dot(p - a, n)) / length(n)
                                      : std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)}));
    }
    return least;
}

} // namespace scc::runtime::test
