#pragma once

#include "runtime/bump.h"
#include "runtime/raycast.h"

/// Where rays meet surfaces: what shading and what looks at pictures otherwise ask of a hit.
namespace scc::runtime::detail {

template <class L>
struct Encounter {
    Surface<L> surface;
    SurfacePoint<L> point; ///< see EncounterParts
    Vec3<L> normal;        ///< m: shading normal that faces the viewer
    IndexOf<L> material;
    IndexOf<L> body;       ///< Tag::id of what the surface encloses; see EncounterParts
    PointSlopes<L> slopes; ///< of `point`; see EncounterParts
};

/// Which of an encounter's parts are filled in beside surface, normal and material.
struct EncounterParts {
    bool body;
    bool point;
    bool uv;     ///< point.uv; only where meet() is told so
    bool slopes; ///< likewise; those of uv where both are
};

/// Puts in `to` what the lanes in `here` have. What the first group of lanes has may stand in the others too,
/// whose turn comes later or which take no part.
template <class T, class Mask>
void put(bool first, const Mask& here, const T& value, T& to) {
    to = first ? value : choose(here, value, to);
}

/// Fills in `at` for the active lanes, which have hit something. The material is chosen by the side of the
/// geometric normal that the ray is on. The shading normal is turned to the viewer by its own sign, so that
/// an interpolated one that already points away at a silhouette shades as in POV-Ray.
template <EncounterParts parts, class S, class L>
[[gnu::always_inline]] inline void meet(const S& scene, const Ray<L>& ray, const Hit<L>& hit,
                                        const MaskOf<L>& active, [[maybe_unused]] bool wants_uv,
                                        [[maybe_unused]] bool wants_slopes, Encounter<L>& at) {
    bool first = true;
    for_each_primitive(
        scene, hit, active,
        [&](const auto& primitive, const MaskOf<L>& here, [[maybe_unused]] const auto inverted,
            [[maybe_unused]] std::uint32_t body) {
            Vec3<L> object_point;
            Surface<L> surface = surface_of(scene, primitive, ray, hit.shape, here, object_point);
            if constexpr (uses_csg(S::traits)) {
                surface = inverted ? turned_over(surface) : surface;
            }
            const MaskOf<L> back = dot(surface.normal, ray.dir) > 0;
            const Vec3<L> normal = choose(dot(surface.shading_normal, ray.dir) > 0, -surface.shading_normal,
                                          surface.shading_normal);
            const Sides& sides = primitive.tag.sides;
            using Index = IndexOf<L>;
            const Index material = S::traits.two_sided ? choose(back, Index(sides.back), Index(sides.front))
                                                       : Index(sides.front);
            // Value by value, since whole structures would be copied through memory.
            put(first, here, surface.point, at.surface.point);
            put(first, here, surface.error, at.surface.error);
            put(first, here, surface.normal, at.surface.normal);
            put(first, here, normal, at.normal);
            put(first, here, material, at.material);
            if constexpr (parts.body) {
                put(first, here, Index(body), at.body);
            }
            if constexpr (parts.point) {
                put(first, here, object_point, at.point.p);
            }
            if constexpr (parts.uv) {
                if (wants_uv) {
                    put(first, here, uv_of(scene, primitive, ray, hit.shape, here, object_point),
                        at.point.uv);
                }
            }
            if constexpr (parts.slopes) {
                if (wants_slopes) {
                    const std::array<Vec3<L>, 3> slopes = object_point_slopes(primitive, L(0));
                    for (std::size_t i = 0; i < slopes.size(); ++i) {
                        put(first, here, slopes[i], at.slopes.p[i]);
                    }
                    if (parts.uv && wants_uv) {
                        const Vec2<Vec3<L>> uv =
                            uv_slopes_of(scene, primitive, ray, hit.shape, here, object_point);
                        put(first, here, uv.x, at.slopes.uv.x);
                        put(first, here, uv.y, at.slopes.uv.y);
                    }
                }
            }
            first = false;
        });
    if constexpr (parts.point) {
        at.point.world = at.surface.point;
        at.point.n = at.surface.normal;
    }
}

} // namespace scc::runtime::detail
