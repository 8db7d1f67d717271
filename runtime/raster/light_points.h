#pragma once

#include "runtime/raster/model.h"
#include "runtime/raycast.h"
#include "runtime/surface_light.h"

#include <vector>

/// The light that leaves points of surfaces, wherever these were found.
namespace scc::runtime::raster {

/// Light that leaves, and the part of what is behind that comes through.
template <class L>
struct Seen {
    Rgb<L> light, transmit;
};
template <class L>
Seen<L> choose(const MaskOf<L>& mask, const Seen<L>& where_true, const Seen<L>& where_false) {
    return {choose(mask, where_true.light, where_false.light),
            choose(mask, where_true.transmit, where_false.transmit)};
}

template <SceneModel S, class L>
class PointLighting {
public:
    using R = typename S::Real;

    explicit PointLighting(const S& scene)
        : scene_(scene), grid_points_(runtime::detail::grid_points_of(scene)) {}

    /// Fills in what functions read beside `point.world` and `point.n`, of points on rays.
    template <bool wants_uv>
    void finish(const Hit<L>& hit, const Ray<L>& ray, const MaskOf<L>& active, SurfacePoint<L>& point) const {
        bool first = true;
        for_each_primitive(scene_, hit, active,
                           [&](const auto& primitive, const MaskOf<L>& here, const auto&, std::uint32_t) {
                               Vec3<L> own = point.world;
                               if constexpr (requires { primitive.object_from_world; }) {
                                   own = transform_point(primitive.object_from_world, point.world);
                               }
                               runtime::detail::put(first, here, own, point.p);
                               if constexpr (S::traits.uv || wants_uv) {
                                   if (wants_uv || reads_uv()) {
                                       runtime::detail::put(
                                           first, here, uv_of(scene_, primitive, ray, hit.shape, here, own),
                                           point.uv);
                                   }
                               }
                               first = false;
                           });
    }

    /// `normal`: turned to the viewer; `dir`: from there.
    Seen<L> light(const SurfacePoint<L>& point, const Vec3<L>& normal, const Vec3<L>& dir,
                  const IndexOf<L>& material, const MaskOf<L>& active) const {
        runtime::detail::Reflectances<L> reflectances;
        runtime::detail::look_up(scene_, material, point, active, reflectances);
        Seen<L> seen{runtime::detail::unshadowed_light(scene_, grid_points_, reflectances, point.world,
                                                       normal, dir, active),
                     {L(0), L(0), L(0)}};
        if constexpr (S::traits.transmission) {
            seen.transmit = reflectances.transmit;
        }
        return seen;
    }

private:
    bool reads_uv() const {
        if constexpr (S::traits.uv) {
            return scene_.reads_uv;
        } else {
            return false;
        }
    }

    const S& scene_;
    std::vector<PointLight<R>> grid_points_;
};

} // namespace scc::runtime::raster
