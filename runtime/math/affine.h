#pragma once

#include "runtime/math/vec.h"

namespace scc::runtime {

/// x' = m[row][0..2] . x + m[row][3] (column vectors).
template <class R>
struct Affine {
    R m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    friend constexpr bool operator==(const Affine&, const Affine&) = default;
};

template <class To, class From>
constexpr Affine<To> affine_cast(const Affine<From>& a) {
    Affine<To> result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            result.m[row][column] = static_cast<To>(a.m[row][column]);
        }
    }
    return result;
}

template <class R, class L>
constexpr Vec3<L> transform_vector(const Affine<R>& a, const Vec3<L>& v) {
    const auto row = [&](int i) { return L(a.m[i][0]) * v.x + L(a.m[i][1]) * v.y + L(a.m[i][2]) * v.z; };
    return {row(0), row(1), row(2)};
}
template <class R, class L>
constexpr Vec3<L> transform_point(const Affine<R>& a, const Vec3<L>& p) {
    return transform_vector(a, p) + Vec3<L>{L(a.m[0][3]), L(a.m[1][3]), L(a.m[2][3])};
}
/// A normal of the destination space, from the inverse map (by its transpose); not of unit length.
template <class R, class L>
constexpr Vec3<L> transform_normal(const Affine<R>& source_from_destination, const Vec3<L>& n) {
    const auto& m = source_from_destination.m;
    const auto column = [&](int i) { return L(m[0][i]) * n.x + L(m[1][i]) * n.y + L(m[2][i]) * n.z; };
    return {column(0), column(1), column(2)};
}

/// |a| applied to a vector of magnitudes: bounds what rounding does to transform_vector.
template <class R, class L>
constexpr Vec3<L> transform_magnitude(const Affine<R>& a, const Vec3<L>& v) {
    const auto row = [&](int i) {
        return L(absolute(a.m[i][0])) * v.x + L(absolute(a.m[i][1])) * v.y + L(absolute(a.m[i][2])) * v.z;
    };
    return {row(0), row(1), row(2)};
}
template <class R>
constexpr Vec3<R> translation_of(const Affine<R>& a) {
    return {a.m[0][3], a.m[1][3], a.m[2][3]};
}

/// `then` after `first`.
template <class R>
constexpr Affine<R> compose(const Affine<R>& then, const Affine<R>& first) {
    Affine<R> result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            R sum = column == 3 ? then.m[row][3] : R(0);
            for (int k = 0; k < 3; ++k) {
                sum += then.m[row][k] * first.m[k][column];
            }
            result.m[row][column] = sum;
        }
    }
    return result;
}

template <class R>
constexpr R determinant(const Affine<R>& a) {
    const auto& m = a.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

namespace detail {

constexpr Affine<long double> inverse_by_cofactors(const Affine<long double>& a) {
    const auto& m = a.m;
    const long double scale = 1 / determinant(a);
    Affine<long double> result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            const int r1 = (column + 1) % 3, r2 = (column + 2) % 3, c1 = (row + 1) % 3, c2 = (row + 2) % 3;
            result.m[row][column] = (m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]) * scale;
        }
    }
    for (int row = 0; row < 3; ++row) {
        result.m[row][3] =
            -(result.m[row][0] * m[0][3] + result.m[row][1] * m[1][3] + result.m[row][2] * m[2][3]);
    }
    return result;
}

} // namespace detail

/// The inverse map; not finite where the determinant is 0. Calculated in long double with one Newton step
/// X' = X + X (1 - A X), so that each entry of a float or double result is its rounded true value unless the
/// map is extremely ill-conditioned; the clearance of spawned rays relies on that (placed.h).
template <class R>
constexpr Affine<R> inverse(const Affine<R>& a) {
    const Affine<long double> wide = affine_cast<long double>(a);
    const Affine<long double> estimate = detail::inverse_by_cofactors(wide);
    const Affine<long double> product = compose(wide, estimate);
    Affine<long double> residual;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            residual.m[row][column] = (row == column ? 1.0L : 0.0L) - product.m[row][column];
        }
    }
    Affine<R> result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            long double step = 0;
            for (int k = 0; k < 3; ++k) {
                step += estimate.m[row][k] * residual.m[k][column];
            }
            result.m[row][column] = static_cast<R>(estimate.m[row][column] + step);
        }
    }
    return result;
}

} // namespace scc::runtime
