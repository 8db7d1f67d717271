#pragma once

#include "runtime/math/lane.h"

namespace scc::runtime {

/// A point, direction or normal. R is a real number or a pack of them.
template <class R>
struct Vec3 {
    R x{}, y{}, z{};

    friend constexpr bool operator==(const Vec3& a, const Vec3& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }

    friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3 operator*(const Vec3& a, const R& s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(const R& s, const Vec3& a) { return a * s; }
    friend constexpr Vec3 operator/(const Vec3& a, const R& s) { return {a.x / s, a.y / s, a.z / s}; }
};

/// Coordinates on a surface.
template <class R>
struct Vec2 {
    R x{}, y{};

    friend constexpr bool operator==(const Vec2& a, const Vec2& b) { return a.x == b.x && a.y == b.y; }
};

/// Linear light, Rec.709 primaries; not clamped.
template <class R>
struct Rgb {
    R r{}, g{}, b{};

    friend constexpr bool operator==(const Rgb& p, const Rgb& q) {
        return p.r == q.r && p.g == q.g && p.b == q.b;
    }

    friend constexpr Rgb operator+(const Rgb& p, const Rgb& q) { return {p.r + q.r, p.g + q.g, p.b + q.b}; }
    friend constexpr Rgb operator*(const Rgb& p, const Rgb& q) { return {p.r * q.r, p.g * q.g, p.b * q.b}; }
    friend constexpr Rgb operator*(const Rgb& p, const R& s) { return {p.r * s, p.g * s, p.b * s}; }
    friend constexpr Rgb operator/(const Rgb& p, const R& s) { return {p.r / s, p.g / s, p.b / s}; }
};

/// The same vector in every lane, or in another precision.
template <class L, class R>
constexpr Vec3<L> lanes(const Vec3<R>& v) {
    return {L(v.x), L(v.y), L(v.z)};
}
template <class L, class R>
constexpr Vec2<L> lanes(const Vec2<R>& v) {
    return {L(v.x), L(v.y)};
}
template <class L, class R>
constexpr Rgb<L> lanes(const Rgb<R>& c) {
    return {L(c.r), L(c.g), L(c.b)};
}

template <class L>
constexpr L dot(const Vec3<L>& a, const Vec3<L>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class L>
constexpr Vec3<L> cross(const Vec3<L>& a, const Vec3<L>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class L>
constexpr L length(const Vec3<L>& v) {
    return square_root(dot(v, v));
}
template <class L>
constexpr Vec3<L> normalize(const Vec3<L>& v) {
    return v * (L(1) / length(v));
}

template <class L>
constexpr Vec3<L> absolute(const Vec3<L>& v) {
    return {absolute(v.x), absolute(v.y), absolute(v.z)};
}
template <class L>
constexpr Vec3<L> minimum(const Vec3<L>& a, const Vec3<L>& b) {
    return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
template <class L>
constexpr Vec3<L> maximum(const Vec3<L>& a, const Vec3<L>& b) {
    return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}
template <class L>
constexpr L largest_component(const Vec3<L>& v) {
    return maximum(maximum(v.x, v.y), v.z);
}
template <class L>
constexpr Vec3<L> choose(const MaskOf<L>& mask, const Vec3<L>& where_true, const Vec3<L>& where_false) {
    return {choose(mask, where_true.x, where_false.x), choose(mask, where_true.y, where_false.y),
            choose(mask, where_true.z, where_false.z)};
}
template <class L>
constexpr Vec2<L> choose(const MaskOf<L>& mask, const Vec2<L>& where_true, const Vec2<L>& where_false) {
    return {choose(mask, where_true.x, where_false.x), choose(mask, where_true.y, where_false.y)};
}
template <class L>
constexpr Rgb<L> choose(const MaskOf<L>& mask, const Rgb<L>& where_true, const Rgb<L>& where_false) {
    return {choose(mask, where_true.r, where_false.r), choose(mask, where_true.g, where_false.g),
            choose(mask, where_true.b, where_false.b)};
}

} // namespace scc::runtime
