#pragma once

#include "runtime/illumination.h"
#include "runtime/primitive.h"

/// Bumps: the surface is shaded as if it were displaced along its outward normal by a height in world units.
/// To first order in the height h, its normal is then n - grad h with the gradient along the surface (J.
/// Blinn, Simulation of Wrinkled Surfaces, 1978). Only the shading changes: hits, outlines and where rays
/// start do not.
namespace scc::runtime {

/// What a height function reads, with derivatives by the point in the world. The normal is left out: heights
/// do not depend on it.
template <class L>
SurfacePoint<Dual<L, 3>> with_slopes(const SurfacePoint<L>& point, const PointSlopes<L>& slopes) {
    using Number = Dual<L, 3>;
    const auto number = [](const L& value, const Vec3<L>& slope) {
        return detail::dual<L, 3>(value, [&](int i) {
            return i == 0 ? slope.x : i == 1 ? slope.y : slope.z;
        });
    };
    return {{number(point.p.x, slopes.p[0]), number(point.p.y, slopes.p[1]), number(point.p.z, slopes.p[2])},
            {Number::variable(point.world.x, 0), Number::variable(point.world.y, 1),
             Number::variable(point.world.z, 2)},
            {},
            {number(point.uv.x, slopes.uv.x), number(point.uv.y, slopes.uv.y)}};
}

/// `normal`: the unit shading normal that faces the viewer; `outward`: the geometric one, along which the
/// height counts, so that a bump is a dent from behind. Where the height has no finite slope, nothing
/// changes.
template <class L>
Vec3<L> bumped_normal(const Vec3<L>& normal, const Vec3<L>& outward, const Vec3<L>& slope) {
    const Vec3<L> along = slope - normal * dot(slope, normal);
    const Vec3<L> bumped = choose(dot(normal, outward) < 0, normal + along, normal - along);
    const L squared = dot(bumped, bumped);
    return choose(squared < infinity<L>(), bumped * (1 / square_root(squared)), normal);
}

/// A ray mirrored by a bumped surface, which it does not enter: one that would is mirrored by the surface
/// itself, too, as POV-Ray does it. `facing`: the geometric normal on the side where the ray comes from.
template <class L>
Vec3<L> reflect_bumped(const Vec3<L>& dir, const Vec3<L>& normal, const Vec3<L>& facing) {
    const Vec3<L> mirrored = reflect(dir, normal);
    const Vec3<L> kept = choose(dot(mirrored, normal) < 0, reflect(dir, facing), reflect(mirrored, facing));
    return choose(dot(mirrored, facing) < 0, kept, mirrored);
}

/// As refract(); by the surface itself where the bump faces away or would send the ray back.
template <class L>
Refraction<L> refract_bumped(const Vec3<L>& dir, const Vec3<L>& normal, const Vec3<L>& facing, const L& from,
                             const L& to) {
    const Refraction<L> bumped = refract(dir, normal, from, to), flat = refract(dir, facing, from, to);
    const MaskOf<L> is_wrong = (dot(dir, normal) > 0) | (dot(bumped.dir, facing) > 0);
    return {choose(is_wrong, flat.dir, bumped.dir), choose(is_wrong, flat.reflectance, bumped.reflectance),
            MaskOf<L>((is_wrong & flat.is_total) | (bumped.is_total & !is_wrong))};
}

} // namespace scc::runtime
