#include "validation/bench/our_kernels.h"

#include "runtime/accel/build.h"
#include "runtime/math/pack.h"
#include "runtime/raycast.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

namespace scc::bench {

using namespace runtime;

namespace {

using L = WidestLane<float>;
static_assert(packet % lane_count<L> == 0);

/// The packs that are traced together: a square of packets in a tile, from `first` of its rays on.
constexpr std::size_t packs_per_packet = packet / lane_count<L>;
constexpr std::size_t packets_across = 4, packets_down = most_packs / packs_per_packet / packets_across;
constexpr std::size_t tile_across = tile_side / packet_side;
static_assert(packets_down >= 1 && tile_across % packets_across == 0 && tile_across % packets_down == 0);

/// f(i, ray) for the packs of the square that begins at packet (x, y) of the tile at `first`.
template <class F>
void for_each_pack(std::size_t first, std::size_t x, std::size_t y, F&& f) {
    for (std::size_t i = 0; i < most_packs; ++i) {
        const std::size_t p = i / packs_per_packet;
        const std::size_t in_tile = (y + p / packets_across) * tile_across + x + p % packets_across;
        f(i, first + in_tile * packet + i % packs_per_packet * lane_count<L>);
    }
}
template <class F>
void for_each_square(std::size_t first, F&& f) {
    for (std::size_t y = 0; y < tile_across; y += packets_down) {
        for (std::size_t x = 0; x < tile_across; x += packets_across) {
            f([&](auto&& g) { for_each_pack(first, x, y, g); });
        }
    }
}
/// Of bare meshes.
constexpr std::uint32_t mesh_kind = [] {
    std::uint32_t found = primitive_kinds;
    [&]<std::uint32_t... shape>(std::integer_sequence<std::uint32_t, shape...>) {
        ((found = is_mesh<ShapeOfKind<float, 2 * shape>> ? 2 * shape : found), ...);
    }
    (std::make_integer_sequence<std::uint32_t, primitive_kinds / 2>{});
    return found;
}();

/// A scene of one mesh and nothing else, as `scc build` would write it.
struct MeshScene : SceneBase<float> {
    static constexpr SceneTraits traits{.bare_shapes = 1U << mesh_kind / 2, .perspective = true};
    using SceneBase<float>::primitives;
    static constexpr std::array<Bare<Mesh<float>>, 1> bare_mesh{};
    static constexpr const auto& primitives(Of<Bare<Mesh<float>>>) { return bare_mesh; }
    static constexpr std::array<Phong<float>, 1> materials{};
    std::array<MeshData, 1> meshes;
};

/// The centres of a packet's pixels from its corner.
const std::vector<float> centers_x = [] {
    std::vector<float> x;
    for (std::size_t i = 0; i < packet; ++i) {
        x.push_back(static_cast<float>(i % packet_side) + 0.5F);
    }
    return x;
}();
const std::vector<float> centers_y = [] {
    std::vector<float> y;
    for (std::size_t i = 0; i < packet; ++i) {
        y.push_back(static_cast<float>(i / packet_side) + 0.5F);
    }
    return y;
}();

L load(const std::vector<float>& numbers, std::size_t first) {
    L result;
    std::memcpy(&result.v, numbers.data() + first, sizeof result.v);
    return result;
}

Ray<L> load_rays(const Rays& rays, std::size_t first) {
    return {{load(rays.org_x, first), load(rays.org_y, first), load(rays.org_z, first)},
            {load(rays.dir_x, first), load(rays.dir_y, first), load(rays.dir_z, first)},
            load(rays.t_min, first),
            load(rays.t_max, first)};
}

} // namespace

struct OurMesh::Scene {
    MeshStorage storage;
    MeshScene scene;

    void store(const Hit<L>& hit, Hits& hits, std::size_t first) const {
        store_lanes(hits.t.data() + first, hit.shape.t);
        std::memcpy(hits.triangle.data() + first, &hit.shape.part.v, sizeof hit.shape.part.v);
    }
};

OurMesh::OurMesh(const TriangleMesh& mesh, BuildQuality quality, int threads)
    : scene_(std::make_unique<Scene>()) {
    scene_->storage = build_mesh(mesh.positions, mesh.indices, {}, {},
                                 {threads, quality == BuildQuality::quick ? runtime::BuildQuality::quick
                                                                          : runtime::BuildQuality::high});
    scene_->scene.meshes[0] = scene_->storage.data();
}
OurMesh::OurMesh(OurMesh&&) noexcept = default;
OurMesh::~OurMesh() = default;

std::size_t OurMesh::bytes() const {
    const MeshStorage& storage = scene_->storage;
    return storage.triangles.capacity() * sizeof(float) + storage.nodes.capacity() * sizeof(BvhNode);
}

void OurMesh::primary(const View& view, Hits& hits, int threads) const {
    for_each_tile(view.rays(), threads, [&](std::size_t begin, std::size_t) {
        for_each_square(begin, [&](auto&& for_packs) {
            std::array<Ray<L>, most_packs> rays;
            std::array<Hit<L>, most_packs> found;
            for_packs([&](std::size_t p, std::size_t first) {
                const Pixel corner = packet_corner(view.side, first);
                const std::size_t in_packet = first % packet;
                rays[p] = view.ray_through(L(static_cast<float>(corner.x)) + load(centers_x, in_packet),
                                           L(static_cast<float>(corner.y)) + load(centers_y, in_packet));
            });
            closest_hits<most_packs, MeshScene, L>(scene_->scene, rays, Apex::origin, found);
            for_packs([&](std::size_t p, std::size_t first) { scene_->store(found[p], hits, first); });
        });
    });
}

void OurMesh::occluded(const Rays& rays, std::vector<std::uint8_t>& blocked, int threads) const {
    for_each_tile(rays.size(), threads, [&](std::size_t begin, std::size_t) {
        for_each_square(begin, [&](auto&& for_packs) {
            std::array<Ray<L>, most_packs> packs;
            std::array<MaskOf<L>, most_packs> found;
            for_packs([&](std::size_t p, std::size_t first) {
                packs[p] = load_rays(rays, first);
                found[p] = MaskOf<L>(false);
            });
            any_hits<most_packs, MeshScene, L>(scene_->scene, packs, Apex::end, found);
            for_packs([&](std::size_t p, std::size_t first) {
                for (unsigned i = 0; i < lane_count<L>; ++i) {
                    blocked[first + i] = static_cast<std::uint8_t>(bits(found[p]) >> i & 1U);
                }
            });
        });
    });
}

void OurMesh::closest(const Rays& rays, Hits& hits, int threads) const {
    for_each_tile(rays.size(), threads, [&](std::size_t first, std::size_t last) {
        while (first < last) {
            const std::size_t count = std::min<std::size_t>(most_packs, (last - first) / lane_count<L>);
            std::array<Ray<L>, most_packs> packs;
            std::array<Hit<L>, most_packs> found;
            for (std::size_t p = 0; p < count; ++p) {
                packs[p] = load_rays(rays, first + p * lane_count<L>);
            }
            closest_hits<most_packs, MeshScene, L>(scene_->scene, std::span(packs).first(count), Apex::none,
                                                   std::span(found).first(count));
            for (std::size_t p = 0; p < count; ++p, first += lane_count<L>) {
                scene_->store(found[p], hits, first);
            }
        }
    });
}

} // namespace scc::bench
