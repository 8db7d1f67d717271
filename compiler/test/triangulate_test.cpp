#include "compiler/import/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace scc::compiler {
namespace {

using Vec3 = runtime::Vec3<double>;
using Outline = std::vector<Vec3>;

Vec3 twice_area(const Outline& corners) {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    }
    return sum;
}

/// The triangles run as the outline does, and add up to its area: so they neither overlap nor leave it.
void expect_covered(const Outline& corners, std::size_t triangles) {
    const Triangulation cut = triangulate(corners);
    EXPECT_FALSE(cut.crosses_itself);
    EXPECT_EQ(cut.triangles.size(), triangles);
    const Vec3 whole = twice_area(corners), normal = normalize(whole);
    double sum = 0;
    for (const auto& [a, b, c] : cut.triangles) {
        const double part = dot(twice_area({corners[a], corners[b], corners[c]}), normal);
        EXPECT_GT(part, 0);
        sum += part;
    }
    EXPECT_NEAR(sum, length(whole), 1e-12 * length(whole));
}

/// As it is, reversed, from every first corner, and turned in space.
void expect_covered_however_written(const std::vector<std::pair<double, double>>& flat,
                                    std::size_t triangles) {
    const Vec3 frames[][2] = {{{1, 0, 0}, {0, 1, 0}},
                              {{0, 1, 0}, {0, 0, 1}},
                              {{0, 0, 1}, {1, 0, 0}},
                              {{0.6, 0.48, 0.64}, {-0.8, 0.36, 0.48}}};
    for (const auto& [u, v] : frames) {
        Outline corners;
        for (const auto& [x, y] : flat) {
            corners.push_back(Vec3{7, -3, 2} + u * x + v * y);
        }
        for (std::size_t first = 0; first < corners.size(); ++first) {
            SCOPED_TRACE(first);
            expect_covered(corners, triangles);
            expect_covered({corners.rbegin(), corners.rend()}, triangles);
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        }
    }
}

TEST(Triangulate, CutsAQuadrangleInTwo) {
    const Triangulation cut = triangulate(Outline{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    ASSERT_EQ(cut.triangles.size(), 2U);
    EXPECT_EQ(cut.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(cut.triangles[1], (std::array<std::uint32_t, 3>{3, 0, 2}));
}

TEST(Triangulate, CoversConvexAndConcaveOutlines) {
    expect_covered_however_written({{0, 0}, {4, 0}, {5, 3}, {2, 5}, {-1, 3}}, 3);
    expect_covered_however_written({{0, 0}, {4, 0}, {1, 1}, {0, 4}}, 2); // arrow head
    expect_covered_however_written({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}}, 6); // U
    expect_covered_however_written(
        {{0, 0}, {6, 0}, {6, 5}, {1, 5}, {1, 2}, {4, 2}, {4, 3}, {2, 3}, {2, 4}, {5, 4}, {5, 1}, {0, 1}},
        10); // spiral
}

TEST(Triangulate, LeavesOutCornersOnALine) {
    const Outline square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 0}};
    const Triangulation cut = triangulate(square);
    EXPECT_FALSE(cut.crosses_itself);
    double sum = 0;
    for (const auto& [a, b, c] : cut.triangles) {
        sum += twice_area({square[a], square[b], square[c]}).z;
    }
    EXPECT_EQ(sum, 8);
    EXPECT_TRUE(triangulate(Outline{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).triangles.empty());
    EXPECT_TRUE(triangulate(Outline(5, Vec3{1, 2, 3})).triangles.empty());
    EXPECT_TRUE(triangulate(Outline{{0, 0, 0}, {1, 0, 0}}).triangles.empty());
}

TEST(Triangulate, CoversAnOutlineThatIsJoinedToItsHole) {
    // A square whose hole is reached by a cut along which the outline runs both ways.
    const Outline ring{{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}, {0, 0, 0},
                       {2, 2, 0}, {2, 4, 0}, {4, 4, 0}, {4, 2, 0}, {2, 2, 0}};
    expect_covered(ring, 8);
}

TEST(Triangulate, CoversRandomStars) {
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> radius(0.1, 1), jitter(0.1, 0.9);
    for (const int n : {4, 7, 20, 101, 1000}) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            Outline star;
            for (int i = 0; i < n; ++i) {
                const double angle = 2 * std::numbers::pi * (i + jitter(engine)) / n, r = radius(engine);
                star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
            }
            // With three or four corners the middle may lie outside; the star runs round it all the same.
            expect_covered(star, static_cast<std::size_t>(n) - 2);
        }
    }
}

TEST(Triangulate, SaysThatAnOutlineCrossesItselfAndEnds) {
    EXPECT_FALSE(triangulate(Outline{{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}}).triangles.empty());
    std::mt19937 engine(12);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    int crossing = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        Outline tangle;
        for (int i = 0; i < 4 + repeat % 60; ++i) {
            tangle.push_back({anywhere(engine), anywhere(engine), anywhere(engine) * 0.1});
        }
        const Triangulation cut = triangulate(tangle);
        EXPECT_LE(cut.triangles.size(), tangle.size() - 2);
        crossing += cut.crosses_itself;
    }
    EXPECT_GT(crossing, 100);
    Outline rounded;
    for (int i = 0; i < 50; ++i) { // on a grid: many corners coincide or lie on lines
        rounded.push_back({double(engine() % 4), double(engine() % 4), 0});
        EXPECT_LE(triangulate(rounded).triangles.size(), rounded.size());
    }
}

} // namespace
} // namespace scc::compiler
