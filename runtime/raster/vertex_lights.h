#pragma once

#include "runtime/accel/build_bvh.h"
#include "runtime/raster/bins.h"
#include "runtime/raster/light_points.h"
#include "runtime/raster/model.h"
#include "runtime/raster/view.h"
#include "runtime/render_settings.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace scc::runtime::raster {

/// A vertex of a mesh as its triangles need it: the place as EyePoint has it, and the light that leaves its
/// front.
template <class R, bool transmits>
struct alignas(sizeof(R) * (transmits ? 16 : 8)) LitVertex {
    static constexpr std::size_t numbers = transmits ? 9 : 6;

    R right, up, ahead;
    R light[numbers - 3]; ///< r g b, and those of the part that comes through
};

/// Each vertex is a lane.
template <class L, bool transmits>
void gather_vertices(const std::array<const LitVertex<RealOf<L>, transmits>*,
                                      static_cast<std::size_t>(lane_count<L>)>& vertices,
                     EyePoint<L>& eye, Seen<L>& seen) {
    constexpr std::size_t count = LitVertex<RealOf<L>, transmits>::numbers;
    RealOf<L> numbers[count][lane_count<L>];
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const auto& v = *vertices[k];
        numbers[0][k] = v.right;
        numbers[1][k] = v.up;
        numbers[2][k] = v.ahead;
        for (std::size_t i = 3; i < count; ++i) {
            numbers[i][k] = v.light[i - 3];
        }
    }
    const auto number = [&](std::size_t i) {
        L result;
        std::memcpy(&result.v, numbers[i], sizeof result.v);
        return result;
    };
    eye = {number(0), number(1), number(2), L(1)};
    seen = {{number(3), number(4), number(5)}, {}};
    if constexpr (transmits) {
        seen.transmit = {number(6), number(7), number(8)};
    }
}

/// Meshes' vertices, each lit once for all triangles that share it. Of those meshes alone for which that is
/// less work than lighting the corners of what is seen; their backs, which are seldom seen, are lit as
/// before.
template <SceneModel S, class L>
class VertexLights {
public:
    using R = typename S::Real;
    using Vertex = LitVertex<R, S::traits.transmission>;

    VertexLights(const S& scene, const RasterModel<R>& model) : scene_(scene), model_(model) {}

    /// `bins`: what is drawn of the surfaces.
    void update(const RasterView<R>& view, const std::vector<Bin<R>>& bins, RasterShading shading,
                int threads) {
        first_of_.assign(model_.surfaces.size(), none_);
        // Functions of a material read more than is the vertex's alone.
        if (S::traits.functions || shading != RasterShading::gouraud) {
            return;
        }
        std::size_t count = 0;
        std::vector<Run> runs;
        for (std::size_t i = 0; i < model_.surfaces.size(); ++i) {
            const RasterSurface<R>& surface = model_.surfaces[i];
            const std::size_t vertices = vertices_of(surface).positions.size() / 3;
            if (vertices == 0 || most_vertices * fronts(bins, i) < vertices) {
                continue;
            }
            first_of_[i] = count;
            for (std::size_t first = 0; first < vertices; first += run_length) {
                runs.push_back({&surface, first, std::min(first + run_length, vertices), count});
            }
            count += vertices;
        }
        vertices_.resize(std::max(count, vertices_.size()));
        const PointLighting<S, L> lighting(scene_);
        runtime::detail::share_work(runs.size(), threads,
                                    [&](std::size_t i) { light(runs[i], view, lighting); });
    }

    /// Whether the surface's vertices are lit.
    bool has(const RasterSurface<R>& surface) const { return first_of(surface) != none_; }
    /// Those of a triangle of such a surface, by its number in the model.
    std::array<const Vertex*, 3> corners(const RasterSurface<R>& surface, std::uint32_t triangle) const {
        const std::uint32_t* const numbers =
            &vertices_of(surface).of_corners[std::size_t{3} * (triangle - surface.first)];
        const Vertex* const first = vertices_.data() + first_of(surface);
        return {first + numbers[0], first + numbers[1], first + numbers[2]};
    }

private:
    static constexpr auto N = static_cast<std::size_t>(lane_count<L>);
    static constexpr std::size_t none_ = ~std::size_t{0};
    static constexpr std::size_t run_length = 1024;
    /// Pays up to so many vertices for each triangle that shows its front: each has three corners, of which
    /// some are hidden, and vertices are faster to load than corners.
    static constexpr std::size_t most_vertices = 4;

    /// Vertices [first, last) of a surface, and where its first one is stored.
    struct Run {
        const RasterSurface<R>* surface;
        std::size_t first, last, to;
    };

    std::size_t first_of(const RasterSurface<R>& surface) const {
        return first_of_[static_cast<std::size_t>(&surface - model_.surfaces.data())];
    }
    const MeshVertices& vertices_of(const RasterSurface<R>& surface) const {
        static const MeshVertices no_vertices;
        return surface.is_mesh && !model_.mesh_vertices.empty() ? model_.mesh_vertices[surface.mesh]
                                                                : no_vertices;
    }
    static std::size_t fronts(const std::vector<Bin<R>>& bins, std::size_t surface) {
        std::size_t sum = 0;
        for (const Bin<R>& bin : bins) {
            sum += surface < bin.fronts_of.size() ? bin.fronts_of[surface] : 0;
        }
        return sum;
    }

    static Vec3<L> load(const float* from, std::size_t count) {
        float numbers[3][N] = {};
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t c = 0; c < 3; ++c) {
                numbers[c][k] = from[3 * k + c];
            }
        }
        return {load_lanes<L>(numbers[0]), load_lanes<L>(numbers[1]), load_lanes<L>(numbers[2])};
    }
    void light(const Run& run, const RasterView<R>& view, const PointLighting<S, L>& lighting) {
        const RasterSurface<R>& surface = *run.surface;
        const MeshData& mesh = scene_.meshes[surface.mesh];
        const float* const positions = vertices_of(surface).positions.data();
        for (std::size_t i = run.first; i < run.last; i += N) {
            const std::size_t count = std::min(N, run.last - i);
            SurfacePoint<L> point{};
            point.world = load(positions + 3 * i, count);
            Vec3<L> normal = load(mesh.normals + 3 * i, count);
            if (surface.is_placed) {
                point.world = transform_point(surface.world_from_object, point.world);
                normal = transform_normal(surface.object_from_world, normal);
            }
            const Seen<L> seen = lighting.light(point, normalize(normal), view.direction_to(point.world),
                                                IndexOf<L>(surface.sides.front), MaskOf<L>(true));
            store(view.to_eye(point.world, L(1)), seen, count, vertices_.data() + run.to + i);
        }
    }
    static void store(const EyePoint<L>& eye, const Seen<L>& seen, std::size_t count, Vertex* to) {
        for (std::size_t k = 0; k < count; ++k) {
            const int i = static_cast<int>(k);
            Vertex& v = to[k];
            v.right = lane(eye.right, i);
            v.up = lane(eye.up, i);
            v.ahead = lane(eye.ahead, i);
            v.light[0] = lane(seen.light.r, i);
            v.light[1] = lane(seen.light.g, i);
            v.light[2] = lane(seen.light.b, i);
            if constexpr (S::traits.transmission) {
                v.light[3] = lane(seen.transmit.r, i);
                v.light[4] = lane(seen.transmit.g, i);
                v.light[5] = lane(seen.transmit.b, i);
            }
        }
    }

    const S& scene_;
    const RasterModel<R>& model_;
    std::vector<Vertex> vertices_;
    std::vector<std::size_t> first_of_; ///< of each surface
};

} // namespace scc::runtime::raster
