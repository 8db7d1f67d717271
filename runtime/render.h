#pragma once

#include "runtime/accel/build.h"
#include "runtime/image.h"
#include "runtime/math/pack.h"
#include "runtime/shade.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace scc::runtime {

namespace detail {

inline constexpr int tile_size = 32;
inline constexpr std::size_t cache_line = 64;

/// A thread's own counters; alone on their cache line.
struct alignas(cache_line) ThreadCounts {
    RayCounts rays;
};

template <SceneModel S, class L>
class Renderer {
public:
    using R = typename S::Real;

    Renderer(const S& scene, const RenderRequest& request, Image& image)
        : scene_(scene), request_(request), image_(image), width_(request.crop.x1 - request.crop.x0),
          height_(request.crop.y1 - request.crop.y0), tiles_across_((width_ + tile_size - 1) / tile_size),
          tiles_(tiles_across_ * ((height_ + tile_size - 1) / tile_size)) {}

    RenderResult run() {
        const auto threads = static_cast<std::size_t>(std::max(1, std::min(request_.threads, tiles_)));
        std::vector<ThreadCounts> counts(threads);
        {
            std::vector<std::jthread> others;
            others.reserve(threads - 1);
            for (std::size_t i = 1; i < threads; ++i) {
                others.emplace_back([this, &rays = counts[i].rays] { draw_tiles(rays, [] {}); });
            }
            try {
                draw_tiles(counts[0].rays, [this] { report_progress(); });
            } catch (...) {
                stopped_ = true;
                throw;
            }
        }
        RenderResult result;
        for (const ThreadCounts& one : counts) {
            result.rays.primary += one.rays.primary;
            result.rays.shadow += one.rays.shadow;
            result.rays.reflected += one.rays.reflected;
        }
        result.complete = done_ == tiles_;
        return result;
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds progress_interval{250};
    static constexpr int block_width = lane_count<L> >= 8 ? 4 : lane_count<L> >= 2 ? 2 : 1;
    static constexpr int block_height = lane_count<L> / block_width;

    template <class AfterTile>
    void draw_tiles(RayCounts& rays, AfterTile&& after_tile) {
        const Shader<S, L> shader(scene_, request_.settings, rays);
        while (!stopped_) {
            const int tile = next_++;
            if (tile >= tiles_) {
                return;
            }
            const int x0 = tile % tiles_across_ * tile_size, y0 = tile / tiles_across_ * tile_size;
            for (int y = y0; y < std::min(y0 + tile_size, height_); y += block_height) {
                for (int x = x0; x < std::min(x0 + tile_size, width_); x += block_width) {
                    draw_block(shader, x, y, rays);
                }
            }
            ++done_;
            after_tile();
        }
    }

    /// Lane i is pixel (x + i % block_width, y + i / block_width); those outside the crop stay dark.
    void draw_block(const Shader<S, L>& shader, int x, int y, RayCounts& rays) {
        L column(0), row(0);
        for (int i = 0; i < lane_count<L>; ++i) {
            set_lane(column, i, static_cast<R>(request_.crop.x0 + x + i % block_width));
            set_lane(row, i, static_cast<R>(request_.crop.y0 + y + i / block_width));
        }
        const MaskOf<L> inside =
            (column < L(static_cast<R>(request_.crop.x1))) & (row < L(static_cast<R>(request_.crop.y1)));
        const Rgb<L> color = pixel_colors(shader, column, row, inside, rays);
        for (unsigned left = bits(inside); left != 0; left &= left - 1) {
            const int i = __builtin_ctz(left);
            float* pixel = image_.at(x + i % block_width, y + i / block_width);
            // + 0 makes -0 positive, so that a term left out and a term of 0 give the same bits.
            pixel[0] = static_cast<float>(lane(color.r, i)) + 0.0F;
            pixel[1] = static_cast<float>(lane(color.g, i)) + 0.0F;
            pixel[2] = static_cast<float>(lane(color.b, i)) + 0.0F;
        }
    }

    /// The mean over the centres of n x n sub-pixels, row by row.
    Rgb<L> pixel_colors(const Shader<S, L>& shader, const L& column, const L& row, const MaskOf<L>& inside,
                        RayCounts& rays) const {
        const int n = request_.settings.samples_per_axis;
        Rgb<L> sum{L(0), L(0), L(0)};
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                sum = sum + shader.radiance(ray_through(column + sub_pixel(i), row + sub_pixel(j)), inside);
                rays.primary += count_lanes(inside);
            }
        }
        return sum / L(static_cast<R>(n * n));
    }
    L sub_pixel(int sample) const {
        return L((static_cast<R>(sample) + R(0.5)) / static_cast<R>(request_.settings.samples_per_axis));
    }

    Ray<L> ray_through(const L& column, const L& row) const {
        const Camera<R>& camera = scene_.camera;
        const Projection projection = !S::traits.orthographic  ? Projection::perspective
                                      : !S::traits.perspective ? Projection::orthographic
                                                               : camera.projection;
        return camera_ray(camera, projection, column, row, request_.settings.width, request_.settings.height);
    }

    void report_progress() {
        if (!request_.progress) {
            return;
        }
        const Clock::time_point now = Clock::now();
        if (now - reported_ >= progress_interval) {
            reported_ = now;
            if (!request_.progress(static_cast<double>(done_) / tiles_)) {
                stopped_ = true;
            }
        }
    }

    const S& scene_;
    const RenderRequest& request_;
    Image& image_;
    int width_, height_;
    int tiles_across_, tiles_;
    Clock::time_point reported_ = Clock::now();
    alignas(cache_line) std::atomic<int> next_{0};
    std::atomic<int> done_{0};
    std::atomic<bool> stopped_{false};
};

} // namespace detail

/// Draws the crop into the image, which has its size and at least 3 channels. The pixels depend on neither
/// the crop nor the number of threads nor the lanes that a register holds. The calling thread draws too, and
/// it alone calls `progress`.
template <class L, SceneModel S>
RenderResult render_with_lanes(const S& scene, const RenderRequest& request, Image& image) {
    return detail::Renderer<S, L>(scene, request, image).run();
}

template <SceneModel S>
RenderResult render(const S& scene, const RenderRequest& request, Image& image) {
    return render_with_lanes<WidestLane<typename S::Real>>(scene, request, image);
}

} // namespace scc::runtime
