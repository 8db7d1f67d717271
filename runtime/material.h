#pragma once

#include "runtime/math/vec.h"

#include <cstdint>

namespace scc::runtime {

inline constexpr std::int32_t no_function = -1;

/// A constant, or the scene's per-point function with this index.
template <class T>
struct Varying {
    T value{};
    std::int32_t function = no_function;

    friend constexpr bool operator==(const Varying&, const Varying&) = default;
};

/// L7, L9, L15. Colours are reflectances per channel.
template <class R>
struct Phong {
    Varying<Rgb<R>> ambient{};
    Varying<Rgb<R>> diffuse{};
    Varying<Rgb<R>> specular{};
    Varying<Rgb<R>> emission{};
    Varying<Rgb<R>> reflect{};
    Varying<R> shininess{32};

    friend constexpr bool operator==(const Phong&, const Phong&) = default;
};

/// Indices into the scene's materials. Front: the side that the geometric normal points to.
struct Sides {
    std::uint32_t front = 0;
    std::uint32_t back = 0;

    friend constexpr bool operator==(const Sides&, const Sides&) = default;
};

} // namespace scc::runtime
