#pragma once

#include "runtime/accel/beam.h"
#include "runtime/accel/bvh.h"
#include "runtime/mesh_data.h"
#include "runtime/shapes/triangle_test.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

namespace scc::runtime {

template <class R>
Vec3<R> read_vector(const float* numbers, std::uint32_t index) {
    const float* v = numbers + std::size_t{3} * index;
    return {R(v[0]), R(v[1]), R(v[2])};
}

inline Bounds<float> bounds_of(const MeshData& mesh) {
    return {{mesh.min[0], mesh.min[1], mesh.min[2]}, {mesh.max[0], mesh.max[1], mesh.max[2]}};
}

/// The corners of triangles of one leaf, from `place` on: as many as L has lanes, of which those beyond the
/// leaf have any numbers.
template <class L>
Corners<L> corners_at(const MeshData& mesh, const TrianglePlace& place) {
    const float* word = triangle_word(mesh, place, 0);
    const auto next = [&] { return load_lanes<L>(std::exchange(word, word + place.count)); };
    return {{next(), next(), next()}, {next(), next(), next()}, {next(), next(), next()}};
}

inline void prefetch_leaf(const MeshData& mesh, const BvhLeaf& leaf) {
    prefetch_bytes(mesh.triangles + words_per_triangle * leaf.first,
                   words_per_triangle * leaf.count * sizeof(float));
}

/// t, moved to where the ray is in the triangle's box if rounding put it outside (a ray along the triangle).
/// So no box around it begins after the hit, and the hierarchy finds the same hit as a test of every
/// triangle. The lanes are those of the rays or, for a single ray, of the triangles.
template <class L, class V, class RayLanes>
L put_into_box(const L& t, const Corners<V>& corners, const SlabRay<RayLanes>& slabs, const L& t_min,
               MaskOf<L>& met) {
    const Vec3<V> min = minimum(minimum(corners.a, corners.b), corners.c);
    const Vec3<V> max = maximum(maximum(corners.a, corners.b), corners.c);
    const L low[3] = {L(min.x), L(min.y), L(min.z)}, high[3] = {L(max.x), L(max.y), L(max.z)};
    const auto range = slabs.range(low, high);
    const L inside = minimum(maximum(t, range.near), range.far);
    met = met & (t >= t_min) & (t < infinity<L>()) & (range.near <= range.far) & (inside >= t_min);
    return inside;
}

namespace detail {

/// As many triangles of a leaf as are tested against a ray at once.
template <class R>
struct TriangleLanes {
    using type = Pack<R, bvh_max_leaf>;
};
template <class R>
requires(sizeof(R) > sizeof(double)) struct TriangleLanes<R> {
    using type = R;
};

/// The search of packs whose rays go by themselves.
template <bool AnyHit, class L>
class RaysInMesh {
public:
    using R = RealOf<L>;

    explicit RaysInMesh(const MeshData& mesh) : mesh_(mesh) {}

    /// `hit` stays where it is until run().
    void add(const Ray<L>& ray, ShapeHit<L>& hit) {
        const std::size_t first = count_ * width;
        const Bounds<float> box = bounds_of(mesh_);
        Pack& pack = packs_[count_++];
        pack.slabs.emplace(ray, Bounds<R>{lanes<R>(box.min), lanes<R>(box.max)});
        pack.hit = &hit;
        pack.best_id = Index(~0U);
        const L* numbers[6] = {&ray.org.x, &ray.org.y, &ray.org.z, &ray.dir.x, &ray.dir.y, &ray.dir.z};
        for (std::size_t i = 0; i < 6; ++i) {
            store_lanes(lines_[i] + first, *numbers[i]);
        }
        store_lanes(t_min_ + first, ray.t_min);
        store_lanes(nearest_ + first, ray.t_max);
        store_lanes(tolerance_ + first,
                    tolerance_per_size(largest_component(absolute(ray.dir)), pack.slabs->reach()));
        turns_.add(first, *pack.slabs, ray.t_min, is_active(ray));
        if (count_ == most) {
            run();
        }
    }

    void run() {
        turns_.run(mesh_.nodes, nearest_, [&](std::size_t ray, std::uint32_t first, std::uint32_t count) {
            bool found = false;
            for (std::uint32_t i = 0; i < count; i += lane_count<T>) {
                found |= test(ray, {first, count, i});
            }
            return AnyHit && found;
        });
        count_ = 0;
    }

private:
    using Index = IndexOf<L>;
    using T = typename TriangleLanes<R>::type;

    static constexpr std::size_t width = lane_count<L>;
    /// Packs at once: enough rays that their turns are long.
    static constexpr std::size_t most = width == 1 ? 1 : std::min<std::size_t>(64 / width, most_packs);
    static constexpr std::size_t rays = most * width;

    struct Pack {
        std::optional<SlabRay<L>> slabs;
        ShapeHit<L>* hit;
        Index best_id;
    };

    Vec3<T> org(std::size_t ray) const { return {T(lines_[0][ray]), T(lines_[1][ray]), T(lines_[2][ray])}; }
    Vec3<T> dir(std::size_t ray) const { return {T(lines_[3][ray]), T(lines_[4][ray]), T(lines_[5][ray])}; }

    /// The lanes that are triangles from `place` on and not what comes after the leaf.
    static unsigned present(const MaskOf<T>& lanes, const TrianglePlace& place) {
        return bits(lanes) & ((1U << (place.count - place.which)) - 1);
    }

    /// Whether the ray meets one. Most triangles of a leaf are behind the ray or beside it.
    bool test(std::size_t ray, const TrianglePlace& place) {
        const Corners<T> corners = corners_at<T>(mesh_, place);
        const Vec3<T> to_a = corners.a - org(ray);
        const T t = distance_to_plane(plane_normal(corners), to_a, dir(ray));
        const MaskOf<T> ahead = t >= T(t_min_[ray]);
        if (present(ahead, place) == 0) {
            return false;
        }
        const MaskOf<T> candidates = ahead & may_pass_through(corners, to_a, dir(ray), T(tolerance_[ray]));
        return present(candidates, place) != 0 && test_exactly(ray, place, t, candidates);
    }

    [[gnu::noinline]] bool test_exactly(std::size_t ray, const TrianglePlace& place, const T& distance,
                                        const MaskOf<T>& candidates) {
        const Corners<T> corners = corners_at<T>(mesh_, place);
        const Vec3<T> direction = dir(ray);
        const Corners<T> relative = relative_to(org(ray), corners);
        const EdgeFunctions<T> edges(TriangleView<T>(relative), direction,
                                     largest_component(absolute(direction)));
        MaskOf<T> met =
            edges.pass(candidates & edges.may_pass(), direction, [&](int i) { return lane(relative, i); });
        const SlabRay<R> slabs = lane(*packs_[ray / width].slabs, static_cast<int>(ray % width));
        const T t = put_into_box(distance, corners, slabs, T(t_min_[ray]), met);
        bool found = false;
        for (unsigned left = present(met, place); left != 0; left &= left - 1) {
            const int i = __builtin_ctz(left);
            found |= keep(ray, lane(t, i),
                          {place.first, place.count, place.which + static_cast<std::uint32_t>(i)});
        }
        return found;
    }

    bool keep(std::size_t ray, R t, const TrianglePlace& place) {
        if (!(t <= nearest_[ray])) {
            return false;
        }
        Pack& pack = packs_[ray / width];
        const auto in_pack = static_cast<int>(ray % width);
        const std::uint32_t id = triangle_id(mesh_, place);
        if (t < nearest_[ray] || id < lane(pack.best_id, in_pack)) {
            nearest_[ray] = t;
            set_lane(pack.hit->t, in_pack, t);
            set_lane(pack.hit->part, in_pack, part_of(place));
            set_lane(pack.best_id, in_pack, id);
        }
        return true;
    }

    const MeshData& mesh_;
    std::size_t count_ = 0;
    std::array<Pack, most> packs_;
    alignas(64) R lines_[6][rays]; ///< origins and directions
    R t_min_[rays], nearest_[rays], tolerance_[rays];
    RaysInTurns<R, static_cast<int>(rays)> turns_;
};

/// The search of packs that run alike.
template <bool AnyHit, class L>
class BeamInMesh {
public:
    using R = RealOf<L>;
    using Index = IndexOf<L>;

    BeamInMesh(const MeshData& mesh, std::span<Ray<L>> rays, Apex apex, std::span<ShapeHit<L>> hits,
               BeamSet<L>& beams)
        : mesh_(mesh), rays_(rays), apex_(apex), hits_(hits), beams_(beams) {
        const Bounds<float> box = bounds_of(mesh);
        const Bounds<R> root{lanes<R>(box.min), lanes<R>(box.max)};
        for (std::size_t i = 0; i < rays.size(); ++i) {
            packs_[i].slabs.emplace(rays[i], root);
            packs_[i].dir_size = largest_component(absolute(rays[i].dir));
        }
        point_ = beams.apex_point(rays);
        reach_ = static_cast<R>(beams.scale());
    }

    void run() {
        traverse_beams(
            mesh_.nodes, beams_, [&](const BvhLeaf& leaf) { prefetch_leaf(mesh_, leaf); },
            [&](unsigned packs, const Bounds<float>& box, std::uint32_t first, std::uint32_t count) {
                if (apex_ == Apex::origin) {
                    test_from_apex(packs, first, count);
                } else if (apex_ == Apex::end) {
                    test_to_apex(packs_through(box, packs), first, count);
                } else {
                    test_from_anywhere(packs_through(box, packs), first, count);
                }
                return false;
            });
    }

private:
    struct Pack {
        std::optional<SlabRay<L>> slabs;
        L dir_size;
        Index best_id{~0U};
    };

    using T = runtime::Pack<R, bvh_max_leaf>;

    /// The leaf's triangles as seen from one point, one by one; what is beyond them in the leaf's lanes no
    /// ray passes through.
    class Views {
    public:
        Views(const TriangleView<T>& views, std::uint32_t count) {
            const T* parts[10] = {&views.a.x, &views.a.y, &views.a.z, &views.b.x, &views.b.y,
                                  &views.b.z, &views.c.x, &views.c.y, &views.c.z, &views.tolerance};
            for (std::size_t i = 0; i < 10; ++i) {
                store_lanes(numbers_[i], *parts[i]);
            }
            for (std::uint32_t i = count; i < bvh_max_leaf; ++i) {
                numbers_[9][i] = -infinity<R>();
            }
        }
        TriangleView<R> operator[](std::uint32_t i) const {
            TriangleView<R> view;
            view.a = {numbers_[0][i], numbers_[1][i], numbers_[2][i]};
            view.b = {numbers_[3][i], numbers_[4][i], numbers_[5][i]};
            view.c = {numbers_[6][i], numbers_[7][i], numbers_[8][i]};
            view.tolerance = numbers_[9][i];
            return view;
        }

    private:
        alignas(64) R numbers_[10][bvh_max_leaf];
    };

    /// f(pack, place, edge functions, lanes that may pass) for the packs and the leaf's triangles.
    template <class F>
    void for_each_candidate(const Views& views, unsigned packs, std::uint32_t first, std::uint32_t count,
                            F&& f) {
        for (; packs != 0; packs &= packs - 1) {
            const auto pack = static_cast<std::size_t>(__builtin_ctz(packs));
            const Vec3<L>& dir = rays_[pack].dir;
            const L& dir_size = packs_[pack].dir_size;
            for (std::uint32_t i = 0; i < count; i += 2) { // two at a time, since each takes long to decide
                const EdgeFunctions<L> one(views[i], dir, dir_size), other(views[i + 1], dir, dir_size);
                const MaskOf<L> by_one = one.may_pass(), by_other = other.may_pass();
                if (none(by_one | by_other)) {
                    continue;
                }
                if (any(by_one)) {
                    f(pack, TrianglePlace{first, count, i}, one, by_one);
                }
                if (any(by_other)) {
                    f(pack, TrianglePlace{first, count, i + 1}, other, by_other);
                }
            }
        }
    }

    /// Those of the packs of which a ray meets the box. Where triangles are small, rays that do not start at
    /// one point leave much room between them, and most of what their beam meets lies there.
    unsigned packs_through(const Bounds<float>& box, unsigned packs) const {
        const Vec3<L> low = lanes<L>(lanes<R>(box.min)), high = lanes<L>(lanes<R>(box.max));
        const L min[3] = {low.x, low.y, low.z}, max[3] = {high.x, high.y, high.z};
        unsigned through = 0;
        for (; packs != 0; packs &= packs - 1) {
            const auto pack = static_cast<std::size_t>(__builtin_ctz(packs));
            const auto range = packs_[pack].slabs->range(min, max);
            const Ray<L>& ray = rays_[pack];
            if (any(maximum(range.near, ray.t_min) <= minimum(range.far, ray.t_max))) {
                through |= packs & -packs;
            }
        }
        return through;
    }

    /// What rays from one point see of a leaf's triangles is calculated once for all rays, for all triangles
    /// at once.
    void test_from_apex(unsigned packs, std::uint32_t first, std::uint32_t count) {
        const Corners<T> relative = relative_to(lanes<T>(point_), corners_at<T>(mesh_, {first, count, 0}));
        const Views views(TriangleView<T>(relative), count);
        for_each_candidate(views, packs, first, count,
                           [&](std::size_t pack, const TrianglePlace& place, const EdgeFunctions<L>& edges,
                               const MaskOf<L>& candidates) {
                               const Corners<R> corners = corners_at<R>(mesh_, place);
                               const Vec3<L>& dir = rays_[pack].dir;
                               const MaskOf<L> met = edges.pass(
                                   candidates, dir, [&](int) { return relative_to(point_, corners); });
                               keep(pack, place, corners,
                                    distance_to_plane(plane_normal(corners), corners.a - point_, dir), met);
                           });
    }

    /// Rays to one point. Most triangles lie on the surface that the rays leave, so that their planes are
    /// behind the rays' starts; and what is seen of the others from the end tells most rays that they miss.
    void test_to_apex(unsigned packs, std::uint32_t first, std::uint32_t count) {
        const Corners<T> corners = corners_at<T>(mesh_, {first, count, 0});
        std::optional<Views> views; // of most leaves none is needed
        const Vec3<T> normals = plane_normal(corners);
        R planes[6][bvh_max_leaf];
        const T* parts[6] = {&normals.x, &normals.y, &normals.z, &corners.a.x, &corners.a.y, &corners.a.z};
        for (int i = 0; i < 6; ++i) {
            store_lanes(planes[i], *parts[i]);
        }
        for (; packs != 0; packs &= packs - 1) {
            const auto pack = static_cast<std::size_t>(__builtin_ctz(packs));
            const Ray<L>& ray = rays_[pack];
            for (std::uint32_t i = 0; i < count; ++i) {
                const Vec3<L> n = lanes<L>(Vec3<R>{planes[0][i], planes[1][i], planes[2][i]});
                const Vec3<L> a = lanes<L>(Vec3<R>{planes[3][i], planes[4][i], planes[5][i]});
                const L distance = dot(n, a - ray.org), slope = dot(n, ray.dir);
                const MaskOf<L> ahead = ((distance >= 0) & (slope > 0)) | ((distance <= 0) & (slope < 0));
                if (none(ahead)) {
                    continue;
                }
                if (!views) {
                    TriangleView<T> seen(relative_to(lanes<T>(point_), corners));
                    seen.tolerance = loose_tolerance(corners);
                    views.emplace(seen, count);
                }
                const EdgeFunctions<L> edges((*views)[i], ray.dir, packs_[pack].dir_size);
                if (any(ahead & edges.may_pass())) {
                    test(pack, {first, count, i});
                }
            }
        }
    }

    /// Enough for whatever rounding makes of the corners as seen from the rays' origins and from their end:
    /// either may move by a few roundings of `reach_`, and the edge functions of a ray that is within `size`
    /// of the triangle by that times `size` (an edge function is an edge's product with the line's moment
    /// about its ends, which is then so small).
    T loose_tolerance(const Corners<T>& corners) const {
        const T size = largest_component(maximum(maximum(corners.a, corners.b), corners.c) -
                                         minimum(minimum(corners.a, corners.b), corners.c));
        return 512 * roundoff<T>() * size * T(reach_);
    }

    void test_from_anywhere(unsigned packs, std::uint32_t first, std::uint32_t count) {
        for (; packs != 0; packs &= packs - 1) {
            for (std::uint32_t i = 0; i < count; ++i) {
                test(static_cast<std::size_t>(__builtin_ctz(packs)), {first, count, i});
            }
        }
    }

    void test(std::size_t pack, const TrianglePlace& place) {
        const Ray<L>& ray = rays_[pack];
        const Corners<R> one = corners_at<R>(mesh_, place);
        const Corners<L> corners{lanes<L>(one.a), lanes<L>(one.b), lanes<L>(one.c)};
        const Corners<L> relative = relative_to(ray.org, corners);
        const L t = distance_to_plane(plane_normal(one), relative.a, ray.dir);
        MaskOf<L> candidates = is_active(ray) & (t >= ray.t_min); // not the triangle that the ray leaves
        if (none(candidates)) {
            return;
        }
        const EdgeFunctions<L> edges(TriangleView<L>(relative), ray.dir, packs_[pack].dir_size);
        candidates = candidates & edges.may_pass();
        if (any(candidates)) {
            keep(pack, place, one, t,
                 edges.pass(candidates, ray.dir, [&](int i) { return lane(relative, i); }));
        }
    }

    void keep(std::size_t pack, const TrianglePlace& place, const Corners<R>& corners, const L& distance,
              MaskOf<L> met) {
        Ray<L>& ray = rays_[pack];
        const L t = put_into_box(distance, corners, *packs_[pack].slabs, ray.t_min, met);
        const Index id(triangle_id(mesh_, place));
        Index& best_id = packs_[pack].best_id;
        const MaskOf<L> found = met & ((t < ray.t_max) | ((t == ray.t_max) & (id < best_id)));
        if (none(found)) {
            return;
        }
        hits_[pack].t = choose(found, t, hits_[pack].t);
        hits_[pack].part = choose(found, Index(part_of(place)), hits_[pack].part);
        best_id = choose(found, id, best_id);
        ray.t_max = choose(found, AnyHit ? -infinity<L>() : t, ray.t_max);
        beams_.shorten(static_cast<int>(pack), ray);
    }

    const MeshData& mesh_;
    std::span<Ray<L>> rays_;
    Apex apex_;
    std::span<ShapeHit<L>> hits_;
    BeamSet<L>& beams_;
    std::array<Pack, most_packs> packs_;
    Vec3<R> point_; ///< the apex
    R reach_;       ///< no coordinate of the mesh or of a ray is larger
};

} // namespace detail

/// The nearest hit of each active ray, or with AnyHit some hit. A hit's part is the triangle's place. The
/// rays' t_max may end anywhere; hits[i] must be as initialised.
template <bool AnyHit, class L>
void intersect_mesh(const MeshData& mesh, std::span<Ray<L>> rays, Apex apex, std::span<ShapeHit<L>> hits) {
    if (mesh.node_count == 0 || rays.empty()) {
        return;
    }
    const auto trace_as_beam = [&]([[maybe_unused]] std::size_t first, [[maybe_unused]] std::size_t count) {
        if constexpr (lane_count<L> == 1) {
            return false;
        } else {
            BeamSet<L> beams;
            const std::span<Ray<L>> packs = rays.subspan(first, count);
            if (!beams.gather(packs, apex, bounds_of(mesh))) {
                return false;
            }
            detail::BeamInMesh<AnyHit, L>(mesh, packs, apex, hits.subspan(first, count), beams).run();
            return true;
        }
    };
    if (trace_as_beam(0, rays.size())) {
        return;
    }
    detail::RaysInMesh<AnyHit, L> singly(mesh);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (rays.size() == 1 || !trace_as_beam(i, 1)) {
            singly.add(rays[i], hits[i]);
        }
    }
    singly.run();
}

namespace detail {

/// Three vectors of each lane's triangle; zeros where not `needed`. `read` gives those of one part.
template <class L, class Read>
Corners<L> gather_corners(const IndexOf<L>& part, const MaskOf<L>& needed, Read&& read) {
    using R = RealOf<L>;
    Corners<L> result{};
    const auto put = [](Vec3<L>& to, int i, const Vec3<R>& from) {
        set_lane(to.x, i, from.x);
        set_lane(to.y, i, from.y);
        set_lane(to.z, i, from.z);
    };
    for (unsigned left = bits(needed); left != 0; left &= left - 1) {
        const int i = __builtin_ctz(left);
        const Corners<R> one = read(place_of(lane(part, i)));
        put(result.a, i, one.a);
        put(result.b, i, one.b);
        put(result.c, i, one.c);
    }
    return result;
}

} // namespace detail

namespace detail {

/// Where a ray meets a triangle.
template <class R>
struct MeshCrossing {
    R t;
    bool outwards; ///< from behind
    std::uint32_t part, id;

    friend bool operator<(const MeshCrossing& a, const MeshCrossing& b) {
        return a.t < b.t || (a.t == b.t && a.id < b.id);
    }
};

/// All of them in the ray's range, in their order along it. A thread has one list for each R.
template <class R>
std::span<const MeshCrossing<R>> mesh_crossings(const MeshData& mesh, const Ray<R>& ray) {
    thread_local std::vector<MeshCrossing<R>> list;
    list.clear();
    if (mesh.node_count == 0) {
        return list;
    }
    const Bounds<float> box = bounds_of(mesh);
    const SlabRay<R> slabs(ray, Bounds<R>{lanes<R>(box.min), lanes<R>(box.max)});
    const R dir_size = largest_component(absolute(ray.dir));
    RaysInTurns<R, 1> search;
    search.add(0, slabs, ray.t_min, true);
    search.run(mesh.nodes, &ray.t_max, [&](std::size_t, std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t which = 0; which < count; ++which) {
            const TrianglePlace place{first, count, which};
            const Corners<R> corners = corners_at<R>(mesh, place), relative = relative_to(ray.org, corners);
            const EdgeFunctions<R> edges(TriangleView<R>(relative), ray.dir, dir_size);
            bool met = edges.may_pass() && edges.pass(true, ray.dir, [&](int) { return relative; });
            const Vec3<R> normal = plane_normal(corners);
            const R t =
                put_into_box(distance_to_plane(normal, relative.a, ray.dir), corners, slabs, ray.t_min, met);
            if (met && t <= ray.t_max) {
                list.push_back({t, dot(normal, ray.dir) > 0, part_of(place), triangle_id(mesh, place)});
            }
        }
        return false;
    });
    std::sort(list.begin(), list.end());
    return list;
}

/// How often a ray leaves the mesh more than it enters it where these, one behind the other by no more than
/// rounding, are: triangles that face to the same side have an edge in common there, and one that is left
/// behind one that is entered makes an outline.
template <class R>
int excess_of(std::span<const MeshCrossing<R>> group) {
    const auto any = [&](bool outwards) {
        return std::any_of(group.begin(), group.end(), [&](const auto& c) { return c.outwards == outwards; });
    };
    return static_cast<int>(any(true)) - static_cast<int>(any(false));
}

/// f(crossings, of which the rest is none) for those that are one, until it returns true.
template <class R, class F>
void for_each_crossing(std::span<const MeshCrossing<R>> list, const Ray<R>& ray, F&& f) {
    const R away = largest_component(absolute(ray.org)) / largest_component(absolute(ray.dir));
    for (std::size_t i = 0; i < list.size();) {
        const R limit = list[i].t + 8 * roundoff<R>() * (away + std::abs(list[i].t));
        const std::size_t begin = i;
        while (i < list.size() && list[i].t <= limit) {
            ++i;
        }
        if (f(list.subspan(begin, i - begin))) {
            return;
        }
    }
}

} // namespace detail

/// Where each active ray next enters or leaves what the mesh's triangles, which close it, have behind them:
/// once or, where the mesh overlaps itself, several times.
template <class L>
Crossing<L> cross_mesh(const MeshData& mesh, const Ray<L>& rays) {
    using R = RealOf<L>;
    Crossing<L> result{{}, MaskOf<L>(false)};
    for (unsigned left = bits(is_active(rays)); left != 0; left &= left - 1) {
        const int i = __builtin_ctz(left);
        const Ray<R> ray = lane(rays, i);
        const auto crossings = detail::mesh_crossings(mesh, ray);
        int depth = 0; // in how many layers of the mesh the ray is
        detail::for_each_crossing(crossings, ray, [&](const auto& group) {
            depth += detail::excess_of(group);
            return false;
        });
        detail::for_each_crossing(crossings, ray, [&](const auto& group) {
            const bool inside = depth > 0;
            depth -= detail::excess_of(group);
            if (inside == (depth > 0)) {
                return false;
            }
            const auto met = std::find_if(group.begin(), group.end(),
                                          [&](const auto& crossing) { return crossing.outwards == inside; });
            set_lane(result.hit.t, i, met->t);
            set_lane(result.hit.part, i, met->part);
            set_lane(result.outwards, i, inside);
            return true;
        });
    }
    return result;
}

/// Of the lanes in `needed`, which have hit this mesh.
template <bool SmoothNormals, class L>
Surface<L> mesh_surface(const MeshData& mesh, const Ray<L>& ray, const ShapeHit<L>& hit,
                        const MaskOf<L>& needed) {
    using R = RealOf<L>;
    const Corners<L> corners = detail::gather_corners<L>(
        hit.part, needed, [&](const TrianglePlace& place) { return corners_at<R>(mesh, place); });
    const Vec3<L> weights = barycentric(corners, ray);
    Surface<L> result = triangle_surface(corners, weights, ray, hit.t);
    if constexpr (SmoothNormals) {
        if (mesh.normals != nullptr) {
            const Corners<L> normals =
                detail::gather_corners<L>(hit.part, needed, [&](const TrianglePlace& place) {
                    const std::uint32_t* index =
                        mesh.normal_indices + std::size_t{3} * triangle_id(mesh, place);
                    return Corners<R>{read_vector<R>(mesh.normals, index[0]),
                                      read_vector<R>(mesh.normals, index[1]),
                                      read_vector<R>(mesh.normals, index[2])};
                });
            result.shading_normal = interpolate_normal(normals, weights, result.normal);
        }
    }
    return result;
}

namespace detail {

/// The coordinates at the corners of what the lanes in `needed` have hit: u and v are x and y.
template <class L>
Corners<L> gather_uvs(const MeshData& mesh, const ShapeHit<L>& hit, const MaskOf<L>& needed) {
    using R = RealOf<L>;
    return gather_corners<L>(hit.part, needed, [&](const TrianglePlace& place) {
        const std::uint32_t* index = mesh.uv_indices + std::size_t{3} * triangle_id(mesh, place);
        const auto read = [&](std::uint32_t i) {
            const float* uv = mesh.uvs + std::size_t{2} * i;
            return Vec3<R>{R(uv[0]), R(uv[1]), R(0)};
        };
        return Corners<R>{read(index[0]), read(index[1]), read(index[2])};
    });
}

} // namespace detail

/// Barycentric, as POV-Ray's mesh2; (0, 0) of a mesh without coordinates. Of the lanes in `needed`.
template <class L>
Vec2<L> mesh_uv(const MeshData& mesh, const Ray<L>& ray, const ShapeHit<L>& hit, const MaskOf<L>& needed) {
    using R = RealOf<L>;
    if (mesh.uvs == nullptr) {
        return {L(0), L(0)};
    }
    const Corners<L> corners = detail::gather_corners<L>(
        hit.part, needed, [&](const TrianglePlace& place) { return corners_at<R>(mesh, place); });
    const Corners<L> uvs = detail::gather_uvs(mesh, hit, needed);
    const Vec3<L> weights = barycentric(corners, ray);
    const Vec3<L> uv = uvs.a * weights.x + uvs.b * weights.y + uvs.c * weights.z;
    return {uv.x, uv.y};
}
/// Their gradients by the point.
template <class L>
Vec2<Vec3<L>> mesh_uv_slopes(const MeshData& mesh, const ShapeHit<L>& hit, const MaskOf<L>& needed) {
    using R = RealOf<L>;
    if (mesh.uvs == nullptr) {
        return {};
    }
    const Corners<L> corners = detail::gather_corners<L>(
        hit.part, needed, [&](const TrianglePlace& place) { return corners_at<R>(mesh, place); });
    return corner_slopes(corners, detail::gather_uvs(mesh, hit, needed));
}

} // namespace scc::runtime
