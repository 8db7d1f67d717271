#include "lang/transforms.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scc::lang {
namespace {

using Rows = std::array<std::array<double, 4>, 3>;

Point difference(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::optional<Point> unit(const Point& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    if (!(length > 0) || !std::isfinite(length)) {
        return std::nullopt;
    }
    return Point{v[0] / length, v[1] / length, v[2] / length};
}

double largest_element(const Rows& m) {
    double largest = 0;
    for (const auto& row : m) {
        for (std::size_t c = 0; c < 3; ++c) {
            largest = std::max(largest, std::abs(row[c]));
        }
    }
    return largest;
}

double frobenius(const Rows& m) {
    double sum = 0;
    for (const auto& row : m) {
        sum += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
    }
    return std::sqrt(sum);
}

/// Inverts the linear part by cofactors, after scaling it so that the determinant neither over- nor
/// underflows.
std::optional<Rows> inverse_linear(const Rows& m) {
    const double size = largest_element(m);
    if (!(size > 0) || !std::isfinite(size)) {
        return std::nullopt;
    }
    std::array<Point, 3> r;
    for (std::size_t i = 0; i < 3; ++i) {
        r[i] = {m[i][0] / size, m[i][1] / size, m[i][2] / size};
    }
    const std::array<Point, 3> columns{cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1])};
    const double determinant = dot(r[0], columns[0]);
    if (determinant == 0) {
        return std::nullopt;
    }
    Rows result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            result[i][j] = columns[j][i] / determinant / size;
        }
    }
    return result;
}

/// Quarter turns in radians are rounded, which leaves 6e-17 where their cosine is 0; this keeps them exact.
double snapped(double value) {
    return std::abs(value) < 5e-16 ? 0 : value;
}

} // namespace

TransformValue translation(const Point& by) {
    return {{{{1, 0, 0, by[0]}, {0, 1, 0, by[1]}, {0, 0, 1, by[2]}}}};
}

TransformValue scaling(const Point& by) {
    return {{{{by[0], 0, 0, 0}, {0, by[1], 0, 0}, {0, 0, by[2], 0}}}};
}

TransformValue rotation(const Point& axis, double radians) {
    const double c = snapped(std::cos(radians));
    const double s = snapped(std::sin(radians));
    const auto [x, y, z] = axis;
    const double t = 1 - c;
    return {{{{t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0},
              {t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0},
              {t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0}}}};
}

std::optional<TransformValue> look_at(const Point& eye, const Point& target, const Point& up) {
    const std::optional<Point> n = unit(difference(eye, target));
    const std::optional<Point> up_unit = unit(up);
    if (!n || !up_unit) {
        return std::nullopt;
    }
    const Point across = cross(*up_unit, *n);
    const std::optional<Point> u = unit(across);
    if (!u ||
        dot(across, across) < 1e-24) { // sine of the angle below 1e-12: only rounding tells the direction
        return std::nullopt;
    }
    const Point v = cross(*n, *u);
    const auto row = [&eye](const Point& a) { return std::array<double, 4>{a[0], a[1], a[2], -dot(a, eye)}; };
    return TransformValue{{row(*u), row(v), row(*n)}};
}

TransformValue then(const TransformValue& first, const TransformValue& second) {
    TransformValue result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& a = second.m[i];
        for (std::size_t j = 0; j < 4; ++j) {
            result.m[i][j] = a[0] * first.m[0][j] + a[1] * first.m[1][j] + a[2] * first.m[2][j];
        }
        result.m[i][3] += a[3];
    }
    return result;
}

std::optional<TransformValue> inverse(const TransformValue& transform) {
    std::optional<Rows> rows = inverse_linear(transform.m);
    if (!rows || !(condition(transform) < 1 / std::numeric_limits<double>::epsilon())) {
        return std::nullopt;
    }
    for (auto& row : *rows) {
        row[3] = -(row[0] * transform.m[0][3] + row[1] * transform.m[1][3] + row[2] * transform.m[2][3]);
    }
    return TransformValue{*rows};
}

double condition(const TransformValue& transform) {
    const std::optional<Rows> rows = inverse_linear(transform.m);
    return rows ? frobenius(transform.m) * frobenius(*rows) : std::numeric_limits<double>::infinity();
}

} // namespace scc::lang
