#include "validation/bench/bench_mesh.h"

#include "runtime/bounds.h"

#include <tiny_obj_loader.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unordered_map>

namespace scc::bench {

namespace {

using Vec = runtime::Vec3<float>;

void set_position(TriangleMesh& mesh, std::size_t i, const Vec& p) {
    mesh.positions[3 * i] = p.x;
    mesh.positions[3 * i + 1] = p.y;
    mesh.positions[3 * i + 2] = p.z;
}

/// The vertices in use, without the one too many.
std::size_t vertices(const TriangleMesh& mesh) {
    return mesh.positions.size() / 3 - 1;
}

void add_position(TriangleMesh& mesh, const Vec& p) {
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
}

TriangleMesh split_in_four(const TriangleMesh& mesh) {
    TriangleMesh result;
    result.positions.assign(mesh.positions.begin(), mesh.positions.end() - 3);
    std::unordered_map<std::uint64_t, std::uint32_t> midpoints;
    midpoints.reserve(2 * mesh.triangles());
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(result.positions.size() / 3);
        const auto [edge, added] =
            midpoints.try_emplace(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), next);
        if (added) {
            add_position(result, (mesh.position(a) + mesh.position(b)) * 0.5F);
        }
        return edge->second;
    };
    result.indices.reserve(4 * mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
        result.indices.insert(result.indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    add_position(result, {0, 0, 0});
    return result;
}

/// Pieces of 1/2^32, well mixed: the finaliser of MurmurHash3.
float random_number(std::uint32_t seed) {
    seed ^= seed >> 16;
    seed *= 0x85EBCA6BU;
    seed ^= seed >> 13;
    seed *= 0xC2B2AE35U;
    seed ^= seed >> 16;
    return static_cast<float>(seed >> 8) * 0x1p-24F;
}

struct Start {
    Vec point, normal;
};

/// Where a camera ray has hit, a little in front of the triangle, with the normal towards the viewer.
Start start_of(const TriangleMesh& mesh, const View& view, const Hits& hits, std::size_t i) {
    const Pixel corner = packet_corner(view.side, i);
    const auto pixel = static_cast<int>(i % packet);
    const Vec dir = view.ray_through(static_cast<float>(corner.x + pixel % packet_side) + 0.5F,
                                     static_cast<float>(corner.y + pixel / packet_side) + 0.5F)
                        .dir;
    const std::uint32_t* index = &mesh.indices[std::size_t{3} * hits.triangle[i]];
    const Vec a = mesh.position(index[0]);
    const Vec n = normalize(cross(mesh.position(index[1]) - a, mesh.position(index[2]) - a));
    const Vec normal = dot(n, dir) > 0 ? -n : n;
    return {view.camera.eye + dir * hits.t[i] + normal * 2e-4F, normal};
}

} // namespace

TriangleMesh load_mesh(const std::filesystem::path& obj) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(obj.string())) {
        throw std::runtime_error("cannot read `" + obj.string() + "`: " + reader.Error());
    }
    TriangleMesh mesh;
    const std::vector<float>& from = reader.GetAttrib().vertices;
    mesh.positions.assign(from.begin(), from.end());
    add_position(mesh, {0, 0, 0});
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        for (const tinyobj::index_t& index : shape.mesh.indices) {
            mesh.indices.push_back(static_cast<std::uint32_t>(index.vertex_index));
        }
    }
    runtime::Bounds<float> box;
    for (const std::uint32_t i : mesh.indices) {
        box.add(mesh.position(i));
    }
    const Vec center = box.center(), extent = box.max - box.min;
    const float scale = 2 / std::max({extent.x, extent.y, extent.z});
    for (std::size_t i = 0; i < vertices(mesh); ++i) {
        set_position(mesh, i, (mesh.position(i) - center) * scale);
    }
    return mesh;
}

TriangleMesh subdivide(TriangleMesh mesh, int times) {
    for (int i = 0; i < times; ++i) {
        mesh = split_in_four(mesh);
    }
    const auto wave = [](const Vec& p, float frequency) {
        return Vec{std::sin(frequency * (p.y + 0.3F * p.z)), std::sin(frequency * (p.z + 0.3F * p.x)),
                   std::sin(frequency * (p.x + 0.3F * p.y))};
    };
    for (std::size_t i = 0; i < vertices(mesh); ++i) {
        const Vec p = mesh.position(i);
        set_position(mesh, i, p + wave(p, 25) * 6e-3F + wave(p, 90) * 1.5e-3F);
    }
    return mesh;
}

View view_of(const TriangleMesh& mesh, int side) {
    View view;
    view.side = side;
    runtime::Camera<float>& camera = view.camera;
    camera.n = normalize(Vec{0.35F, 0.45F, 1});
    camera.u = normalize(cross(Vec{0, 1, 0}, camera.n));
    camera.v = cross(camera.n, camera.u);
    camera.eye = camera.n * 4;
    runtime::Bounds<float> outline; // on the plane at distance 1
    for (const std::uint32_t i : mesh.indices) {
        const Vec p = mesh.position(i) - camera.eye;
        const float distance = -dot(p, camera.n);
        outline.add(Vec{dot(p, camera.u) / distance, dot(p, camera.v) / distance, 1});
    }
    const Vec extent = outline.max - outline.min;
    camera.half_height = 0.5F * std::min(extent.x, extent.y);
    camera.shift_x = outline.center().x / (2 * camera.half_height);
    camera.shift_y = outline.center().y / (2 * camera.half_height);
    return view;
}

Rays shadow_rays(const TriangleMesh& mesh, const View& view, const Hits& hits) {
    const Vec light = view.camera.eye + view.camera.u * 2.5F + view.camera.v * 1.5F;
    Rays rays;
    for (std::size_t i = 0; i < view.rays(); ++i) {
        if (hits.hit(i)) {
            const Start start = start_of(mesh, view, hits, i);
            rays.add(start.point, light - start.point, 1);
        } else {
            rays.add_inactive();
        }
    }
    return rays;
}

Rays bounce_rays(const TriangleMesh& mesh, const View& view, const Hits& hits) {
    Rays rays;
    for (std::size_t i = 0; i < view.rays(); ++i) {
        if (!hits.hit(i)) {
            continue;
        }
        const Start start = start_of(mesh, view, hits, i);
        const auto seed = static_cast<std::uint32_t>(2 * i);
        const float angle = 2 * std::numbers::pi_v<float> * random_number(seed);
        const float height = 1 - 2 * random_number(seed + 1);
        const float radius = std::sqrt(1 - height * height);
        // The normal and a point on the unit sphere: cosine-distributed.
        const Vec dir =
            start.normal * 1.0001F + Vec{radius * std::cos(angle), radius * std::sin(angle), height};
        rays.add(start.point, normalize(dir), std::numeric_limits<float>::infinity());
    }
    rays.fill_last_packet();
    return rays;
}

} // namespace scc::bench
