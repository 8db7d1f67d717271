#pragma once

#include "runtime/camera.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <thread>
#include <vector>

/// What the kernels under test and their peers are given and give back.
namespace scc::bench {

/// Not closed in any way; three indices per triangle.
struct TriangleMesh {
    std::vector<float> positions; ///< x y z each
    std::vector<std::uint32_t> indices;

    std::size_t triangles() const { return indices.size() / 3; }
    runtime::Vec3<float> position(std::size_t i) const {
        return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    }
};

/// Rays and hits come in packets of this many, and threads take them by the tile.
inline constexpr std::size_t packet = 16;
inline constexpr int packet_side = 4;
inline constexpr int tile_side = 32;
inline constexpr std::size_t tile = std::size_t{tile_side} * tile_side;

/// A square picture; its side is a multiple of tile_side.
struct View {
    runtime::Camera<float> camera;
    int side = 0;

    std::size_t rays() const { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }
    /// Through a point of the picture, in pixels.
    template <class L>
    runtime::Ray<L> ray_through(const L& column, const L& row) const {
        return camera_ray(camera, runtime::Projection::perspective,
                          window_x(camera, runtime::Projection::perspective, column, side, side),
                          window_y(camera, row, side));
    }
};

/// The pixels of a picture in the order of its hits: tile by tile, in these 4 x 4 pixels by 4 x 4 pixels.
struct Pixel {
    int x, y;
};
inline Pixel packet_corner(int side, std::size_t first) {
    const auto tiles_across = static_cast<std::size_t>(side / tile_side);
    constexpr std::size_t across = tile_side / packet_side;
    const std::size_t in_tiles = first / tile, in_packets = first % tile / packet;
    return {static_cast<int>(in_tiles % tiles_across * tile_side + in_packets % across * packet_side),
            static_cast<int>(in_tiles / tiles_across * tile_side + in_packets / across * packet_side)};
}

/// A number per ray, and whole packets of them: what is beyond the last ray takes no part. A ray with
/// t_max < t_min takes no part either.
struct Rays {
    std::vector<float> org_x, org_y, org_z, dir_x, dir_y, dir_z, t_min, t_max;

    std::size_t size() const { return t_max.size(); }
    std::size_t active() const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            count += t_min[i] <= t_max[i] ? 1U : 0U;
        }
        return count;
    }
    void add(const runtime::Vec3<float>& org, const runtime::Vec3<float>& dir, float to) {
        org_x.push_back(org.x);
        org_y.push_back(org.y);
        org_z.push_back(org.z);
        dir_x.push_back(dir.x);
        dir_y.push_back(dir.y);
        dir_z.push_back(dir.z);
        t_min.push_back(0);
        t_max.push_back(to);
    }
    void add_inactive() { add({0, 0, 0}, {0, 0, 1}, -1); }
    void fill_last_packet() {
        while (size() % packet != 0) {
            add_inactive();
        }
    }
};

struct Hits {
    std::vector<float> t;                ///< infinity: missed
    std::vector<std::uint32_t> triangle; ///< the tracer's own name for it; of a miss anything

    explicit Hits(std::size_t count) : t(count), triangle(count) {}
    bool hit(std::size_t i) const { return t[i] < std::numeric_limits<float>::infinity(); }
};

/// f(first, last) for the tiles of [0, count), by so many threads.
template <class F>
void for_each_tile(std::size_t count, int threads, F&& f) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t first = next.fetch_add(tile); first < count; first = next.fetch_add(tile)) {
            f(first, std::min(first + tile, count));
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) {
        others.emplace_back(work);
    }
    work();
}

} // namespace scc::bench
