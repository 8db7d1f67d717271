#pragma once

namespace scc::runtime {

/// A point, direction or normal. R is a real number or a pack of them.
template <class R>
struct Vec3 {
    R x{}, y{}, z{};

    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

/// Linear light, Rec.709 primaries; not clamped.
template <class R>
struct Rgb {
    R r{}, g{}, b{};

    friend constexpr bool operator==(const Rgb&, const Rgb&) = default;
};

} // namespace scc::runtime
