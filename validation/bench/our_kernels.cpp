#include "validation/bench/our_kernels.h"

#include "runtime/accel/build.h"
#include "runtime/math/pack.h"
#include "runtime/raycast.h"

#include <cstring>

namespace scc::bench {

using namespace runtime;

namespace {

using L = WidestLane<float>;
static_assert(packet % lane_count<L> == 0);
constexpr std::uint32_t mesh_kind = primitive_kinds - 2;
static_assert(is_mesh<ShapeOfKind<float, mesh_kind>>);

/// A scene of one mesh and nothing else, as `scc build` would write it.
struct MeshScene : SceneBase<float> {
    static constexpr SceneTraits traits{.bare_shapes = 1U << mesh_kind / 2, .perspective = true};
    using SceneBase<float>::primitives;
    static constexpr std::array<Bare<Mesh<float>>, 1> bare_mesh{};
    static constexpr const auto& primitives(Of<Bare<Mesh<float>>>) { return bare_mesh; }
    static constexpr std::array<Phong<float>, 1> materials{};
    std::array<MeshData, 1> meshes;
};

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
        for (int i = 0; i < lane_count<L>; ++i) {
            const float t = lane(hit.shape.t, i);
            hits.t[first + static_cast<std::size_t>(i)] = t;
            if (t < infinity<float>()) {
                hits.triangle[first + static_cast<std::size_t>(i)] =
                    storage.triangles[lane(hit.shape.part, i)].id;
            }
        }
    }
};

OurMesh::OurMesh(const TriangleMesh& mesh, BuildQuality, int) : scene_(std::make_unique<Scene>()) {
    scene_->storage = build_mesh(mesh.positions, mesh.indices);
    scene_->scene.meshes[0] = scene_->storage.data();
}
OurMesh::OurMesh(OurMesh&&) noexcept = default;
OurMesh::~OurMesh() = default;

std::size_t OurMesh::bytes() const {
    const MeshStorage& storage = scene_->storage;
    return storage.positions.capacity() * sizeof(float) +
           storage.triangles.capacity() * sizeof(MeshTriangle) + storage.nodes.capacity() * sizeof(BvhNode);
}

void OurMesh::primary(const View& view, Hits& hits, int threads) const {
    for_each_tile(view.rays(), threads, [&](std::size_t first, std::size_t last) {
        for (; first < last; first += lane_count<L>) {
            const Pixel corner = packet_corner(view.side, first);
            L column, row;
            for (int i = 0; i < lane_count<L>; ++i) {
                const int pixel = static_cast<int>(first % packet) + i;
                set_lane(column, i, static_cast<float>(corner.x + pixel % packet_side) + 0.5F);
                set_lane(row, i, static_cast<float>(corner.y + pixel / packet_side) + 0.5F);
            }
            const Ray<L> ray =
                camera_ray(view.camera, Projection::perspective, column, row, view.side, view.side);
            scene_->store(closest_hit(scene_->scene, ray), hits, first);
        }
    });
}

void OurMesh::occluded(const Rays& rays, std::vector<std::uint8_t>& blocked, int threads) const {
    for_each_tile(rays.size(), threads, [&](std::size_t first, std::size_t last) {
        for (; first < last; first += lane_count<L>) {
            const unsigned mask = bits(any_hit(scene_->scene, load_rays(rays, first)));
            for (unsigned i = 0; i < lane_count<L>; ++i) {
                blocked[first + i] = static_cast<std::uint8_t>(mask >> i & 1U);
            }
        }
    });
}

void OurMesh::closest(const Rays& rays, Hits& hits, int threads) const {
    for_each_tile(rays.size(), threads, [&](std::size_t first, std::size_t last) {
        for (; first < last; first += lane_count<L>) {
            scene_->store(closest_hit(scene_->scene, load_rays(rays, first)), hits, first);
        }
    });
}

} // namespace scc::bench
