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

/// L7, L9, L15, and what is seen through the surface. Colours are parts per channel. The light that leaves is
///     ambient + diffuse + specular + emission + reflect * mirrored + transmit * behind;
/// an opacity is worked into these parts already.
template <class R>
struct Phong {
    Varying<Rgb<R>> ambient{};
    Varying<Rgb<R>> diffuse{};
    Varying<Rgb<R>> specular{};
    Varying<Rgb<R>> emission{};
    Varying<Rgb<R>> reflect{};
    Varying<Rgb<R>> transmit{};
    Varying<R> shininess{32};
    R ior = 1;            ///< index of refraction of what the surface encloses
    bool fresnel = false; ///< by the dielectric's reflectance F: reflect counts F times, transmit 1 - F times
    std::int32_t bump = no_function; ///< height along the geometric normal, in world units; see bump.h

    friend constexpr bool operator==(const Phong&, const Phong&) = default;
};

/// Glass, too, whatever its tint: what it mirrors depends on what it encloses.
template <class R>
constexpr bool lets_through(const Phong<R>& p) {
    return p.fresnel || p.transmit.function != no_function || !(p.transmit.value == Rgb<R>{});
}
/// Whether rays may bend at it, or be mirrored by Fresnel's equations.
template <class R>
constexpr bool refracts(const Phong<R>& p) {
    return lets_through(p) && (p.ior != 1 || p.fresnel);
}

/// Indices into the scene's materials. Front: the side that the geometric normal points to.
struct Sides {
    std::uint32_t front = 0;
    std::uint32_t back = 0;

    friend constexpr bool operator==(const Sides&, const Sides&) = default;
};

} // namespace scc::runtime
