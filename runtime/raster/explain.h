#pragma once

#include "runtime/explanation.h"
#include "runtime/raster/draw.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

/// A sample of a raster picture as the painter finds it, with the numbers behind it.
namespace scc::runtime {

namespace detail {

/// What a lit point's light consists of, as its light is calculated.
template <class S>
class LitPoint {
    using R = typename S::Real;

public:
    explicit LitPoint(const S& scene) : scene_(scene), lighting_(scene) {}

    /// `normal`: turned to the viewer; `dir`: from there.
    RayTerms terms(const SurfacePoint<R>& point, const Vec3<R>& normal, const Vec3<R>& dir,
                   std::uint32_t material) const {
        RayTerms terms;
        terms.has_met = true;
        terms.dir = lanes<double>(dir);
        terms.point = lanes<double>(point.world);
        terms.normal = lanes<double>(point.n);
        terms.shading_normal = lanes<double>(normal);
        terms.material = material;
        Reflectances<R> reflectances{};
        look_up(scene_, IndexOf<R>(material), point, true, reflectances);
        terms.ambient = lanes<double>(reflectances.ambient);
        terms.diffuse = lanes<double>(reflectances.diffuse);
        terms.specular = lanes<double>(reflectances.specular);
        terms.emission = lanes<double>(reflectances.emission);
        terms.shininess = static_cast<double>(reflectances.shininess);
        const auto seen = lighting_.light(point, normal, dir, IndexOf<R>(material), true);
        terms.light = lanes<double>(seen.light);
        terms.transmitted = lanes<double>(seen.transmit);
        const auto add = [&](LightTerms::Kind kind, const auto& light, std::size_t index, std::size_t part) {
            terms.lights.push_back(of_light(light, reflectances, point.world, normal, dir));
            terms.lights.back().kind = kind;
            terms.lights.back().index = static_cast<std::uint32_t>(index);
            terms.lights.back().part = static_cast<std::uint32_t>(part);
        };
        const auto add_all = [&](LightTerms::Kind kind, const auto& table) {
            for (std::size_t i = 0; i < table.size(); ++i) {
                add(kind, table[i], i, 0);
            }
        };
        add_all(LightTerms::Kind::point, scene_.point_lights);
        add_all(LightTerms::Kind::directional, scene_.directional_lights);
        add_all(LightTerms::Kind::spot, scene_.spot_lights);
        for (std::size_t i = 0; i < scene_.rectangle_lights.size(); ++i) {
            std::size_t part = 0;
            for_each_point(scene_.rectangle_lights[i], [&](const auto& grid_point) {
                add(LightTerms::Kind::rectangle, grid_point, i, part++);
            });
        }
        return terms;
    }

private:
    struct Observer {
        static constexpr bool observes = true;
        LightTerms* to;

        template <class Tell>
        void tell(Tell&& tell_it) {
            tell_it(*this);
        }
        void diffuse(const Rgb<R>& term) { to->diffuse = lanes<double>(term); }
        void specular(R strength, const Rgb<R>& term) {
            to->highlight = static_cast<double>(strength);
            to->specular = lanes<double>(term);
        }
    };

    template <class Light>
    LightTerms of_light(const Light& light, const Reflectances<R>& material, const Vec3<R>& point,
                        const Vec3<R>& normal, const Vec3<R>& dir) const {
        const LightAt<R> seen = light_at(light, point);
        const R cosine = dot(seen.to_light, normal);
        const bool lit = lit_lanes(light, seen, cosine, true);
        LightTerms terms;
        terms.to_light = lanes<double>(seen.to_light);
        terms.distance = static_cast<double>(seen.distance);
        terms.cosine = static_cast<double>(cosine);
        if constexpr (requires { light.kc; }) {
            terms.attenuation =
                is_attenuated(light) ? static_cast<double>(attenuation(light, seen.distance)) : 1;
        }
        if constexpr (requires { light.cos_outer; }) {
            terms.is_in_cone = lit || !(cosine > 0);
            terms.cone_share =
                lit ? static_cast<double>(cone_share(light, cone_cosine(light, seen.to_light))) : 0;
        }
        if (lit) {
            Observer observer{&terms};
            terms.adds =
                lanes<double>(reflected_light<S>(light, material, normal, dir, seen, cosine, lit, observer));
            terms.reaches = true;
        }
        return terms;
    }

    const S& scene_;
    raster::PointLighting<S, R> lighting_;
};

/// What a triangle shows of a sample.
template <class S>
class TriangleTerms {
    using R = typename S::Real;

public:
    TriangleTerms(const S& scene, const RasterModel<R>& model, const raster::RasterView<R>& view,
                  RasterShading shading)
        : scene_(scene), model_(model), view_(view), shading_(shading), lit_(scene), finish_(scene) {}

    /// `id`: see screen_triangle.h; (x, y): the sample in the picture, by samples.
    DrawnTerms of(std::uint32_t id, R z, R x, R y) const {
        const std::uint32_t number = id & raster::triangle_number;
        const RasterSurface<R>& surface = raster::surface_of_triangle(model_, number);
        const std::uint32_t i = number - surface.first;
        const bool back = (id & raster::seen_from_back) != 0;
        DrawnTerms terms;
        terms.id = surface.id;
        terms.triangle = raster::rank_of_triangle(model_, scene_.meshes, surface, i);
        terms.pseudodepth = static_cast<double>(z);
        terms.is_front = !back;
        const raster::WorldTriangle<R> t = raster::world_triangle(model_, scene_.meshes, surface, i);
        std::array<raster::EyePoint<R>, 3> eye;
        std::array<raster::ClipPoint<R>, 3> clip;
        for (std::size_t c = 0; c < 3; ++c) {
            eye[c] = view_.to_eye(t.corners[c], t.weights[c]);
            clip[c] = view_.to_clip(eye[c], x, y);
        }
        // Seen from the sample itself, the values of the linear weights are those at 0.
        const auto linear = raster::corner_weights(clip);
        const R sum = linear[0].at + linear[1].at + linear[2].at;
        const std::array<R, 3> weights{linear[0].at / sum, linear[1].at / sum, linear[2].at / sum};
        R ahead = 0, finite = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            terms.weights[c] = static_cast<double>(weights[c]);
            terms.corners[c] = lanes<double>(t.corners[c]);
            ahead = ahead + weights[c] * eye[c].ahead;
            finite = finite + weights[c] * eye[c].weight;
        }
        terms.has_corners = !surface.at_infinity;
        terms.w = static_cast<double>(view_.is_orthographic() ? R(1) : ahead / finite);
        if (shading_ != RasterShading::hidden_line) {
            add_points(surface, i, t, weights, ahead / finite, back, x, y, terms);
        } else {
            terms.light = lanes<double>(Rgb<R>(scene_.background));
        }
        return terms;
    }

private:
    void add_points(const RasterSurface<R>& surface, std::uint32_t i, const raster::WorldTriangle<R>& t,
                    const std::array<R, 3>& weights, R ahead, bool back, R x, R y, DrawnTerms& terms) const {
        const Vec3<R> geometric = normalize(cross(t.corners[1] - t.corners[0] * t.weights[1],
                                                  t.corners[2] - t.corners[0] * t.weights[2])) *
                                  (surface.is_mirrored ? R(-1) : R(1));
        auto normals = raster::world_normals(model_, scene_.meshes, surface, i);
        for (Vec3<R>& normal : normals) {
            normal = normal == Vec3<R>{} ? geometric : normal;
        }
        const std::uint32_t material = back ? surface.sides.back : surface.sides.front;
        const auto lit = [&](const Vec3<R>& world, const Vec3<R>& own, const Vec3<R>& normal,
                             const Ray<R>& ray, R distance) {
            SurfacePoint<R> point{};
            point.world = world;
            point.n = surface.is_faceted ? geometric : own;
            Hit<R> hit;
            hit.shape.t = distance;
            hit.shape.part = raster::part_of_triangle(model_, surface, i);
            hit.kind = surface.kind;
            hit.index = surface.index;
            finish_.template finish<false>(hit, ray, true, point);
            terms.points.push_back(lit_.terms(point, normal, ray.dir, material));
            return terms.points.size() - 1;
        };
        if (shading_ == RasterShading::phong || surface.at_infinity) {
            const Ray<R> ray = view_.ray_through(x, y);
            Vec3<R> sum{};
            for (std::size_t c = 0; c < 3; ++c) {
                sum = sum + normals[c] * weights[c];
            }
            const Vec3<R> own = normalize(sum);
            const RayTerms& at = terms.points[lit(ray.org + ray.dir * ahead, own,
                                                  dot(own, ray.dir) > 0 ? -own : own, ray, ahead)];
            terms.light = at.light;
            terms.transmit = at.transmitted;
            return;
        }
        const std::size_t first = shading_ == RasterShading::flat ? 2 : 0;
        for (std::size_t c = first; c < 3; ++c) {
            const Vec3<R> own = normalize(normals[c]), dir = view_.direction_to(t.corners[c]);
            const RayTerms& at =
                terms
                    .points[lit(t.corners[c], own, back ? -own : own, Ray<R>{t.corners[c] - dir, dir}, R(1))];
            const double weight = first == 2 ? 1 : terms.weights[c];
            terms.light = terms.light + at.light * weight;
            terms.transmit = terms.transmit + at.transmitted * weight;
        }
    }

    const S& scene_;
    const RasterModel<R>& model_;
    const raster::RasterView<R>& view_;
    RasterShading shading_;
    LitPoint<S> lit_;
    raster::PointLighting<S, R> finish_;
};

} // namespace detail

/// Sample (i, j) of the one pixel of the request's crop, of its n x n from the top left corner.
template <SceneModel S>
RasterExplanation explain_raster(const S& scene, const RasterModel<typename S::Real>& model,
                                 const RenderRequest& request, int i, int j) {
    using R = typename S::Real;
    const int n = samples_per_axis(request.settings);
    const int column = request.crop.x0 * n + i, row = request.crop.y0 * n + j;
    const raster::RasterView<R> view(scene.camera, request.settings);
    const RasterShading shading = request.settings.raster.shading;
    const detail::TriangleTerms<S> triangles(scene, model, view, shading);
    RasterExplanation result;
    const double corner = request.settings.point == PixelPoint::corner ? 0.5 : 0;
    result.column = (column + 0.5) / n - corner;
    result.row = (row + 0.5) / n + corner;
    raster::RasterPainter<S, WidestLane<R>> painter(scene, model);
    const raster::DrawChoice choice{request.settings.raster.cull, shading == RasterShading::hidden_line};
    painter.draw(request, choice, shading, [&](auto& tile, int number) {
        for (const auto& found : tile.covering(number, column, row)) {
            DrawnTerms terms;
            if (found.is_line) {
                terms.is_line = true;
                terms.id = found.id;
                terms.pseudodepth = static_cast<double>(found.z);
                terms.light = lanes<double>(model.segments[found.id].color);
            } else {
                terms = triangles.of(found.id, found.z, static_cast<R>(column) + R(0.5),
                                     static_cast<R>(row) + R(0.5));
            }
            terms.verdict = found.is_seen ? DrawnTerms::Verdict::seen
                            : !found.is_line && (found.id & raster::lets_light_through) != 0
                                ? DrawnTerms::Verdict::through
                                : DrawnTerms::Verdict::farther;
            result.drawn.push_back(std::move(terms));
        }
    });
    std::stable_sort(result.drawn.begin(), result.drawn.end(), [](const DrawnTerms& a, const DrawnTerms& b) {
        return a.pseudodepth != b.pseudodepth ? a.pseudodepth < b.pseudodepth : a.verdict < b.verdict;
    });
    // What lets light through counts up to the nearest that does not.
    const auto seen = std::find_if(result.drawn.begin(), result.drawn.end(), [](const DrawnTerms& d) {
        return d.verdict == DrawnTerms::Verdict::seen;
    });
    for (auto d = seen; d != result.drawn.end(); ++d) {
        d->verdict = d == seen ? d->verdict : DrawnTerms::Verdict::farther;
    }
    result.sample = seen == result.drawn.end() ? lanes<double>(Rgb<R>(scene.background)) : seen->light;
    for (auto d = seen; d != result.drawn.begin();) {
        if ((--d)->verdict == DrawnTerms::Verdict::through) {
            result.sample = d->light + d->transmit * result.sample;
        }
    }
    return result;
}

} // namespace scc::runtime
