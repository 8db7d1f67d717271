#pragma once

#include "runtime/accel/build.h"
#include "runtime/accel/view.h"
#include "runtime/camera_rays.h"
#include "runtime/free_painter.h"
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
        : scene_(scene), request_(request), image_(image), camera_(scene, request.settings),
          width_(request.crop.x1 - request.crop.x0), height_(request.crop.y1 - request.crop.y0),
          tiles_across_((width_ + tile_size - 1) / tile_size),
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
            result.rays += one.rays;
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
        Shader<S, L> shader(scene_, request_.settings, rays);
        if constexpr (S::traits.pixel_sampling) {
            if (!is_plain_grid(request_.settings)) {
                const int around = reach_of(request_.settings.filter);
                FreePainter<S, L> painter(camera_, shader, request_, image_, rays);
                draw_tiles(rays, after_tile, [&](int x, int y) {
                    painter.paint(x, y, tile_size, candidates_in_tile(x, y, around));
                });
                return;
            }
        }
        TilePainter painter(*this, shader, rays);
        draw_tiles(rays, after_tile, [&](int x, int y) { painter.paint(x, y, candidates_in_tile(x, y, 0)); });
    }
    /// `paint(x, y)` draws the tile that begins there in the crop.
    template <class AfterTile, class Paint>
    void draw_tiles(RayCounts& rays, AfterTile&& after_tile, Paint&& paint) {
        [[maybe_unused]] FieldCounts before;
        if constexpr (uses_implicit<S>) {
            before = field_counts;
        }
        while (!stopped_) {
            const int tile = next_++;
            if (tile >= tiles_) {
                break;
            }
            paint(tile % tiles_across_ * tile_size, tile / tiles_across_ * tile_size);
            ++done_;
            after_tile();
        }
        if constexpr (uses_implicit<S>) {
            rays.undecided += field_counts.undecided - before.undecided;
            rays.at_jumps += field_counts.at_jumps - before.at_jumps;
        }
    }

    /// Draws tiles, strip by strip of block_height pixels, each pixel with n x n samples at the centres of
    /// sub-pixels. Blocks of neighbouring samples, not of pixels, are traced together: with n x n samples in
    /// a pixel these run more alike, but n x n blocks have as many samples as a block of pixels has.
    class TilePainter {
    public:
        TilePainter(const Renderer& renderer, Shader<S, L>& shader, RayCounts& rays)
            : renderer_(renderer), shader_(shader), rays_(rays),
              n_(samples_per_axis(renderer.request_.settings)),
              samples_across_(static_cast<std::size_t>(n_ * tile_size)),
              columns_(static_cast<std::size_t>(n_ * tile_size / pack_width)),
              rows_(static_cast<std::size_t>(n_ * tile_size / pack_height)) {
            for (std::vector<R>& channel : samples_) {
                channel.resize(samples_across_ * static_cast<std::size_t>(n_ * block_height));
            }
        }

        /// The pixels from (x, y) of the crop on; those outside the crop are left out.
        void paint(int x, int y, Candidates candidates) {
            place(x, y);
            candidates_ = candidates;
            const int bottom = std::min(y + tile_size, renderer_.height_);
            const int columns = std::min(tile_size, renderer_.width_ - x);
            for (int top = y; top < bottom; top += block_height) {
                const int rows = std::min(block_height, bottom - top);
                for (int j = 0; j < n_ * rows; j += block_height) {
                    for (int i = 0; i < n_ * columns; i += block_width) {
                        trace(i, j, n_ * (top - y));
                    }
                }
                for (int row = 0; row < rows; ++row) {
                    store(row * n_, columns, renderer_.image_.at(x, top + row));
                }
            }
        }

    private:
        /// A pack's samples in one direction.
        struct Positions {
            L window;         ///< see window_x
            MaskOf<L> inside; ///< the crop
        };

        void place(int x, int y) {
            const Renderer& r = renderer_;
            const Crop& crop = r.request_.crop;
            left_ = crop.x0 + x;
            top_ = crop.y0 + y;
            for (std::size_t i = 0; i < columns_.size(); ++i) {
                const Part column = samples_from(left_, static_cast<int>(i) * pack_width,
                                                 [](int lane) { return lane % pack_width; });
                columns_[i] = {r.camera_.window_x(column.pixel, column.within),
                               column.pixel < L(static_cast<R>(crop.x1))};
            }
            for (std::size_t j = 0; j < rows_.size(); ++j) {
                const Part row = samples_from(top_, static_cast<int>(j) * pack_height,
                                              [](int lane) { return lane / pack_width; });
                rows_[j] = {r.camera_.window_y(row.pixel, row.within),
                            row.pixel < L(static_cast<R>(crop.y1))};
            }
        }
        /// Pixels and where in them, in one direction.
        struct Part {
            L pixel, within;
        };
        /// Where the samples from `first` on of the pixels from `pixel` on lie.
        template <class Offset>
        Part samples_from(int pixel, int first, Offset&& offset) const {
            Part result;
            for (int lane = 0; lane < lane_count<L>; ++lane) {
                const int sample = first + offset(lane);
                set_lane(result.pixel, lane, static_cast<R>(pixel + sample / n_));
                set_lane(result.within, lane, (static_cast<R>(sample % n_) + R(0.5)) / static_cast<R>(n_));
            }
            return result;
        }
        /// That of a lane of the pack from (i, j) of the tile's samples on.
        Sample sample_of(int i, int j, int lane) const {
            const int x = i + lane % pack_width, y = j + lane / pack_width;
            return {{left_ + x / n_, top_ + y / n_}, y % n_ * n_ + x % n_};
        }

        /// Samples one block, from (i, j) of the strip's samples, whose first row is `above` of the tile's.
        void trace(int i, int j, int above) {
            std::array<Ray<L>, packs> rays;
            std::array<MaskOf<L>, packs> inside;
            std::array<Rgb<L>, packs> colors;
            for (int p = 0; p < packs; ++p) {
                const int pack_i = i + p % packs_across * pack_width,
                          pack_j = above + j + p / packs_across * pack_height;
                const Positions& column = columns_[static_cast<std::size_t>(pack_i / pack_width)];
                const Positions& row = rows_[static_cast<std::size_t>(pack_j / pack_height)];
                const auto pack = static_cast<std::size_t>(p);
                inside[pack] = column.inside & row.inside;
                rays[pack] = renderer_.camera_.straight_ray(column.window, row.window);
                rays_.primary += count_lanes(inside[pack]);
            }
            if (!renderer_.camera_.is_straight()) {
                bend(i, above + j, rays);
            }
            shader_.radiance(rays, renderer_.camera_.apex(), candidates_, inside, colors);
            for (int p = 0; p < packs; ++p) {
                const int pack_i = i + p % packs_across * pack_width,
                          pack_j = j + p / packs_across * pack_height;
                const Rgb<L>& color = colors[static_cast<std::size_t>(p)];
                keep(color.r, sample_at(0, pack_i, pack_j));
                keep(color.g, sample_at(1, pack_i, pack_j));
                keep(color.b, sample_at(2, pack_i, pack_j));
            }
        }
        /// The rays of the block from (i, j) of the tile's samples on.
        [[gnu::noinline]] void bend(int i, int j, std::array<Ray<L>, packs>& rays) const {
            for (int p = 0; p < packs; ++p) {
                const int pack_i = i + p % packs_across * pack_width,
                          pack_j = j + p / packs_across * pack_height;
                renderer_.camera_.bend(
                    columns_[static_cast<std::size_t>(pack_i / pack_width)].window,
                    rows_[static_cast<std::size_t>(pack_j / pack_height)].window,
                    [&](int lane) { return sample_of(pack_i, pack_j, lane); },
                    rays[static_cast<std::size_t>(p)]);
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
            for (int column = 0; column < columns; ++column, pixel += 3) {
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
        Shader<S, L>& shader_;
        RayCounts& rays_;
        int n_;
        int left_ = 0, top_ = 0;                ///< of the tile, in the picture
        std::size_t samples_across_;            ///< the tile
        std::vector<Positions> columns_, rows_; ///< of the tile's packs across and down
        Candidates candidates_ = all_candidates;
        std::array<std::vector<R>, 3> samples_; ///< of a strip: red, green, blue
    };

    bool is_searched_by_hierarchy() const {
        if constexpr (S::traits.accelerator) {
            return !scene_.accelerator.nodes.empty();
        } else {
            return false;
        }
    }
    /// Of the tile that begins at (x, y) of the crop, with so many pixels around it, seen with one more.
    Candidates candidates_in_tile(int x, int y, int around) const {
        if (boxes_.empty() || !camera_.is_straight()) {
            return all_candidates;
        }
        const auto corner = [&](int column, int row) {
            return camera_ray(scene_.camera, camera_.projection(),
                              camera_.window_x(static_cast<R>(request_.crop.x0 + column), R(0)),
                              camera_.window_y(static_cast<R>(request_.crop.y0 + row), R(0)));
        };
        const int more = around + 1;
        const int left = x - more, right = x + tile_size + more, top = y - more,
                  bottom = y + tile_size + more;
        return candidates_in(boxes_, ViewPart<R>({corner(left, top), corner(right, top),
                                                  corner(right, bottom), corner(left, bottom)}));
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
    CameraRays<S> camera_;
    int width_, height_;
    int tiles_across_, tiles_;
    std::vector<Bounds<R>> boxes_; ///< of the shapes that are tested one by one, in the order of Candidates
    Clock::time_point reported_ = Clock::now();
    alignas(cache_line) std::atomic<int> next_{0};
    std::atomic<int> done_{0};
    std::atomic<bool> stopped_{false};
};

} // namespace detail

/// Draws the crop into the image, which has its size and 3 channels. The pixels depend on neither
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
