#pragma once

#include "runtime/raster/corner_weights.h"
#include "runtime/raster/corners.h"
#include "runtime/raster/lane_groups.h"
#include "runtime/raster/light_points.h"
#include "runtime/raster/lit_corners.h"
#include "runtime/raster/vertex_lights.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// What samples show of the triangles that were found nearest (L10).
namespace scc::runtime::raster {

/// Of one tile. Vertices and faces are lit with normals turned to the side that is seen, as by OpenGL's
/// GL_LIGHT_MODEL_TWO_SIDE; samples with normals turned to the viewer by their own sign, as rays do it.
/// Planes, which have no vertices at finite places, are lit at each sample.
template <SceneModel S, class L>
class TriangleShader {
public:
    using R = typename S::Real;
    using Mask = MaskOf<L>;
    static constexpr int N = lane_count<L>;
    /// Of numbers as add() gives them.
    using Groups = LaneGroups<L>;

    TriangleShader(const S& scene, const RasterModel<R>& model, const RasterView<R>& view,
                   const VertexLights<S, L>& lights, RasterShading shading)
        : scene_(scene), model_(model), view_(view), lights_(lights), shading_(shading), lighting_(scene) {}

    /// The tile that begins at this sample.
    void start(int left, int top) {
        left_ = left;
        top_ = top;
        shown_.clear();
        to_prepare_.clear();
        lit_.clear();
        has_samples_ = has_vertices_ = false;
    }
    /// A triangle, by its id (see screen_triangle.h); a number for it.
    std::uint32_t add(std::uint32_t id) {
        if (shading_ == RasterShading::hidden_line) {
            return add(Rgb<R>(scene_.background));
        }
        const auto number = static_cast<std::uint32_t>(shown_.size());
        Shown& shown = shown_.emplace_back();
        shown.id = id;
        shown.surface = &surface_of(id & triangle_number);
        shown.by_sample = shading_ == RasterShading::phong || shown.surface->at_infinity;
        (shown.by_sample ? has_samples_ : has_vertices_) = true;
        const bool is_front = (id & seen_from_back) == 0;
        if (is_front && lights_.has(*shown.surface)) {
            lit_.push_back({number, lights_.corners(*shown.surface, id & triangle_number)});
            for (const Vertex* vertex : lit_.back().corners) {
                __builtin_prefetch(vertex); // prepare() reads it, when all are known
            }
        } else {
            to_prepare_.push_back(number);
        }
        return number;
    }
    /// What is not lit.
    std::uint32_t add(const Rgb<R>& color) {
        has_vertices_ = true;
        shown_.emplace_back();
        set_color(shown_.size() - 1, color, first_color);
        return static_cast<std::uint32_t>(shown_.size() - 1);
    }
    /// To be called when all are known.
    void prepare() {
        PackOfShown pack;
        std::size_t count = 0;
        for (const std::uint32_t number : to_prepare_) {
            Shown& shown = shown_[number];
            if (count == N || (count > 0 && placed_by(*shown.surface) != placed_by(*pack[0]->surface))) {
                prepare(pack, count);
                count = 0;
            }
            pack[count++] = &shown;
        }
        if (count > 0) {
            prepare(pack, count);
        }
        for (std::size_t i = 0; i < lit_.size(); i += N) {
            prepare_lit(&lit_[i], std::min<std::size_t>(N, lit_.size() - i));
        }
    }

    /// Nothing is lit at each sample, so that interpolate() does for all.
    bool has_vertices_alone() const { return !has_samples_; }
    /// Colours at vertices, or of faces, at samples (column, row) of the tile. for_each_group(f) calls
    /// f(lanes, number) as LaneGroups has them.
    template <class ForEachGroup>
    Seen<L> interpolate(ForEachGroup&& for_each_group, const L& column, const L& row) const {
        Seen<L> seen{};
        L sum(1);
        for_each_group([&](const Mask& lanes, std::uint32_t number) {
            const auto& numbers = shown_[number].numbers;
            const auto put = [&](std::size_t at, L& to) {
                const L value = L(numbers[at]) + L(numbers[at + 1]) * column + L(numbers[at + 2]) * row;
                to = choose(lanes, value, to);
            };
            const auto put_color = [&](std::size_t at, Rgb<L>& to) {
                put(at, to.r);
                put(at + 3, to.g);
                put(at + 6, to.b);
            };
            put(weight_sum, sum);
            put_color(first_color, seen.light);
            if constexpr (S::traits.transmission) {
                put_color(first_transmit, seen.transmit);
            }
        });
        const L scale = L(1) / sum;
        return {seen.light * scale, seen.transmit * scale};
    }
    Seen<L> shade(const Groups& groups, const L& column, const L& row, const Mask& active) const {
        if (!has_vertices_) {
            return shade_samples(groups, column, row, active);
        }
        Groups lit;
        Mask by_sample(false);
        for (const auto& group : groups) {
            if (shown_[group.number].by_sample) {
                by_sample = by_sample | group.lanes;
                lit.add(group.lanes, group.number);
            }
        }
        by_sample = by_sample & active;
        const Seen<L> seen = interpolate(
            [&](auto&& f) {
                for (const auto& group : groups) {
                    f(group.lanes, group.number);
                }
            },
            column, row);
        return none(by_sample) ? seen : choose(by_sample, shade_samples(lit, column, row, by_sample), seen);
    }

    /// A sample's place on its triangle.
    struct Place {
        SurfacePoint<L> point;
        Vec3<L> dir;    ///< the sample's ray
        L ahead;        ///< the part of the ray to there, and distance along the view axis
        Vec3<L> normal; ///< m of L7
        IndexOf<L> material;
    };
    /// Of samples that show triangles, where all are lit at each sample.
    template <bool wants_uv>
    Place place(const Groups& groups, const L& column, const L& row, const Mask& active) const {
        const auto linear = [&](std::size_t at) { return value(groups, at, column, row); };
        Place result;
        const Ray<L> ray = view_.ray_through(column + L(static_cast<R>(left_) + R(0.5)),
                                             row + L(static_cast<R>(top_) + R(0.5)));
        result.dir = ray.dir;
        result.ahead = linear(depth) / linear(finite_sum);
        result.point.world = ray.org + ray.dir * result.ahead;
        const auto geometric = [&](auto component) {
            return gather(groups, [=](const Shown& s) { return s.geometric.*component; });
        };
        result.point.n = {geometric(&Vec3<R>::x), geometric(&Vec3<R>::y), geometric(&Vec3<R>::z)};
        // Seen from behind, all weights are negative.
        const L side = choose(linear(weight_sum) < 0, L(-1), L(1));
        const Vec3<L> sum =
            Vec3<L>{linear(first_normal), linear(first_normal + 3), linear(first_normal + 6)} * side;
        const L squared = dot(sum, sum);
        const Vec3<L> normal = choose(squared > 0, sum * (L(1) / square_root(squared)), result.point.n);
        result.normal = choose(dot(normal, ray.dir) > 0, -normal, normal);
        result.material = gather_index(groups, [](const Shown& s) { return s.material; });
        if constexpr (S::traits.functions || wants_uv) {
            const IndexOf<L> faceted =
                gather_index(groups, [](const Shown& s) { return s.surface->is_faceted ? 1U : 0U; });
            result.point.n = choose(faceted == IndexOf<L>(1U), result.point.n, normal);
            lighting_.template finish<wants_uv>(hit_of(groups, result.ahead), ray, active, result.point);
        }
        return result;
    }
    std::uint32_t object_of(std::uint32_t number) const { return shown_[number].surface->id; }

private:
    /// Where a Shown has which Linear: the sum of the corners' weights, then either those that, divided by
    /// it, give colours, or those of the normal; then the sum of the weights of corners at finite places, and
    /// the depth times that.
    static constexpr std::size_t weight_sum = 0, first_color = 3, first_transmit = 12, first_normal = 3,
                                 finite_sum = 12, depth = 15, most_numbers = 21;
    struct Shown {
        std::uint32_t id = 0, material = 0;
        const RasterSurface<R>* surface = nullptr; ///< none of what is not lit
        bool by_sample = false;
        std::array<R, most_numbers> numbers{1};
        Vec3<R> geometric{};
    };

    using Vertex = typename VertexLights<S, L>::Vertex;
    /// A triangle whose vertices were lit before.
    struct Lit {
        std::uint32_t number;
        std::array<const Vertex*, 3> corners;
    };

    void set_color(std::size_t number, const Rgb<R>& color, std::size_t at) {
        set_color(shown_[number], color, at);
    }
    static void set_color(Shown& shown, const Rgb<R>& color, std::size_t at) {
        auto& numbers = shown.numbers;
        numbers[at] = color.r;
        numbers[at + 3] = color.g;
        numbers[at + 6] = color.b;
    }

    template <class Get>
    L gather(const Groups& groups, Get&& get) const {
        return groups.template gather<L>([&](std::uint32_t number) { return get(shown_[number]); });
    }
    template <class Get>
    IndexOf<L> gather_index(const Groups& groups, Get&& get) const {
        return groups.template gather<IndexOf<L>>([&](std::uint32_t number) { return get(shown_[number]); });
    }
    /// The value of the Linear at `at`.
    L value(const Groups& groups, std::size_t at, const L& column, const L& row) const {
        const auto of = [&](std::uint32_t number) {
            const auto& numbers = shown_[number].numbers;
            return L(numbers[at]) + L(numbers[at + 1]) * column + L(numbers[at + 2]) * row;
        };
        return groups.template gather<L>(of);
    }

    Seen<L> shade_samples(const Groups& groups, const L& column, const L& row, const Mask& active) const {
        const Place at = place<false>(groups, column, row, active);
        return lighting_.light(at.point, at.normal, at.dir, at.material, active);
    }

    Hit<L> hit_of(const Groups& groups, const L& t) const {
        Hit<L> hit;
        hit.shape.t = t;
        hit.shape.part = gather_index(groups, [&](const Shown& s) {
            return part_of_triangle(model_, *s.surface, (s.id & triangle_number) - s.surface->first);
        });
        hit.kind = gather_index(groups, [](const Shown& s) { return s.surface->kind; });
        hit.index = gather_index(groups, [](const Shown& s) { return s.surface->index; });
        return hit;
    }

    /// Most often that of the triangle before.
    const RasterSurface<R>& surface_of(std::uint32_t triangle) {
        if (last_surface_ == nullptr || triangle - last_surface_->first >= last_surface_->count) {
            last_surface_ = &surface_of_triangle(model_, triangle);
        }
        return *last_surface_;
    }

    using PackOfShown = std::array<Shown*, static_cast<std::size_t>(N)>;

    /// The first `count` of these triangles, which have the same placed_by(); the others' lanes are made up.
    void prepare(PackOfShown& pack, std::size_t count) {
        std::fill(pack.begin() + static_cast<std::ptrdiff_t>(count), pack.end(), pack[count - 1]);
        const LitCorners<L> corners = corners_of(pack);
        std::array<EyePoint<L>, 3> eye;
        for (std::size_t c = 0; c < 3; ++c) {
            eye[c] = view_.to_eye(corners.points[c], corners.weights[c]);
        }
        const auto sum_of = blend_of(eye);
        if (has_samples_) {
            prepare_samples(pack, count, corners, eye, sum_of);
        }
        if (has_vertices_) {
            prepare_vertices(pack, count, corners, sum_of);
        }
    }
    /// What gives, of numbers at the corners, their sum by the corners' weights.
    auto blend_of(const std::array<EyePoint<L>, 3>& eye) const {
        std::array<ClipPoint<L>, 3> clip;
        for (std::size_t c = 0; c < 3; ++c) {
            clip[c] =
                view_.to_clip(eye[c], L(static_cast<R>(left_) + R(0.5)), L(static_cast<R>(top_) + R(0.5)));
        }
        return [weights = corner_weights(clip)](auto&& of_corner) {
            return weights[0] * of_corner(0) + weights[1] * of_corner(1) + weights[2] * of_corner(2);
        };
    }
    /// The first `count` of these triangles.
    void prepare_lit(const Lit* lit, std::size_t count) {
        PackOfShown pack;
        std::array<std::array<const Vertex*, static_cast<std::size_t>(N)>, 3> vertices;
        for (std::size_t k = 0; k < pack.size(); ++k) {
            const Lit& one = lit[std::min(k, count - 1)];
            pack[k] = &shown_[one.number];
            for (std::size_t c = 0; c < 3; ++c) {
                vertices[c][k] = one.corners[c];
            }
        }
        std::array<EyePoint<L>, 3> eye;
        std::array<Seen<L>, 3> seen;
        for (std::size_t c = 0; c < 3; ++c) {
            gather_vertices(vertices[c], eye[c], seen[c]);
        }
        keep_colors(pack, count, seen, blend_of(eye));
    }
    template <class SumOf>
    void prepare_samples(const PackOfShown& pack, std::size_t count, const LitCorners<L>& corners,
                         const std::array<EyePoint<L>, 3>& eye, SumOf&& sum_of) {
        const auto keep = [&](std::size_t at, const Linear<L>& linear) {
            store(pack, count, true, at, linear);
        };
        keep(weight_sum, sum_of([](std::size_t) { return L(1); }));
        keep(first_normal, sum_of([&](std::size_t c) { return corners.normals[c].x; }));
        keep(first_normal + 3, sum_of([&](std::size_t c) { return corners.normals[c].y; }));
        keep(first_normal + 6, sum_of([&](std::size_t c) { return corners.normals[c].z; }));
        keep(finite_sum, sum_of([&](std::size_t c) { return eye[c].weight; }));
        keep(depth, sum_of([&](std::size_t c) { return eye[c].ahead; }));
        for (std::size_t k = 0; k < count; ++k) {
            const int i = static_cast<int>(k);
            pack[k]->geometric = {lane(corners.geometric.x, i), lane(corners.geometric.y, i),
                                  lane(corners.geometric.z, i)};
        }
    }
    template <class SumOf>
    void prepare_vertices(const PackOfShown& pack, std::size_t count, const LitCorners<L>& corners,
                          SumOf&& sum_of) {
        Mask active(false);
        for (std::size_t k = 0; k < count; ++k) {
            set_lane(active, static_cast<int>(k), !pack[k]->by_sample);
        }
        if (none(active)) {
            return;
        }
        if (shading_ == RasterShading::flat) {
            const Seen<L> seen = light_vertex(pack, corners, 2, active);
            for (std::size_t k = 0; k < count; ++k) {
                if (!pack[k]->by_sample) {
                    set_color(*pack[k], lane_of(seen.light, k), first_color);
                    set_color(*pack[k], lane_of(seen.transmit, k), first_transmit);
                }
            }
            return;
        }
        std::array<Seen<L>, 3> seen;
        for (std::size_t c = 0; c < 3; ++c) {
            seen[c] = light_vertex(pack, corners, c, active);
        }
        keep_colors(pack, count, seen, sum_of);
    }
    template <class SumOf>
    void keep_colors(const PackOfShown& pack, std::size_t count, const std::array<Seen<L>, 3>& seen,
                     SumOf&& sum_of) {
        const auto keep = [&](std::size_t at, auto&& of_corner) {
            store(pack, count, false, at, sum_of(of_corner));
        };
        keep(weight_sum, [](std::size_t) { return L(1); });
        keep(first_color, [&](std::size_t c) { return seen[c].light.r; });
        keep(first_color + 3, [&](std::size_t c) { return seen[c].light.g; });
        keep(first_color + 6, [&](std::size_t c) { return seen[c].light.b; });
        if constexpr (S::traits.transmission) {
            keep(first_transmit, [&](std::size_t c) { return seen[c].transmit.r; });
            keep(first_transmit + 3, [&](std::size_t c) { return seen[c].transmit.g; });
            keep(first_transmit + 6, [&](std::size_t c) { return seen[c].transmit.b; });
        }
    }
    static Rgb<R> lane_of(const Rgb<L>& color, std::size_t k) {
        const int i = static_cast<int>(k);
        return {lane(color.r, i), lane(color.g, i), lane(color.b, i)};
    }
    /// Of those that are, or are not, lit by samples.
    void store(const PackOfShown& pack, std::size_t count, bool by_sample, std::size_t at,
               const Linear<L>& linear) {
        for (std::size_t k = 0; k < count; ++k) {
            Shown& s = *pack[k];
            if (s.by_sample == by_sample) {
                const int i = static_cast<int>(k);
                s.numbers[at] = lane(linear.at, i);
                s.numbers[at + 1] = lane(linear.x, i);
                s.numbers[at + 2] = lane(linear.y, i);
            }
        }
    }

    /// Notes their materials, too.
    LitCorners<L> corners_of(const PackOfShown& pack) const {
        std::array<const RasterSurface<R>*, static_cast<std::size_t>(N)> surfaces;
        std::array<std::uint32_t, static_cast<std::size_t>(N)> ids;
        for (std::size_t k = 0; k < surfaces.size(); ++k) {
            surfaces[k] = pack[k]->surface;
            ids[k] = pack[k]->id;
        }
        const LitCorners<L> corners =
            lit_corners<S::traits.two_sided, L>(model_, scene_.meshes, surfaces, ids);
        for (std::size_t k = 0; k < surfaces.size(); ++k) {
            pack[k]->material = lane(corners.material, static_cast<int>(k));
        }
        return corners;
    }

    Seen<L> light_vertex(const PackOfShown& pack, const LitCorners<L>& corners, std::size_t c,
                         const Mask& active) const {
        const Vec3<L> normal = normalize(corners.normals[c]);
        SurfacePoint<L> point{};
        point.world = corners.points[c];
        const Vec3<L> dir = view_.direction_to(point.world);
        if constexpr (S::traits.functions) {
            const Groups groups = one_by_one(pack);
            const IndexOf<L> faceted =
                gather_index(groups, [](const Shown& s) { return s.surface->is_faceted ? 1U : 0U; });
            point.n = choose(faceted == IndexOf<L>(1U), corners.geometric, normal);
            const Ray<L> ray{point.world - dir, dir};
            lighting_.template finish<false>(hit_of(groups, L(1)), ray, active, point);
        }
        return lighting_.light(point, normal * corners.side, dir, corners.material, active);
    }
    Groups one_by_one(const PackOfShown& pack) const {
        Groups groups;
        for (int k = 0; k < N; ++k) {
            Mask lanes(false);
            set_lane(lanes, k, true);
            groups.add(lanes, static_cast<std::uint32_t>(pack[static_cast<std::size_t>(k)] - shown_.data()));
        }
        return groups;
    }

    const S& scene_;
    const RasterModel<R>& model_;
    const RasterView<R>& view_;
    const VertexLights<S, L>& lights_;
    RasterShading shading_;
    PointLighting<S, L> lighting_;
    std::vector<Shown> shown_;
    std::vector<std::uint32_t> to_prepare_;
    std::vector<Lit> lit_;
    const RasterSurface<R>* last_surface_ = nullptr;
    bool has_samples_ = false;  ///< something shown is lit at each sample
    bool has_vertices_ = false; ///< something shown is not
    int left_ = 0, top_ = 0;
};

} // namespace scc::runtime::raster
