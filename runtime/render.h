#pragma once

#include "runtime/accel/build.h"
#include "runtime/accel/view.h"
#include "runtime/image.h"
#include "runtime/math/pack.h"
#include "runtime/shade.h"

#include <algorithm>
#include <array>
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
          tiles_(tiles_across_ * ((height_ + tile_size - 1) / tile_size)) {
        if (!is_searched_by_hierarchy()) {
            boxes_ = primitive_boxes(scene);
        }
    }

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
    /// A pack is a block of samples, and so many packs are a block again.
    static constexpr int pack_width = lane_count<L> >= 8 ? 4 : lane_count<L> >= 2 ? 2 : 1;
    static constexpr int pack_height = lane_count<L> / pack_width;
    static constexpr int packs = packs_together<S, L>;
    static constexpr int packs_across = packs > 1 ? 4 : 1;
    static constexpr int block_width = packs_across * pack_width;
    static constexpr int block_height = packs / packs_across * pack_height;
    static_assert(tile_size % block_width == 0 && tile_size % block_height == 0);

    template <class AfterTile>
    void draw_tiles(RayCounts& rays, AfterTile&& after_tile) {
        StripPainter painter(*this, rays);
        while (!stopped_) {
            const int tile = next_++;
            if (tile >= tiles_) {
                return;
            }
            const int x0 = tile % tiles_across_ * tile_size, y0 = tile / tiles_across_ * tile_size;
            const Candidates candidates = candidates_in_tile(x0, y0);
            for (int y = y0; y < std::min(y0 + tile_size, height_); y += block_height) {
                painter.paint(x0, y, candidates);
            }
            ++done_;
            after_tile();
        }
    }

    /// Draws strips of tile_size x block_height pixels, each with n x n samples at the centres of sub-pixels.
    /// Blocks of neighbouring samples, not of pixels, are traced together: with n x n samples in a pixel
    /// these run more alike, but n x n blocks have as many samples as a block of pixels has.
    class StripPainter {
    public:
        StripPainter(const Renderer& renderer, RayCounts& rays)
            : renderer_(renderer), shader_(renderer.scene_, renderer.request_.settings, rays), rays_(rays),
              n_(renderer.request_.settings.samples_per_axis),
              samples_across_(static_cast<std::size_t>(n_ * tile_size)) {
            for (std::vector<R>& channel : samples_) {
                channel.resize(samples_across_ * static_cast<std::size_t>(n_ * block_height));
            }
            for (int first = 0; first < n_ * tile_size; first += pack_width) {
                columns_.push_back(positions(first, [](int lane) { return lane % pack_width; }));
            }
            for (int first = 0; first < n_ * block_height; first += pack_height) {
                rows_.push_back(positions(first, [](int lane) { return lane / pack_width; }));
            }
        }

        /// The pixels from (x, y) of the crop on; those outside the crop are left out.
        void paint(int x, int y, Candidates candidates) {
            const Crop& crop = renderer_.request_.crop;
            const int rows = std::min(block_height, renderer_.height_ - y);
            const int columns = std::min(tile_size, renderer_.width_ - x);
            for (int j = 0; j < n_ * rows; j += block_height) {
                for (int i = 0; i < n_ * columns; i += block_width) {
                    trace(crop.x0 + x, crop.y0 + y, i, j, candidates);
                }
            }
            for (int row = 0; row < rows; ++row) {
                store(row * n_, columns, renderer_.image_.at(x, y + row));
            }
        }

    private:
        /// Where a pack's samples are in one direction, in pixels of the strip: whole ones, and the rest,
        /// which is added last so that rounding does not depend on where the strip begins.
        struct Positions {
            L pixel, within;
            L from(int start) const { return (L(static_cast<R>(start)) + pixel) + within; }
        };
        template <class Offset>
        Positions positions(int first, Offset&& offset) const {
            Positions result{};
            for (int lane = 0; lane < lane_count<L>; ++lane) {
                const int sample = first + offset(lane);
                set_lane(result.pixel, lane, static_cast<R>(sample / n_));
                set_lane(result.within, lane, (static_cast<R>(sample % n_) + R(0.5)) / static_cast<R>(n_));
            }
            return result;
        }

        /// Samples one block, from (i, j) of the samples of the pixels at (x, y) of the picture.
        void trace(int x, int y, int i, int j, Candidates candidates) {
            const Crop& crop = renderer_.request_.crop;
            std::array<Ray<L>, packs> rays;
            std::array<MaskOf<L>, packs> inside;
            std::array<Rgb<L>, packs> colors;
            for (int p = 0; p < packs; ++p) {
                const int pack_i = i + p % packs_across * pack_width,
                          pack_j = j + p / packs_across * pack_height;
                const L column = columns_[static_cast<std::size_t>(pack_i / pack_width)].from(x);
                const L row = rows_[static_cast<std::size_t>(pack_j / pack_height)].from(y);
                const auto pack = static_cast<std::size_t>(p);
                inside[pack] = (column < L(static_cast<R>(crop.x1))) & (row < L(static_cast<R>(crop.y1)));
                rays[pack] = renderer_.ray_through(column, row);
                rays_.primary += count_lanes(inside[pack]);
            }
            const Apex apex = renderer_.projection() == Projection::perspective ? Apex::origin : Apex::none;
            shader_.radiance(rays, apex, candidates, inside, colors);
            for (int p = 0; p < packs; ++p) {
                const int pack_i = i + p % packs_across * pack_width,
                          pack_j = j + p / packs_across * pack_height;
                const Rgb<L>& color = colors[static_cast<std::size_t>(p)];
                keep(color.r, sample_at(0, pack_i, pack_j));
                keep(color.g, sample_at(1, pack_i, pack_j));
                keep(color.b, sample_at(2, pack_i, pack_j));
            }
        }
        void keep(const L& values, R* to) const {
            R rows[lane_count<L>];
            store_lanes(rows, values);
            for (int row = 0; row < pack_height; ++row, to += samples_across_) {
                std::copy_n(rows + row * pack_width, pack_width, to);
            }
        }
        R* sample_at(std::size_t channel, int i, int j) {
            return &samples_[channel]
                            [static_cast<std::size_t>(j) * samples_across_ + static_cast<std::size_t>(i)];
        }

        /// A row of pixels, whose samples begin at row j.
        void store(int j, int columns, float* pixels) {
            const R* const from[] = {sample_at(0, 0, j), sample_at(1, 0, j), sample_at(2, 0, j)};
            if (n_ == 1) {
                store(columns, pixels, [=](int channel, int column) { return from[channel][column]; });
            } else {
                store(columns, pixels,
                      [=, this](int channel, int column) { return mean(from[channel] + column * n_); });
            }
        }
        /// + 0 makes -0 positive, so that a term left out and a term of 0 give the same bits.
        template <class Value>
        void store(int columns, float* pixel, Value&& value) const {
            const int stride = renderer_.image_.channels;
            for (int column = 0; column < columns; ++column, pixel += stride) {
                pixel[0] = static_cast<float>(value(0, column)) + 0.0F;
                pixel[1] = static_cast<float>(value(1, column)) + 0.0F;
                pixel[2] = static_cast<float>(value(2, column)) + 0.0F;
            }
        }
        /// Over a pixel's samples, row by row.
        R mean(const R* samples) const {
            R sum = 0;
            for (int j = 0; j < n_; ++j, samples += samples_across_) {
                for (int i = 0; i < n_; ++i) {
                    sum = sum + samples[i];
                }
            }
            return sum / static_cast<R>(n_ * n_);
        }

        const Renderer& renderer_;
        const Shader<S, L> shader_;
        RayCounts& rays_;
        int n_;
        std::vector<Positions> columns_, rows_; ///< of the packs across and down
        std::size_t samples_across_;
        std::array<std::vector<R>, 3> samples_; ///< red, green, blue
    };

    bool is_searched_by_hierarchy() const {
        if constexpr (S::traits.accelerator) {
            return !scene_.accelerator.nodes.empty();
        } else {
            return false;
        }
    }
    /// Of the tile that begins at (x, y) of the crop, seen with a pixel around it.
    Candidates candidates_in_tile(int x, int y) const {
        if (boxes_.empty()) {
            return all_candidates;
        }
        const R left = static_cast<R>(request_.crop.x0 + x - 1), right = left + R(tile_size + 2);
        const R top = static_cast<R>(request_.crop.y0 + y - 1), bottom = top + R(tile_size + 2);
        return candidates_in(boxes_, ViewPart<R>({ray_through(left, top), ray_through(right, top),
                                                  ray_through(right, bottom), ray_through(left, bottom)}));
    }

    Projection projection() const {
        return !S::traits.orthographic  ? Projection::perspective
               : !S::traits.perspective ? Projection::orthographic
                                        : scene_.camera.projection;
    }
    template <class Lane>
    Ray<Lane> ray_through(const Lane& column, const Lane& row) const {
        return camera_ray(scene_.camera, projection(), column, row, request_.settings.width,
                          request_.settings.height);
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
    std::vector<Bounds<R>> boxes_; ///< of the shapes that are tested one by one, in the order of Candidates
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
