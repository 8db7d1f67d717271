#include "compiler/import/triangulate.h"

#include <algorithm>
#include <cmath>

namespace scc::compiler {

namespace {

using runtime::Vec3;

struct Point {
    double x = 0, y = 0;
};

/// Twice the area of the triangle, positive where it runs counter-clockwise.
double area(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// Newell's normal: twice the area of the outline's projections.
Vec3<double> normal_of(std::span<const Vec3<double>> corners) {
    Vec3<double> sum;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3<double> p = corners[i] - corners[0];
        const Vec3<double> q = corners[i + 1 == corners.size() ? 0 : i + 1] - corners[0];
        sum = sum + cross(p, q);
    }
    return sum;
}

class Ears {
public:
    explicit Ears(std::span<const Vec3<double>> corners)
        : count_(static_cast<std::uint32_t>(corners.size())) {
        // Seen along the axis that the normal is nearest to, from the side where the outline runs
        // counter-clockwise.
        const Vec3<double> normal = normal_of(corners), size = absolute(normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const double facing = axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z;
        const bool flat = !(std::abs(facing) > 0) || !std::isfinite(facing);
        for (const Vec3<double>& corner : corners) {
            const Vec3<double> p = corner - corners[0];
            const Point seen = axis == 0 ? Point{p.y, p.z} : axis == 1 ? Point{p.z, p.x} : Point{p.x, p.y};
            points_.push_back(facing < 0 ? Point{-seen.x, seen.y} : seen);
        }
        for (std::uint32_t i = 0; i < count_; ++i) {
            next_.push_back(i + 1 == count_ ? 0 : i + 1);
            previous_.push_back(i == 0 ? count_ - 1 : i - 1);
        }
        is_cut_.resize(count_);
        count_ = flat ? 0 : count_;
    }

    Triangulation cut() {
        find_reflex();
        // Every second corner first, so that the triangles do not all fan out from one.
        for (const std::uint32_t first : {1U, 0U}) {
            for (std::uint32_t i = first; i < count_; i += 2) {
                waiting_.push_back(i);
            }
        }
        // Whether a corner is an ear changes only when a neighbour is cut off.
        for (std::size_t i = 0; i < waiting_.size() && count_ > 3; ++i) {
            const std::uint32_t corner = waiting_[i];
            if (!is_cut_[corner] && is_ear(corner)) {
                take(corner);
                waiting_.push_back(previous_[corner]);
                waiting_.push_back(next_[corner]);
            }
        }
        cut_the_rest();
        return std::move(result_);
    }

private:
    double turn(std::uint32_t i) const { return area(points_[previous_[i]], points_[i], points_[next_[i]]); }

    void find_reflex() {
        for (std::uint32_t i = 0; i < count_; ++i) {
            is_reflex_.push_back(turn(i) < 0);
            if (is_reflex_.back()) {
                reflex_.push_back(i);
            }
        }
    }

    /// Whether no other corner lies in the triangle at this one. Only reflex corners can; one that coincides
    /// with a corner of the triangle (where an outline touches itself) does not count.
    bool is_ear(std::uint32_t i) const {
        const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
        const double size = area(a, b, c);
        if (size < 0) {
            return false;
        }
        if (size == 0) {
            return !turns_back(a, b, c);
        }
        const auto same = [](const Point& p, const Point& q) { return p.x == q.x && p.y == q.y; };
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t other) {
            const Point& p = points_[other];
            return is_reflex_[other] && other != i && other != previous_[i] && other != next_[i] &&
                   area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0 && !same(p, a) &&
                   !same(p, b) && !same(p, c);
        });
    }

    /// Whether the outline turns round at b: a spike, which is cut off last.
    static bool turns_back(const Point& a, const Point& b, const Point& c) {
        return (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) < 0;
    }

    /// A simple outline has two ears as long as it has more than three corners.
    void cut_the_rest() {
        std::uint32_t corner = 0;
        while (corner < is_cut_.size() && is_cut_[corner]) {
            ++corner;
        }
        result_.crosses_itself = count_ > 3;
        for (std::uint32_t tried = 0; count_ > 3; corner = next_[corner]) {
            if (turn(corner) > 0 || tried == count_) {
                take(corner);
                tried = 0;
            } else {
                ++tried;
            }
        }
        if (count_ == 3) {
            emit(corner);
        }
    }

    void take(std::uint32_t i) {
        emit(i);
        const std::uint32_t before = previous_[i], after = next_[i];
        next_[before] = after;
        previous_[after] = before;
        is_cut_[i] = true;
        is_reflex_[i] = false;
        --count_;
        // Cutting an ear can only make its neighbours less reflex, but a crossing outline knows no rules.
        for (const std::uint32_t neighbour : {before, after}) {
            const bool reflex = turn(neighbour) < 0;
            if (reflex && !is_reflex_[neighbour]) {
                reflex_.push_back(neighbour);
            }
            is_reflex_[neighbour] = reflex;
        }
        if (++taken_ % 64 == 0) {
            reflex_.erase(std::remove_if(reflex_.begin(), reflex_.end(),
                                         [&](std::uint32_t corner) { return !is_reflex_[corner]; }),
                          reflex_.end());
        }
    }

    void emit(std::uint32_t i) {
        if (turn(i) != 0) {
            result_.triangles.push_back({previous_[i], i, next_[i]});
        }
    }

    std::uint32_t count_; ///< of corners that are left
    std::vector<Point> points_;
    std::vector<std::uint32_t> next_, previous_, reflex_, waiting_;
    std::vector<bool> is_reflex_, is_cut_;
    std::size_t taken_ = 0;
    Triangulation result_;
};

} // namespace

Triangulation triangulate(std::span<const Vec3<double>> corners) {
    if (corners.size() < 3) {
        return {};
    }
    if (corners.size() == 3) {
        return {{{0, 1, 2}}};
    }
    return Ears(corners).cut();
}

} // namespace scc::compiler
