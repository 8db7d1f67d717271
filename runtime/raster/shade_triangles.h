#pragma once

#include "runtime/raster/corner_weights.h"
#include "runtime/raster/corners.h"
#include "runtime/raster/light_points.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
    /// One for each lane, as add() gives them.
    using Numbers = std::array<std::uint32_t, static_cast<std::size_t>(N)>;

    TriangleShader(const S& scene, const RasterModel<R>& model, const RasterView<R>& view,
                   RasterShading shading)
        : scene_(scene), model_(model), view_(view), shading_(shading), lighting_(scene) {}

    /// The tile that begins at this sample.
    void start(int left, int top) {
        left_ = left;
        top_ = top;
        shown_.clear();
        to_prepare_.clear();
        has_samples_ = has_vertices_ = false;
    }
    /// A triangle, by its id (see screen_triangle.h); a number for it.
    std::uint32_t add(std::uint32_t id) {
        if (shading_ == RasterShading::hidden_line) {
            return add(Rgb<R>(scene_.background));
        }
        to_prepare_.push_back(static_cast<std::uint32_t>(shown_.size()));
        Shown& shown = shown_.emplace_back();
        shown.id = id;
        shown.surface = &surface_of_triangle(model_, id & triangle_number);
        shown.by_sample = shading_ == RasterShading::phong || shown.surface->at_infinity;
        (shown.by_sample ? has_samples_ : has_vertices_) = true;
        return to_prepare_.back();
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
        for (std::size_t i = 0; i < to_prepare_.size(); i += N) {
            Numbers numbers;
            const std::size_t count = std::min<std::size_t>(N, to_prepare_.size() - i);
            for (std::size_t k = 0; k < numbers.size(); ++k) {
                numbers[k] = to_prepare_[i + std::min(k, count - 1)];
            }
            prepare(numbers, count);
        }
    }

    /// At samples (column, row) of the tile. Inactive lanes have the number of some other.
    Seen<L> shade(const Numbers& numbers, const L& column, const L& row, const Mask& active) const {
        const bool alike = all_alike(numbers);
        if (!has_samples_) {
            return interpolate(numbers, alike, column, row);
        }
        if (!has_vertices_) {
            return shade_samples(numbers, alike, column, row, active);
        }
        Mask by_sample(false);
        for (int k = 0; k < N; ++k) {
            set_lane(by_sample, k, shown(numbers, k).by_sample);
        }
        by_sample = by_sample & active;
        const Seen<L> seen = interpolate(numbers, alike, column, row);
        if (none(by_sample)) {
            return seen;
        }
        Numbers lit = numbers;
        const std::uint32_t some = numbers[static_cast<std::size_t>(first_lane(by_sample))];
        for (int k = 0; k < N; ++k) {
            if (!shown(numbers, k).by_sample) {
                lit[static_cast<std::size_t>(k)] = some;
            }
        }
        return choose(by_sample, shade_samples(lit, all_alike(lit), column, row, by_sample), seen);
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
    Place place(const Numbers& numbers, const L& column, const L& row, const Mask& active) const {
        return place<wants_uv>(numbers, all_alike(numbers), column, row, active);
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

    const Shown& shown(const Numbers& numbers, int k) const {
        return shown_[numbers[static_cast<std::size_t>(k)]];
    }
    static bool all_alike(const Numbers& numbers) {
        return std::all_of(numbers.begin(), numbers.end(), [&](std::uint32_t n) { return n == numbers[0]; });
    }
    void set_color(std::size_t number, const Rgb<R>& color, std::size_t at) {
        auto& numbers = shown_[number].numbers;
        numbers[at] = color.r;
        numbers[at + 3] = color.g;
        numbers[at + 6] = color.b;
    }

    template <class Get>
    L gather(const Numbers& numbers, bool alike, Get&& get) const {
        if (alike) {
            return L(get(shown_[numbers[0]]));
        }
        R values[N];
        for (int k = 0; k < N; ++k) {
            values[k] = get(shown(numbers, k));
        }
        return from_lanes(values);
    }
    static L from_lanes(const R* values) {
        L result;
        std::memcpy(&result.v, values, sizeof result.v);
        return result;
    }
    template <class Get>
    IndexOf<L> gather_index(const Numbers& numbers, Get&& get) const {
        typename IndexOf<L>::Number values[N];
        for (int k = 0; k < N; ++k) {
            values[k] = get(shown(numbers, k));
        }
        IndexOf<L> result;
        std::memcpy(&result.v, values, sizeof result.v);
        return result;
    }
    /// The value of the Linear at `at`.
    L value(const Numbers& numbers, bool alike, std::size_t at, const L& column, const L& row) const {
        const auto number = [&](std::size_t i) {
            return gather(numbers, alike, [=](const Shown& s) { return s.numbers[i]; });
        };
        return number(at) + number(at + 1) * column + number(at + 2) * row;
    }

    /// Colours at vertices, or of faces.
    Seen<L> interpolate(const Numbers& numbers, bool alike, const L& column, const L& row) const {
        const L scale = L(1) / value(numbers, alike, weight_sum, column, row);
        const auto color = [&](std::size_t at) {
            return Rgb<L>{value(numbers, alike, at, column, row), value(numbers, alike, at + 3, column, row),
                          value(numbers, alike, at + 6, column, row)} *
                   scale;
        };
        Seen<L> seen{color(first_color), {L(0), L(0), L(0)}};
        if constexpr (S::traits.transmission) {
            seen.transmit = color(first_transmit);
        }
        return seen;
    }

    Seen<L> shade_samples(const Numbers& numbers, bool alike, const L& column, const L& row,
                          const Mask& active) const {
        const Place at = place<false>(numbers, alike, column, row, active);
        return lighting_.light(at.point, at.normal, at.dir, at.material, active);
    }

    template <bool wants_uv>
    Place place(const Numbers& numbers, bool alike, const L& column, const L& row, const Mask& active) const {
        const auto linear = [&](std::size_t at) { return value(numbers, alike, at, column, row); };
        Place result;
        const Ray<L> ray = view_.ray_through(column + L(static_cast<R>(left_) + R(0.5)),
                                             row + L(static_cast<R>(top_) + R(0.5)));
        result.dir = ray.dir;
        result.ahead = linear(depth) / linear(finite_sum);
        result.point.world = ray.org + ray.dir * result.ahead;
        const auto geometric = [&](auto component) {
            return gather(numbers, alike, [=](const Shown& s) { return s.geometric.*component; });
        };
        result.point.n = {geometric(&Vec3<R>::x), geometric(&Vec3<R>::y), geometric(&Vec3<R>::z)};
        // Seen from behind, all weights are negative.
        const L side = choose(linear(weight_sum) < 0, L(-1), L(1));
        const Vec3<L> sum =
            Vec3<L>{linear(first_normal), linear(first_normal + 3), linear(first_normal + 6)} * side;
        const L squared = dot(sum, sum);
        const Vec3<L> normal = choose(squared > 0, sum * (L(1) / square_root(squared)), result.point.n);
        result.normal = choose(dot(normal, ray.dir) > 0, -normal, normal);
        result.material = gather_index(numbers, [](const Shown& s) { return s.material; });
        if constexpr (S::traits.functions || wants_uv) {
            const IndexOf<L> faceted =
                gather_index(numbers, [](const Shown& s) { return s.surface->is_faceted ? 1U : 0U; });
            result.point.n = choose(faceted == IndexOf<L>(1U), result.point.n, normal);
            lighting_.template finish<wants_uv>(hit_of(numbers, result.ahead), ray, active, result.point);
        }
        return result;
    }
    Hit<L> hit_of(const Numbers& numbers, const L& t) const {
        Hit<L> hit;
        hit.shape.t = t;
        hit.shape.part = gather_index(numbers, [&](const Shown& s) {
            return part_of_triangle(model_, *s.surface, (s.id & triangle_number) - s.surface->first);
        });
        hit.kind = gather_index(numbers, [](const Shown& s) { return s.surface->kind; });
        hit.index = gather_index(numbers, [](const Shown& s) { return s.surface->index; });
        return hit;
    }

    /// Several triangles' corners in the world.
    struct Corners3 {
        std::array<Vec3<L>, 3> points;
        std::array<L, 3> weights;
        std::array<Vec3<L>, 3> normals;
        Vec3<L> geometric; ///< on the front side
    };

    /// The first `count` of these triangles.
    void prepare(const Numbers& numbers, std::size_t count) {
        const Corners3 corners = corners_of(numbers);
        std::array<EyePoint<L>, 3> eye;
        std::array<ClipPoint<L>, 3> clip;
        for (std::size_t c = 0; c < 3; ++c) {
            eye[c] = view_.to_eye(corners.points[c], corners.weights[c]);
            clip[c] =
                view_.to_clip(eye[c], L(static_cast<R>(left_) + R(0.5)), L(static_cast<R>(top_) + R(0.5)));
        }
        const std::array<Linear<L>, 3> weights = corner_weights(clip);
        for (std::size_t k = 0; k < count; ++k) {
            Shown& s = shown_[numbers[k]];
            const bool back = S::traits.two_sided && (s.id & seen_from_back) != 0;
            s.material = back ? s.surface->sides.back : s.surface->sides.front;
        }
        const auto sum_of = [&](auto&& of_corner) {
            return weights[0] * of_corner(0) + weights[1] * of_corner(1) + weights[2] * of_corner(2);
        };
        if (has_samples_) {
            prepare_samples(numbers, count, corners, eye, sum_of);
        }
        if (has_vertices_) {
            prepare_vertices(numbers, count, corners, sum_of);
        }
    }
    template <class SumOf>
    void prepare_samples(const Numbers& numbers, std::size_t count, const Corners3& corners,
                         const std::array<EyePoint<L>, 3>& eye, SumOf&& sum_of) {
        const auto keep = [&](std::size_t at, const Linear<L>& linear) {
            store(numbers, count, true, at, linear);
        };
        keep(weight_sum, sum_of([](std::size_t) { return L(1); }));
        keep(first_normal, sum_of([&](std::size_t c) { return corners.normals[c].x; }));
        keep(first_normal + 3, sum_of([&](std::size_t c) { return corners.normals[c].y; }));
        keep(first_normal + 6, sum_of([&](std::size_t c) { return corners.normals[c].z; }));
        keep(finite_sum, sum_of([&](std::size_t c) { return eye[c].weight; }));
        keep(depth, sum_of([&](std::size_t c) { return eye[c].ahead; }));
        for (std::size_t k = 0; k < count; ++k) {
            const int i = static_cast<int>(k);
            shown_[numbers[k]].geometric = {lane(corners.geometric.x, i), lane(corners.geometric.y, i),
                                            lane(corners.geometric.z, i)};
        }
    }
    template <class SumOf>
    void prepare_vertices(const Numbers& numbers, std::size_t count, const Corners3& corners,
                          SumOf&& sum_of) {
        Mask active(false);
        for (std::size_t k = 0; k < count; ++k) {
            set_lane(active, static_cast<int>(k), !shown_[numbers[k]].by_sample);
        }
        if (none(active)) {
            return;
        }
        if (shading_ == RasterShading::flat) {
            const Seen<L> seen = light_vertex(numbers, corners, 2, active);
            for (std::size_t k = 0; k < count; ++k) {
                if (!shown_[numbers[k]].by_sample) {
                    set_color(numbers[k], lane_of(seen.light, k), first_color);
                    set_color(numbers[k], lane_of(seen.transmit, k), first_transmit);
                }
            }
            return;
        }
        std::array<Seen<L>, 3> seen;
        for (std::size_t c = 0; c < 3; ++c) {
            seen[c] = light_vertex(numbers, corners, c, active);
        }
        const auto keep = [&](std::size_t at, auto&& of_corner) {
            store(numbers, count, false, at, sum_of(of_corner));
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
    void store(const Numbers& numbers, std::size_t count, bool by_sample, std::size_t at,
               const Linear<L>& linear) {
        for (std::size_t k = 0; k < count; ++k) {
            Shown& s = shown_[numbers[k]];
            if (s.by_sample == by_sample) {
                const int i = static_cast<int>(k);
                s.numbers[at] = lane(linear.at, i);
                s.numbers[at + 1] = lane(linear.x, i);
                s.numbers[at + 2] = lane(linear.y, i);
            }
        }
    }

    Corners3 corners_of(const Numbers& numbers) const {
        R values[22][N];
        for (int k = 0; k < N; ++k) {
            const Shown& s = shown(numbers, k);
            const std::uint32_t i = (s.id & triangle_number) - s.surface->first;
            const WorldTriangle<R> t = world_triangle(model_, scene_.meshes, *s.surface, i);
            for (std::size_t c = 0; c < 3; ++c) {
                values[4 * c][k] = t.corners[c].x;
                values[4 * c + 1][k] = t.corners[c].y;
                values[4 * c + 2][k] = t.corners[c].z;
                values[4 * c + 3][k] = t.weights[c];
            }
            const auto normals = world_normals(model_, scene_.meshes, *s.surface, i);
            for (std::size_t c = 0; c < 3; ++c) {
                values[12 + 3 * c][k] = normals[c].x;
                values[13 + 3 * c][k] = normals[c].y;
                values[14 + 3 * c][k] = normals[c].z;
            }
            values[21][k] = s.surface->is_mirrored ? R(-1) : R(1);
        }
        Corners3 result;
        const auto vector = [&](std::size_t n) {
            return Vec3<L>{from_lanes(values[n]), from_lanes(values[n + 1]), from_lanes(values[n + 2])};
        };
        for (std::size_t c = 0; c < 3; ++c) {
            result.points[c] = vector(4 * c);
            result.weights[c] = from_lanes(values[4 * c + 3]);
            result.normals[c] = vector(12 + 3 * c);
        }
        const auto edge = [&](std::size_t c) {
            return result.points[c] - result.points[0] * result.weights[c];
        };
        result.geometric = normalize(cross(edge(1), edge(2))) * from_lanes(values[21]);
        for (Vec3<L>& normal : result.normals) { // those that a mesh lacks
            const Mask missing = (normal.x == 0) & (normal.y == 0) & (normal.z == 0);
            normal = choose(missing, result.geometric, normal);
        }
        return result;
    }

    Seen<L> light_vertex(const Numbers& numbers, const Corners3& corners, std::size_t c,
                         const Mask& active) const {
        const L side = gather(numbers, false,
                              [](const Shown& s) { return (s.id & seen_from_back) != 0 ? R(-1) : R(1); });
        const Vec3<L> normal = normalize(corners.normals[c]);
        SurfacePoint<L> point{};
        point.world = corners.points[c];
        const Vec3<L> dir = view_.direction_to(point.world);
        if constexpr (S::traits.functions) {
            const IndexOf<L> faceted =
                gather_index(numbers, [](const Shown& s) { return s.surface->is_faceted ? 1U : 0U; });
            point.n = choose(faceted == IndexOf<L>(1U), corners.geometric, normal);
            const Ray<L> ray{point.world - dir, dir};
            lighting_.template finish<false>(hit_of(numbers, L(1)), ray, active, point);
        }
        const IndexOf<L> material = gather_index(numbers, [](const Shown& s) { return s.material; });
        return lighting_.light(point, normal * side, dir, material, active);
    }

    const S& scene_;
    const RasterModel<R>& model_;
    const RasterView<R>& view_;
    RasterShading shading_;
    PointLighting<S, L> lighting_;
    std::vector<Shown> shown_;
    std::vector<std::uint32_t> to_prepare_;
    bool has_samples_ = false;  ///< something shown is lit at each sample
    bool has_vertices_ = false; ///< something shown is not
    int left_ = 0, top_ = 0;
};

} // namespace scc::runtime::raster
