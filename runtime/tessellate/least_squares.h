#pragma once

#include "runtime/math/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

/// Points that are near to several planes at once.
namespace scc::runtime {

/// The point nearest to the one that distances are relative to at which sum (n . x - d)^2 is smallest.
/// Directions in which the planes say next to nothing are left as they are.
template <class R>
class PlaneFit {
public:
    /// n . x = d, n of unit length.
    void add(const Vec3<R>& n, R d) {
        ++count_;
        foot_ = n * d;
        const std::array<R, 3> v{n.x, n.y, n.z};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                matrix_[i][k] += v[i] * v[k];
            }
            right_[i] += v[i] * d;
        }
    }

    /// By the eigenvectors of the symmetric matrix; those count whose eigenvalues are more than `least` of
    /// the largest one.
    Vec3<R> solve(R least) const {
        if (count_ == 1) {
            return foot_;
        }
        Matrix a = matrix_, vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        diagonalize(a, vectors);
        const R largest = std::max({a[0][0], a[1][1], a[2][2]});
        Vec3<R> result{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (a[i][i] > least * largest) {
                const Vec3<R> v{vectors[0][i], vectors[1][i], vectors[2][i]};
                const R along = v.x * right_[0] + v.y * right_[1] + v.z * right_[2];
                result = result + v * (along / a[i][i]);
            }
        }
        return result;
    }

private:
    using Matrix = std::array<std::array<R, 3>, 3>;

    /// Jacobi's rotations.
    static void diagonalize(Matrix& a, Matrix& vectors) {
        constexpr int sweeps = 12;
        constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
        const R small = std::numeric_limits<R>::epsilon() * (a[0][0] + a[1][1] + a[2][2]);
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            if (std::max({std::abs(a[0][1]), std::abs(a[0][2]), std::abs(a[1][2])}) <= small) {
                return;
            }
            for (const auto& [p, q] : pairs) {
                if (a[p][q] == 0) {
                    continue;
                }
                const R theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const R t = (theta < 0 ? R(-1) : R(1)) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const R c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (std::size_t k = 0; k < 3; ++k) {
                    const R kp = a[k][p], kq = a[k][q];
                    a[k][p] = c * kp - s * kq;
                    a[k][q] = s * kp + c * kq;
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    const R pk = a[p][k], qk = a[q][k];
                    a[p][k] = c * pk - s * qk;
                    a[q][k] = s * pk + c * qk;
                    const R vp = vectors[k][p], vq = vectors[k][q];
                    vectors[k][p] = c * vp - s * vq;
                    vectors[k][q] = s * vp + c * vq;
                }
            }
        }
    }

    int count_ = 0;
    Vec3<R> foot_{}; ///< of the last plane
    Matrix matrix_{};
    std::array<R, 3> right_{};
};

} // namespace scc::runtime
