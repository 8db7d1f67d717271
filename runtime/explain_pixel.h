#pragma once

#include "runtime/accel/build.h"
#include "runtime/camera_rays.h"
#include "runtime/explanation.h"
#include "runtime/residual.h"
#include "runtime/shade.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// A pixel drawn as the renderer draws it, by the same code, with somebody watching.
namespace scc::runtime {

namespace detail {

template <class R>
Vec3<double> widened(const Vec3<R>& v) {
    return lanes<double>(v);
}
template <class R>
Rgb<double> widened(const Rgb<R>& c) {
    return lanes<double>(c);
}

/// All surfaces that a ray passes through.
template <class R>
class CandidateSearch {
public:
    using S = DynamicScene<R>;
    static constexpr std::size_t most_per_shape = 64;

    CandidateSearch(const S& scene, const Ray<R>& ray) : scene_(scene), ray_(ray) {}

    std::vector<Candidate> run() {
        any_of_kinds<S>([&]<std::uint32_t kind>() {
            for (const auto& primitive : scene_.primitives(Of<PrimitiveOfKind<R, kind>>{})) {
                if constexpr (is_csg<ShapeOfKind<R, kind>>) {
                    add_solid(primitive.shape.root, primitive.tag.id);
                } else {
                    add_surface(primitive, primitive.tag.id);
                }
            }
            return false;
        });
        std::stable_sort(found_.begin(), found_.end(), [](const Candidate& a, const Candidate& b) {
            return a.t < b.t || (a.t == b.t && a.member < b.member);
        });
        return std::move(found_);
    }

private:
    /// Behind a hit by more than rounding.
    R behind(R t) const {
        const R away = largest_component(absolute(ray_.org)) / largest_component(absolute(ray_.dir));
        return t + 8 * roundoff<R>() * (away + absolute(t));
    }

    template <class Primitive>
    ShapeHit<R> next_hit(const Primitive& primitive, R t_min) const {
        Ray<R> ray = to_object(primitive, ray_);
        ray.t_min = t_min;
        if constexpr (is_mesh<decltype(primitive.shape)>) {
            ShapeHit<R> hit;
            intersect_mesh<false, R>(scene_.meshes[primitive.shape.mesh], {&ray, 1}, Apex::none, {&hit, 1});
            return hit;
        } else {
            return intersect_shape(scene_, primitive.shape, ray);
        }
    }

    template <class Primitive>
    void add_surface(const Primitive& primitive, std::uint32_t id) {
        R t_min = ray_.t_min;
        for (std::size_t count = 0; count < most_per_shape; ++count) {
            const ShapeHit<R> hit = next_hit(primitive, t_min);
            if (!(hit.t < infinity<R>())) {
                return;
            }
            Vec3<R> object_point;
            const Surface<R> surface = surface_of(scene_, primitive, ray_, hit, true, object_point);
            const Ray<R>& in_object = to_object(primitive, ray_);
            Candidate candidate{.t = static_cast<double>(hit.t),
                                .point = widened(ray_.org + hit.t * ray_.dir),
                                .id = id,
                                .member = primitive.tag.id,
                                .shape = decltype(primitive.shape)::name,
                                .enters = dot(surface.normal, ray_.dir) < 0,
                                .residual = residual_in(scene_, primitive.shape, hit.part,
                                                        in_object.org + hit.t * in_object.dir)};
            found_.push_back(candidate);
            t_min = behind(hit.t);
        }
    }

    /// Members' surfaces are of the solid where it begins or ends there.
    void add_solid(std::uint32_t root, std::uint32_t id) {
        const std::size_t first = found_.size();
        for (std::uint32_t at = root; at < root + scene_.csg_nodes[root].size; ++at) {
            if (scene_.csg_nodes[at].op == CsgOp::member) {
                visit_member(scene_, scene_.csg_nodes[at].member,
                             [&](const auto& member) { add_surface(member.primitive, id); });
            }
        }
        struct Boundary {
            double t;
            std::uint32_t member;
        };
        std::vector<Boundary> boundaries;
        Ray<R> ray = ray_;
        while (boundaries.size() < most_per_shape) {
            const Hit<R> hit = intersect_solid<false>(scene_, root, ray);
            if (!(hit.shape.t < infinity<R>())) {
                break;
            }
            boundaries.push_back({static_cast<double>(hit.shape.t), hit.id});
            ray.t_min = behind(hit.shape.t);
        }
        for (std::size_t i = first; i < found_.size(); ++i) {
            Candidate& c = found_[i];
            const bool is_boundary =
                std::any_of(boundaries.begin(), boundaries.end(),
                            [&](const Boundary& b) { return b.t == c.t && b.member == c.member; });
            const auto after = std::count_if(boundaries.begin(), boundaries.end(),
                                             [&](const Boundary& b) { return b.t > c.t; });
            c.verdict = is_boundary      ? Candidate::Verdict::farther
                        : after % 2 == 1 ? Candidate::Verdict::inside
                                         : Candidate::Verdict::outside;
        }
    }

    const S& scene_;
    const Ray<R>& ray_;
    std::vector<Candidate> found_;
};

/// Writes down what a Shader tells.
template <class R>
class Recorder {
public:
    using S = DynamicScene<R>;

    Recorder(const S& scene, Explanation& to) : scene_(scene), to_(to) {}

    void ray(const Ray<R>& ray, const Rgb<R>& weight, R bounces) {
        RayTerms terms;
        terms.way = way_;
        terms.parent = parent_;
        terms.bounces = static_cast<int>(bounces);
        terms.org = widened(ray.org);
        terms.dir = widened(ray.dir);
        terms.weight = widened(weight);
        terms.candidates = CandidateSearch<R>(scene_, ray).run();
        to_.rays.push_back(std::move(terms));
        lights_seen_ = 0;
        current_ = to_.rays.size() - 1;
    }
    void met(const Hit<R>& hit, const Encounter<R>& at, const Reflectances<R>& material) {
        RayTerms& ray = to_.rays[current_];
        ray.has_met = true;
        ray.t = static_cast<double>(hit.shape.t);
        ray.id = at.body;
        ray.member = hit.id;
        ray.point = widened(at.surface.point);
        ray.error = widened(at.surface.error);
        ray.normal = widened(at.surface.normal);
        ray.shading_normal = widened(at.normal);
        ray.is_front = dot(widened(at.surface.normal), ray.dir) <= 0;
        ray.material = at.material;
        ray.is_bumped = scene_.materials[at.material].bump != no_function;
        ray.ambient = widened(material.ambient);
        ray.diffuse = widened(material.diffuse);
        ray.specular = widened(material.specular);
        ray.emission = widened(material.emission);
        ray.reflect = widened(material.reflect);
        ray.transmit = widened(material.transmit);
        ray.shininess = static_cast<double>(material.shininess);
        for (Candidate& candidate : ray.candidates) {
            if (candidate.t == ray.t && candidate.member == ray.member) {
                candidate.verdict = Candidate::Verdict::met;
            }
        }
    }

    template <class Light>
    void light(const Light& light, const LightAt<R>& seen, R cosine, bool lit) {
        LightTerms terms = place_of_light(lights_seen_++);
        terms.to_light = widened(seen.to_light);
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
        to_.rays[current_].lights.push_back(terms);
    }
    void feeler(const Ray<R>& ray, bool is_blocked) {
        Feeler feeler{widened(ray.org), widened(ray.dir), is_blocked, 0, 0, {}};
        Ray<R> again = ray;
        again.t_max = is_blocked && !(ray.t_max > 0) ? infinity<R>() : ray.t_max;
        if (is_blocked) {
            const Hit<R> hit = closest_hit<S, R>(scene_, again);
            feeler.t = static_cast<double>(hit.shape.t);
            for_each_primitive(scene_, hit, true,
                               [&](const auto&, bool, bool, std::uint32_t body) { feeler.id = body; });
        }
        last_light().feelers.push_back(feeler);
    }
    void filtered(const Hit<R>&, const Rgb<R>& filter) {
        last_light().feelers.back().filter = widened(filter);
    }
    void diffuse(const Rgb<R>& term) { last_light().diffuse = widened(term); }
    void specular(R strength, const Rgb<R>& term) {
        last_light().highlight = static_cast<double>(strength);
        last_light().specular = widened(term);
    }
    void adds_light(const Rgb<R>& sum) {
        last_light().adds = widened(sum);
        last_light().reaches = true;
    }
    void leaves(const Rgb<R>& light) { to_.rays[current_].light = widened(light); }

    void crosses(R from, R to, R share, bool is_total) {
        to_.rays[current_].refraction = RayTerms::Refraction{
            static_cast<double>(from), static_cast<double>(to), static_cast<double>(share), is_total};
    }
    void goes_on(const Rgb<R>& reflected, bool mirrored, const Rgb<R>& transmitted, bool through) {
        RayTerms& ray = to_.rays[current_];
        ray.reflected = widened(reflected);
        ray.transmitted = widened(transmitted);
        ray.goes_back = mirrored;
        ray.goes_through = through;
        parent_ = static_cast<int>(current_);
        way_ = through ? RayTerms::Way::through : RayTerms::Way::mirrored;
        if (through && mirrored) {
            waiting_.push_back(parent_);
        }
    }
    void takes_up() {
        parent_ = waiting_.back();
        way_ = RayTerms::Way::mirrored;
        waiting_.pop_back();
    }

private:
    LightTerms& last_light() { return to_.rays[current_].lights.back(); }

    /// The lights come in the order of illuminate().
    LightTerms place_of_light(std::size_t i) const {
        using Kind = LightTerms::Kind;
        LightTerms terms;
        const auto is_of = [&](Kind kind, std::size_t count) {
            terms.kind = kind;
            terms.index = static_cast<std::uint32_t>(i);
            const bool found = i < count;
            i -= found ? 0 : count;
            return found;
        };
        if (is_of(Kind::point, scene_.point_lights.size()) ||
            is_of(Kind::directional, scene_.directional_lights.size()) ||
            is_of(Kind::spot, scene_.spot_lights.size())) {
            return terms;
        }
        terms.kind = Kind::rectangle;
        terms.index = 0;
        for (const RectangleLight<R>& light : scene_.rectangle_lights) {
            if (i < light.nu * light.nv) {
                break;
            }
            i -= light.nu * light.nv;
            ++terms.index;
        }
        terms.part = static_cast<std::uint32_t>(i);
        return terms;
    }

    const S& scene_;
    Explanation& to_;
    std::size_t current_ = 0, lights_seen_ = 0;
    RayTerms::Way way_ = RayTerms::Way::primary;
    int parent_ = -1;
    std::vector<int> waiting_;
};

/// Passes on what it is told to a Recorder, or nothing to none.
template <class R>
struct Watcher {
    static constexpr bool observes = true;
    Recorder<R>* recorder = nullptr;

    template <class Tell>
    void tell(Tell&& tell_it) const {
        if (recorder != nullptr) {
            tell_it(*recorder);
        }
    }
};

} // namespace detail

/// Draws the one pixel of the request's crop, as render() does by a plain grid, to the bit. `to`: null, or
/// what becomes of sample (i, j) of the pixel's n x n, from its top left corner.
template <class R>
Rgb<float> explain_pixel(const DynamicScene<R>& scene, const RenderRequest& request, int i, int j,
                         Explanation* to) {
    const RenderSettings& settings = request.settings;
    const int n = samples_per_axis(settings);
    const auto within = [&](int sample) { return (static_cast<R>(sample) + R(0.5)) / static_cast<R>(n); };
    const CameraRays<DynamicScene<R>> camera(scene, settings);
    const Pixel pixel{request.crop.x0, request.crop.y0};
    Rgb<R> sum{R(0), R(0), R(0)};
    RayCounts counts;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const R window_x = camera.window_x(static_cast<R>(pixel.column), within(x)),
                    window_y = camera.window_y(static_cast<R>(pixel.row), within(y));
            std::array<Ray<R>, 1> ray{camera.straight_ray(window_x, window_y)};
            camera.bend(
                window_x, window_y,
                [&](int) {
                    return Sample{pixel, y * n + x};
                },
                ray[0]);
            const bool is_it = to != nullptr && x == i && y == j;
            Explanation unused;
            detail::Recorder<R> recorder(scene, is_it ? *to : unused);
            detail::Shader<DynamicScene<R>, R, detail::Watcher<R>> shader(scene, settings, counts,
                                                                          {is_it ? &recorder : nullptr});
            std::array<Rgb<R>, 1> color;
            shader.radiance(ray, camera.apex(), all_candidates, {true}, color);
            if (is_it) {
                const double corner = settings.point == PixelPoint::corner ? 0.5 : 0;
                to->column = pixel.column + (static_cast<double>(within(x)) - corner);
                to->row = pixel.row + (static_cast<double>(within(y)) + corner);
                to->sample = detail::widened(color[0]);
            }
            sum = sum + color[0];
        }
    }
    const auto stored = [&](R v) {
        return static_cast<float>(n == 1 ? v : v / static_cast<R>(n * n)) + 0.0F;
    };
    return {stored(sum.r), stored(sum.g), stored(sum.b)};
}

} // namespace scc::runtime
